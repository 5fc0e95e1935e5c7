"""Synthesize variants of a few motions of one behavior.

>>> from solvers.samples import GaitSettings, walking_gait
>>> from solvers.variation import learn_variation_model, synthesize
>>> walks = [walking_gait(GaitSettings(duration=1.0, seed=seed)) for seed in (1, 2, 3)]
>>> model = learn_variation_model(walks)
>>> len(synthesize(model, 5))
5
"""

from typing import TYPE_CHECKING

from ..import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .borrow_variation import borrow_variation
    from .curves import Partition
    from .learn_variation import learn_variation_model
    from .loops import resample_loop
    from .measure_variation import measure_variation
    from .synthesize import Variant, draw_variants, synthesize
    from .variation_model import VariationModel, load_variation_model
    from .vary_settings import VaryMethod, VarySettings

__all__ = [
    "Partition",
    "Variant",
    "VariationModel",
    "VaryMethod",
    "VarySettings",
    "borrow_variation",
    "draw_variants",
    "learn_variation_model",
    "load_variation_model",
    "measure_variation",
    "resample_loop",
    "synthesize",
]

import_on_demand(__name__)
