"""Find samples that a tracker repeated because it had lost a joint or the whole body."""

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Flags
from ...motion import Motion, Tracks
from ...motion.skeletons import find_shot_boundaries
from .repeat_runs import (
    MAX_REPEAT_RAD,
    RepeatRuns,
    are_still,
    connect_runs,
    find_repeat_runs,
    part_steps,
    part_trajectories,
)

MIN_JITTER_RAD = 6e-5
"""Lowest jitter of a recording, radians; most have 9e-5 to 4e-3. It guards animation that was
keyed by hand, whose curves are smooth (`test_anticipation_between_keys_is_not_held`)."""
MIN_PARTS = 2
"""Number of connected parts that repeat in the same frames only if they were lost together.
Chosen by hand: 2 are an arm whose hand has no keys."""
MIN_GROUP_RATIO, MIN_RATIO = 0.5, 1.5
"""Jump after the repeats of several and of single parts, as a ratio to the step after it, and
of single ones also to the step before. They guard poses that are left by steps that grow
(`test_pose_that_is_eased_out_of_is_not_held`) or that a single joint keeps
(`test_joint_that_stops_and_goes_on_is_not_held`)."""
MIN_JUMP_RAD = np.radians(1.0)
"""Smallest jump after the repeats of all parts together, radians. It guards bodies that hardly
move (`test_repeats_of_a_body_that_hardly_moves_do_not_matter`)."""
MIN_ENTRY_RATIO = 3.0
"""Step to the repeated value, as a ratio to the steps before it and after the repeats, above
which this value is wrong too. Measured: an arm that a tracker puts into its rest pose has 10
and more, and a punch speeds up by 2 from frame to frame at 30 Hz."""
MIN_QUANTA = 5.0
"""Largest jump after the repeats in smallest steps of a joint, a ratio. It guards joints that
are rounded (`test_fingers_of_a_glove_in_coarse_steps_are_not_held`)."""
MIN_DIRECTION, MAX_SPEED_RATIO = 0.1, 1.6
"""At what looks like a cut: cosine of the jump and of the movement before and after it, and
mean speed of the jump as a ratio to the faster of both. They guard joined takes
(`test_pose_that_fills_up_a_joined_take_is_not_held`): 6 % of the dropped frames of development
takes are left out by them, and 6 % of the poses that fill up a clip are not."""
N_JITTER_SAMPLES = 2000
"""Samples of a joint from which its jitter is estimated. It bounds the run time."""


def find_held_samples(recording: Motion | Tracks) -> Flags:
    """Return which samples repeat the one before although the body moves on.

    Formats of poses cannot leave a sample out, so a tracker that loses a limb, or a stream that
    loses packets, repeats the last value or a pose at rest, and then jumps. What was recorded
    has some jitter, so several connected parts repeat in the same frames only if they were
    lost. A single part may stop: it must jump farther than it moves from frame to frame, from a
    value that is not straight and at which it does not stop most of the time; and rounded
    values repeat anyhow. What looks like a cut after the repeats is one, unless
    the body moves on in its direction, and not faster. Curves without jitter were keyed by
    hand: there poses are held on purpose. Repeats at the start or the end of a take may be such
    a pose, and are kept.

    Returns
    -------
    Flags
        Shape (n_frames, n_joints + 1) of a motion, the last for the position of the root, or
        (n_frames, n_points) of tracks.
    """
    trajectories = part_trajectories(recording)
    n_frames, n_parts = trajectories.shape[:2]
    held = np.zeros((n_frames, n_parts), dtype=np.bool_)
    steps = part_steps(trajectories)
    repeats = steps <= MAX_REPEAT_RAD
    if not repeats.any() or not _jitter(trajectories, repeats) >= MIN_JITTER_RAD:
        return held
    runs = find_repeat_runs(recording, trajectories, repeats)
    if runs is None:
        return held
    is_still = are_still(repeats) | np.isnan(steps).all(axis=0)
    _, first, group = np.unique(
        connect_runs(recording, runs, is_still), return_index=True, return_inverse=True
    )
    starts = runs.starts - _are_entered_by_a_jump(runs, group)[group]
    are_held = _move_on(runs, group) & ~_are_cuts(
        recording, trajectories, starts[first], runs.stops[first]
    )
    is_single = np.bincount(group)[group] < MIN_PARTS
    for run in np.flatnonzero(are_held[group] & ~(is_single & runs.are_stops)):
        held[starts[run] : runs.stops[run], runs.parts[run]] = True
    return held


