"""Made depth recordings for drivers, from the sequences of the benchmarks."""

import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[3]
CAMERA = ("fx", "fy", "cx", "cy")
N_FRAMES = 40
"""Of each recording: tracking a frame before two cameras takes seconds."""


def write_cameras(folder: Path) -> None:
    """Write a walk before two cameras."""
    sys.path.insert(0, str(ROOT))
    from tests.benchmarks.depth.cameras.camera_pairs import camera_pair

    pair = camera_pair("walk, side")
    _write(folder / "front.npz", pair.first.depth)
    _write(folder / "side.npz", pair.second.depth)


def write_people(folder: Path) -> None:
    """Write two people who stand next to each other."""
    sys.path.insert(0, str(ROOT))
    from tests.benchmarks.depth.people.two_actors import people_sequence

    _write(folder / "two.npz", people_sequence("side by side", tuning=True).depth)


def _write(path: Path, recording) -> None:
    images = [recording.frame(frame) for frame in range(min(N_FRAMES, recording.n_frames))]
    np.savez_compressed(
        path,
        depth=(1000.0 * np.array(images)).round().astype(np.uint16),
        frame_rate=recording.frame_rate,
        **{name: getattr(recording.camera, name) for name in CAMERA},
    )
