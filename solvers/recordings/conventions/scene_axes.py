"""Turn takes of files of other programs upright, where the bodies refute the stated axis."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ...motion import AxisName, Motion, find_humanoid_map
from .axes import rotation_to_z_up
from .body_unit import MIN_MAP_SCORE
from .file_axes import conventions_of, rotate_motion, rotated_conventions
from .standing_joints import (
    AXES,
    StandingJoints,
    height_of,
    is_unfolded,
    measure_floor,
    measure_standing,
    sampled_positions,
)

STATED: AxisName = "Y"
"""The axis of `AXES` that a file states: importers have turned it up."""
MIN_STANDING = 0.8
"""Evidence of the motion, a ratio, from which a body stands along an axis. Chosen by hand: it
stands in 90 % of the frames."""
MAX_STANDING = 0.5
"""Evidence along the stated axis, a ratio, from which it is believed. Measured: a take of rolls
has 0.49 (docs/benchmarks/importing.md)."""
MIN_FLOOR = 0.8
"""Evidence of the floor, a ratio, that counts. Chosen by hand: the lowest joint of an adult is
within 14 cm of height 0."""
MIN_TRAVEL_FRACTION = 0.75
"""Travel, relative to the height of the body, that counts. Chosen by hand: hips rise by 0.5
when an actor gets up from the floor."""
MAX_ASYMMETRY = 0.03
"""Distance of a joint from the mirror image of the other side's, relative to the height, in a
rest pose that was made by design. Chosen by hand: 5 cm of an adult."""
MIN_VOTES = 2
"""Number of witnesses against the stated axis from which a take is turned. Chosen by hand: each
by itself may be an accident."""


class _Verdict(NamedTuple):
    """What one take shows."""

    axis: AxisName
    """Along which the body stands, in most frames."""
    is_standing: bool
    """Whether that is the stated axis, or nearly."""
    is_refuted: bool
    """Whether the stated axis cannot be right."""


def stand_scene_upright(takes: Sequence[Motion]) -> list[Motion]:
    """Return the takes of a file, turned where its up axis cannot be right.

    Three witnesses are heard about a body that lies or is upside down in most frames: whether
    its rest pose, made by design, stands along the same axis as the motion; whether its feet
    are at height 0 along that axis; and whether the actor would rise by most of its height.
    Two of them are enough. A rest pose that stands as the file states, or travel head first,
    is one against. Nothing is turned where a body of the file stands: its axes are right.

    Parameters
    ----------
    takes : sequence of Motion
        All of one file, read by the axes that the file states.

    Returns
    -------
    list of Motion
        With `stated_up` in the conventions of takes that were turned.
    """
    verdicts = [verdict for verdict in map(_verdict, takes) if verdict is not None]
    axes = {verdict.axis for verdict in verdicts if verdict.is_refuted}
    if len(axes) != 1 or any(verdict.is_standing for verdict in verdicts):
        return list(takes)
    rotation = rotation_to_z_up(axes.pop())
    return [_rotate_take(take, rotation) for take in takes]


def _rotate_take(take: Motion, rotation: Array) -> Motion:
    stated = conventions_of(take)
    corrected = replace(rotated_conventions(stated, rotation), stated_up=stated.up)
    return replace(rotate_motion(take, rotation, rotation), conventions=corrected)


def _verdict(take: Motion) -> _Verdict | None:
    """Return what a take shows; None where no person is recognized."""
    humanoid = find_humanoid_map(take.skeleton)
    if humanoid.score < MIN_MAP_SCORE:  # the trunk of an animal lies
        return None
    roles = humanoid.indices(take.skeleton)
    body, positions = StandingJoints.from_roles(roles), sampled_positions(take)
    if (
        body is None
        or not {"head", "leftFoot", "rightFoot"} <= roles.keys()
        or not len(positions)
    ):
        return None
    standing = measure_standing(positions, body)
    axis = max(AXES, key=lambda each: standing[each])
    if axis == STATED or standing[STATED] > MAX_STANDING:
        return _Verdict(axis, is_standing=True, is_refuted=False)
    votes = (
        _vote_of_rest(take.skeleton.rest_positions, body, roles, axis)
        + (measure_floor(positions, body)[axis] >= MIN_FLOOR)
        + _vote_of_travel(positions, body, axis)
    )
    is_refuted = standing[axis] >= MIN_STANDING and votes >= MIN_VOTES
    return _Verdict(axis, is_standing=False, is_refuted=is_refuted)


def _vote_of_rest(
    rest: Array, body: StandingJoints, roles: Mapping[str, int], axis: AxisName
) -> int:
    """Return 1 for a designed rest pose that stands along an axis, -1 along the stated one."""
    if not is_unfolded(rest, body):
        return 0
    standing = measure_standing(rest[None], body)
    if standing[STATED] >= MIN_STANDING:
        return -1
    return int(standing[axis] >= MIN_STANDING and _is_symmetric(rest, body, roles))


def _is_symmetric(rest: Array, body: StandingJoints, roles: Mapping[str, int]) -> bool:
    """Whether left and right mirror each other, as in no frame of a recording."""
    sides = [
        rest[[roles[role], roles[f"right{role.removeprefix('left')}"]]] - rest[body.hips]
        for role in roles
        if role.startswith("left") and f"right{role.removeprefix('left')}" in roles
    ]
    left, right = np.stack(sides, axis=1)
    across = (left - right).mean(axis=0)
    across /= max(float(np.linalg.norm(across)), 1e-9)
    mirrored = right - 2.0 * (right @ across)[:, None] * across
    tolerance = MAX_ASYMMETRY * height_of(rest[None], body)
    return bool(np.linalg.norm(left - mirrored, axis=1).max() <= tolerance)


def _vote_of_travel(positions: Array, body: StandingJoints, axis: AxisName) -> int:
    """Return 1 if an actor would rise by most of its height, -1 where it travels head first."""
    travel = np.ptp(positions[:, body.hips], axis=0)
    rise, ahead = (float(travel @ np.abs(AXES[each])) for each in (STATED, axis))
    enough = MIN_TRAVEL_FRACTION * height_of(positions, body)
    if rise >= enough and rise > 2.0 * ahead:
        return 1
    return -int(ahead >= enough and ahead > rise)
