"""Detect, close and repeat cyclic clips.

The last frame of a cycle is the first of the next. Poses and velocities must agree there in the
actor's own frame; position and heading may advance.
"""

from dataclasses import replace

import numpy as np

from ..arrays import Array
from ..motion import Motion, resample
from ..rotations import inverse, multiply, rotate
from .align_examples import positions_in_body_frame
from .curves import HEIGHT_COLUMN, MotionCurves

MIN_LOOP_FRAMES = 8
"""Minimum frames of a cyclic clip. It guards clips too short for a cycle."""
MAX_MEAN_GAP_M = 0.06
"""Maximum mean joint distance in meters between the first and the last pose of a loop. Half and
twice are no better (`make sensitivity`)."""
MAX_JOINT_GAP_M = 0.25
"""Maximum distance in meters of any single joint. Chosen by hand; `make sensitivity` varies
it."""
MAX_SPEED_CHANGE = 2.5
"""Maximum velocity difference at the seam, relative to the mean speed. It guards half cycles,
whose ends are near but move in opposite directions."""
SEAM_S = 0.3
"""Seconds before and after the seam over which it is blended. Chosen by hand;
`make sensitivity` varies it."""
HORIZONTAL = np.array([1.0, 1.0, 0.0])
MAX_SEAM_RAD = 0.02
"""Maximum joint difference in radians at the seam of a closed loop. It guards cycles that were
closed before against rounding in their file."""


def detect_loop(motion: Motion, headings: Array) -> bool:
    """Return whether a clip ends nearly in its first pose and at its first velocity.

    `headings` are angles in radians, (n_frames,).
    """
    if motion.n_frames < MIN_LOOP_FRAMES:
        return False
    body = positions_in_body_frame(motion, headings)
    steps = np.diff(body, axis=0)
    mean_step = np.linalg.norm(steps, axis=-1).mean()
    gap, step_change = body[-1] - body[0], steps[-1] - steps[0]
    gap_lengths, change_lengths = (np.linalg.norm(each, axis=-1) for each in (gap, step_change))
    is_near = (
        gap_lengths.mean() < MAX_MEAN_GAP_M + mean_step
        and gap_lengths.max() < MAX_JOINT_GAP_M + mean_step
    )
    return bool(is_near and change_lengths.mean() < MAX_SPEED_CHANGE * mean_step)


def close_loop(
    curves: MotionCurves, frame_rate: float, by_joint: Array, free: Array
) -> MotionCurves:
    """Blend a seam so that pose and velocity agree at the end and the start.

    Cubic Hermite polynomials remove the difference at the seam, half before and half after it.

    Parameters
    ----------
    curves : MotionCurves
    frame_rate : float, hertz
    by_joint : shape (n_joints,), 0 to 1
        Fraction of the difference to remove; the root's displacements and height use the first.
    free : shape (2,), 0 or 1
        Whether the start and the end may change.
    """
    n, halves = len(curves.root), free / max(free.sum(), 1.0)
    if n < MIN_LOOP_FRAMES or not free.any():
        return curves
    half_width = min(SEAM_S * frame_rate, (n - 1) / 2.0)
    channels = np.concatenate(
        [curves.root[:, None, HEIGHT_COLUMN:], curves.joints.reshape(n, 1, -1)], axis=2
    )[:, 0]
    weights = np.concatenate([by_joint[:1], np.repeat(by_joint, 3)])
    channels = channels + weights * _seam_correction(channels, half_width, halves)
    root = curves.root.copy()
    root[:, HEIGHT_COLUMN] = channels[:, 0]
    steps = root[1:, :HEIGHT_COLUMN]
    ends = [1.5 * steps[0] - 0.5 * steps[1], 1.5 * steps[-1] - 0.5 * steps[-2]]
    frames = np.arange(0.5, n - 1)
    fade = halves[0] * _hermite_value(frames / half_width)
    fade -= halves[1] * _hermite_value((n - 1 - frames) / half_width)
    root[1:, :HEIGHT_COLUMN] += by_joint[0] * np.outer(fade, ends[1] - ends[0])
    return replace(curves, root=root, joints=channels[:, 1:].reshape(curves.joints.shape))


def is_closed(curves: MotionCurves) -> bool:
    """Return whether the last pose equals the first within `MAX_SEAM_RAD`."""
    return bool(np.abs(curves.joints[-1] - curves.joints[0]).max() < MAX_SEAM_RAD)


