"""Is confidence true? Of the joints reported as ".9", nine in ten should be near the truth."""

from collections import defaultdict
from collections.abc import Iterable, Mapping
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from solvers.arrays import Array
from solvers.motion import Motion
from solvers.pictures import SERIES, Canvas
from solvers.pictures.canvas import FAINT, GRID, INK

from ..shared.noise import angle_error
from ..shared.tables import table
from .conditions import CONDITIONS, Case

NEAR_DEG = 5.0
"""A joint nearer to the truth than this counts as right."""
N_BINS = 10
HIGH_CONFIDENCE = 0.9
"""The confidence from which on nine in ten are promised to be right."""
KINDS = GOOD, OUTLIERS, MISSING = "good", "outliers", "missing"
"""Samples that only noise touched, that are wrong, and that are not there."""
MIN_SHARE = 1e-4
"""Bins with a smaller fraction of the samples are not drawn: chance rules them."""
SIZE, LEFT, TOP, BOTTOM, RIGHT = 420.0, 70.0, 50.0, 60.0, 190.0


class Bins:
    """Samples by the confidence that was reported: how many, and how many are right."""

    def __init__(self) -> None:
        self._n, self._reported, self._right = (np.zeros(N_BINS) for _ in range(3))

    def add(self, confidence: Array, error: Array) -> None:
        """Add samples; confidence from 0 to 1, error in degrees, both of one shape."""
        bins = np.minimum((confidence.ravel() * N_BINS).astype(int), N_BINS - 1)
        right = error.ravel() <= NEAR_DEG
        self._n += np.bincount(bins, minlength=N_BINS)
        self._reported += np.bincount(bins, confidence.ravel(), N_BINS)
        self._right += np.bincount(bins, right, N_BINS)

    def joined(self, others: Iterable["Bins"]) -> "Bins":
        """Return the samples of these bins and of others."""
        joined = Bins()
        for one in (self, *others):
            joined._n, joined._reported = joined._n + one._n, joined._reported + one._reported
            joined._right = joined._right + one._right
        return joined

    @property
    def fraction(self) -> Array:
        """Fraction of all samples in each bin."""
        return np.asarray(self._n / max(self._n.sum(), 1.0))

    @property
    def reported(self) -> Array:
        """Mean confidence in each bin; NaN where it is empty."""
        return np.divide(self._reported, self._n, np.full(N_BINS, np.nan), where=self._n > 0)

    @property
    def right(self) -> Array:
        """Fraction of the samples of each bin that are right; NaN where it is empty."""
        return np.divide(self._right, self._n, np.full(N_BINS, np.nan), where=self._n > 0)

    @property
    def expected_error(self) -> float:
        """Mean difference of confidence and fraction right, over samples (Guo et al. 2017)."""
        return float(np.nansum(self.fraction * np.abs(self.reported - self.right)))

    @property
    def high_confidence(self) -> tuple[float, float]:
        """Fraction of samples at HIGH_CONFIDENCE or more, and of these the fraction right."""
        last = round(HIGH_CONFIDENCE * N_BINS)
        n = self._n[last:].sum()
        right = self._right[last:].sum() / n if n else np.nan
        return float(self.fraction[last:].sum()), float(right)


