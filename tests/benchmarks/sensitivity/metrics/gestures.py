"""Gestures in the joints of a camera: how many are recognized as before."""

from typing import Any

import numpy as np

from solvers.arrays import Array
from solvers.gestures import GestureSettings
from solvers.gestures.recognition import recognize_gestures
from solvers.motion.humanoid.posture_joints import posture_positions
from solvers.recordings import read_joints
from solvers.samples import PerformanceSettings, perform_gestures

from ...shared.clips import DATA

ACTS = (
    "rest", "hand up", "rest", "wave right", "rest", "wave left", "rest", "clap", "rest",
    "zoom in", "rest", "turn", "rest", "zoom out", "clap", "rest",
)  # fmt: skip
RECORDED = {
    "actions": "msr_action3d/*_s0[12]_*",
    "exercises": "ui_prmd/*_s0[12]_e01*",
    "sign language": "laban/Ges*",
}
"""Takes of a Kinect by figure. Subjects 3 and 4, whom the tests use, are not among them."""
Streams = dict[str, list[tuple[Array, Array, Array | None]]]


def prepare() -> dict[str, Any]:
    """Perform all gestures once, with noise, and read takes of other movements.

    What is recognized now is wanted.
    """
    performance = perform_gestures(ACTS, PerformanceSettings(seed=1, noise=0.005))
    streams: Streams = {
        "performed": [(performance.times, performance.positions, performance.confidence)]
    }
    for figure, pattern in RECORDED.items():
        recordings = [read_joints(each) for each in sorted((DATA / "kinect").glob(pattern))]
        streams[figure] = [
            (np.arange(len(positions)) / recording.frame_rate, positions, None)
            for recording in recordings
            if len(positions := posture_positions(recording))
        ]
    return {"streams": streams, "wanted": _recognized(streams)}


def measure(streams: Streams, wanted: dict[str, set[Any]]) -> dict[str, float]:
    """Count all gestures, and those that are no longer, or newly, recognized."""
    found = _recognized(streams)
    return {
        f"{figure}: gestures, and changed ones": float(
            max(1, len(wanted[figure])) + len(found[figure] ^ wanted[figure])
        )
        for figure in streams
    }


def _recognized(streams: Streams) -> dict[str, set[Any]]:
    settings = GestureSettings(waves_need_hand_up=False)
    return {
        figure: {
            (number, event.gesture.name, round(event.time, 1), round(event.amount, 2))
            for number, stream in enumerate(some)
            for event in recognize_gestures(*stream, settings)
        }
        for figure, some in streams.items()
    }
