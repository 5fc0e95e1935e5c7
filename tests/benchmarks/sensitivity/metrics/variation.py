"""Variants: how near each is to examples that were kept aside, how far, how smooth."""

import numpy as np

from solvers.denoising import learn_joint_limits, limit_excess
from solvers.motion import JointLimits, Motion, detect_contacts
from solvers.variation import (
    VarySettings,
    borrow_variation,
    draw_variants,
    learn_variation_model,
    measure_variation,
)
from solvers.variation.loops import repeat_loop

from ...variation.variation_measures import angular_velocities
from ..takes import hdm05, walk

N_VARIANTS = 4


def prepare() -> dict[str, object]:
    """Take squats and kicks of one actor, and cycles of a walk."""
    sets = {
        "squat": [hdm05("squat1Reps", number) for number in (1, 2, 3, 4)],
        "kick": [hdm05("kickLFront1Reps", number) for number in (1, 3, 5)],
        "sneak": [hdm05("sneak2StepsLStart", number) for number in (1, 2, 3)],
    }
    limits = {name: learn_joint_limits(examples) for name, examples in sets.items()}
    cycle = walk("07_03").slice(12, 12 + 34)
    return {"sets": sets, "limits": limits, "cycle": cycle}


def measure(
    sets: dict[str, list[Motion]], limits: dict[str, JointLimits], cycle: Motion
) -> dict[str, float]:
    """Compare variation, jerk, contacts and lengths with the examples; excess beyond limits."""
    figures = {}
    for name, examples in sets.items():
        model = learn_variation_model(examples)
        variants = draw_variants(
            model, N_VARIANTS, settings=VarySettings(seed=5), planting=None
        )
        found = variant_figures([each.motion for each in variants], examples, limits[name])
        figures |= {f"{name}: {key}": what for key, what in found.items()}
    borrowed = draw_variants(borrow_variation(sets["kick"][0]), N_VARIANTS, planting=None)
    found = variant_figures([each.motion for each in borrowed], sets["kick"], limits["kick"])
    figures |= {f"borrowed: {key}": what for key, what in found.items()}
    model = learn_variation_model([cycle])
    loop = draw_variants(model, 1, planting=None)[0].motion
    figures["loop: seam"] = 0.01 + _seam(repeat_loop(loop, 2), loop.n_frames)
    return figures


def variant_figures(
    variants: list[Motion], examples: list[Motion], limits: JointLimits
) -> dict[str, float]:
    """Return how far ratios of variants to examples are from 1, and degrees beyond limits."""
    excess = [float(np.degrees(limit_excess(each, limits)).mean()) for each in variants]
    spreads = [1.0 + np.std([each.n_frames for each in one]) for one in (variants, examples)]
    return {
        "variation": _off(measure_variation(variants), measure_variation(examples)),
        "jerk": _off(_jerk(variants), _jerk(examples)),
        "in contact": _off(_in_contact(variants), _in_contact(examples)),
        "spread of lengths": _off(*spreads),
        "beyond limits deg": 0.05 + float(np.mean(excess)),
    }


def _off(one: float, other: float) -> float:
    """Return the distance of a ratio from 1 in both directions; a tenth is added to all."""
    return 0.1 + abs(float(np.log(one / other)))


def _jerk(motions: list[Motion]) -> float:
    return float(
        np.mean([
            np.abs(np.diff(angular_velocities(each), n=2, axis=0)).mean() for each in motions
        ])
    )


def _in_contact(motions: list[Motion]) -> float:
    return 0.01 + float(np.mean([detect_contacts(each).mean() for each in motions]))


def _seam(twice: Motion, n_frames: int) -> float:
    """Largest step of the velocity at the seam, relative to that elsewhere."""
    steps = np.abs(np.diff(angular_velocities(twice), axis=0)).mean(axis=(1, 2))
    return float(steps[n_frames - 3 : n_frames + 1].max() / np.median(steps))
