"""Physics before and after, and at part of its strength, on takes that it was not tuned on.

    python -m tests.benchmarks.physics.bench_physics                   # about two minutes
    python -m tests.benchmarks.physics.bench_physics --full --docs
        # twice as many, docs/manual/physics.md

Slide: speed of both feet over the ground, of the slowest point of the sole, while the input
stands (contacts detected on the input). Carrying: the same while the simulated foot carries
more than a tenth of the weight, whatever the input's contacts are. Deepest: how far the body's
surface is under the ground at worst, and in the worst 1 % of the frames. Lengths: largest
change of a bone's length. Jerk: mean third derivative of the joints' positions. Distance: of
the joints from the input, mean and 95th percentile. Speed: seconds of take for one second of
one processor. Help: force from outside as a fraction of the weight. Impossible: what of the
change of momentum neither gravity nor a push within friction by ground that is touched could
give, mean, as a fraction of the weight. The ground is under the feet of each take.
"""

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path
from time import perf_counter, process_time
from typing import NamedTuple

import numpy as np

from solvers.motion import (
    Motion,
    detect_contacts,
    find_humanoid_map,
    forward_kinematics,
    joint_parents,
    motion_from_points,
)
from solvers.physics import Ground, Simulated, SimulateSettings, apply_strength, simulate
from solvers.physics.body import build_physics_body
from solvers.physics.body_surface import measure_clearance, measure_foot_slide
from solvers.physics.soles_and_ground import add_soles
from solvers.physics.target import fill_motion_gaps
from solvers.recordings import read_recording
from solvers.samples import CorruptionSettings, corrupt

from ..shared.report import DOCS, Report
from ..shared.tables import table
from .physics_momentum import impossible_force

DATA = Path(__file__).resolve().parents[4] / "shared" / "data"
MIN_LOAD_FRACTION = 0.1
"""Fraction of the weight."""
STRENGTHS = (0.25, 0.5, 1.0)
MAX_FRAMES = 600
"""Frames of a take."""

COLUMNS = (
    "slide cm/s", "carrying cm/s", "deepest mm", "worst 1 % mm", "lengths mm", "jerk m/s³",
    "distance mm", "95 % mm", "impossible %", "followed %", "help %", "speed x",
)  # fmt: skip
SETS = {
    "CMU walks and runs, 120 Hz": ("mocap/cmu_walk", ("10", "26", "27", "32", "35_")),
    "HDM05, 11 classes of actor dg, 120 Hz": ("mocap/hdm05", ("HDM_dg_",)),
    "Kinect v2 (UI-PRMD, subjects 4 and 5), 30 Hz": ("kinect/ui_prmd", ("m0",)),
    "Kinect v2 (IRDS), 30 Hz": ("kinect/irds", ("",)),
    "Kinect v1 (MSR Action3D), 30 Hz": ("kinect/msr_action3d", ("a",)),
}
SHAKEN = "CMU walks and runs at 30 Hz, shaken by 1 degree and 5 mm"


class Row(NamedTuple):
    """Figures of one clip, in the order of COLUMNS."""

    figures: tuple[float, ...]


