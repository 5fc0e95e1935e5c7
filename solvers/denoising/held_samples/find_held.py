"""Find samples that a tracker repeated because it had lost a joint or the whole body."""

from collections import defaultdict
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np

from ...arrays import Array, Flags
from ...motion import Motion, Tracks
from ...rotations import angle_between, unroll

MAX_REPEAT_RAD, MAX_REPEAT_M = 1e-5, 1e-6
"""Largest step of a repeated rotation or position, radians and meters. It bounds the rounding
of single precision: 1e-7 of a quaternion, and 5e-7 of 5 m."""
METERS_PER_RADIAN = 0.3
"""Displacement in meters that counts like a rotation by one radian. Chosen by hand: 0.3 m is
the length of a limb's bone, so that both move its end as far."""
MIN_RATIO = 1.5
"""Jump after the repeats, as a ratio to the steps before and after: a body that moves on has 2
after one repeat, and more after more. It guards poses from which a movement starts
(`test_pose_between_linear_keys_is_not_held`)."""
MIN_JUMP_RAD = np.radians(1.0)
"""Smallest jump after the repeats of all parts together, radians. It guards bodies that hardly
move (`test_repeats_of_a_body_that_hardly_moves_do_not_matter`)."""
MAX_SPEED_RATIO = 10.0
"""Mean speed from the first repeat to the jump, as a ratio to the slower of both sides. It
guards cuts (`test_still_pose_at_the_start_or_before_a_cut_is_not_held`)."""
MIN_QUANTA = 5.0
"""Largest jump after the repeats in smallest steps of a joint, a ratio. It guards joints that
are rounded (`test_fingers_of_a_glove_in_coarse_steps_are_not_held`)."""
MAX_REPEATED_FRACTION = 0.75
"""Fraction of repeated samples above which a joint counts as keyed on steps. It guards
animation that was keyed by hand (`test_poses_keyed_on_steps_are_not_held`)."""


class _Event(NamedTuple):
    """A run of repeats of one rotation or position, and the jump after it."""

    part: int
    jump: float
    speed: float
    """The jump by its number of frames."""
    before: float
    after: float
    """Speeds of the changes before and after."""
    quanta: float
    """The jump in smallest steps of this part."""


def find_held_samples(recording: Motion | Tracks) -> Flags:
    """Return which samples repeat the one before although the body moves on.

    Formats of poses cannot leave a sample out, so a tracker that loses a limb, or a stream that
    loses packets, repeats the last value and then jumps. A pose that an actor or an animator
    holds is left by small steps that grow. Parts that repeat in the same frames are judged
    together. A value at which a part stops most of the time is a limit of the joint. Repeats at
    the start or the end of a take may be such a pose, and are kept.

    Returns
    -------
    Flags
        Shape (n_frames, n_joints + 1) of a motion, the last for the position of the root, or
        (n_frames, n_points) of tracks.
    """
    steps, limits = _steps(recording)
    held = np.zeros((recording.n_frames, steps.shape[1]), dtype=np.bool_)
    events: defaultdict[tuple[int, int], list[_Event]] = defaultdict(list)
    for part in np.flatnonzero((steps <= limits).any(axis=0)):
        found = list(_events(int(part), steps[:, part], float(limits[part])))
        values = _values(recording, int(part))[[span[0] for span, _ in found]]
        for (span, event), is_limit in zip(found, _are_limits(values), strict=True):
            if not is_limit:
                events[span].append(event)
    for (start, stop), members in events.items():
        if _moves_on(members):
            held[start:stop, [event.part for event in members]] = True
    return held


def body_is_held(recording: Motion | Tracks, held: Flags) -> Flags:
    """Return the frames in which most of what moves in this take is held, shape (n_frames,)."""
    steps, limits = _steps(recording)
    moving = (steps > limits).any(axis=0)
    return np.asarray(held.any(axis=1) & (held[:, moving].mean(axis=1) >= 0.5))


def _steps(recording: Motion | Tracks) -> tuple[Array, Array]:
    """Return the steps between frames and the largest of a repeat, radians.

    The shapes are (n_frames - 1, n_parts) and (n_parts,).
    """
    if isinstance(recording, Tracks):
        steps = np.linalg.norm(np.diff(recording.positions, axis=0), axis=-1)
        return steps / METERS_PER_RADIAN, np.full(
            recording.n_points, MAX_REPEAT_M / METERS_PER_RADIAN
        )
    turns = np.abs(angle_between(recording.rotations[1:], recording.rotations[:-1]))
    moves = np.linalg.norm(np.diff(recording.root_positions, axis=0), axis=-1)
    limits = np.full(turns.shape[1] + 1, MAX_REPEAT_RAD)
    limits[-1] = MAX_REPEAT_M / METERS_PER_RADIAN
    return np.column_stack([turns, moves / METERS_PER_RADIAN]), limits


def _values(recording: Motion | Tracks, part: int) -> Array:
    """Return the rotation or position of a part, shape (n_frames, 4 or 3)."""
    if isinstance(recording, Tracks):
        return recording.positions[:, part]
    if part == recording.n_joints:
        return recording.root_positions
    return unroll(recording.rotations[:, part])


def _are_limits(values: Array) -> Flags:
    """Return which of these values make up half of all, shape (n_values,)."""
    if len(values) < 2:
        return np.zeros(len(values), dtype=np.bool_)
    rounded = np.round(values / MAX_REPEAT_RAD)
    _, which, counts = np.unique(rounded, axis=0, return_inverse=True, return_counts=True)
    return np.asarray(counts[which.reshape(-1)] > max(0.5 * len(values), 1.0))


def _events(part: int, steps: Array, limit: float) -> Iterator[tuple[tuple[int, int], _Event]]:
    """Yield the first and the last frame + 1 of each run of repeats, and its jump."""
    frames = np.flatnonzero(~(steps <= limit)) + 1  # a missing sample ends a run
    if len(frames) < 3 or len(frames) < (1.0 - MAX_REPEATED_FRACTION) * len(steps):
        return
    sizes = steps[frames - 1]
    lengths = np.diff(frames, prepend=0)
    speeds = sizes / lengths
    smallest = float(np.nanmin(sizes, initial=np.inf))
    for index in np.flatnonzero(lengths[1:-1] > 1) + 1:
        around = sizes[index], speeds[index], speeds[index - 1], speeds[index + 1]
        if np.isfinite(around).all():
            jump, speed, before, after = map(float, around)
            span = int(frames[index - 1]) + 1, int(frames[index])
            yield span, _Event(part, jump, speed, before, after, jump / smallest)


def _moves_on(events: Sequence[_Event]) -> bool:
    """Return whether the parts moved on at a speed like that before and after."""
    jump, speed, before, after = np.linalg.norm([event[1:5] for event in events], axis=0)
    return bool(
        jump >= max(MIN_RATIO * max(before, after), MIN_JUMP_RAD)
        and speed <= MAX_SPEED_RATIO * min(before, after)
        and max(event.quanta for event in events) >= MIN_QUANTA
    )
