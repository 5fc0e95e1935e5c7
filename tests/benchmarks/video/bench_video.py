"""What Clean, Plant Feet and Physics make of takes of video models, next to plain filters.

    make bench-video                     # about three minutes
    make bench-video ARGUMENTS=--docs    # into docs/benchmarks/video.md

The takes, and which captures they were made from: `video_takes.py`. All steps run with their
default settings, one after another, as the buttons do.

- Angle error: mean angle between local rotations and the truth's, over all joints and frames.
- Jitter: mean third derivative of the joints' positions.
- Foot slide: mean speed of the slower of ankle and toes while the truth's foot stands.
- Floats, sinks: mean height of standing feet above, and below, that of the truth's.
- Root drift: mean horizontal distance of the hips from the truth's, without a constant offset.
"""

import argparse
import sys
from collections.abc import Callable, Mapping
from time import perf_counter

import numpy as np

from solvers.arrays import Array
from solvers.denoising import denoise, plant_feet
from solvers.motion import Motion, detect_contacts
from solvers.physics import simulate
from solvers.recordings import read_recording

from ..peers.smoothers import butterworth, gcv_spline
from ..shared.clips import DATA
from ..shared.noise import learn_channels
from ..shared.report import DOCS, Report
from ..shared.tables import Scores, number, table
from .video_measures import figures_of
from .video_takes import ALONE, PER_FRAME, TEMPORAL, Faults, recorded, truths

REAL = (
    "corpus/smpl/kimodo_soma_npz/01_single_text_prompt.npz",
    "corpus/smpl/kimodo_soma_npz/05_root_path.npz",
    "corpus/bvh/smpl_momask/momask_out.bvh",
    "corpus/bvh/smpl_template/template.bvh",
)
OURS = "Clean, Plant Feet"
COMPLETE = {
    "A model that sees one frame at a time": PER_FRAME,
    "A model that sees the whole video": TEMPORAL,
}


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--docs", action="store_true", help="rewrite docs/benchmarks/video.md")
    parser.add_argument("--clips", type=int, default=None, help="at most this many clips")
    chosen = parser.parse_args()
    started = perf_counter()
    captures = dict(list(truths().items())[: chosen.clips])
    tables: list[Scores | str] = [
        compare(title, captures, faults) for title, faults in COMPLETE.items()
    ]
    tables.append(compare_faults(dict(list(captures.items())[:: len(captures) // 6 or 1])))
    tables.append(compare_real())
    texts = [each.markdown() if isinstance(each, Scores) else each for each in tables]
    report = Report(chosen.docs, DOCS / "benchmarks" / "video.md")
    report.part("video", texts, perf_counter() - started)


def compare(title: str, captures: Mapping[str, Motion], faults: Faults) -> Scores:
    """Return the figures of all steps on all takes with these faults."""
    scores = Scores(f"{title}, {len(captures)} takes", "units in the header", OURS)
    for name, truth in captures.items():
        contacts = detect_contacts(truth)
        taken = recorded(name, truth, faults)
        results = {"the capture itself": truth, **solved(taken, with_peers=True)}
        for method, result in results.items():
            for column, figure in figures_of(result, contacts, truth).items():
                scores.add(method, column, name, figure)
        print(f"Done: {title}, {name}", file=sys.stderr, flush=True)
    return scores


def compare_faults(captures: Mapping[str, Motion]) -> str:
    """Return a table of each fault alone, before and after each step."""
    rows: dict[str, list[str]] = {}
    for fault, faults in ALONE.items():
        scores = Scores(fault, "")
        for name, truth in captures.items():
            contacts = detect_contacts(truth)
            for method, result in solved(recorded(name, truth, faults)).items():
                for column, figure in figures_of(result, contacts, truth).items():
                    scores.add(method, column, name, figure)
        for method in scores.methods:
            cells = [number(scores.mean(method, column)) for column in scores.columns]
            rows[f"{fault}: {method}"] = cells
        columns = scores.columns
        print(f"Done: {fault}", file=sys.stderr, flush=True)
    return (
        f"**Each fault alone, {len(captures)} takes, means**\n\n{table(['', *columns], rows)}\n"
    )


def compare_real() -> str:
    """Return a table of real exports, whose truth is unknown."""
    rows: dict[str, list[str]] = {}
    for file in REAL:
        taken = read_recording(DATA / file)
        assert isinstance(taken, Motion)
        contacts = detect_contacts(taken)
        for method, result in solved(taken).items():
            figures = figures_of(result, contacts, None)
            moved = mean_distance(taken, result)
            rows[f"{file.split('/')[-1]}: {method}"] = [
                *map(number, figures.values()), number(moved)
            ]  # fmt: skip
    header = ["", *figures, "moved, cm"]
    return f"**Real exports, without truth**\n\n{table(header, rows)}\n"


def mean_distance(a: Motion, b: Motion) -> float:
    """Return how far the hips moved, centimeters."""
    return 100.0 * float(np.linalg.norm(a.root_positions - b.root_positions, axis=-1).mean())


def solved(taken: Motion, with_peers: bool = False) -> dict[str, Motion]:
    """Return the take as it came and after each step."""
    results = {"as imported": taken}
    for name, smooth in PEERS.items() if with_peers else ():
        results[name] = filtered(taken, smooth)
    clean = denoise(taken).recording
    assert isinstance(clean, Motion)
    planted = plant_feet(clean).motion
    simulated = simulate(planted).motion
    return {
        **results, "Clean without Plant Feet": clean, OURS: planted,
        "Clean, Plant Feet, Physics": simulated,
    }  # fmt: skip


PEERS: dict[str, Callable[[Array, float], Array]] = {
    "GCV spline": gcv_spline,
    "Butterworth, 6 Hz": butterworth,
}


def filtered(motion: Motion, smooth: Callable[[Array, float], Array]) -> Motion:
    """Return the motion with each of its channels filtered."""
    channels = learn_channels([motion])
    values = smooth(channels.values(motion), motion.frame_rate)
    path = smooth(motion.root_positions, motion.frame_rate)
    return channels.motion(values, motion).with_poses(root_positions=path)


if __name__ == "__main__":
    main()
