"""What there is to say about a recording before anything is done to it, as plain numbers."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..depth_scene import DepthRecording
from ..motion import JointRecording, Motion, Tracks


def recording_figures(
    recording: Motion | Tracks | JointRecording | DepthRecording,
) -> dict[str, Any]:
    """Return size, rate and gaps of a recording, with units in the names, ready for JSON.

    A gap is a stretch of frames in which a joint or marker is not observed. One that never is
    counts as never seen instead; end sites, which nothing records, do not count at all.

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
        names, seen = np.array(skeleton.names)[columns], recording.observed[:, columns]
    else:
        tracks = recording.tracks if isinstance(recording, JointRecording) else recording
        names, seen = np.array(tracks.names), tracks.visible
    ever = seen.any(axis=0)
    lengths = _gap_lengths(seen[:, ever])
    figures = {
        "markers" if isinstance(recording, Tracks) else "joints": len(names),
        "n_frames": recording.n_frames,
        "frame_rate_hz": recording.frame_rate,
        "duration_s": recording.n_frames / recording.frame_rate,
        "gaps": len(lengths),
        "missing_share": float(np.mean(~seen)),
        "longest_gap_s": float(lengths.max(initial=0)) / recording.frame_rate,
        "never_seen": names[~ever].tolist(),
    }
    if isinstance(recording, JointRecording):
        figures["sensor"] = recording.sensor.value
    return figures


def _gap_lengths(seen: NDArray[np.bool_]) -> NDArray[np.intp]:
    """Return how many frames each gap of each column, shape (n_frames, n), lasts."""
    edge = np.ones((1, seen.shape[1]), dtype=bool)
    turns = np.diff(np.concatenate([edge, seen, edge]).T.astype(np.int8))
    return np.flatnonzero(turns == 1) - np.flatnonzero(turns == -1)
