"""What an animator chooses for Check."""

from typing import NamedTuple

from ..solvers.denoising.quality import QualitySettings
from ..solvers.denoising.worst_spots import SpotSettings


class CheckSettings(NamedTuple):
    """All that the button offers."""

    quality: QualitySettings
    spots: SpotSettings
