"""How well reliability indicates wrong joints: areas under curves, calibration, device's flags.

    make bench-reliability                     # some minutes
    make bench-reliability ARGUMENTS=--docs    # into docs/technical/reliability.md
    make bench-reliability ARGUMENTS=--fit     # only print the models of errors of all subjects

Areas are computed for each subject of UI-PRMD and averaged. "Left out" are models fitted
without that subject; what ships was fitted to all five. Wrong is what is that far off after
the median offset of each joint and take is taken out. Ten takes, m03_s01, are left out: their
markers are of a repetition with the other leg.
"""

import argparse
from collections.abc import Callable
from itertools import pairwise
from time import perf_counter

import numpy as np

from solvers.motion import JointRecording
from solvers.motion.skeletons.joint_recording import TRACKED
from solvers.reconstruction import ReliabilitySettings, measure_reliability
from solvers.recordings import read_recording

from ..shared.clips import DATA
from ..shared.report import DOCS, PICTURES, Report
from ..shared.tables import table
from .part_reliability import (
    LIMITS,
    Pair,
    area_under_curve,
    areas_by_subject,
    error_scores,
    error_scores_by_subject,
    fit_model,
    read_pairs,
    signs_of,
)
from .plot_reliability import TAKE, draw_take

KINECT = DATA / "kinect"
FLAGGED = ("irds", "kimore", "laban", "msr_action3d", "azure")
BINS = (0.0, 0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0)
EYES_CLOSED = ReliabilitySettings(inferred=1.0)
"""Without the tracking state, since that is to be predicted."""


