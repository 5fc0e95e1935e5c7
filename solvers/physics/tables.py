"""Tables of a human body's masses, sizes and strengths by segment."""

from ..motion.humanoid import ARM_ROLES, CENTRAL_ROLES, LEG_ROLES, SIDES

ROLES = (
    *CENTRAL_ROLES,
    *(side + part for side in SIDES for part in (*LEG_ROLES, *ARM_ROLES)),
)
"""Humanoid roles with a segment of their own, 22 at most; hands and feet are one segment
each."""

HUMAN_MASS_KG = 70.0
"""Mass of a body whose legs are 0.9 m long; it grows with the cube of that length. Reference
Man of the International Commission on Radiological Protection (1975), Publication 23."""

MASS_FRACTIONS = {
    "hips": 0.1182, "spine": 0.1549, "chest": 0.0665, "upperChest": 0.0665,
    "neck": 0.0120, "head": 0.0561,
    "Shoulder": 0.0120, "UpperArm": 0.0263, "LowerArm": 0.0150, "Hand": 0.0059,
    "UpperLeg": 0.1447, "LowerLeg": 0.0457, "Foot": 0.0113, "Toes": 0.0020,
}  # fmt: skip
"""Fractions of the mass of a body, by De Leva (1996, doi:10.1016/0021-9290(95)00178-6), table
4, mean of women and men. His upper trunk is divided among chest and shoulders, his head among
head and neck, his foot among foot and toes."""

STRENGTHS_NM = {
    "spine": 600.0, "chest": 550.0, "upperChest": 500.0, "neck": 110.0, "head": 70.0,
    "Shoulder": 200.0, "UpperArm": 160.0, "LowerArm": 110.0, "Hand": 30.0,
    "UpperLeg": 600.0, "LowerLeg": 550.0, "Foot": 400.0, "Toes": 120.0,
}  # fmt: skip
"""Maximum torque of a joint, for legs of 0.9 m. Chosen by hand at about 2 times what was
measured on strong adults: with those values, jumpers whose feet were captured slightly off did
not leave the ground."""

DEFAULT_STRENGTH_NM = 400.0
"""Maximum torque of a joint without a role. Half and twice gain less than 1 %
(`make sensitivity`)."""

SEGMENT_LENGTHS_M = {"head": 0.2, "Hand": 0.16, "Toes": 0.06, "Foot": 0.15}
"""Length of a segment without a joint at its end, meters, for legs of 0.9 m. Chosen by hand, to
0.01 m."""

MAX_RADIUS_M = 0.105
"""Radius of the thickest capsule, for legs of 0.9 m: trunks are not round. Chosen by hand;
`make sensitivity` varies it."""

DENSITY_KG_M3 = 1000.0
"""Density of a body: by definition that of water, in which people just float."""


def role_without_side(role: str) -> str:
    """Return the role without its side: UpperArm for leftUpperArm."""
    return role.removeprefix("left").removeprefix("right")


def next_roles(role: str) -> tuple[str, ...]:
    """Return the roles at which a segment may end, best first."""
    if role in CENTRAL_ROLES:
        return CENTRAL_ROLES[CENTRAL_ROLES.index(role) + 1 :]
    part = role_without_side(role)
    chain = LEG_ROLES if part in LEG_ROLES else ARM_ROLES
    side = role.removesuffix(part)
    return tuple(side + below for below in chain[chain.index(part) + 1 :])


def find_mass_role(role: str, played: "set[str] | dict[str, int]") -> str:
    """Return the role that carries a segment's mass: its own, or the nearest above it."""
    while role not in played:
        part = role_without_side(role)
        if role in CENTRAL_ROLES:
            role = CENTRAL_ROLES[CENTRAL_ROLES.index(role) - 1] if role != "hips" else ""
        elif part in {"UpperLeg", "Shoulder"}:
            role = "hips" if part == "UpperLeg" else "upperChest"
        else:
            chain = LEG_ROLES if part in LEG_ROLES else ARM_ROLES
            role = role.removesuffix(part) + chain[chain.index(part) - 1]
        if not role:
            return ""
    return role
