"""Solve of the button Check: measure a take and list its worst issues."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...solvers.denoising import (
    Issue,
    IssueSettings,
    Quality,
    QualitySettings,
    find_worst_issues,
    measure_quality,
)
from ...solvers.motion import (
    JointLimits,
    Motion,
    Tracks,
    describe_low_confidence,
    explain_roles,
    find_humanoid_map,
)
from ...solvers.progress import Progress, unwatched, within


@dataclass(frozen=True, eq=False)
class Checked:
    """Quality figures of a take, and its issues."""

    quality: Quality
    issues: tuple[Issue, ...]
    low_confidence: str = ""
    """A sentence about joints whose role has low confidence: feet may be other joints then."""


def check(
    body: Motion | Tracks,
    settings: QualitySettings,
    issues: IssueSettings,
    *,
    contacts: NDArray[np.bool_] | None,
    limits: JointLimits | None,
    progress: Progress = unwatched,
) -> Checked:
    """Measure a body or its markers and list the worst issues."""
    quality = measure_quality(
        body,
        settings=settings,
        contacts=contacts,
        limits=limits,
        progress=within(progress, 0.0, 0.9),
    )
    worst = find_worst_issues(
        body, quality, settings=issues, progress=within(progress, 0.9, 1.0)
    )
    return Checked(quality, worst, _low_confidence(body))


def _low_confidence(body: Motion | Tracks) -> str:
    if isinstance(body, Tracks):
        return ""
    humanoid = find_humanoid_map(body.skeleton)
    return describe_low_confidence(humanoid, explain_roles(body.skeleton, humanoid))
