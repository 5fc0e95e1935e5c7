"""Judge the up axis of a recording from the body in it."""

from collections.abc import Mapping
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from ...arrays import Array
from ...motion import (
    AxisName,
    FileConventions,
    Motion,
    Skeleton,
    find_humanoid_map,
)
from ...progress import Progress, Remark, unwatched
from .axes import longest_bone_path, rotation_to_z_up
from .contact import sampled_steps
from .file_axes import FORWARD, rotate_motion
from .standing_joints import (
    AXES,
    N_SAMPLED_FRAMES,
    StandingJoints,
    is_unfolded,
    measure_floor,
    measure_joint_contact,
    measure_rest,
    measure_standing,
    sampled_pairs,
    sampled_positions,
)

UpAxisName = AxisName

STANDING_WEIGHT = 1.0
"""Weight of the evidence of the motion: head above hips above feet in most frames, -1 to 1. By
definition 1: the others are relative to it."""
REST_WEIGHT = 0.8
"""Weight of the same in the rest pose: files are exported with it standing, but not always
turned as the motion is. Chosen by hand: x0.5 fails
`test_a_lying_actor_is_left_lying_and_reported`, x2 `test_any_axis_may_be_up`."""
FLOOR_WEIGHT = 0.3
"""Weight of the evidence of the floor: the lowest joint is near zero, 0 to 1. Chosen by hand:
x0.5 fails `test_any_axis_may_be_up`."""
CONTACT_WEIGHT = 1.0
"""Weight of the evidence of contact: the lowest joints rest, 0 to 1. The same as of the motion.
Sweep: of 346 cuts of HDM05 and CMU in three axes, x0.5 leaves a tenth more wrong or unclear."""
EXPECTED: dict[UpAxisName, float] = {"Y": 0.1, "Z": 0.05, "-X": -0.2, "-Y": -0.2, "-Z": -0.2}
"""Weight of the evidence of the format, 0 to 1 (that of motion is 1): BVH has Y up, some
programs write Z up, and a body that is upside down stands on its hands rather. Chosen by hand
below all of `FLOOR_WEIGHT`, 0.3."""
CLEAR_LEAD = 0.5
"""Lead, in the weights above, over the next axis below which the report says that the evidence
disagrees. Half of the evidence of the motion, 1. Measured: it is 1.6 and more in 79 of 87
upright takes of ten makers, and 0.1 to 0.9 in those whose rest pose has another axis."""
CLEAR_STANDING = 0.7
"""Evidence of motion and floor, each a ratio, from which another axis of the rest pose is
ignored. Measured: in upright takes of Bandai-Namco, whose rest pose lies, it is 0.91 and more;
the motion alone has 0.79 and more in all 87 takes."""
CLEAR_FLOOR_LEAD = 0.3
"""Lead of the evidence of the floor, a ratio, for that. Measured: it is 0.40 and more in those
takes, and 0.09 in `bvh_test3.bvh`, which is near zero on both axes."""
MIN_LYING_FLOOR = 0.8
"""Evidence of the floor along another axis, a ratio, from which the body may lie there rather
than stand. Measured: joints of an actor who lies are up to 8 % of the stature above the
floor."""
CLEAR_CONTACT_LEAD = 0.2
"""Lead of the evidence of contact, a ratio, from which the body may lie along another axis,
unless it stands on a floor. Measured: it is 0.16 in an upright take, `test_mocap.bvh`."""
MIN_REST_STANDING = 0.7
"""Evidence, a ratio, from which the rest pose has an axis of its own. Chosen by hand: x2 fails
`test_any_axis_may_be_up`."""


class UpAxis(NamedTuple):
    """Up axis of a file."""

    axis: UpAxisName
    rest_axis: UpAxisName
    """The same of the rest pose, which may differ."""
    is_clear: bool
    """Whether the evidence agrees."""
    confidence: float = 1.0
    """From 0.5, where two axes are equally likely, to 1 with a clear lead over the next."""


