"""Capture of all actions of a real Kinect (UTD-MHAD), against the skeleton of its SDK.

    python -m tests.benchmarks.depth.bench_depth --only kinect [--docs]

That skeleton is a reference and no truth. Nothing is given to `capture` but the depth. Sheets
of pictures go to build/depth_kinect, for each subject; smaller ones of the first into docs.
"""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from PIL import Image

from solvers.depth_tracking.capturing.capture import Capture, capture

from ..shared.report import BENCHMARK_PICTURES, show
from ..shared.tables import Scores
from .depth_overlays import overlay, save_sheet, strip
from .depth_takes import ACTIONS, HANDS, OURS, STABLE, SUBJECTS, KinectTake, kinect_take

LOOKED_AT = 5
"""Frames of a take that are drawn."""
N_SHEETS = 3
BUILD = Path(__file__).resolve().parents[3] / "build" / "depth_kinect"
MAX_FOUND_ERROR_M = 0.1


def kinect(subjects: Sequence[int] = SUBJECTS) -> list[str]:
    """Capture each action of each subject; return the table."""
    which = ", ".join(map(str, subjects))
    scores = Scores("UTD-MHAD, a real Kinect", f"clips are the subjects {which}", "")
    everything = []
    for subject in subjects:
        rows = []
        for action, label in enumerate(ACTIONS, start=1):
            take = kinect_take(action, subject)
            if take is None:
                continue
            found = capture(take.depth)
            scores_ = figures(take, found)
            for column, figure in scores_.items():
                scores.add(f"{action} {label}", column, take.name, figure)
                everything.append((column, take.name, figure))
            rows.append(drawn(take, found))
            print(
                take.name, {key: round(value, 2) for key, value in scores_.items()}, flush=True
            )
        per_sheet = -(-len(rows) // N_SHEETS)
        for sheet in range(N_SHEETS):
            part = rows[sheet * per_sheet : (sheet + 1) * per_sheet]
            save_sheet(part, 1, 0.6, BUILD / f"s{subject}_{sheet}.jpg")
            if subject == subjects[0]:
                save_sheet(part, 3, 0.42, _picture(sheet))
    for column, name, figure in everything:
        scores.add("all", column, name, figure)
    text = scores.markdown()
    return [text, *_pictures()]


def _pictures() -> list[str]:
    return [show(_picture(sheet), "All actions of one subject") for sheet in range(N_SHEETS)]


def _picture(sheet: int) -> Path:
    return BENCHMARK_PICTURES / "depth" / f"kinect_{sheet}.jpg"


def figures(take: KinectTake, found: Capture) -> dict[str, float]:
    """Return what the table says of one take."""
    distances = take.distances(found.joints.positions)
    scores_ = distances[np.isfinite(distances).all(axis=1)]
    hands = [OURS[index] for index in HANDS]
    return {
        "cm, stable joints": 100.0 * float(scores_[:, STABLE].mean()),
        "% < 10 cm": 100.0 * float((scores_ < MAX_FOUND_ERROR_M)[:, STABLE].mean()),
        "cm, hands": 100.0 * float(scores_[:, HANDS].mean()),
        "% hands in air": 100.0 * take.hands_in_air(found.joints.positions[:, hands]),
        "% SDK's in air": 100.0 * take.hands_in_air(take.joints[:, HANDS]),
        "cm in depth": 100.0 * float(np.nanmean(found.residual)),
        "coverage": float(found.coverage.mean()),
        "restarts": float(len(found.restarts)),
        "flagged %": 100.0 * float(found.low_confidence.mean()),
    }


def drawn(take: KinectTake, found: Capture) -> Image.Image:
    """Draw some frames of a take in a row."""
    frames = np.linspace(0, take.depth.n_frames - 1, LOOKED_AT + 2)[1:-1].round().astype(int)
    panels = [overlay(take.depth, found, one, take.joints[one]) for one in frames.tolist()]
    return strip(panels, f"{take.action} {ACTIONS[take.action - 1]}")
