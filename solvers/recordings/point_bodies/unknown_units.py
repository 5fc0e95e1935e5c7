"""Give bodies without a unit the size of an adult, and undo the scale of single frames."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ...arrays import Array
from ...motion import FileConventions, JointRecording, Tracks
from ...motion.humanoid import ADULT_STATURE_M, posture_positions
from ...progress import Progress, Remark
from ..conventions import stature, with_conventions
from .unnamed_joints import limb_lengths

MAX_STATURE_M, MIN_STATURE_M = 4.0, 0.5
"""Statures, meters, outside which lengths have no known unit. They guard normalized points."""
BOX = 1.0
"""Largest coordinate of each frame. By definition of points that programs divide by it, to
draw them."""
MAX_ROUNDING = 1e-6
"""Difference from it, as a ratio. It bounds the rounding of single precision."""


def are_scaled_by_frame(positions: Array) -> bool:
    """Return whether joints that move have the same largest coordinate, 1, in all frames.

    Parameters
    ----------
    positions : shape (n_frames, n_joints, 3), NaN where missing
    """
    observed = np.abs(positions[np.isfinite(positions).any(axis=(1, 2))])
    largest = np.fmax.reduce(observed.reshape(len(observed), -1), axis=1)
    is_moving = len(observed) > 1 and bool((observed != observed[:1]).any())
    return is_moving and bool((np.abs(largest - BOX) <= MAX_ROUNDING).all())


def with_constant_lengths(names: Sequence[str], positions: Array) -> Array:
    """Scale each frame so that the bones of the limbs have the same lengths in all.

    Parameters
    ----------
    names : names of joints with humanoid roles
    positions : shape (n_frames, n_joints, 3), NaN where missing
    """
    lengths, _ = limb_lengths(posture_positions(Tracks(tuple(names), positions, 1.0)))
    is_known = np.isfinite(lengths)
    ratios = np.full(lengths.shape, np.nan)
    for bone in np.flatnonzero(is_known.any(axis=0)):
        ratios[:, bone] = np.nanmedian(lengths[:, bone]) / lengths[:, bone]
    scales = np.ones(len(positions))
    scales[is_known.any(axis=1)] = np.nanmedian(ratios[is_known.any(axis=1)], axis=1)
    return np.asarray(scales[:, None, None] * positions)


def has_size_of_person(recording: JointRecording) -> bool:
    """Return whether a body, in meters, has the size of a person, or none that is known."""
    tall = stature(recording)
    return tall is None or MIN_STATURE_M <= tall <= MAX_STATURE_M


def with_adult_size(
    recording: JointRecording, noted: FileConventions, progress: Progress
) -> JointRecording:
    """Give a body whose lengths have no unit the size of an adult."""
    tall = stature(recording)
    if tall is None:
        return recording
    factor = ADULT_STATURE_M / tall
    progress(
        1.0,
        Remark(
            f"Lengths have no known unit; the actor is scaled to {ADULT_STATURE_M:g} m. Set"
            " Scale if that is wrong"
        ),
    )
    larger = recording.tracks.with_positions(factor * recording.tracks.positions)
    return with_conventions(
        recording.with_tracks(larger), replace(noted, unit=noted.unit * factor)
    )
