r"""Clean as it is pressed first, without examples, next to the filters an animator has.

    make bench-first-press                      # the scored takes: some minutes
    make bench-first-press ARGUMENTS=--quick    # six development takes at 30 Hz: a minute
    make bench-first-press ARGUMENTS=--development   # all development takes
    make bench-first-press ARGUMENTS=--detections    # only what is found before the estimate
    make bench-first-press ARGUMENTS="--docs --pictures"   # also writes the document

Which takes are for development is fixed in takes.py, what is corrupted in conditions.py, what
is measured in measures.py. `--only ours` leaves out the peers.
"""

import argparse
from collections import defaultdict
from collections.abc import Iterable, Sequence
from time import perf_counter

import numpy as np

from solvers.arrays import Flags
from solvers.denoising import Quality, measure_quality

from ..shared.report import BENCHMARK_PICTURES, DOCS, Report, show
from ..shared.tables import number, table
from .calibration import Calibration
from .conditions import CONDITIONS, Case
from .detections import detections
from .draw_worst import draw_worst
from .filters import METHODS, OURS, PEERS, PUBLISHED
from .measures import Figures, measure
from .takes import DEVELOPMENT, QUICK, SCORED, UNPACKED, Take

DOCUMENT = DOCS / "benchmarks" / "first_press.md"
MUCH_BETTER = 0.9
"""A peer with less than this fraction of our error is a tenth better."""
MIN_DIFFERENCE = 0.02
"""Degrees: less between ours and a peer is no difference."""
TITLES = {
    "angle": "Angle error, degrees, mean over takes",
    "position": "Distance of hands and feet from the truth, cm, mean over takes",
    "speed_kept": "Peak speed of hands and feet, relative to the truth's, mean over takes",
    "excursion_loss": "Worst reach lost at a turning point, cm, of all takes",
}


class Scores:
    """Figures by method, condition and take."""

    def __init__(self) -> None:
        self.figures: dict[str, dict[str, dict[str, Figures]]] = defaultdict(
            lambda: defaultdict(dict)
        )
        self.flagged: dict[str, list[float]] = defaultdict(list)
        self.listed: dict[str, list[float]] = defaultdict(list)
        self.errors_listed: dict[str, list[int]] = defaultdict(list)
        self.errors: dict[str, int] = defaultdict(int)
        self.seconds: dict[str, float] = defaultdict(float)
        self.calibration = Calibration()

    def add_check(self, condition: str, quality: Quality, is_good: Flags) -> None:
        """Count the spikes that Check lists among good samples and among errors."""
        self.listed[condition].append(float(quality.spikes[is_good].mean()))
        self.errors_listed[condition].append(int(quality.spikes[~is_good].sum()))
        self.errors[condition] += int(np.count_nonzero(~is_good))

    def tables(self) -> list[str]:
        """Return a table for each figure, and one of what is only asked of ours."""
        texts = []
        for column, title in TITLES.items():
            statistic = np.max if column == "excursion_loss" else np.mean
            rows = {
                method: [
                    number(float(statistic([getattr(each, column) for each in takes.values()])))
                    for takes in conditions.values()
                ]
                for method, conditions in self.figures.items()
            }
            texts.append(f"**{title}**\n\n{self._table(rows)}\n")
        texts += [f"**Only ours**\n\n{self._table(self._own_rows())}\n", self._worst()]
        return [*texts, *self.calibration.tables()]

    def _table(self, rows: dict[str, list[str]]) -> str:
        return table(["", *map(str, CONDITIONS)], rows)

    def _own_rows(self) -> dict[str, list[str]]:
        worse = [len(self._worse(str(one))) for one in CONDITIONS]
        n_takes = len(self.figures[OURS][str(CONDITIONS[0])])
        return {
            "takes where a peer is a tenth better, %": [
                f"{100 * count / n_takes:.0f}" for count in worse
            ],
            "good samples flagged, %": [
                f"{100 * np.mean(self.flagged[str(one)]):.2f}" for one in CONDITIONS
            ],
            "good samples that Check lists as spikes, %": [
                f"{100 * np.mean(self.listed[str(one)]):.2f}" for one in CONDITIONS
            ],
            "errors that Check lists, %": [
                f"{100 * sum(self.errors_listed[str(one)]) / self.errors[str(one)]:.0f}"
                if one.outliers or one.bursts
                else "-"
                for one in CONDITIONS
            ],
            "seconds": [f"{self.seconds[str(one)]:.1f}" for one in CONDITIONS],
        }

    def _worse(self, condition: str) -> dict[str, tuple[float, str]]:
        """Return the error relative to the best peer, and its name, where it is much better."""
        found = {}
        for take, ours in self.figures[OURS][condition].items():
            peer = self.best_peer(condition, take)
            if peer is None:
                continue
            angle = self.figures[peer][condition][take].angle
            if angle < min(MUCH_BETTER * ours.angle, ours.angle - MIN_DIFFERENCE):
                found[take] = (ours.angle / angle, peer)
        return found

    def best_peer(self, condition: str, take: str) -> str | None:
        """Return the peer with the least angle error, or None where none was run."""
        is_clean = any(str(one) == condition and one.is_clean for one in CONDITIONS)
        unfair = "interpolation" if is_clean else ""  # it returns its input
        angles = {
            name: self.figures[name][condition][take].angle
            for name in PEERS
            if name in self.figures and name != unfair
        }
        return min(angles, key=angles.__getitem__, default=None)

    def _worst(self) -> str:
        rows = {}
        for one in map(str, CONDITIONS):
            worse = sorted(self._worse(one).items(), key=lambda each: -each[1][0])[:3]
            ours = self.figures[OURS][one].items()
            lost = sorted(ours, key=lambda each: -each[1].excursion_loss)[:3]
            rows[one] = [
                "; ".join(f"{take} x{ratio:.2f} of {peer}" for take, (ratio, peer) in worse),
                "; ".join(
                    f"{take} {each.worst.label} {each.excursion_loss:.1f}"
                    for take, each in lost
                    if each.worst
                ),
            ]
        header = ["", "a peer is nearer to the truth", "reach lost, cm"]
        return f"**Our worst takes**\n\n{table(header, rows)}\n"