def repeat_loop(motion: Motion, n_cycles: int) -> Motion:
    """Return several cycles of a loop, each starting where the one before ends.

    `n_cycles` cycles of n frames have n_cycles (n - 1) + 1 frames.
    """
    rotation = _cycle_rotation(motion)
    rotations, positions = [motion.rotations], [motion.root_positions]
    for _ in range(n_cycles - 1):
        next_rotations = rotations[-1].copy()
        next_rotations[:, 0] = multiply(rotation, next_rotations[:, 0])
        rotations.append(next_rotations)
        previous = positions[-1]
        positions.append(
            rotate(rotation, previous - previous[0] * HORIZONTAL) + previous[-1] * HORIZONTAL
        )
    rotations[:-1] = [each[:-1] for each in rotations[:-1]]
    positions[:-1] = [each[:-1] for each in positions[:-1]]
    return motion.with_poses(np.concatenate(rotations), np.concatenate(positions))


def extract_middle_cycle(cycles: Motion, cycle: Motion) -> Motion:
    """Return the second of three cycles, moved back to the position of the first.

    Parameters
    ----------
    cycles : Motion
        Three cycles that `repeat_loop` made of `cycle`, possibly edited or resampled.
    cycle : Motion
    """
    n = (cycles.n_frames - 1) // 3
    second = cycles.slice(n, 2 * n + 1)
    inverse_rotation = inverse(_cycle_rotation(cycle))
    rotations = second.rotations.copy()
    rotations[:, 0] = multiply(inverse_rotation, rotations[:, 0])
    positions = rotate(
        inverse_rotation, second.root_positions - cycle.root_positions[-1] * HORIZONTAL
    )
    return second.with_poses(rotations, positions + cycle.root_positions[0] * HORIZONTAL)


def resample_loop(motion: Motion, frame_rate: float) -> Motion:
    """Return a loop at another frame rate that still loops.

    Its duration is rounded to whole frames.

    Parameters
    ----------
    motion : Motion
    frame_rate : float, hertz
    """
    steps = motion.n_frames - 1
    n_steps = max(round(steps * frame_rate / motion.frame_rate), 1)
    scaled = replace(repeat_loop(motion, 3), frame_rate=steps * frame_rate / n_steps)
    return extract_middle_cycle(resample(scaled, frame_rate), motion)


def _cycle_rotation(motion: Motion) -> Array:
    """Return the rotation about Z from the first pose to the last."""
    rotation = multiply(motion.rotations[-1, 0], inverse(motion.rotations[0, 0]))
    rotation = rotation * np.array([1.0, 0.0, 0.0, 1.0])
    return np.asarray(rotation / max(np.linalg.norm(rotation), 1e-12))


def _seam_correction(curves: Array, half_width: float, halves: Array) -> Array:
    """Return what to add to curves, (n_frames, n), so that the last frame joins the first."""
    n = len(curves)
    gap = curves[-1] - curves[0]
    begin = 2.0 * curves[1] - 1.5 * curves[0] - 0.5 * curves[2]
    end = 1.5 * curves[-1] + 0.5 * curves[-3] - 2.0 * curves[-2]
    velocity_gap = end - begin
    frames = np.arange(n, dtype=np.float64)
    after, before = frames / half_width, (n - 1 - frames) / half_width
    first = np.outer(_hermite_value(after), gap) + half_width * np.outer(
        _hermite_slope(after), velocity_gap
    )
    last = np.outer(_hermite_value(before), gap) - half_width * np.outer(
        _hermite_slope(before), velocity_gap
    )
    return np.asarray(halves[0] * first - halves[1] * last)


def _hermite_value(fraction: Array) -> Array:
    """Return the Hermite polynomial from 1 to 0 with slope 0 at both ends."""
    fraction = np.clip(fraction, 0.0, 1.0)
    return np.asarray((1.0 + 2.0 * fraction) * (1.0 - fraction) ** 2)


def _hermite_slope(fraction: Array) -> Array:
    """Return the Hermite polynomial from 0 to 0 with slope 1 at the start and 0 at the end."""
    fraction = np.clip(fraction, 0.0, 1.0)
    return np.asarray(fraction * (1.0 - fraction) ** 2)
