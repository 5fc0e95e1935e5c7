"""Recover the measured joints of a motion from the recording that it was solved from."""

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..motion import JointRecording, Motion, Tracks, forward_kinematics, motion_from_points
from ..motion.humanoid import fill_missing_hips
from ..rotations import RIGID_POINTS, fit_similarity

MAX_DISTANCE_M = 0.002
"""Maximum distance in meters between matching joints, due to the rounding of keys."""
MAX_COSINE_DIFFERENCE = 1e-3
"""Maximum difference of the cosines of half angles of rotations in the preselection, due to the
rounding of keys."""
N_PROBES = 5
"""Number of frames compared in the preselection. It bounds the run time: what passes is
compared in all frames."""
MAX_STARTS = 100
"""Maximum number of candidates to compare. It bounds the run time of motionless takes; only
these have more."""


def joints_from_source(motion: Motion, recording: JointRecording) -> JointRecording | None:
    """Return the joints of a recording aligned to a motion, if the motion was solved from it.

    Bones of constant length lose how far the tracker stretched them, and the position of a
    joint below a missing parent. The recording keeps both. It is used only if the motion still
    is the result of `motion_from_points`, or a segment of it, up to a similarity transform.
    None otherwise.
    """
    if recording.parents.count(-1) != 1 or recording.n_frames < motion.n_frames:
        return None
    recording = fill_missing_hips(recording)
    rebuilt = motion_from_points(recording.tracks, recording.parents)
    names = motion.skeleton.names
    if set(rebuilt.skeleton.names) != set(names):
        return None
    order = [rebuilt.skeleton.index(name) for name in names]
    source = forward_kinematics(rebuilt).positions[:, order]
    target = forward_kinematics(motion).positions
    for first in _candidate_starts(rebuilt.rotations[:, order, 0], motion.rotations[..., 0]):
        segment = slice(first, first + motion.n_frames)
        fit = _fit(source[segment], target)
        if fit is not None:
            return _transformed_segment(recording, names, segment, motion.frame_rate, fit)
    return None


def _candidate_starts(full: Array, segment: Array) -> NDArray[np.intp]:
    """Return candidate first frames of a segment, by local rotations, which ignore position.

    Both are cosines of half angles, shape (n_frames, n_joints), the root's first.
    """
    n_starts = len(full) - len(segment) + 1
    fits = np.ones(n_starts, bool)
    for probe in np.linspace(0, len(segment) - 1, N_PROBES).astype(int):
        candidates, sample = full[probe : probe + n_starts, 1:], segment[probe, 1:]
        same = np.abs(np.abs(candidates) - np.abs(sample)) <= MAX_COSINE_DIFFERENCE
        fits &= (same | (np.isnan(candidates) & np.isnan(sample))).all(axis=1)
    return np.flatnonzero(fits)[:MAX_STARTS]


def _fit(source: Array, target: Array) -> tuple[Array, float, Array] | None:
    """Return rotation, scale and translation that map joints onto others; None if none does."""
    observed = np.isfinite(source).all(axis=-1)
    if (observed != np.isfinite(target).all(axis=-1)).any() or observed.sum() < RIGID_POINTS:
        return None
    axes, scale, shift = fit_similarity(source[observed], target[observed])
    moved = scale * source[observed] @ axes.T + shift
    return (
        None
        if np.abs(moved - target[observed]).max() > MAX_DISTANCE_M * scale
        else (axes, scale, shift)
    )


def _transformed_segment(
    recording: JointRecording,
    names: tuple[str, ...],
    segment: slice,
    frame_rate: float,
    fit: tuple[Array, float, Array],
) -> JointRecording:
    """Return some joints and frames of a recording after a similarity transform."""
    axes, scale, shift = fit
    columns = [recording.names.index(name) for name in names]
    positions = scale * recording.tracks.positions[segment][:, columns] @ axes.T + shift
    state, confidence = recording.tracking_state, recording.tracks.confidence
    confidence_values = None if confidence is None else confidence[segment][:, columns]
    return JointRecording(
        Tracks(names, positions, frame_rate, confidence_values),
        None if state is None else state[segment][:, columns],
        recording.sensor,
    )
