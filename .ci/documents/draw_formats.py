"""Draw a real recording of each format for docs/formats: docs/pictures/formats.

    make pictures

Draws what the reader made of the file. Nothing of the recordings is stored.
"""

import sys
from pathlib import Path

import numpy as np

from solvers.motion import JointRecording
from solvers.pictures import StickFigureSettings, ViewDirection, draw_stick_figures
from solvers.recordings import read_recording

ROOT = Path(__file__).resolve().parents[2]
PICTURES = ROOT / "docs" / "pictures" / "formats"
SAMPLES = {
    "bvh": ("mocap/cmu_walk/07_01.bvh", "side"),
    "acclaim": ("mocap/05_13.amc", "front"),
    "c3d": ("markers/85_02.c3d", "side"),
    "trc": ("formats/trc/motion_capture_run.trc", "side"),
    "irds": ("kinect/irds/215_18_1_4_2_stand.txt", "front"),
    "kinect_csv": ("kinect/laban/Ges01_wavehand.csv", "front"),
    "msr_action3d": ("kinect/msr_action3d/a01_s01_e01_skeleton3D.txt", "front"),
    "azure_csv": ("kinect/azure/joints_sync_1.csv", "front"),
    "ui_prmd": ("kinect/ui_prmd/m01_s01_e01.npz", "front"),
}
"""By page: a file in the folder of recordings, and the direction of view."""


def on_the_floor(recording):
    """Lift the joints of a depth camera, which is at the origin, so that the feet are at 0."""

    if not isinstance(recording, JointRecording):
        return recording
    positions = recording.tracks.positions
    lowest = np.quantile(positions[recording.tracks.visible][:, 2], 0.01)
    return recording.with_tracks(
        recording.tracks.with_positions(positions - (0.0, 0.0, lowest))
    )


def main(recordings: Path) -> None:
    """Draw one picture for each page."""

    for page, (file, view) in SAMPLES.items():
        recording = on_the_floor(read_recording(recordings / file))
        settings = StickFigureSettings(n_figures=8, height=150, view=ViewDirection(view))
        label = f"{file.rsplit('/', 1)[-1]}, as it was read"
        draw_stick_figures({label: recording}, settings).save(PICTURES / f"{page}.png")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
