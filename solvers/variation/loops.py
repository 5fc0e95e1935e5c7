"""Clips that end as they begin, so that they can be played over and over.

The last frame is the first of the next round: poses and velocities must agree there, as the
actor sees them. Where he is and whither he faces may go on.
"""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..motion import Motion, resample
from ..rotations import inverse, multiply, rotate
from .align_examples import positions_in_body_frame
from .motion_curves import HEIGHT, MotionCurves

Array = NDArray[np.float64]

FEWEST = 8
"""Frames of a clip that may loop."""
LOOP_GAP = 0.06
"""Metres by which joints may be beside where they began, for a clip to loop."""
FARTHEST = 0.25
"""Metres by which any one joint may be."""
HURRY = 2.5
"""Times the usual speed by which the speed there may differ."""
EASE = 0.3
"""Seconds before and after the seam over which it is closed."""
LEVEL = np.array([1.0, 1.0, 0.0])
SEAMLESS = 0.02
"""Radians by which joints may differ at the seam of what counts as closed."""


def loops(motion: Motion, turns: Array) -> bool:
    """Whether a clip ends nearly as it begins, and goes on as it began; by its headings."""
    if motion.n_frames < FEWEST:
        return False
    body = positions_in_body_frame(motion, turns)
    steps = np.diff(body, axis=0)
    usual = np.linalg.norm(steps, axis=-1).mean()
    gap, hurry = body[-1] - body[0], steps[-1] - steps[0]
    apart, unlike = (np.linalg.norm(one, axis=-1) for one in (gap, hurry))
    near = apart.mean() < LOOP_GAP + usual and apart.max() < FARTHEST + usual
    return bool(near and unlike.mean() < HURRY * usual)


def close_loop(
    course: MotionCurves, frame_rate: float, by_joint: Array, free: Array
) -> MotionCurves:
    """Let a course end as it begins, in pose and velocity.

    What differs at the seam is taken back with cubic Hermite polynomials, half before and half
    after it.

    Parameters
    ----------
    course : Course
    frame_rate : float, hertz
    by_joint : shape (n_joints,), 0 to 1
        Which part of the difference is taken back; for the root's way and height as for the
        first joint.
    free : shape (2,), 0 or 1
        Whether the beginning and the end may change.
    """
    n, halves = len(course.root), free / max(free.sum(), 1.0)
    if n < FEWEST or not free.any():
        return course
    reach = min(EASE * frame_rate, (n - 1) / 2.0)
    curves = np.concatenate(
        [course.root[:, None, HEIGHT:], course.joints.reshape(n, 1, -1)], axis=2
    )[:, 0]
    parts = np.concatenate([by_joint[:1], np.repeat(by_joint, 3)])
    curves = curves + parts * _seam(curves, reach, halves)
    root = course.root.copy()
    root[:, HEIGHT] = curves[:, 0]
    paces = root[1:, :HEIGHT]
    ends = [1.5 * paces[0] - 0.5 * paces[1], 1.5 * paces[-1] - 0.5 * paces[-2]]
    frames = np.arange(0.5, n - 1)
    fade = halves[0] * _value(frames / reach)
    fade -= halves[1] * _value((n - 1 - frames) / reach)
    root[1:, :HEIGHT] += by_joint[0] * np.outer(fade, ends[1] - ends[0])
    return replace(course, root=root, joints=curves[:, 1:].reshape(course.joints.shape))


def is_closed(course: MotionCurves) -> bool:
    """Whether the last pose is the first."""
    return bool(np.abs(course.joints[-1] - course.joints[0]).max() < SEAMLESS)


def repeat_loop(motion: Motion, rounds: int) -> Motion:
    """Return several rounds of a loop, each from where the one before ends.

    Of `rounds` rounds of n frames there are rounds (n - 1) + 1.
    """
    turn = _turn_of_round(motion)
    rotations, places = [motion.rotations], [motion.root_positions]
    for _ in range(rounds - 1):
        again = rotations[-1].copy()
        again[:, 0] = multiply(turn, again[:, 0])
        rotations.append(again)
        before = places[-1]
        places.append(rotate(turn, before - before[0] * LEVEL) + before[-1] * LEVEL)
    rotations[:-1] = [one[:-1] for one in rotations[:-1]]
    places[:-1] = [one[:-1] for one in places[:-1]]
    return motion.with_poses(np.concatenate(rotations), np.concatenate(places))


def extract_middle_cycle(three: Motion, one: Motion) -> Motion:
    """Return the second of three rounds, brought back to where the first is.

    Parameters
    ----------
    three : Motion
        Three rounds that were changed since `repeated` made them of `one`, or resampled.
    one : Motion
    """
    n = (three.n_frames - 1) // 3
    middle = three.slice(n, 2 * n + 1)
    back = inverse(_turn_of_round(one))
    rotations = middle.rotations.copy()
    rotations[:, 0] = multiply(back, rotations[:, 0])
    places = rotate(back, middle.root_positions - one.root_positions[-1] * LEVEL)
    return middle.with_poses(rotations, places + one.root_positions[0] * LEVEL)


def resample_loop(motion: Motion, frame_rate: float) -> Motion:
    """Return a loop at another frame rate, still a loop: as fast but for part of a frame.

    Parameters
    ----------
    motion : Motion
    frame_rate : float, hertz
    """
    steps = motion.n_frames - 1
    wanted = max(round(steps * frame_rate / motion.frame_rate), 1)
    even = replace(repeat_loop(motion, 3), frame_rate=steps * frame_rate / wanted)
    return extract_middle_cycle(resample(even, frame_rate), motion)


def _turn_of_round(motion: Motion) -> Array:
    """Return the turn about Z from the first pose to the last."""
    turn = multiply(motion.rotations[-1, 0], inverse(motion.rotations[0, 0]))
    turn = turn * np.array([1.0, 0.0, 0.0, 1.0])
    return np.asarray(turn / max(np.linalg.norm(turn), 1e-12))


def _seam(curves: Array, reach: float, halves: Array) -> Array:
    """Return what to add to curves, (n_frames, n), for the last to go on as the first."""
    n = len(curves)
    gap = curves[-1] - curves[0]
    begin = 2.0 * curves[1] - 1.5 * curves[0] - 0.5 * curves[2]
    end = 1.5 * curves[-1] + 0.5 * curves[-3] - 2.0 * curves[-2]
    hurry = end - begin
    frames = np.arange(n, dtype=np.float64)
    after, before = frames / reach, (n - 1 - frames) / reach
    first = np.outer(_value(after), gap) + reach * np.outer(_slope(after), hurry)
    last = np.outer(_value(before), gap) - reach * np.outer(_slope(before), hurry)
    return np.asarray(halves[0] * first - halves[1] * last)


def _value(part: Array) -> Array:
    """Return the Hermite polynomial that leaves 1 with slope 0 and ends at 0 with slope 0."""
    part = np.clip(part, 0.0, 1.0)
    return np.asarray((1.0 + 2.0 * part) * (1.0 - part) ** 2)


def _slope(part: Array) -> Array:
    """Return the Hermite polynomial that leaves 0 with slope 1 and ends at 0 with slope 0."""
    part = np.clip(part, 0.0, 1.0)
    return np.asarray(part * (1.0 - part) ** 2)