def main() -> None:
    """Print three tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument(
        "--docs", action="store_true", help="rewrite docs/technical/reliability.md"
    )
    parser.add_argument("--fit", action="store_true", help="print fitted models, no tables")
    chosen = parser.parse_args()
    if chosen.fit:
        print_models(read_pairs(KINECT / "ui_prmd"))
        return
    report_reliability(chosen.docs)


def report_reliability(docs: bool) -> None:
    """Print the tables; into docs/technical/reliability.md, with its picture, if so."""
    started = perf_counter()
    pairs = read_pairs(KINECT / "ui_prmd")
    tables = [areas(pairs), calibration(pairs), flags()]
    report = Report(docs, DOCS / "technical" / "reliability.md")
    report.part("reliability", tables, perf_counter() - started)
    if docs:
        take = next(pair for pair in pairs if pair.name == TAKE)
        draw_take(take, PICTURES / "results" / "reliability.png")


def print_models(pairs: list[Pair]) -> None:
    """Print what reliability_error.py should say."""
    for causal in (False, True):
        signs = [signs_of(pair.recording, causal) for pair in pairs]
        print("CAUSAL" if causal else "CENTERED", fit_model(signs, [p.error for p in pairs]))


def areas(pairs: list[Pair]) -> str:
    """Return areas under the curve, for both modes and limits."""
    rows: dict[str, list[str]] = {}
    for causal in (False, True):
        signs = [signs_of(pair.recording, causal) for pair in pairs]
        measures = dict(error_scores(pairs, causal))
        measures["path: distance from the smoothed path"] = [each.deviation for each in signs]
        measures["lengths: maximum error"] = [each.length_error for each in signs]
        for name, error_probability in measures.items():
            _put_areas(
                rows,
                name,
                [areas_by_subject(pairs, error_probability, limit) for limit in LIMITS],
            )
        left_out = [
            areas_by_subject(pairs, error_scores_by_subject(pairs, signs, limit), limit)
            for limit in LIMITS
        ]
        _put_areas(rows, "default, subject left out", left_out)
    error = np.concatenate([pair.error.ravel() for pair in pairs])
    fractions = " and ".join(f"{np.nanmean(error > limit):.1%}" for limit in LIMITS)
    columns = [f"{when}, > {100 * limit:.0f} cm" for when in WHEN for limit in LIMITS]
    head = (
        f"**Area under the ROC curve** of detecting joint errors above 5 and 10 cm ({fractions}"
        f" of all), {len(pairs)} takes of UI-PRMD; mean over subjects (worst subject)\n\n"
    )
    return head + table(["measure", *columns], rows) + "\n"


WHEN = ("both sides", "past only")


def _put_areas(rows: dict[str, list[str]], name: str, found: list[list[float]]) -> None:
    cells = [f"{np.mean(each):.3f} ({np.min(each):.3f})" for each in found]
    rows.setdefault(name, []).extend(cells)


def calibration(pairs: list[Pair]) -> str:
    """Return what was said of joints, and how many of them were wrong."""
    signs = [signs_of(pair.recording, causal=False) for pair in pairs]
    error = np.concatenate([pair.error.ravel() for pair in pairs])
    rows: dict[str, list[str]] = {}
    for limit in LIMITS:
        left_out = error_scores_by_subject(pairs, signs, limit)
        error_probability = np.concatenate([each.ravel() for each in left_out])[
            np.isfinite(error)
        ]
        wrong = error[np.isfinite(error)] > limit
        for low, high in pairwise(BINS):
            here = (error_probability >= low) & (error_probability < high)
            cells = [
                f"{here.mean():.2%}",
                f"{error_probability[here].mean():.3f}",
                f"{wrong[here].mean():.3f}",
            ]
            rows.setdefault(f"{low:g} to {high:g}", []).extend(cells)
    columns = [f"{words}, {100 * limit:.0f} cm" for limit in LIMITS for words in WORDS]
    return (
        "**Calibration** of the default, subject left out: predicted probability of an error,"
        " and fraction of joints with one\n\n" + table(["probability", *columns], rows) + "\n"
    )


WORDS = ("fraction", "predicted", "actual")


def flags() -> str:
    """Return the agreement of measures with the device's own state, by data set."""
    rows: dict[str, list[str]] = {}
    for name in FLAGGED:
        files = sorted(path for path in (KINECT / name).iterdir() if path.is_file())
        takes = [take for take in map(read_recording, files) if _has_flags(take)]
        if takes:
            rows[f"{name}, {len(takes)} takes"] = _agreement(takes)
    names = ["inferred", *MEASURES]
    return (
        "**The device's own flag**: fraction of observed joints with the state inferred"
        " (msr_action3d: confidence below 1), and area under the ROC curve of predicting it\n\n"
        + table(["data", *names], rows)
        + "\n"
    )


MEASURES: dict[str, Callable[..., np.ndarray]] = {
    "behavior term": lambda found: found.behavior,
    "kinematics term": lambda found: found.kinematics,
    "default": lambda found: found.combined,
}


def _agreement(takes: list[JointRecording]) -> list[str]:
    found = [measure_reliability(take, settings=EYES_CLOSED) for take in takes]
    visible = [take.tracks.visible for take in takes]
    inferred = np.concatenate([
        _low_confidence(take)[is_visible]
        for take, is_visible in zip(takes, visible, strict=True)
    ])
    cells = [f"{inferred.mean():.1%}"]
    for measure in MEASURES.values():
        error_probability = [
            1.0 - measure(each)[is_visible]
            for each, is_visible in zip(found, visible, strict=True)
        ]
        cells.append(f"{area_under_curve(np.concatenate(error_probability), inferred):.3f}")
    return cells


def _has_flags(take: object) -> bool:
    return isinstance(take, JointRecording) and _low_confidence(take).any()


def _low_confidence(take: JointRecording) -> np.ndarray:
    """Return which joints have low confidence by the device: by its state or its confidence."""
    if take.tracking_state is not None:
        return take.tracking_state < TRACKED
    if take.tracks.confidence is not None:
        return take.tracks.confidence < 1.0
    return np.zeros(take.tracks.positions.shape[:2], bool)


if __name__ == "__main__":
    main()
