"""What an animator chooses for Check."""

from typing import NamedTuple

from ...solvers.denoising import QualitySettings, SpotSettings


class CheckSettings(NamedTuple):
    """All that the button offers."""

    quality: QualitySettings
    spots: SpotSettings
