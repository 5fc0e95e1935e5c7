"""Summarize a recording in plain numbers, before any processing."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..depth_scene import DepthRecording
from ..motion import JointRecording, Motion, Tracks
from ..signals import find_runs


def recording_figures(
    recording: Motion | Tracks | JointRecording | DepthRecording,
) -> dict[str, Any]:
    """Return size, rate and gaps of a recording, with units in the names, ready for JSON.

    A gap is an interval without observations of a joint or marker. A joint without any
    observation is listed in `never_seen` instead. End sites are ignored.

    Returns
    -------
    dict
        `joints` or `markers`, `n_frames`, `frame_rate_hz`, `duration_s`, `gaps`,
        `missing_share`, `longest_gap_s`, `never_seen` (names), and the `sensor` of a camera. Of
        depth: `width_px`, `height_px`, `n_frames`, `frame_rate_hz`, `duration_s`.
    """
    if isinstance(recording, DepthRecording):
        return {
            "width_px": recording.camera.width,
            "height_px": recording.camera.height,
            "n_frames": recording.n_frames,
            "frame_rate_hz": recording.frame_rate,
            "duration_s": recording.n_frames / recording.frame_rate,
        }
    if isinstance(recording, Motion):
        skeleton = recording.skeleton
        columns = [
            joint for joint in range(skeleton.n_joints) if not skeleton.is_end_site(joint)
        ]
        names, observed = np.array(skeleton.names)[columns], recording.observed[:, columns]
    else:
        tracks = recording.tracks if isinstance(recording, JointRecording) else recording
        names, observed = np.array(tracks.names), tracks.visible
    is_observed = observed.any(axis=0)
    lengths = _gap_lengths(observed[:, is_observed])
    figures = {
        "markers" if isinstance(recording, Tracks) else "joints": len(names),
        "n_frames": recording.n_frames,
        "frame_rate_hz": recording.frame_rate,
        "duration_s": recording.n_frames / recording.frame_rate,
        "gaps": len(lengths),
        "missing_share": float(np.mean(~observed)),
        "longest_gap_s": float(lengths.max(initial=0)) / recording.frame_rate,
        "never_seen": names[~is_observed].tolist(),
    }
    if isinstance(recording, JointRecording):
        figures["sensor"] = recording.sensor.value
    return figures


def _gap_lengths(observed: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Return the length in frames of each gap of each column, shape (n_frames, n)."""
    runs = [find_runs(~column) for column in observed.T]
    return np.array([stop - start for column in runs for start, stop in column], dtype=np.intp)
