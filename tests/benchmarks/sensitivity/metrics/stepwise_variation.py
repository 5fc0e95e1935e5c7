"""Variants that are drawn frame by frame, of hops and of squats."""

from solvers.denoising import learn_joint_limits
from solvers.motion import JointLimits, Motion
from solvers.variation import VaryMethod, VarySettings, draw_variants, learn_variation_model

from ..takes import hdm05
from .variation import N_VARIANTS, variant_figures

SETTINGS = VarySettings(method=VaryMethod.COREGIONALISED, seed=5)


def prepare() -> dict[str, object]:
    """Take hops and squats of one actor."""
    sets = {
        "hop": [hdm05("hopBothLegs1hops", number) for number in (1, 2, 3)],
        "squat": [hdm05("squat1Reps", number) for number in (1, 2)],
    }
    limits = {name: learn_joint_limits(examples) for name, examples in sets.items()}
    return {"sets": sets, "limits": limits}


def measure(sets: dict[str, list[Motion]], limits: dict[str, JointLimits]) -> dict[str, float]:
    """Compare the variants with the examples, as `variation` does."""
    figures = {}
    for name, examples in sets.items():
        model = learn_variation_model(examples, settings=SETTINGS)
        variants = draw_variants(model, N_VARIANTS, settings=SETTINGS, planting=None)
        found = variant_figures([each.motion for each in variants], examples, limits[name])
        figures |= {f"{name}: {key}": what for key, what in found.items()}
    return figures