def main() -> None:
    """Print a table for each set of clips."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--full", action="store_true", help="twice as many clips")
    parser.add_argument("--docs", action="store_true", help="rewrite docs/manual/physics.md")
    chosen = parser.parse_args()
    started = perf_counter()
    tables = [
        means(title, list(clips(title, 12 if chosen.full else 6))) for title in (*SETS, SHAKEN)
    ]
    report = Report(chosen.docs, DOCS / "manual" / "physics.md")
    report.part("physics", tables, perf_counter() - started)


def clips(title: str, at_most: int) -> Iterator[Motion]:
    """Yield the takes of a set, spread over its files."""
    if title == SHAKEN:
        for number, motion in enumerate(clips("CMU walks and runs, 120 Hz", at_most)):
            slow = Motion(
                motion.skeleton, motion.rotations[::4], motion.root_positions[::4], 30.0
            )
            wrong = CorruptionSettings(jitter=1.0, root_jitter=0.005, seed=number)
            yield corrupt(slow, wrong)
        return
    folder, beginnings = SETS[title]
    files = sorted((DATA / folder).iterdir())
    if "PRMD" in title:
        files = [file for file in files if "_s04_" in file.name or "_s05_" in file.name]
    elif folder == "mocap/hdm05":
        files = [f for f in files if f.suffix == ".amc"]
    files = [file for file in files if file.name.startswith(beginnings)]
    for index in np.linspace(0, len(files) - 1, min(at_most, len(files))).astype(int):
        motion = motion_of(files[index])
        yield motion.slice(1, min(motion.n_frames, MAX_FRAMES))


def motion_of(path: Path) -> Motion:
    """Read a take; tracked joints become the motion of a skeleton of constant lengths."""
    recording = read_recording(path)
    if isinstance(recording, Motion):
        return recording
    return fill_motion_gaps(
        motion_from_points(recording.tracks, joint_parents(recording.names))
    )


def means(title: str, motions: list[Motion]) -> str:
    """Return the means over the clips, before and at each strength."""
    rows: dict[str, list[Row]] = {}
    for motion in motions:
        started = process_time()
        simulated = simulate(motion, settings=SimulateSettings(ground=Ground.FEET))
        speed = motion.n_frames * motion.dt / (process_time() - started)
        rows.setdefault("before", []).append(row(motion, motion, simulated))
        for strength in STRENGTHS:
            result = apply_strength(motion, simulated, strength)
            rows.setdefault(f"strength {strength:g}", []).append(
                row(motion, result, simulated, speed)
            )
        rows.setdefault("without Plant", []).append(without_plant(motion))
    cells = {}
    for name, found in rows.items():
        figures = np.array([each.figures for each in found]).mean(axis=0)
        cells[name] = ["" if np.isnan(figure) else f"{figure:.3g}" for figure in figures]
    print(f"Done: {title}", file=sys.stderr, flush=True)
    return f"**{title}**, {len(motions)} clips, means\n\n{table(['', *COLUMNS], cells)}\n"


def without_plant(motion: Motion) -> Row:
    """Measure what friction alone holds."""
    settings = SimulateSettings(ground=Ground.FEET, plant=False)
    simulated = simulate(motion, settings=settings)
    return row(motion, simulated.motion, simulated)


def row(motion: Motion, result: Motion, simulated: Simulated, speed: float = np.nan) -> Row:
    """Measure one result."""
    humanoid = find_humanoid_map(motion.skeleton)
    body = add_soles(build_physics_body(motion, humanoid), motion, humanoid, simulated.ground)
    depths = np.maximum(-measure_clearance(body, result, simulated.ground), 0.0)
    seconds = motion.n_frames * motion.dt
    before, after = (forward_kinematics(each).positions for each in (motion, result))
    displacements = np.linalg.norm(after - before, axis=-1)[:, list(body.joints)]
    jerks = np.linalg.norm(np.diff(after, 3, axis=0) * motion.frame_rate**3, axis=-1)
    is_input = result is motion
    return Row((
        100 * measure_foot_slide(body, result, detect_contacts(motion, humanoid)) / seconds,
        100
        * measure_foot_slide(body, result, simulated.foot_loads > MIN_LOAD_FRACTION)
        / seconds,
        1000 * depths.max(),
        1000 * np.percentile(depths, 99),
        1000 * length_change(result, after),
        jerks.mean(),
        1000 * displacements.mean(),
        1000 * np.percentile(displacements, 95),
        100 * impossible_force(body, result, simulated.ground),
        np.nan if is_input else 100 * simulated.followed.mean(),
        np.nan if is_input else 100 * simulated.support.mean(),
        speed,
    ))


def length_change(motion: Motion, positions: np.ndarray) -> float:
    """Return the largest difference of a bone's length from the skeleton's, meters."""
    bones = positions[:, 1:] - positions[:, list(motion.skeleton.parents[1:])]
    lengths = np.linalg.norm(motion.skeleton.offsets[1:], axis=-1)
    return float(np.abs(np.linalg.norm(bones, axis=-1) - lengths).max())


if __name__ == "__main__":
    main()
