"""Animals are no people, and people who face another way keep their sides."""

import numpy as np
import pytest
from rigs import RIGS

from solvers.motion import Skeleton, find_humanoid_map
from solvers.motion.humanoid.roles import MIN_NAME_SCORE
from solvers.rotations import inverse, normalize, rotate

NO_PERSON = 0.5
"""Confidence below which the panel does not call a map that of a person."""


class Tree:
    """A skeleton that grows."""

    def __init__(self, root, position):
        self.names, self.parents, self.offsets = [root], [-1], [np.array(position, float)]

    def add(self, parent, *links):
        """Add a chain of names and offsets below a joint."""
        for name, offset in links:
            self.parents.append(self.names.index(parent))
            self.names.append(name)
            self.offsets.append(np.array(offset, float))
            parent = name

    @property
    def skeleton(self):
        return Skeleton(tuple(self.names), tuple(self.parents), np.array(self.offsets))


def crab():
    """Ten legs of five joints, eyes on stalks, as of a game."""
    tree = Tree("ORG_Hips", (0, 0, 0.4))
    tree.add("ORG_Hips", ("BN_Pelvis", (0, 0, 0.05)))
    for side, sign in (("L", 1), ("R", -1)):
        tree.add(
            "BN_Pelvis", *((f"BN_Eye_{side}_{n}", (sign * 0.03, -0.1, 0.05)) for n in "12")
        )
        for leg in range(5):
            y = -0.3 + 0.15 * leg
            steps = [
                (0.2, y, 0.0),
                (0.25, y / 3, 0.2),
                (0.3, 0, 0),
                (0.25, 0, -0.35),
                (0.1, 0, -0.25),
            ]
            tree.add(
                "BN_Pelvis",
                *(
                    (f"BN_Leg_{side}_{leg}{n}", (sign * x, y, z))
                    for n, (x, y, z) in enumerate(steps)
                ),
            )
    return tree.skeleton


def horse(names="{}"):
    """A horse of 3ds Max Biped, with the joints of a person and hooves."""

    def called(name):
        return names.format(name)

    tree = Tree(called("Pelvis"), (0, 0.5, 1.4))
    chain = lambda *links: [(called(name), offset) for name, offset in links]  # noqa: E731
    tree.add(
        called("Pelvis"),
        *chain(
            ("Spine", (0, -0.2, 0.02)),
            ("Spine1", (0, -0.25, 0)),
            ("Spine2", (0, -0.3, 0.02)),
            ("Neck", (0, -0.25, 0.15)),
            ("Neck1", (0, -0.25, 0.3)),
            ("Head", (0, -0.2, 0.3)),
        ),
    )
    tree.add(called("Pelvis"), *chain(("Tail", (0, 0.3, 0.1)), ("Tail1", (0, 0.2, -0.3))))
    for side, sign in (("L", 1), ("R", -1)):
        tree.add(
            called("Pelvis"),
            *chain(
                (f"{side} Thigh", (sign * 0.15, 0.05, -0.1)),
                (f"{side} Calf", (0, -0.2, -0.4)),
                (f"{side} HorseLink", (0, 0.3, -0.3)),
                (f"{side} Foot", (0, 0, -0.4)),
                (f"{side} Toe0", (0, -0.1, -0.15)),
            ),
        )
        tree.add(
            called("Spine2"),
            *chain(
                (f"{side} Clavicle", (sign * 0.1, -0.05, -0.05)),
                (f"{side} UpperArm", (sign * 0.05, -0.2, -0.3)),
                (f"{side} Forearm", (0, 0.15, -0.2)),
                (f"{side} Hand", (0, 0, -0.4)),
                (f"{side} Finger0", (0, -0.05, -0.3)),
            ),
        )
    return tree.skeleton  # fmt: skip


