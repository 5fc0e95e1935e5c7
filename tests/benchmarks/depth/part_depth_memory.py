"""Memory and time that captures of long recordings take, each in a process of its own.

    python -m tests.benchmarks.depth.bench_depth --only memory [--docs]

A short take is played to and fro, drawn at 80 x 60 pixels, and captured at the cheapest
settings from the file's pictures to planted feet. Twenty minutes are 36,000 frames.
"""

import json
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from resource import RUSAGE_SELF, getrusage
from time import process_time

from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.capturing.capture import CaptureSettings
from solvers.workflows import capture_recording

from ..shared.tables import number, table
from .depth_sequences import sequence

LENGTHS = (300, 3000, 36_000)
TAKE, STEP = "walk_front", 4
CHEAP = CaptureSettings(backward=False, refine=False, check_every=600, patience=60)
MEGABYTE = 1024.0
"""Linux reports the peak in kilobytes."""


def memory(lengths: Sequence[int] = LENGTHS) -> list[str]:
    """Return the table."""
    rows, peaks = {}, []
    for n_frames in lengths:
        report = _in_its_own_process(n_frames)
        peaks.append(report["peak"])
        rows[f"{n_frames} frames, {n_frames / 1800:.3g} min"] = [
            number(report["peak"]), number(report["n_frames"] / report["seconds"]),
            number(report["residual"]),
        ]  # fmt: skip
    grown = 1024.0 * (peaks[-1] - peaks[0]) / (lengths[-1] - lengths[0])
    header = ["recording", "peak MB", "frames/s", "cm in depth"]
    return [
        "**Long recordings** (80 x 60, forward, body not refined)\n\n"
        + table(header, rows)
        + f"\n\nEach further frame takes {grown:.1f} kB; a picture has 19 kB.\n"
    ]


def _in_its_own_process(n_frames: int) -> dict[str, float]:
    command = [sys.executable, "-m", "tests.benchmarks.depth.part_depth_memory", str(n_frames)]
    root = Path(__file__).resolve().parents[3]
    done = subprocess.run(command, check=True, capture_output=True, text=True, cwd=root)
    return json.loads(done.stdout)


def _looped(n_frames: int) -> DepthRecording:
    """Return that many frames of the take, forth and back, read on demand."""
    take = sequence(TAKE).depth
    there_and_back = [*range(take.n_frames), *range(take.n_frames - 2, 0, -1)]

    def read(frame: int):
        return take.frame(there_and_back[frame % len(there_and_back)])[::STEP, ::STEP]

    return DepthRecording(take.camera.every(STEP), n_frames, take.frame_rate, read)


def main(n_frames: int) -> None:
    """Capture and print what it took."""
    started = process_time()
    found = capture_recording(_looped(n_frames), settings=CHEAP)
    report = {
        "n_frames": found.motion.n_frames,
        "seconds": process_time() - started,
        "peak": getrusage(RUSAGE_SELF).ru_maxrss / MEGABYTE,
        "residual": 100.0 * float(found.captured.residual.mean()),
    }
    print(json.dumps(report))


if __name__ == "__main__":
    main(int(sys.argv[1]))
