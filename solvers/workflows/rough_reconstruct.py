"""Steady tracked joints by how far they are trusted, where no posture is known."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import solveh_banded

from ..motion import JointRecording
from ..progress import Progress, unwatched, within
from ..reconstruction.follow_joints import follow_joints
from ..reconstruction.reliability import measure_reliability
from ..reconstruction.result import Reconstruction
from ..settings import Settings, setting

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class ReconstructSettings(Settings):
    """How joints are rebuilt."""

    smoothing: float = setting(
        0.1, "Seconds over which trusted joints are steadied; higher takes more jitter out",
        unit="s", minimum=0.0, maximum=2.0,
    )  # fmt: skip


def reconstruct(
    recording: JointRecording,
    postures: None = None,
    prior: None = None,
    *,
    settings: ReconstructSettings = ReconstructSettings(),
    progress: Progress = unwatched,
) -> Reconstruction:
    """Smooth every joint, the trusted samples counting most."""
    reliability = measure_reliability(recording, progress=within(progress, 0.0, 0.4))
    tracks = recording.tracks
    weights = np.where(tracks.visible, 1e-3 + reliability.combined**2, 0.0)
    places = np.stack(
        [
            _steady(np.nan_to_num(tracks.positions[:, joint]), weights[:, joint],
                    (settings.smoothing * tracks.frame_rate / 2.0) ** 4)
            for joint in range(tracks.n_points)
        ],
        axis=1,
    )  # fmt: skip
    rebuilt = tracks.with_positions(places)
    motion = follow_joints(rebuilt, recording.parents, reliability.combined)
    progress(1.0, "Done")
    return Reconstruction(rebuilt, motion, reliability, reliability.combined, "Smoothed")


def _steady(values: Array, weights: Array, stiffness: float) -> Array:
    n_frames = len(values)
    if n_frames < 3 or not weights.any():
        return values
    second = np.diff(np.eye(n_frames), 2, axis=0)
    whole = stiffness * second.T @ second + np.diag(weights + 1e-9)
    bands = np.zeros((3, n_frames))
    for at in range(3):
        bands[2 - at, at:] = np.diagonal(whole, at)
    return np.asarray(solveh_banded(bands, weights[:, None] * values))
