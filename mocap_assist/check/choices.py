"""What an animator chooses for Check."""

from typing import NamedTuple

from ...solvers.denoising import IssueSettings, QualitySettings


class CheckSettings(NamedTuple):
    """All that the button offers."""

    quality: QualitySettings
    spots: IssueSettings