def wolf(trunk):
    """A wolf with the joints of a person, called as those of MotionBuilder."""
    tree = Tree("Hips", (0, 0.3, 0.65))
    tree.add("Hips", ("Spine", (0, -0.35 * trunk, 0)), ("Spine1", (0, -0.45 * trunk, 0)))
    tree.add("Spine1", ("Neck", (0, -0.2 * trunk, 0.05)), ("Head", (0, -0.15, 0.15)))
    tree.add("Hips", ("Tail", (0, 0.08, 0)), ("Tail1", (0, 0.12, -0.1)))
    for side, sign in (("Left", 1), ("Right", -1)):
        links = [("Shoulder", (sign * 0.04, 0, -0.02)), ("Arm", (sign * 0.04, -0.05, -0.08)),
                 ("ForeArm", (0, 0.13, -0.18)), ("Hand", (0, -0.03, -0.2))]  # fmt: skip
        tree.add("Spine1", *((side + name, offset) for name, offset in links))
        links = [("UpLeg", (sign * 0.08, 0, -0.05)), ("Leg", (0, -0.1, -0.22)),
                 ("Foot", (0, 0.18, -0.13)), ("ToeBase", (0, -0.05, -0.2))]  # fmt: skip
        tree.add("Hips", *((side + name, offset) for name, offset in links))
    return tree.skeleton


@pytest.mark.parametrize("trunk", [0.4, 0.6, 0.8])
def test_a_wolf_with_the_names_of_a_person_is_none(trunk):
    """Its trunk lies between its legs, whatever joints a table leaves out."""
    assert find_humanoid_map(wolf(trunk)).score < NO_PERSON


@pytest.mark.parametrize(
    "animal", [crab(), horse(), horse("Bip01 {}"), horse("j_{}_x")], ids=lambda a: a.names[0]
)
def test_animals_are_not_people(animal):
    assert find_humanoid_map(animal).score < NO_PERSON


@pytest.mark.parametrize("family", ["Mixamo", "Unreal"])
@pytest.mark.parametrize("rotation", [(-1, -1, 1), (1, 1, 1)])
@pytest.mark.parametrize("has_toes", [True, False])
def test_sides_are_those_of_the_names_wherever_the_body_faces(family, rotation, has_toes):
    """Names of no table, but for a side: an avatar that faces +Y is not mirrored."""
    rig = RIGS[family](1.0)
    kept = [j for j, name in enumerate(rig.names) if has_toes or not is_toe(name)]
    side = {1: "_L", -1: "_R", 0: ""}
    names = [
        f"bone{j}{side[int(np.sign(np.round(rig.rest_positions[j, 0], 3)))]}" for j in kept
    ]
    parents = [kept.index(rig.parents[j]) if rig.parents[j] >= 0 else -1 for j in kept]
    other = Skeleton(tuple(names), tuple(parents), rig.offsets[kept] * rotation)

    found = find_humanoid_map(other)

    sided = {role: name for role, name in found.joints.items() if "eg" in role or "rm" in role}
    assert len(sided) >= 8
    assert {role: name[-1] for role, name in sided.items()} == {
        role: role[0].upper() for role in sided
    }
    assert found.score > MIN_NAME_SCORE / 2


@pytest.mark.parametrize("family", ["Mixamo", "Unreal", "Rigify"])
def test_bones_along_one_axis_at_rest_keep_the_roles_of_their_names(family):
    """Rokoko and others store every bone along X; only the hips show a width."""
    rig = RIGS[family](1.0)
    lengths = np.linalg.norm(rig.offsets, axis=1)
    along = np.array([1.0, 0.0, 0.0]) * lengths[:, None]
    beside = np.abs(rig.offsets[:, 0]) > 0.5 * lengths
    offsets = np.where(beside[:, None], rig.offsets, along)

    found = find_humanoid_map(Skeleton(rig.names, rig.parents, offsets))

    assert found.joints == find_humanoid_map(rig).joints
    assert found.score == 1.0


@pytest.mark.parametrize("family", ["Mixamo", "Unreal", "Rigify"])
def test_a_rest_pose_of_a_somersault_keeps_the_roles_of_its_names(family):
    """An animation without its mesh rests in its first frame: here bent double."""
    rig = RIGS[family](1.0)
    upper = next(
        j
        for j, name in enumerate(rig.names)
        if name.endswith(("Spine", "spine_01", "spine.001"))
    )
    offsets = rig.offsets.copy()
    for joint in rig.subtree(upper):
        if joint != upper:
            offsets[joint] *= (1.0, -1.0, -1.0)  # half a turn about X

    found = find_humanoid_map(Skeleton(rig.names, rig.parents, offsets))

    assert found.joints == find_humanoid_map(rig).joints
    assert found.score == 1.0