def body_is_held(recording: Motion | Tracks, held: Flags) -> Flags:
    """Return the frames in which most of what moves in this take is held, shape (n_frames,)."""
    moving = (part_steps(part_trajectories(recording)) > MAX_REPEAT_RAD).any(axis=0)
    return np.asarray(held.any(axis=1) & (held[:, moving].mean(axis=1) >= 0.5))


def _jitter(trajectories: Array, repeats: Flags) -> float:
    """Return the median over all parts that move of what the movement does not explain.

    The fourth difference of white noise has 70 times its variance; that of curves between keys,
    which are polynomials of third degree, is 0. Repeats are left out.
    """
    jitter = []
    for part in np.flatnonzero(~are_still(repeats)):
        frames = np.flatnonzero(~repeats[:, part])[:N_JITTER_SAMPLES] + 1
        changes = np.diff(trajectories[frames, part], n=4, axis=0)
        sizes = np.linalg.norm(changes, axis=-1) / np.sqrt(70.0)
        if np.isfinite(sizes).any():
            jitter.append(float(np.nanmedian(sizes)))
    return float(np.median(jitter)) if jitter else 0.0


def _move_on(runs: RepeatRuns, group: NDArray[np.intp]) -> Flags:
    """Return in which groups of runs with the same frames the parts moved on."""

    jumps, before, after = (
        _together(values, group) for values in (runs.jumps, runs.before, runs.after)
    )
    quanta = np.zeros(len(jumps))
    np.maximum.at(quanta, group, runs.quanta)
    moved = np.where(
        np.bincount(group) >= MIN_PARTS,
        jumps >= MIN_GROUP_RATIO * after,
        jumps >= MIN_RATIO * np.maximum(before, after),
    )
    return np.asarray(moved & (jumps >= MIN_JUMP_RAD) & (quanta >= MIN_QUANTA))


def _are_entered_by_a_jump(runs: RepeatRuns, group: NDArray[np.intp]) -> Flags:
    """Return in which groups of runs the parts jumped to the repeated value, too."""
    before, earlier, after = (
        _together(values, group) for values in (runs.before, runs.earlier, runs.after)
    )
    return np.asarray(before > MIN_ENTRY_RATIO * np.maximum(earlier, after))


def _together(values: Array, group: NDArray[np.intp]) -> Array:
    """Return the root of the sum of squares of each group."""
    return np.asarray(np.sqrt(np.bincount(group, np.nan_to_num(values) ** 2)))


def _are_cuts(
    recording: Motion | Tracks,
    trajectories: Array,
    starts: NDArray[np.intp],
    stops: NDArray[np.intp],
) -> Flags:
    """Return which runs end at a cut from which the body does not move on as before."""
    are_cuts: Flags = np.isin(stops, find_shot_boundaries(recording))
    for index in np.flatnonzero(are_cuts):
        last, stop = starts[index] - 1, stops[index]
        around = trajectories[[last - 1, last, stop, min(stop + 1, len(trajectories) - 1)]]
        before, jump, after = np.nan_to_num(np.diff(around, axis=0)).reshape(3, -1)
        around_it, size = before + after, np.linalg.norm(jump)
        speed = max(np.linalg.norm(before), np.linalg.norm(after))
        are_cuts[index] = (
            jump @ around_it < MIN_DIRECTION * size * np.linalg.norm(around_it)
            or size > MAX_SPEED_RATIO * (stop - last) * speed
        )
    return are_cuts
