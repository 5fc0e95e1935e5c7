"""Turn the joints of one body as those of another are turned in the world."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..motion import WorldPoses
from ..rotations import IDENTITY, inverse, multiply, slerp
from .body import Body
from .trunk_lean import leaning_swings

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

TRUNK = ("spine", "chest", "upperChest")
NECK = ("neck", "head")


class Turn(NamedTuple):
    """How a part of the body is turned in the world, and which joints had a share in it."""

    rotations: Array
    """From the canonical T-pose, shape (n_frames, 4)."""
    joints: frozenset[int]
    """Of the source's body."""


def transfer_pose(
    source: Body, seen: WorldPoses, unknown: Flags, target: Body
) -> tuple[Array, Flags]:
    """Return the target's local rotations that give each part the source's orientation.

    A role that both bodies have is turned in the world as in the source. The spine is a chain
    whose lower end turns with the hips: where the numbers of joints differ, the turns of the
    source are spread evenly over the target's, and the top is turned as in the source; so is
    the neck, between chest and head. The spine swings a little for the neck to be where the
    source's is (`leaning_swings`). All else rests relative to its parent.

    Parameters
    ----------
    source, target : Body
    seen : WorldPoses
        Of the source.
    unknown : bool, shape (n_frames, n_source_joints)
        Where the source's local rotations were not observed.

    Returns
    -------
    rotations : shape (n_frames, n_target_joints, 4)
    unknown : bool, shape (n_frames, n_target_joints)
        Rotations that rest on something not observed.
    """
    wanted = _leaning(source, seen, target, _wanted_turns(source, seen.rotations, target))
    n_frames = len(seen.rotations)
    skeleton = target.skeleton
    local = np.tile(IDENTITY, (n_frames, skeleton.n_joints, 1))
    missing = np.zeros((n_frames, skeleton.n_joints), dtype=np.bool_)
    present: list[Turn] = []
    for joint, parent in enumerate(skeleton.parents):
        above = present[parent] if parent >= 0 else Turn(IDENTITY, frozenset())
        turn = wanted.get(joint)
        if turn is None:
            present.append(above)
            continue
        # World rotations from the target's rest pose; `above` holds such, not canonical ones.
        rotations = multiply(turn.rotations, inverse(target.alignment[joint]))
        local[:, joint] = multiply(inverse(above.rotations), rotations)
        shares = sorted(turn.joints ^ above.joints)
        missing[:, joint] = unknown[:, shares].any(axis=1)
        present.append(Turn(rotations, turn.joints))
    return local, missing


def _wanted_turns(source: Body, world: Array, target: Body) -> dict[int, Turn]:
    """Return the turn of each target joint that gets one."""
    turns = {role: _turn(source, world, joint) for role, joint in source.joints.items()}
    given = dict(turns)
    trunk = [role for role in TRUNK if role in turns]
    top = turns[trunk[-1]] if trunk else turns["hips"]
    if trunk:
        chain = [turns["hips"], *(turns[role] for role in trunk)]
        given |= _spread(chain, [role for role in TRUNK if role in target.joints])
    if "head" in turns:
        chain = [top, *(turns[role] for role in NECK if role in turns)]
        given |= _spread(chain, [role for role in NECK if role in target.joints])
    return {target.joints[role]: turn for role, turn in given.items() if role in target.joints}


def _leaning(
    source: Body, seen: WorldPoses, target: Body, wanted: dict[int, Turn]
) -> dict[int, Turn]:
    """Return the turns with those of the trunk swung so that it leans as the source's."""
    trunk = [target.joints[role] for role in TRUNK if target.joints.get(role) in wanted]
    turned = {
        joint: multiply(turn.rotations, inverse(target.alignment[joint]))
        for joint, turn in wanted.items()
    }
    hips = wanted[target.joints["hips"]].rotations
    swings = leaning_swings(source, target, seen, hips, turned, trunk)
    return wanted | {
        joint: Turn(multiply(swing, wanted[joint].rotations), wanted[joint].joints)
        for joint, swing in swings.items()
    }


def _turn(source: Body, world: Array, joint: int) -> Turn:
    shares = frozenset((joint, *source.skeleton.ancestors(joint)))
    return Turn(multiply(world[:, joint], source.alignment[joint]), shares)


def _spread(chain: list[Turn], roles: list[str]) -> dict[str, Turn]:
    """Spread a chain's turns, its first being where it is rooted, evenly over the roles."""
    spread = {}
    for number, role in enumerate(roles, start=1):
        lower, rest = divmod(number * (len(chain) - 1), len(roles))
        if rest == 0:
            spread[role] = chain[lower]
            continue
        start, stop = chain[lower], chain[lower + 1]
        fraction = np.array(rest / len(roles))
        between = slerp(start.rotations, stop.rotations, fraction)
        spread[role] = Turn(between, start.joints | stop.joints)
    return spread
