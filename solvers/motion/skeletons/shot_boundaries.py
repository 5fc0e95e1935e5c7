"""Find shot boundaries: discontinuities between two frames of a take."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, row_blocks
from ...rotations import unroll
from .motion import Motion
from .tracks import Tracks

N_CONTEXT_FRAMES = 8
"""Frames on each side from which the typical step of each joint is estimated. It guards takes
with repeated frames (`test_fast_movement_in_repeated_frames_is_no_shot_boundary`)."""
HALF_FRACTION, MAJORITY_FRACTION = 0.5, 0.7
"""Fractions of the joints that jump at a boundary. Half and twice are no better
(`make sensitivity`)."""
MIN_HALF_JUMP, MIN_MAJORITY_JUMP = 2.5, 1.5
"""Jumps of half and of most joints at a boundary, in multiples of their typical steps. The
first frames of CMU recordings, T-poses, have 5.6 and 3.0 at 30 Hz, and more at 120 Hz. Hops,
kicks and jumps, even with noise and outliers, have at most 2.0 and 1.35. Half and twice are no
better (`make sensitivity`)."""
TURNED_FRACTION, MIN_ROOT_JUMP = 0.25, 15.0
"""Fraction of the joints that jump, and jump of the root in multiples of its typical step, at a
boundary where the root turns all others. Measured: the T-pose of an Xsens suit, which faces
elsewhere, has 0.4 and 89. Of 477 real takes, with noise and outliers too, none that moves on
has a fraction of 0.25 with more than 12."""
MIN_STEP_RAD = np.radians(1.0)
"""Lower bound of the typical step of a joint, radians. Half and twice are no better
(`make sensitivity`)."""
MIN_STEP_M = 0.04
"""Meters, likewise. It guards actors who stand still: a dropped camera frame moves all points
of a body by a few centimeters
(`test_dropped_camera_frame_of_an_actor_who_stands_is_no_shot_boundary`)."""
MIN_JOINTS = 6
"""With fewer joints, a common jump of nearly all of them is not significant. It guards props
and single bones (`test_prop_that_is_put_elsewhere_is_no_shot_boundary`)."""
MIN_MOTION = 1e-6
"""Radians or meters: a joint with smaller steps does not move. It guards a division."""
MIN_SHOT_S = 0.25
"""A shorter shot shows no movement that can be distinguished from noise. It guards takes whose
body jumps away for a few frames and returns (`test_transient_jump_of_a_body_is_no_cut`)."""


def find_shot_boundaries(recording: Motion | Tracks) -> tuple[int, ...]:
    """Return the first frame of every shot of a take except the first.

    Most takes have one shot. Many recordings begin with a T-pose of one frame; others were
    joined, or the sensor was restarted. At a boundary nearly all joints jump at once, much
    farther than between other frames, and stay there; or the root of a motion turns all others,
    and some joints jump too. Dropouts of a joint and jumps of a body that returns within a
    quarter of a second are no boundaries. In a motion, but not in tracks, neither is a
    displacement of the complete body in one pose.
    """
    has_root = isinstance(recording, Motion)
    min_step = MIN_STEP_RAD if has_root else MIN_STEP_M
    steps = _all_steps(recording)
    moving = np.nanmax(steps, axis=0, initial=0.0) > MIN_MOTION
    if moving.sum() < MIN_JOINTS:
        return ()
    # A repeated frame contains no information about the speed of the body.
    steps[np.nanmax(steps, axis=1, initial=0.0) == 0.0] = np.nan
    cuts = [int(step) + 1 for step in _jumps(steps[:, moving], min_step, has_root)]
    index = 0
    while index + 1 < len(cuts):
        start, stop = cuts[index : index + 2]
        is_brief = is_short_shot(stop - start, recording.frame_rate)
        before, after = max(start - 2 * N_CONTEXT_FRAMES, 0), stop + 2 * N_CONTEXT_FRAMES
        if is_brief and _jump_is_possible(
            _trajectory(recording, slice(before, after))[:, moving],
            slice(start - before, stop - before),
            min_step,
        ):
            del cuts[index : index + 2]
        else:
            index += 1
    return tuple(cuts)


def shot_ranges(recording: Motion | Tracks, cuts: tuple[int, ...]) -> Iterator[tuple[int, int]]:
    """Yield the start and stop frame of every shot."""
    yield from pairwise((0, *cuts, recording.n_frames))


def is_short_shot(n_frames: int, frame_rate: float) -> bool:
    """Return whether a shot is too short to be cleaned."""
    return n_frames < MIN_SHOT_S * frame_rate


def describe_shots(
    recording: Motion | Tracks, cuts: tuple[int, ...], frames: Sequence[float]
) -> str:
    """Return a report for the animator, with the numbers of its frames; empty for one shot."""
    if not cuts:
        return ""
    cleaned_starts, sentences = [], []
    for start, stop in shot_ranges(recording, cuts):
        first, last = f"{frames[start]:.7g}", f"{frames[stop - 1]:.7g}"
        if not is_short_shot(stop - start, recording.frame_rate):
            cleaned_starts.append(first)
        elif stop - start == 1:
            sentences.append(f"Frame {first} is a separate pose and was kept as recorded.")
        else:
            sentences.append(
                f"Frames {first} to {last} are separate poses and were kept as recorded."
            )
    if len(cleaned_starts) > 1:
        starts = _join_names(cleaned_starts[1:])
        sentences.insert(
            0, f"The take has a cut before frame {starts}; its shots were cleaned separately."
        )
    return " ".join(sentences)


def _join_names(names: list[str]) -> str:
    return " and ".join([", ".join(names[:-1]), names[-1]] if names[:-1] else names)


def _trajectory(recording: Motion | Tracks, frames: slice) -> Array:
    """Return the trajectories of the joints, shape (n_frames, n_joints, n_components)."""
    if isinstance(recording, Tracks):
        return recording.positions[frames]
    skeleton = recording.skeleton
    joints = [joint for joint in range(skeleton.n_joints) if not skeleton.is_end_site(joint)]
    # Twice the quaternion: the distance of neighbors is then their angle in radians.
    return 2.0 * unroll(recording.rotations[frames][:, joints])


def _all_steps(recording: Motion | Tracks) -> Array:
    n_steps = recording.n_frames - 1
    n_joints = _trajectory(recording, slice(1)).shape[1]
    steps = np.empty((n_steps, n_joints))
    for block in row_blocks(n_steps, 4 * n_joints):
        steps[block] = _steps(_trajectory(recording, slice(block.start, block.stop + 1)))
    return steps


def _steps(trajectory: Array) -> Array:
    """Return the distance of each joint between frames, shape (n_frames - 1, n_joints)."""
    return np.asarray(np.linalg.norm(np.diff(trajectory, axis=0), axis=-1))


def _jumps(steps: Array, min_step: float, has_root: bool) -> NDArray[np.intp]:
    """Return the steps, from frame i to i + 1, where nearly all joints jump."""
    typical = np.fmax([_median(joint, 0) for joint in steps.T], min_step)
    result = [np.empty(0, dtype=np.intp)]
    for block in row_blocks(*steps.shape):
        # `_ratios` divides by at least this, so that all boundaries are among these candidates.
        ratios = steps[block] / typical
        candidates = block.start + np.flatnonzero(
            _exceeded_by(ratios, TURNED_FRACTION) >= MIN_HALF_JUMP
        )
        ratios = _ratios(steps, typical, candidates)
        are_boundaries = _is_boundary(ratios)
        if has_root:
            are_boundaries |= _is_turned(ratios)
        result.append(candidates[are_boundaries])
    return np.concatenate(result)


def _jump_is_possible(trajectory: Array, excursion: slice, min_step: float) -> bool:
    """Return whether the jump across the brief shot is possible within its duration."""
    steps = _steps(np.delete(trajectory, excursion, axis=0))
    typical = np.fmax(_median(steps, 0), min_step)
    ratios = _ratios(steps, typical, np.array([excursion.start - 1]))
    return not _is_boundary(ratios, max(MIN_HALF_JUMP, excursion.stop - excursion.start + 1.0))[
        0
    ]


def _ratios(steps: Array, typical: Array, at: NDArray[np.intp]) -> Array:
    """Return the jump of each joint in multiples of its typical step, shape (n, n_joints).

    NaN where the joint is missing.
    """
    n_steps = len(steps)
    offsets = np.arange(1, N_CONTEXT_FRAMES + 1)
    before, after = (
        _median(_values_at(steps, at[:, None] + sign * offsets, n_steps), 1) for sign in (-1, 1)
    )
    typical = np.fmax(np.fmax(before, after), typical)
    return np.asarray(steps[at] / typical)


def _is_boundary(ratios: Array, min_half_jump: float = MIN_HALF_JUMP) -> NDArray[np.bool_]:
    n_observed = np.isfinite(ratios).sum(axis=1)
    return np.asarray(
        (_exceeded_by(ratios, HALF_FRACTION) >= min_half_jump)
        & (_exceeded_by(ratios, MAJORITY_FRACTION) >= MIN_MAJORITY_JUMP)
        & (n_observed >= MIN_JOINTS)
        & (n_observed >= HALF_FRACTION * ratios.shape[1])
    )


def _is_turned(ratios: Array) -> NDArray[np.bool_]:
    """Return whether the root, the first joint that moves, turns a body that jumps."""
    jumps = _exceeded_by(ratios, TURNED_FRACTION) >= MIN_HALF_JUMP
    return np.asarray(jumps & (ratios[:, 0] >= MIN_ROOT_JUMP))


def _values_at(values: Array, indices: NDArray[np.intp], length: int) -> Array:
    """Return the values at these indices; NaN outside of the range."""
    inside = (indices >= 0) & (indices < length)
    result = values[np.clip(indices, 0, length - 1)]
    result[~inside] = np.nan
    return np.asarray(result)


def _exceeded_by(ratios: Array, fraction: float) -> Array:
    """Return the ratio that this fraction of the observed joints reaches, shape (n_steps,)."""
    ordered = np.sort(np.where(np.isnan(ratios), -1.0, ratios), axis=1)[:, ::-1]
    n_observed = (ordered >= 0.0).sum(axis=1)
    index = np.clip(np.ceil(fraction * n_observed).astype(int) - 1, 0, ratios.shape[1] - 1)
    return np.take_along_axis(ordered, index[:, None], axis=1)[:, 0]


def _median(values: Array, axis: int) -> Array:
    """Return the median without NaN; NaN where all are NaN."""
    ordered = np.sort(values, axis=axis)
    count = np.isfinite(values).sum(axis=axis, keepdims=True)
    low = np.take_along_axis(ordered, np.maximum((count - 1) // 2, 0), axis=axis)
    high = np.take_along_axis(
        ordered, np.minimum(count // 2, values.shape[axis] - 1), axis=axis
    )
    return np.asarray(np.squeeze(0.5 * (low + high), axis=axis))
