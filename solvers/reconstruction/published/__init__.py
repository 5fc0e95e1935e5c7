"""Reconstruction as published: [SHJT13] for missing joints, [ZH14] for sensor errors.

Both are methods of `reconstruct` and baselines of `make bench-reconstruct`. They stay as the
papers print them; the default in the other folders improves on them.
"""

from .posture_reconstruction import reconstruct_published_postures
from .residual_reconstruction import ThreeTermSettings, reconstruct_published_residuals

__all__ = [
    "ThreeTermSettings",
    "reconstruct_published_postures",
    "reconstruct_published_residuals",
]