class Calibration:
    """Confidence and errors of one method in all conditions."""

    def __init__(self) -> None:
        self._bins: dict[str, dict[str, Bins]] = defaultdict(lambda: defaultdict(Bins))

    def add(self, case: Case, cleaned: Motion, confidence: Array) -> None:
        """Add the moving joints of a take; confidence has the shape (n_frames, n_joints)."""
        joints = np.flatnonzero(case.channels.joints)
        error = angle_error(cleaned, case.truth, joints)
        missing = np.isnan(case.recording.rotations[:, joints]).any(axis=-1)
        bins = self._bins[str(case.condition)]
        good = case.is_good[:, joints]
        for name, where in zip(KINDS, (good, ~good & ~missing, missing), strict=True):
            bins[name].add(confidence[:, joints][where], error[where])

    def kind(self, name: str) -> Bins:
        """Return the samples of one of KINDS of all conditions."""
        return Bins().joined(bins[name] for bins in self._bins.values())

    def tables(self) -> list[str]:
        """Return what was reported and what was right, by bin and by condition."""
        kinds = [self.kind(name) for name in KINDS]
        everything = Bins().joined(kinds)
        lower = np.arange(N_BINS) / N_BINS
        rows = {
            f"{low:.1f} to {low + 1 / N_BINS:.1f}": [
                f"{100 * everything.fraction[index]:.2f}",
                _percent(everything.reported[index]),
                *(_percent(each.right[index]) for each in (everything, *kinds)),
            ]
            for index, low in enumerate(lower)
        }
        rows["expected calibration error"] = [
            "-", "-", *(_percent(each.expected_error) for each in (everything, *kinds))
        ]  # fmt: skip
        header = ["confidence", "fraction of samples", "mean confidence", "right, all", *KINDS]
        title = f"**Confidence: joints within {NEAR_DEG:g} degrees of the truth, %**"
        return [f"{title}\n\n{table(header, rows)}\n", self._by_condition()]

    def _by_condition(self) -> str:
        found = [Bins().joined(self._bins[str(one)].values()) for one in CONDITIONS]
        rows = {
            f"reported {HIGH_CONFIDENCE:g} or more": [
                _percent(bins.high_confidence[0]) for bins in found
            ],
            f"of these within {NEAR_DEG:g} degrees": [
                _percent(bins.high_confidence[1]) for bins in found
            ],
            "expected calibration error": [_percent(bins.expected_error) for bins in found],
        }
        header = ["", *map(str, CONDITIONS)]
        return f"**Confidence by condition, %**\n\n{table(header, rows)}\n"

    def draw(self, path: Path) -> None:
        """Write the calibration curve to a PNG file."""
        draw_curve({name: self.kind(name) for name in KINDS}, path)


def draw_curve(kinds: Mapping[str, Bins], path: Path) -> None:
    """Write reported confidence against the fraction right; a true one lies on the diagonal."""
    canvas = Canvas(LEFT + SIZE + RIGHT, TOP + SIZE + BOTTOM)
    canvas.text(LEFT, 20.0, f"Joints within {NEAR_DEG:g} degrees of the truth, %")
    for mark in np.linspace(0.0, 1.0, 6):
        canvas.line([_pixel(0.0, mark), _pixel(1.0, mark)], GRID)
        canvas.text(LEFT - 8.0, _pixel(0.0, mark)[1], f"{100 * mark:.0f}", INK, "rm")
        canvas.text(_pixel(mark, 0.0)[0], TOP + SIZE + 16.0, f"{mark:.1f}", INK, "mm")
    canvas.text(LEFT + SIZE / 2.0, TOP + SIZE + 42.0, "confidence reported", INK, "mm")
    canvas.line([_pixel(0.0, 0.0), _pixel(1.0, 1.0)], FAINT)
    for row, ((name, bins), color) in enumerate(zip(kinds.items(), SERIES, strict=False)):
        drawn = _drawn(bins)
        points = [
            _pixel(*each) for each in zip(bins.reported[drawn], bins.right[drawn], strict=True)
        ]
        if points:
            canvas.line(points, color, 2.0)
        for point, fraction in zip(points, bins.fraction[drawn], strict=True):
            canvas.dot(point, color, 3.0 + 9.0 * float(np.sqrt(fraction)))
        y = TOP + 22.0 * row
        canvas.line([(LEFT + SIZE + 24.0, y), (LEFT + SIZE + 48.0, y)], color, 3.0)
        canvas.text(LEFT + SIZE + 56.0, y, name)
    path.parent.mkdir(parents=True, exist_ok=True)
    canvas.picture().save(path)


def _drawn(bins: Bins) -> NDArray[np.bool_]:
    return np.asarray(bins.fraction > MIN_SHARE)


def _pixel(reported: float, right: float) -> tuple[float, float]:
    return LEFT + SIZE * reported, TOP + SIZE * (1.0 - right)


def _percent(fraction: float) -> str:
    return f"{100 * fraction:.1f}" if np.isfinite(fraction) else "-"
