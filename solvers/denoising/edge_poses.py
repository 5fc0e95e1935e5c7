"""Find poses at the ends of a take in which a limb does not belong to the movement."""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..motion import Motion, Tracks, find_humanoid_map
from ..motion.skeletons import MIN_SHOT_S, is_short_shot, shot_ranges
from ..rotations import inverse, multiply, rotation_vector_from_quaternion

HIPS = "hips"
NAMES = ("left arm", "left leg", "right arm", "right leg", "head", "hips")
ROLES = {
    "arm": ("Shoulder", "UpperArm", "LowerArm"), "leg": ("UpperLeg", "LowerLeg"),
    "head": ("neck", "head"), HIPS: ("hips",),
}  # fmt: skip
LIMBS = {
    name: tuple(side + role for role in ROLES[limb])
    for name in NAMES
    for side, _, limb in [name.rpartition(" ")]
}
"""Humanoid roles of each limb; the first one that exists is its top."""
MIN_JUMP_RAD = np.radians(35.0)
"""Change of the rotation step of a limb from one frame to the next, radians. Measured: 32 real
takes from 30 to 120 Hz (runs, kicks, boxing, dance), cut into 37,352 takes of 0.8 and 2 s, have
at most 34 degrees at an end, and an arm in a T-pose has 80 to 150. No head and no hips have
more in 4,902 such takes."""
MIN_RATIO = 2.5
"""The same change, as a ratio to the 95th percentile within the take. Sweep on these takes with
noise of 0 to 3 degrees: at 2.5 no movement is kept apart, at 2 there is one."""
TYPICAL_PERCENTILE = 95.0
"""Percentile of the changes that stands for the take, by definition of the ratio above."""
ONE_SIDED_WEIGHT = 2.0 / 3.0
"""Ratio by which the change at the first and the last step counts, which only one other step
predicts. Chosen by hand on these takes, whose real changes are larger there."""


class EdgePose(NamedTuple):
    """A limb near the start or end of a take, separated from the rest by a jump."""

    limb: str
    joints: tuple[int, ...]
    start: int
    stop: int


def find_edge_poses(recording: Motion | Tracks, cuts: tuple[int, ...]) -> tuple[EdgePose, ...]:
    """Return limbs that are in a separate pose within a quarter second of either end of a shot.

    The head and the hips count as limbs, the hips without what hangs on them. Trackers and
    hand-made actions often begin with a limb in the T-pose. The limb then makes
    one step that neither the step before nor the step after predicts. How well steps are
    predicted is measured on the take itself; a fast stroke speeds up and slows down over
    several frames. Tracks have no limbs.
    """
    if isinstance(recording, Tracks):
        return ()
    skeleton = recording.skeleton
    joints = find_humanoid_map(skeleton).indices(skeleton)
    found = []
    for limb, roles in LIMBS.items():
        members = [joints[role] for role in roles if role in joints]
        if not members:
            continue
        subtree = tuple(members if limb == HIPS else skeleton.subtree(members[0]))
        for start, stop in shot_ranges(recording, cuts):
            if not is_short_shot(stop - start, recording.frame_rate):
                found += [
                    EdgePose(limb, subtree, start + first, start + last)
                    for first, last in _separate_frames(
                        recording.rotations[start:stop, members], recording.frame_rate
                    )
                ]
    return tuple(found)


def hide_edge_poses(recording: Motion | Tracks, poses: Sequence[EdgePose]) -> Motion | Tracks:
    """Return the recording with these poses missing, and the root's position in its own."""
    if not poses or isinstance(recording, Tracks):
        return recording
    rotations, roots = recording.rotations.copy(), recording.root_positions.copy()
    for pose in poses:
        rotations[pose.start : pose.stop, list(pose.joints)] = np.nan
        if 0 in pose.joints:
            roots[pose.start : pose.stop] = np.nan
    return recording.with_poses(rotations, roots)


