"""Draw real recordings before and after Reconstruct: docs/pictures/results.

    make pictures

Prints their measurements. Nothing of the recordings is stored.
"""

import sys
from pathlib import Path

import numpy as np
from draw_formats import on_the_floor

from solvers.denoising import measure_quality
from solvers.motion import motion_from_points
from solvers.pictures import StickFigureSettings, ViewDirection, draw_stick_figures
from solvers.recordings import read_recording
from solvers.workflows import reconstruct_recording

ROOT = Path(__file__).resolve().parents[2]
PICTURES = ROOT / "docs" / "pictures" / "results"
SAMPLES = {
    "irds": ("irds/215_18_5_8_1_stand.txt", range(8, 36), "front"),
    "kimore": ("kimore/JointPositionExercise1.csv", range(0, 505), "front"),
    "msr_action3d": ("msr_action3d/a05_s02_e03_skeleton3D.txt", range(10, 40), "front"),
}
"""By page: a file within the folder of recordings, the frames, and the direction of view."""


def main(recordings: Path) -> None:
    """Draw one picture for each."""

    settings = {"n_figures": 8, "height": 150}
    for name, (file, frames, view) in SAMPLES.items():
        recording = on_the_floor(read_recording(recordings / "kinect" / file))
        result = reconstruct_recording(recording)
        both = {
            "tracked": motion_from_points(recording.tracks, recording.parents),
            "reconstructed": result.motion,
        }
        style = StickFigureSettings(view=ViewDirection(view), **settings)
        draw_stick_figures(both, style, frames=frames).save(
            PICTURES / f"reconstruction_{name}.png"
        )
        before, after = (
            measure_quality(each).figures()["mean_jitter_m_per_s3"]
            for each in (recording.tracks, result.motion)
        )
        parents = np.array(recording.parents)
        bones = np.flatnonzero(parents >= 0)
        positions = recording.tracks.positions
        lengths = np.linalg.norm(positions[:, bones] - positions[:, parents[bones]], axis=-1)
        spread = 1000.0 * float(np.nanmean(np.nanstd(lengths, axis=0)))
        slide = result.planted
        feet = f"{slide.slide_before:.3f} -> {slide.slide_after:.3f}" if slide else "-"
        print(
            f"{file}: {recording.n_frames} frames, rebuilt {100 * result.rebuilt.mean():.1f} %,"
            f" jitter {before:.0f} -> {after:.0f} m/s3, lengths vary {spread:.1f} mm -> 0,"
            f" feet slide {feet} m"
        )


if __name__ == "__main__":
    main(Path(sys.argv[1]))
