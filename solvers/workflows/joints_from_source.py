"""What was measured, for a motion that was made of it: bones do not keep all that it told."""

import numpy as np
from numpy.typing import NDArray

from ..motion import JointRecording, Motion, Tracks, forward_kinematics, motion_from_points
from ..motion.humanoid import with_hips

Array = NDArray[np.float64]
SAME = 0.002
"""Metres by which joints may differ: the rounding of keys, far from the camera."""
FEWEST = 3
SAME_TURN = 1e-3
"""Cosines of half angles by which turns may differ, to be worth a closer look."""
N_PROBES = 5
MOST_STARTS = 100
"""Of those that are looked at closely; only who stands still has more."""


def joints_from_source(motion: Motion, recording: JointRecording) -> JointRecording | None:
    """Return a recording as it lies where a motion is, if the motion was made of it.

    Bones of constant length cannot tell how far the tracker stretched them, nor where a joint
    was that hangs on one that was not seen. The recording can; but it is only believed where
    the motion is still what `motion_from_points` makes of it, or a part of that, moved, turned
    and scaled as a whole at most. None where it is not.
    """
    if recording.parents.count(-1) != 1 or recording.n_frames < motion.n_frames:
        return None
    recording = with_hips(recording)
    made = motion_from_points(recording.tracks, recording.parents)
    names = motion.skeleton.names
    if set(made.skeleton.names) != set(names):
        return None
    order = [made.skeleton.index(name) for name in names]
    start = forward_kinematics(made).positions[:, order]
    stop = forward_kinematics(motion).positions
    for first in _starts(made.rotations[:, order, 0], motion.rotations[..., 0]):
        part = slice(first, first + motion.n_frames)
        fit = _fit(start[part], stop)
        if fit is not None:
            return _cut(recording, names, part, motion.frame_rate, fit)
    return None


def _starts(whole: Array, part: Array) -> NDArray[np.intp]:
    """Return frames at which a part may begin, by turns that do not depend on where it is.

    Both are cosines of half angles, shape (n_frames, n_joints), the root's first.
    """
    n_starts = len(whole) - len(part) + 1
    fits = np.ones(n_starts, bool)
    for probe in np.linspace(0, len(part) - 1, N_PROBES).astype(int):
        there, here = whole[probe : probe + n_starts, 1:], part[probe, 1:]
        same = np.abs(np.abs(there) - np.abs(here)) <= SAME_TURN
        fits &= (same | (np.isnan(there) & np.isnan(here))).all(axis=1)
    return np.flatnonzero(fits)[:MOST_STARTS]


def _fit(start: Array, stop: Array) -> tuple[Array, float, Array] | None:
    """Return the turn, scale and shift that bring joints onto others; None if none does."""
    seen = np.isfinite(start).all(axis=-1)
    if (seen != np.isfinite(stop).all(axis=-1)).any() or seen.sum() < FEWEST:
        return None
    axes, scale, shift = _similarity(start[seen], stop[seen])
    moved = scale * start[seen] @ axes.T + shift
    return None if np.abs(moved - stop[seen]).max() > SAME * scale else (axes, scale, shift)


def _cut(
    recording: JointRecording,
    names: tuple[str, ...],
    part: slice,
    frame_rate: float,
    fit: tuple[Array, float, Array],
) -> JointRecording:
    """Return some joints and frames of a recording, turned, scaled and shifted."""
    axes, scale, shift = fit
    points = [recording.names.index(name) for name in names]
    places = scale * recording.tracks.positions[part][:, points] @ axes.T + shift
    state, confidence = recording.tracking_state, recording.tracks.confidence
    told = None if confidence is None else confidence[part][:, points]
    return JointRecording(
        Tracks(names, places, frame_rate, told),
        None if state is None else state[part][:, points],
        recording.sensor,
    )


def _similarity(start: Array, stop: Array) -> tuple[Array, float, Array]:
    """Return turn, scale and shift that bring points, shape (n, 3), nearest to others.

    Umeyama (1991), doi:10.1109/34.88573.
    """
    middles = start.mean(axis=0), stop.mean(axis=0)
    first, second = start - middles[0], stop - middles[1]
    left, sizes, right = np.linalg.svd(second.T @ first)
    signs = np.array([1.0, 1.0, np.sign(np.linalg.det(left) * np.linalg.det(right))])
    axes = (left * signs) @ right
    scale = float((sizes * signs).sum() / max((first**2).sum(), np.finfo(float).tiny))
    return axes, scale, middles[1] - scale * axes @ middles[0]
