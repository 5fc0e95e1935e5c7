"""Precision, recall and timing of detected contacts, pooled over takes."""

from dataclasses import dataclass, field

import numpy as np

from solvers.arrays import Flags
from solvers.motion.humanoid import SIDES
from solvers.signals import find_runs

from ..shared.tables import number

MAX_ONSET_ERROR_S = 0.2
"""Seconds: a contact that begins farther from a true one is not that one."""
COLUMNS = (
    *(f"{side} {figure}" for side in SIDES for figure in ("precision", "recall", "F1")),
    "onset error, frames", "ms", "late by, ms", "missed onsets %",
)  # fmt: skip


@dataclass(eq=False)
class DetectionScores:
    """Counts of frames by foot, and the errors of the frames at which contacts begin."""

    counts: np.ndarray = field(default_factory=lambda: np.zeros((2, 3)))
    """For each foot: true, detected, and both."""
    onset_errors: list[float] = field(default_factory=list)
    """Frames; positive is late."""
    onset_times: list[float] = field(default_factory=list)
    """The same, seconds."""
    n_onsets: int = 0

    def add(
        self, detected: Flags, truth: Flags, frame_rate: float, known: Flags | None = None
    ) -> None:
        """Note a take: contacts (n_frames, 2), in the frames in which the truth is known."""
        known = np.ones_like(truth) if known is None else known
        for foot in range(len(SIDES)):
            true, found = truth[:, foot] & known[:, foot], detected[:, foot] & known[:, foot]
            self.counts[foot] += true.sum(), found.sum(), (true & found).sum()
            self._add_onsets(detected[:, foot], truth[:, foot], known[:, foot], frame_rate)

    def _add_onsets(
        self, detected: Flags, truth: Flags, known: Flags, frame_rate: float
    ) -> None:
        found = np.array([start for start, _ in find_runs(detected) if start > 0])
        for start, _ in find_runs(truth):
            if start == 0 or not known[start - 1]:
                continue
            self.n_onsets += 1
            errors = found - start
            error = errors[np.abs(errors).argmin()] if len(errors) else np.inf
            if abs(error) <= MAX_ONSET_ERROR_S * frame_rate:
                self.onset_errors.append(float(error))
                self.onset_times.append(float(error / frame_rate))

    def precision(self, foot: int | None = None) -> float:
        """Return the fraction of detected frames that are true; of both feet without a foot."""
        _, found, both = self._counts(foot)
        return float(both / found) if found else float("nan")

    def recall(self, foot: int | None = None) -> float:
        """Return the fraction of true frames that are detected."""
        true, _, both = self._counts(foot)
        return float(both / true) if true else float("nan")

    def f1(self, foot: int | None = None) -> float:
        """Return the harmonic mean of precision and recall."""
        true, found, both = self._counts(foot)
        return float(2.0 * both / (true + found)) if true + found else float("nan")

    def row(self) -> list[str]:
        """Return the cells of `COLUMNS`."""
        feet = [
            figure(foot)
            for foot in range(len(SIDES))
            for figure in (self.precision, self.recall, self.f1)
        ]
        times = 1000.0 * np.array(self.onset_times)
        timing = [
            np.abs(self.onset_errors).mean(), np.abs(times).mean(), times.mean(),
        ] if self.onset_errors else [float("nan")] * 3  # fmt: skip
        missed = 1.0 - len(self.onset_errors) / self.n_onsets if self.n_onsets else float("nan")
        return [
            *(f"{figure:.3f}" if np.isfinite(figure) else "-" for figure in feet),
            *map(number, timing), f"{100.0 * missed:.1f}",
        ]  # fmt: skip

    def _counts(self, foot: int | None) -> np.ndarray:
        return self.counts.sum(axis=0) if foot is None else self.counts[foot]