def main() -> None:
    """Print the tables, and perhaps write them down."""
    chosen = _arguments()
    takes = SCORED
    if chosen.quick or chosen.development:
        takes = QUICK if chosen.quick else DEVELOPMENT
    methods = [
        name
        for name in METHODS
        if not (chosen.quick and name == PUBLISHED) and (not chosen.only or name in chosen.only)
    ]
    report = Report(chosen.docs, DOCUMENT)
    started = perf_counter()
    if not chosen.quick:
        found = detections()
        report.part("detections", [found], perf_counter() - started)
    if chosen.detections:
        return
    started = perf_counter()
    scores = run(takes, methods)
    drawn = _draw(scores, takes) if chosen.pictures else []
    seconds = perf_counter() - started
    report.part("first press", [*scores.tables(), *drawn], seconds)
    print(f"{seconds:.0f} s")


def run(takes: Sequence[Take], methods: Iterable[str]) -> Scores:
    """Run the methods on all takes in all conditions."""
    scores, methods = Scores(), tuple(methods)
    for condition in CONDITIONS:
        for take in takes:
            case = Case(take, condition)
            for name in methods:
                started = perf_counter()
                result = METHODS[name](case)
                if name == OURS:
                    scores.seconds[str(condition)] += perf_counter() - started
                    assert result.flagged is not None and result.confidence is not None
                    scores.calibration.add(case, result.motion, result.confidence)
                    is_good = case.is_good
                    scores.flagged[str(condition)].append(float(result.flagged[is_good].mean()))
                    scores.add_check(str(condition), measure_quality(case.recording), is_good)
                figures = measure(case, result.motion)
                scores.figures[name][str(condition)][str(take)] = figures
    return scores


def _draw(scores: Scores, takes: Sequence[Take]) -> list[str]:
    """Draw the calibration and the worst takes; return the pictures as Markdown.

    Those of development takes are for the developer only.
    """
    folder = BENCHMARK_PICTURES / "first_press" if takes is SCORED else UNPACKED / "pictures"
    curve = folder / "calibration.png"
    paths = [curve, *draw_worst(scores, takes, folder)]
    scores.calibration.draw(curve)
    titles = (path.stem.replace("_", " ") for path in paths)
    return [
        f"{show(path, title.capitalize(), DOCUMENT)}\n"
        for title, path in zip(titles, paths, strict=True)
    ]


def _arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="six development takes")
    parser.add_argument("--development", action="store_true", help="development takes")
    parser.add_argument("--only", nargs="+", default=[], help="names of methods")
    parser.add_argument("--detections", action="store_true", help="only what is found first")
    parser.add_argument("--docs", action="store_true", help=f"rewrite {DOCUMENT.name}")
    parser.add_argument("--pictures", action="store_true", help="draw the worst takes")
    return parser.parse_args()


if __name__ == "__main__":
    main()