def restore_edge_poses(
    recording: Motion | Tracks,
    cleaned: Motion | Tracks,
    confidence: Array,
    poses: Sequence[EdgePose],
) -> tuple[Motion | Tracks, Array]:
    """Return the cleaned recording and its confidence with these poses as recorded.

    The confidence has the shape (n_frames, n_joints).
    """
    if not poses or isinstance(recording, Tracks) or isinstance(cleaned, Tracks):
        return cleaned, confidence
    rotations, roots = cleaned.rotations.copy(), cleaned.root_positions.copy()
    confidence = confidence.copy()
    for pose in poses:
        if 0 in pose.joints:
            frames = slice(pose.start, pose.stop)
            seen = np.isfinite(recording.root_positions[frames])
            roots[frames] = np.where(seen, recording.root_positions[frames], roots[frames])
        where = np.ix_(np.arange(pose.start, pose.stop), np.array(pose.joints))
        observed, recorded = recording.observed[where], recording.rotations[where]
        rotations[where] = np.where(observed[..., None], recorded, rotations[where])
        confidence[where] = np.where(observed, 1.0, confidence[where])
    return cleaned.with_poses(rotations, roots), confidence


def describe_edge_poses(poses: Sequence[EdgePose], frames: Sequence[float]) -> str:
    """Return a report for the animator, with the numbers of the take's frames."""
    return " ".join(
        _describe_edge_pose(
            pose.limb, f"{frames[pose.start]:.7g}", f"{frames[pose.stop - 1]:.7g}"
        )
        for pose in poses
    )


def _describe_edge_pose(limb: str, first: str, last: str) -> str:
    if first == last:
        return f"Frame {first} of the {limb} is a separate pose and was kept as recorded."
    return (
        f"Frames {first} to {last} of the {limb} are separate poses and were kept as recorded."
    )


def _separate_frames(rotations: Array, frame_rate: float) -> Iterator[tuple[int, int]]:
    """Yield start and stop of separate poses at either end of (n_frames, n_joints, 4).

    A take of less than two such ends says too little about what is a jump.
    """
    n_frames, zone = len(rotations), max(round(MIN_SHOT_S * frame_rate), 1)
    changes = _step_changes(rotations)
    if len(changes) < 2 * zone:
        return
    if (first := _find_jump(changes, np.arange(zone))) is not None:
        yield 0, first + 1
    if (last := _find_jump(changes, np.arange(len(changes) - zone, len(changes)))) is not None:
        yield last + 1, n_frames


def _find_jump(changes: Array, zone: NDArray[np.intp]) -> int | None:
    """Return the step with a jump in this zone, if there is one alone.

    A jump alters the changes of three steps. Another jump is the way back of a spike.
    """
    observed = np.isfinite(changes)
    if not observed[zone].any():
        return None
    step = int(zone[np.nanargmax(changes[zone])])
    is_other = observed & (np.abs(np.arange(len(changes)) - step) > 1)
    if is_other.sum() < len(zone):
        return None
    typical = float(np.percentile(changes[is_other], TYPICAL_PERCENTILE))
    limit = max(MIN_JUMP_RAD, MIN_RATIO * typical)
    returns = is_other[zone] & (changes[zone] > limit)
    return step if changes[step] > limit and not returns.any() else None


def _step_changes(rotations: Array) -> Array:
    """Return by how much each step differs from the mean of its neighbors, (n_frames - 1,).

    Radians, over all joints. NaN where a joint is missing.
    """
    steps = rotation_vector_from_quaternion(multiply(inverse(rotations[:-1]), rotations[1:]))
    if len(steps) < 2:
        return np.full(len(steps), np.nan)
    changes = np.empty_like(steps)
    changes[1:-1] = steps[1:-1] - 0.5 * (steps[:-2] + steps[2:])
    changes[0] = ONE_SIDED_WEIGHT * (steps[0] - steps[1])
    changes[-1] = ONE_SIDED_WEIGHT * (steps[-1] - steps[-2])
    return np.asarray(np.sqrt((changes**2).sum(axis=(1, 2))))