def estimate_up_axis(
    motion: Motion, expected: Mapping[UpAxisName, float] | None = None
) -> UpAxis:
    """Return the axis along which the actor stands.

    Four kinds of evidence are weighed against each other: whether the head is above the hips
    and these above the feet in most frames; the same in the rest pose; whether the lowest
    joint is near zero; and whether the lowest joints rest. Only joints
    with a humanoid role count, so that roots, props and stale offsets have no say. Where no
    body is recognized, Y is up unless all joints are stretched out flat.

    Parameters
    ----------
    motion : Motion
        Read as if Y were up.
    expected : mapping of axis to evidence, or None
        Evidence of a format whose rest pose is known to have Y up: only these axes are
        possible, and the rest pose has no vote. None: any axis, Y and Z rather.
    """
    positions = sampled_positions(motion)
    roles = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    body = StandingJoints.from_roles(roles)
    if body is None or not len(positions):
        return _estimate_by_extent(motion.skeleton, positions)
    rest = motion.skeleton.rest_positions[None]
    in_rest = dict.fromkeys(AXES, 0.0)
    if expected is None and is_unfolded(rest[0], body):
        in_rest = measure_standing(rest, body)
    contact = measure_joint_contact(*sampled_pairs(motion), body)
    estimated = _weigh(positions, body, in_rest, contact, expected)
    rest_best = max(AXES, key=lambda axis: in_rest[axis])
    if expected:
        return estimated._replace(rest_axis="Y")
    stands = in_rest[rest_best] > MIN_REST_STANDING
    return estimated._replace(rest_axis=rest_best) if stands else estimated


