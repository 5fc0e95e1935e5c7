"""How long a live frame takes, from joints to a rig, and how far it is from the offline result.

    make bench-live
    make bench-live ARGUMENTS=--docs    # into docs/benchmarks/live.md
    make bench-live ARGUMENTS="--only depth"

Takes of depth cameras are sent frame by frame to a `LiveTake` and then to a rig, without a
socket. Then streams are sent over a socket in each protocol, and timed by stage. Last, depth
images are tracked while they are written. Takes whose path is missing are left out.
"""

import argparse
from collections.abc import Iterator
from pathlib import Path
from time import perf_counter, thread_time
from typing import NamedTuple

import numpy as np

from solvers.motion import JointRecording, Motion, find_humanoid_map
from solvers.reconstruction import ReconstructSettings, reconstruct
from solvers.recordings import read_recording
from solvers.recordings.streams import StreamProtocol, frames_from_recording
from solvers.retargeting import LiveRetargeting
from solvers.samples import GaitSettings, walker_skeleton, walking_gait
from solvers.workflows import LiveTake

from ..depth.depth_sequences import TRUTH
from ..shared.report import DOCS, Report
from ..shared.tables import table
from .followed_depth import followed
from .held_feet import HEADER, HeldFeet, drifting, hold_feet

DATA = Path(__file__).parents[4] / "shared" / "data" / "kinect"
TAKES = {
    "KIMORE 1, Kinect v2": DATA / "kimore" / "JointPositionExercise1.csv",
    "KIMORE 5, Kinect v2": DATA / "kimore" / "JointPositionExercise5.csv",
    "IRDS, Kinect v2": DATA / "irds" / "216_18_6_1_1_stand.txt",
}
N_FRAMES = 300


class LiveFigures(NamedTuple):
    """Figures of one take."""

    reconstruct_ms: list[float]
    retarget_ms: list[float]
    calibration_s: float
    offline_cm: float
    """Mean distance from the causal reconstruction of the complete take."""
    feet: HeldFeet


PARTS = ("joints", "delay", "depth")


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--docs", action="store_true", help="rewrite docs/benchmarks/live.md")
    parser.add_argument("--only", choices=PARTS, help="measure one part")
    arguments = parser.parse_args()
    report = Report(arguments.docs, DOCS / "benchmarks" / "live.md")
    for part, measure_part in zip(PARTS, (_joints, _delay, _depth), strict=True):
        if arguments.only in {None, part}:
            measure_part(report)


def _joints(report: Report) -> None:
    started = perf_counter()
    measured = {name: measure(path) for name, path in TAKES.items() if path.exists()}
    rows = {name: _row(figures) for name, figures in measured.items()}
    header = [
        "take", "joints and rotations, ms", "95th percentile", "rig, ms", "95th percentile",
        "measuring the actor, s", "distance from offline, cm",
    ]  # fmt: skip
    report.part("live", [table(header, rows) + "\n"], perf_counter() - started)
    feet = {name: figures.feet for name, figures in measured.items()} | walks()
    rows = {name: each.cells() for name, each in feet.items()}
    report.part("feet", [table(HEADER, rows) + "\n"], perf_counter() - started)


def _delay(report: Report) -> None:
    from .delay import measure_delay  # imports bpy, which workers of the next part cannot

    started = perf_counter()
    rows = {
        name: measure_delay(*stream, walker_skeleton()).cells() for name, stream in streams()
    }
    header = ["stream", "receive", "solve", "rig", "to Blender", "at most behind"]
    report.part("delay", [table(header, rows) + "\n"], perf_counter() - started)


def _depth(report: Report) -> None:
    started = perf_counter()
    if TRUTH.exists():
        report.part("depth", [followed().markdown()], perf_counter() - started)


def streams() -> Iterator[tuple[str, tuple[Motion | JointRecording, StreamProtocol]]]:
    """Yield what is sent: joints of a camera, and a made walk in each protocol of bones."""
    name, path = next(iter(TAKES.items()))
    if path.exists():
        recording = read_recording(path)
        yield f"{name}, JSON", (recording.slice(0, N_FRAMES), StreamProtocol.JSON)
    walk = walking_gait(GaitSettings(duration=6.0, frame_rate=60.0))
    for protocol in StreamProtocol:
        if protocol not in {StreamProtocol.AUTO, StreamProtocol.JSON}:
            yield f"made walk, {protocol.label}", (walk, protocol)


def walks() -> dict[str, HeldFeet]:
    """Return made walks on a drifting path, at two rates, with their feet held."""
    found = {}
    for rate in (30, 60):
        walk = drifting(walking_gait(GaitSettings(duration=13.0, frame_rate=rate)))
        frames = [walk.slice(frame, frame + 1) for frame in range(3 * rate, walk.n_frames)]
        found[f"made walk with drift, {rate} Hz"] = hold_feet(walk.slice(0, 3 * rate), frames)
    return found


def measure(path: Path) -> LiveFigures:
    """Send a take frame by frame, and compare it with the offline result."""
    recording = read_recording(path)
    recording = recording.slice(0, min(N_FRAMES, recording.n_frames))
    take, rig, poses, times, rig_times, followed = LiveTake(), None, [], [], [], []
    calibration_s = 0.0
    for frame in frames_from_recording(recording):
        began = thread_time()
        arrived = take.add([frame])
        elapsed = thread_time() - began
        if take.calibration is not None and rig is None:
            rig, calibration_s = _rig_for(take), elapsed
            continue
        if not arrived or rig is None:
            continue
        times.append(1e3 * elapsed)
        poses += arrived
        began = thread_time()
        followed.append(rig.update(arrived[-1].motion))
        rig_times.append(1e3 * (thread_time() - began))
    offline = reconstruct(recording, settings=ReconstructSettings(causal=True))
    last = offline.tracks.positions[-len(poses) :]
    distance = np.linalg.norm(
        np.stack([each.joints.positions for each in poses]) - last, axis=-1
    )
    assert rig is not None and take.calibration is not None
    feet = hold_feet(rig.update(take.calibration), followed)
    offline_cm = 100.0 * float(np.nanmean(distance))
    return LiveFigures(times, rig_times, calibration_s, offline_cm, feet)


def _rig_for(take: LiveTake) -> LiveRetargeting:
    calibration, rig = take.calibration, walker_skeleton()
    assert calibration is not None
    source = find_humanoid_map(calibration.skeleton)
    return LiveRetargeting(calibration, source, rig, find_humanoid_map(rig))


def _row(figures: LiveFigures) -> list[str]:
    cells = [
        float(percentile)
        for times in (figures.reconstruct_ms, figures.retarget_ms)
        for percentile in np.percentile(times, [50, 95])
    ]
    return [f"{each:.1f}" for each in cells] + [
        f"{figures.calibration_s:.1f}", f"{figures.offline_cm:.2f}",
    ]  # fmt: skip


if __name__ == "__main__":
    main()
