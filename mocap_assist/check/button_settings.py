"""Settings of Check."""

from typing import NamedTuple

from ...solvers.denoising import IssueSettings, QualitySettings


class CheckBundle(NamedTuple):
    """Settings of the button."""

    quality: QualitySettings
    issues: IssueSettings