def estimate_up_of_joints(
    positions: Array, roles: Mapping[str, int], expected: Mapping[UpAxisName, float]
) -> UpAxis:
    """Return the axis along which joints stand that were read with Y up.

    Frames count in which hips, head and feet are observed; other joints may be missing.

    Parameters
    ----------
    positions : shape (n_frames, n_joints, 3); NaN where missing
    roles : index of each humanoid role
    expected : evidence of the format for each axis that is possible
    """
    is_observed = np.isfinite(positions).all(axis=2)
    body = StandingJoints.from_roles({
        role: joint for role, joint in roles.items() if is_observed[:, joint].any()
    })
    shown = [] if body is None else [body.hips, body.head, *body.feet]
    is_shown = is_observed[:, shown].all(axis=1)
    observed = positions[is_shown]
    if body is None or not len(observed):
        best = max(expected, key=lambda axis: expected[axis])
        return UpAxis(best, best, is_clear=False, confidence=0.5)
    step = max(1, len(observed) // N_SAMPLED_FRAMES)
    steps = sampled_steps(is_shown)
    contact = measure_joint_contact(positions[steps], positions[steps + 1], body)
    return _weigh(observed[::step], body, dict.fromkeys(AXES, 0.0), contact, expected)


def _weigh(
    positions: Array,
    body: "StandingJoints",
    in_rest: Mapping[UpAxisName, float],
    contact: Mapping[UpAxisName, float],
    expected: Mapping[UpAxisName, float] | None,
) -> UpAxis:
    """Weigh the evidence; the rest pose gets the axis of the motion.

    A body that stands along an axis that the format does not have is no clear case. Neither is
    one that may lie along another axis.
    """
    standing = measure_standing(positions, body)
    floor = measure_floor(positions, body)
    totals = {
        axis: STANDING_WEIGHT * standing[axis]
        + REST_WEIGHT * in_rest[axis]
        + FLOOR_WEIGHT * floor[axis]
        + CONTACT_WEIGHT * contact[axis]
        + (expected or EXPECTED).get(axis, 0.0)
        for axis in expected or AXES
    }
    rest = measure_rest(positions, body, floor)
    resting = {axis: rest[axis] for axis in totals}
    best, second = sorted(totals, key=lambda axis: totals[axis], reverse=True)[:2]
    lead = (totals[best] - totals[second]) / CLEAR_LEAD
    on_floor = floor[best] - floor[second] >= CLEAR_FLOOR_LEAD
    stands = min(standing[best], floor[best]) if on_floor else 0.0
    elsewhere = max((standing[axis] for axis in AXES if axis not in totals), default=0.0)
    is_elsewhere = elsewhere >= CLEAR_STANDING and elsewhere > standing[best]
    may_lie = (
        _rests_elsewhere(best, resting, contact)
        if min(standing[best], in_rest[best]) >= CLEAR_STANDING
        else _may_lie(best, in_rest, floor, resting, contact, stands < CLEAR_STANDING)
    )
    sure = 0.0 if is_elsewhere or may_lie else max(lead, stands)
    is_clear = sure > 0.0 and (lead >= 1.0 or stands >= CLEAR_STANDING)
    confidence = 1.0 if is_clear else float(np.clip(sure, 0.0, 0.99))
    return UpAxis(best, best, is_clear, 0.5 + 0.5 * confidence)


def _may_lie(
    best: UpAxisName,
    in_rest: Mapping[UpAxisName, float],
    floor: Mapping[UpAxisName, float],
    resting: Mapping[UpAxisName, float],
    contact: Mapping[UpAxisName, float],
    is_off_floor: bool,
) -> bool:
    """Whether a body may lie along another axis than that along which it would stand.

    It does if it is on zero there, and its feet are far from zero or its rest pose stands along
    that axis and its feet do not rest clearly; and if, off the floor, it rests there.
    """
    lying = max((axis for axis in resting if axis != best), key=lambda axis: resting[axis])
    is_rival = resting[lying] - floor[best] >= CLEAR_FLOOR_LEAD or (
        in_rest[lying] > MIN_REST_STANDING
        and contact[best] - contact[lying] < CLEAR_CONTACT_LEAD
    )
    rests = max(contact[axis] for axis in resting if axis[-1] != best[-1]) - contact[best]
    return (resting[lying] >= MIN_LYING_FLOOR and is_rival) or (
        is_off_floor and rests >= CLEAR_CONTACT_LEAD
    )


def _rests_elsewhere(
    best: UpAxisName,
    resting: Mapping[UpAxisName, float],
    contact: Mapping[UpAxisName, float],
) -> bool:
    """Whether a body that stands like its rest pose both is on zero and rests along an axis.

    One of these by itself is an accident, such as of a camera next to the feet.
    """
    return any(
        resting[axis] >= MIN_LYING_FLOOR and contact[axis] - contact[best] >= CLEAR_CONTACT_LEAD
        for axis in resting
        if axis[-1] != best[-1]
    )


def stand_upright(
    motion: Motion,
    progress: Progress = unwatched,
    expected: Mapping[UpAxisName, float] | None = None,
) -> Motion:
    """Turn a motion that was read with Y up so that the actor stands (`estimate_up_axis`).

    What was estimated is noted in its conventions. `progress` is given a message where the
    evidence disagrees.
    """
    estimated = estimate_up_axis(motion, expected)
    if not estimated.is_clear:
        progress(1.0, Remark(describe_guessed_axis(estimated.axis)))
    noted = replace(
        motion.conventions or FileConventions(),
        up=estimated.axis,
        forward=FORWARD[estimated.axis],
        rest_up=estimated.rest_axis,
        confidence=estimated.confidence,
    )
    rotated = rotate_to_z_up(motion, estimated.axis, estimated.rest_axis)
    return replace(rotated, conventions=noted)


def describe_guessed_axis(axis: UpAxisName) -> str:
    """Report which axis is interpreted as up where the evidence disagrees."""
    return (
        f"{axis} is interpreted as up, but the take does not show it clearly; set Up if the"
        " actor lies on its side"
    )


def rotate_to_z_up(motion: Motion, axis: UpAxisName, rest_axis: UpAxisName) -> Motion:
    """Turn a motion that was read with Y up so that the right axes are up.

    Parameters
    ----------
    motion : Motion
    axis : axis of the file that is up in the motion
    rest_axis : the same for the rest pose
    """
    if axis == rest_axis == "Y":
        return motion
    return rotate_motion(motion, rotation_to_z_up(axis), rotation_to_z_up(rest_axis))


def _estimate_by_extent(skeleton: Skeleton, positions: Array) -> UpAxis:
    """Return Z where something is flat with Y up, in the rest pose and in most frames."""
    flat = skeleton.rest_positions[None] if not len(positions) else positions
    extents = [
        np.median(np.ptp(points, axis=1), axis=0)
        for points in (skeleton.rest_positions[None], flat)
    ]
    reach = longest_bone_path(skeleton.parents, skeleton.offsets)
    is_flat = all(y > z for _, y, z in extents) and extents[0][1] > max(
        2.0 * extents[0][2], 0.5 * reach
    )
    axis: UpAxisName = "Z" if is_flat else "Y"
    return UpAxis(axis, axis, is_clear=True)
