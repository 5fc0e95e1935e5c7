"""Variants of a few motions of one behaviour.

>>> from solvers.samples import GaitSettings, walking_gait
>>> from solvers.variation import learn_variation_model, synthesize
>>> walks = [walking_gait(GaitSettings(duration=1.0, seed=seed)) for seed in (1, 2, 3)]
>>> model = learn_variation_model(walks)
>>> len(synthesize(model, 5))
5
"""

from .measure_variation import measure_variation
from .partitions import Partition
from .synthesize import VarySettings, synthesize
from .variation_model import VariationModel, learn_variation_model, load_variation_model

__all__ = [
    "Partition",
    "VariationModel",
    "VarySettings",
    "learn_variation_model",
    "load_variation_model",
    "measure_variation",
    "synthesize",
]
