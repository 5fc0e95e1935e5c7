"""Settings of Check: what is measured, and its thresholds."""

from typing import NamedTuple

from ...solvers.denoising import IssueSettings, QualitySettings


class CheckBundle(NamedTuple):
    """Settings of the button."""

    quality: QualitySettings
    issues: IssueSettings
