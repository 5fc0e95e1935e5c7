"""Measure a take in the few figures that an animator reads at a glance."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from ...arrays import Flags
from ...denoising import Issue, IssueSettings, Quality, find_worst_issues, measure_quality
from ...motion import JointLimits, Motion, Tracks
from ...progress import Progress, unwatched, within
from ...signals import find_runs

MAX_ISSUES = IssueSettings().max_issues
"""Number of issues at which Check stops to list them, by definition."""
UNKNOWN = "–"
"""Text of a figure that is not known."""


@dataclass(frozen=True, eq=False)
class TakeFigures:
    """Quality of a take, and what Check lists of it.

    Attributes
    ----------
    quality : Quality
    issues : tuple of Issue
        Worst first, as many as Check lists by default.
    """

    quality: Quality
    issues: tuple[Issue, ...]

    @property
    def n_spikes(self) -> int:
        """Number of spikes of all joints."""
        return _count(self.quality.spikes)

    @property
    def n_gaps(self) -> int:
        """Number of gaps of all joints."""
        return _count(self.quality.gaps)

    def figures(self) -> dict[str, Any]:
        """Return the figures as JSON-ready values with units in the names; None is unknown."""
        return {
            "jitter_deg": _finite_or_none(np.degrees(self.quality.rotation_noise)),
            "longest_foot_slide_cm": _finite_or_none(100.0 * self.quality.longest_foot_slide),
            "spikes": self.n_spikes,
            "gaps": self.n_gaps,
            "issues": len(self.issues),
        }


def measure_take(
    recording: Motion | Tracks,
    *,
    contacts: Flags | None = None,
    limits: JointLimits | None = None,
    progress: Progress = unwatched,
) -> TakeFigures:
    """Measure a take and list its issues, as Check does with its defaults.

    Parameters
    ----------
    recording : Motion or Tracks; NaN = not observed
    contacts : bool, shape (n_frames, 2), left and right
        When each foot is in contact; detected if not given. Give the same contacts to compare
        a take before and after.
    limits : JointLimits
        Limits of the joints; joints beyond them are issues.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        The contacts do not fit the recording.
    SolveCancelled
        Raised by `progress`.
    """
    quality = measure_quality(
        recording, contacts=contacts, limits=limits, progress=within(progress, 0.0, 0.9)
    )
    issues = find_worst_issues(recording, quality, progress=within(progress, 0.9, 1.0))
    return TakeFigures(quality, issues)


def figure_texts(
    before: Mapping[str, Any], after: Mapping[str, Any]
) -> tuple[tuple[str, str, str], ...]:
    """Return label, value before and value after of the four figures of `figures`."""
    first, last = _texts(before), _texts(after)
    return tuple((label, first[label], last[label]) for label in first)


def _texts(figures: Mapping[str, Any]) -> dict[str, str]:
    spikes, gaps = figures.get("spikes"), figures.get("gaps")
    issues = figures.get("issues")
    faults = None if spikes is None or gaps is None else spikes + gaps
    return {
        "Jitter": _amount(figures.get("jitter_deg"), "{:.2f}°"),
        "Longest Slide": _amount(figures.get("longest_foot_slide_cm"), "{:.1f} cm"),
        "Spikes, Gaps": _amount(faults, "{}"),
        "Issues": _amount(issues, "{}+" if issues == MAX_ISSUES else "{}"),
    }


def _count(flags: Flags) -> int:
    return sum(len(find_runs(joint)) for joint in flags.T)


def _finite_or_none(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _amount(value: float | None, form: str) -> str:
    return UNKNOWN if value is None else form.format(value)