def test_any_rest_axes_and_a_neck_in_the_chest_keep_the_roles_of_the_names(rng):
    """Of CMU's walks as another tool writes them: each joint at rest has axes of its own."""
    rig = RIGS["Mixamo"](1.0)
    roles = find_humanoid_map(rig).joints
    neck, foot = rig.index(roles["neck"]), rig.index(roles["leftFoot"])
    trunk = [neck, *rig.ancestors(neck)][
        : rig.ancestors(neck).index(rig.index(roles["hips"])) + 1
    ]
    leg = [foot, rig.parents[foot]]
    lengths = np.linalg.norm(rig.offsets, axis=1)
    offsets = rig.offsets.copy()
    offsets[trunk] *= 0.28 * lengths[leg].sum() / lengths[trunk].sum()
    for _ in range(10):
        axes = normalize(rng.normal(size=(rig.n_joints, 4)))
        rotated = offsets.copy()
        for joint, parent in enumerate(rig.parents):
            if parent >= 0:
                rotated[joint] = rotate(inverse(axes[parent]), offsets[joint])

        found = find_humanoid_map(Skeleton(rig.names, rig.parents, rotated))

        assert found.joints == roles


def test_plain_words_of_a_game_are_enough():
    """As of a robot: no collar bones, and other bones that control it."""
    rows = [
        ("MASTER", "", (0, 0, 0)), ("hip", "MASTER", (0, 0, 0.63)),
        ("waist", "hip", (0, 0, 0.12)),
        ("chest", "waist", (0, 0, 0.25)), ("neck", "chest", (0, 0, 0.37)),
        ("head", "neck", (0, 0.05, 0.15)), ("HEAD_AIM", "MASTER", (0, -1.7, 1.9)),
    ]  # fmt: skip
    for side, sign in (("l", 1), ("r", -1)):
        rows += [
            (f"{side}-arm", "chest", (sign * 0.28, 0, 0.23)),
            (f"{side}-forearm", f"{side}-arm", (sign * 0.2, 0.1, -0.18)),
            (f"{side}-hand", f"{side}-forearm", (sign * 0.25, -0.1, -0.2)),
            (f"{side}-thigh", "hip", (sign * 0.1, 0, 0.05)),
            (f"{side}-leg", f"{side}-thigh", (sign * 0.02, 0, -0.2)),
            (f"{side}-foot", f"{side}-leg", (sign * 0.03, 0, -0.43)),
            (f"{side}-LEGCONTROL", "MASTER", (sign * 0.15, 0, 0.06)),
        ]
    names = [name for name, _, _ in rows]
    parents = tuple(names.index(parent) if parent else -1 for _, parent, _ in rows)
    skeleton = Skeleton(tuple(names), parents, np.array([row[2] for row in rows], float))

    found = find_humanoid_map(skeleton)

    assert found.score > MIN_NAME_SCORE
    assert found.joint("hips") == "hip"
    assert found.joint("leftUpperArm") == "l-arm"
    assert found.joint("rightLowerLeg") == "r-leg"
    assert found.joint("head") == "head"


def is_toe(name):
    return "Toe" in name or "ball" in name


@pytest.mark.parametrize("wrapper", ["Root", "ROOT"])
def test_hips_are_below_a_wrapper_of_the_same_name(wrapper):
    """Acclaim calls its hips "root", as many programs call what they put above them."""
    tree = Tree(wrapper, (0, 0, 0))
    tree.add(wrapper, ("root", (0, 0, 0.95)))
    tree.add(
        "root",
        ("lowerback", (0, 0, 0.1)),
        ("upperback", (0, 0, 0.12)),
        ("thorax", (0, 0, 0.12)),
        ("lowerneck", (0, 0, 0.12)),
        ("upperneck", (0, 0, 0.06)),
        ("head", (0, 0, 0.08)),
    )
    for side, sign in (("l", 1), ("r", -1)):
        tree.add(
            "root",
            (f"{side}hipjoint", (0, 0, 0)),
            (f"{side}femur", (0.1 * sign, 0, -0.05)),
            (f"{side}tibia", (0.05 * sign, 0, -0.42)),
            (f"{side}foot", (0, 0, -0.42)),
            (f"{side}toes", (0, -0.15, -0.05)),
        )
        tree.add(
            "thorax",
            (f"{side}clavicle", (0, 0, 0.05)),
            (f"{side}humerus", (0.18 * sign, 0, 0.05)),
            (f"{side}radius", (0.28 * sign, 0, 0)),
            (f"{side}wrist", (0.14 * sign, 0, 0)),
            (f"{side}hand", (0.07 * sign, 0, 0)),
        )

    found = find_humanoid_map(tree.skeleton)

    assert found.joints["hips"] == "root"
    assert found.score == 1.0
