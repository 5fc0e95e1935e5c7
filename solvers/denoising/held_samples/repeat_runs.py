"""Runs of samples that repeat the one before, part by part."""

from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Flags
from ...motion import Motion, Tracks
from ...rotations import unroll

MAX_REPEAT_RAD = 1e-5
"""Largest step of a repeated sample, radians. It bounds the rounding of single precision: 1e-7
of a quaternion, and 5e-7 of 5 m."""
METERS_PER_RADIAN = 0.3
"""Displacement in meters that counts like a rotation by one radian. A bone of an arm is that
long, so that both move its end as far: 0.186 and 0.146 of the stature in Winter 2009, figure
4.1."""
MAX_REPEATED_FRACTION = 0.7
"""Fraction of repeated samples above which a joint counts as still. It guards joints that move
in steps (`test_poses_on_steps_are_not_held`)."""
MAX_STRAIGHT_RAD = 1e-3
"""Angle to the rest pose at which a joint is straight, radians. It bounds the rounding of files
with two decimals."""
MIN_BODY_FRACTION = 0.5
"""Fraction of the joints that move from which on they are the body. By definition."""
MAX_EXPECTED_RUNS = 0.1
"""Number of runs of one length that the other repeats of a part lead to expect, from which on
one is no evidence. Sweep: 32 development takes in steps of 0.01 to 1 degree have 350 wrong
repeats without it, and 93 with it."""


class RepeatRuns(NamedTuple):
    """Runs of repeats of single parts, each an entry of these arrays."""

    parts: NDArray[np.intp]
    starts: NDArray[np.intp]
    stops: NDArray[np.intp]
    """First frame that repeats the one before, and first that does not."""
    jumps: Array
    before: Array
    after: Array
    """Speeds of the changes before and after, per frame."""
    earlier: Array
    """Speed of the change before the one before; 0 if there is none."""
    quanta: Array
    """The jump in smallest steps of the part."""
    are_stops: Flags
    """Whether it stops at this value most of the time or is straight there, as at a limit of
    the joint, or repeats as often elsewhere, as rounded values do."""


def part_trajectories(recording: Motion | Tracks) -> Array:
    """Return rotations and positions whose distances are radians, (n_frames, n_parts, 4)."""
    if isinstance(recording, Tracks):
        return recording.positions / METERS_PER_RADIAN
    root = np.pad(recording.root_positions / METERS_PER_RADIAN, ((0, 0), (0, 1)))
    # Twice the quaternion: the distance of neighbors is then their angle in radians.
    return np.concatenate([2.0 * unroll(recording.rotations), root[:, None]], axis=1)


def part_steps(trajectories: Array) -> Array:
    """Return the distance of each part between frames, shape (n_frames - 1, n_parts)."""
    return np.asarray(np.linalg.norm(np.diff(trajectories, axis=0), axis=-1))


def are_still(repeats: Flags) -> Flags:
    """Return which parts repeat most of the time, shape (n_parts,)."""
    return np.asarray(repeats.mean(axis=0) > MAX_REPEATED_FRACTION)


def find_repeat_runs(
    recording: Motion | Tracks, trajectories: Array, repeats: Flags
) -> RepeatRuns | None:
    """Return the runs of repeats between two changes of all parts that are not still.

    Parameters
    ----------
    recording : Motion or Tracks
    trajectories : shape (n_frames, n_parts, n_components)
        Of the joints, and of the root's position, or of the points.
    repeats : shape (n_frames, n_parts)
    """
    found = [
        run
        for part in np.flatnonzero(~are_still(repeats))
        for run in _runs(int(part), trajectories[:, part], repeats[:, part])
    ]
    if not found:
        return None
    runs = RepeatRuns(*map(np.concatenate, zip(*found, strict=True)))
    if isinstance(recording, Tracks):
        return runs
    values = trajectories[runs.starts, runs.parts]
    is_rotation = runs.parts < recording.skeleton.n_joints
    is_straight = is_rotation & (np.linalg.norm(values[:, 1:], axis=1) <= MAX_STRAIGHT_RAD)
    return runs._replace(are_stops=runs.are_stops | is_straight)


def connect_runs(
    recording: Motion | Tracks, runs: RepeatRuns, is_still: Flags
) -> NDArray[np.intp]:
    """Return a number for each run, which those share whose parts were lost together, if any.

    They have the same frames. In a motion they are most of the body, or each part hangs on
    another one of them, as in a limb. Joints that are still, or never observed, connect what
    hangs on them with what they hang on. `is_still` has the shape (n_parts,).
    """
    times = runs.starts * (recording.n_frames + 1) + runs.stops
    if isinstance(recording, Tracks):
        return times
    _, first, group, n_runs = np.unique(
        times, return_index=True, return_inverse=True, return_counts=True
    )
    is_body = n_runs >= MIN_BODY_FRACTION * np.count_nonzero(~is_still)
    anchors = np.append(recording.skeleton.parents, 0)  # the position hangs on the root
    for joint in range(1, recording.skeleton.n_joints):
        parent = anchors[joint]
        anchors[joint] = anchors[parent] if is_still[parent] and parent > 0 else parent
    n_parts = len(anchors)
    keys = times * n_parts + runs.parts
    anchor_keys = times * n_parts + anchors[runs.parts]
    order = np.argsort(keys)
    place = np.searchsorted(keys, anchor_keys, sorter=order)
    found = order[np.minimum(place, len(order) - 1)]
    is_linked = (keys[found] == anchor_keys) & (anchors[runs.parts] >= 0)
    connected = np.where(is_linked, found, np.arange(len(keys)))
    connected = np.where(is_body[group], first[group], connected)
    while (connected[connected] != connected).any():
        connected = connected[connected]
    return connected


def _runs(part: int, values: Array, repeats: Flags) -> Iterator[tuple[NDArray[Any], ...]]:
    """Yield the runs of repeats of a part, if there are any between two changes."""
    frames = np.flatnonzero(~repeats) + 1  # a missing sample ends a run
    if len(frames) < 3:
        return
    sizes = np.linalg.norm(values[frames] - values[frames - 1], axis=-1)
    lengths = np.diff(frames, prepend=0)
    speeds = sizes / lengths
    which = np.flatnonzero(lengths[1:-1] > 1) + 1
    which = which[np.isfinite(sizes[which] + sizes[which - 1] + sizes[which + 1])]
    if len(which):
        smallest = np.nanmin(sizes)
        starts = frames[which - 1] + 1
        yield (
            np.full(len(which), part), starts, frames[which], sizes[which], speeds[which - 1],
            speeds[which + 1], np.append(0.0, speeds)[which - 1], sizes[which] / smallest,
            _recur(values[starts]) | _are_expected(repeats, lengths[which] - 1),
        )  # fmt: skip


def _are_expected(repeats: Flags, n_repeats: NDArray[np.intp]) -> Flags:
    """Return which runs of repeats the part's other repeats lead to expect, (n_runs,)."""
    rates = (np.count_nonzero(repeats) - n_repeats) / (len(repeats) - n_repeats)
    return np.asarray(len(repeats) * rates**n_repeats > MAX_EXPECTED_RUNS)


def _recur(values: Array) -> Flags:
    """Return which of these values make up half of all, shape (n_values,)."""
    if len(values) < 2:
        return np.zeros(len(values), dtype=np.bool_)
    rounded = np.round(values / MAX_REPEAT_RAD)
    _, which, counts = np.unique(rounded, axis=0, return_inverse=True, return_counts=True)
    return np.asarray(counts[which.reshape(-1)] > max(0.5 * len(values), 1.0))
