"""What the button Check has solved for it."""

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
from ...solvers.motion import JointLimits, Motion, Tracks
from ...solvers.progress import Progress, unwatched, within


@dataclass(frozen=True, eq=False)
class Checked:
    """What is wrong with a take, in all and place by place."""

    quality: Quality
    spots: tuple[Issue, ...]


def check(
    body: Motion | Tracks,
    settings: QualitySettings,
    spots: IssueSettings,
    *,
    contacts: NDArray[np.bool_] | None,
    limits: JointLimits | None,
    progress: Progress = unwatched,
) -> Checked:
    """Measure a body or its markers and list the worst spots."""
    quality = measure_quality(
        body,
        settings=settings,
        contacts=contacts,
        limits=limits,
        progress=within(progress, 0.0, 0.9),
    )
    found = find_worst_issues(
        body, quality, settings=spots, progress=within(progress, 0.9, 1.0)
    )
    return Checked(quality, found)
