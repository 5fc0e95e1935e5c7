"""Synthesize new motions like the examples, different in pose and timing."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..errors import InvalidMotionError
from ..feet import PlantSettings
from ..motion import Motion
from ..progress import Progress, unwatched, within
from ..signals import smoothstep
from .contact_state import contacts_from_state
from .curves import LEG_ROWS, MotionCurves, clamp_softly, motion_from_curves, partition_joints
from .loops import close_loop, is_closed
from .mixtures import draw_mixing_weights, mix_deviations
from .plant_variant import plant_variant
from .time_warp import apply_time_warp
from .variation_model import VariationModel
from .vary_settings import DEFAULT_SETTINGS, VaryMethod, VarySettings

RANGE_MARGIN = 0.15
"""Fraction of a channel's range in the examples by which a variant may exceed it. Half and
twice are no better (`make sensitivity`)."""
PIN_S = 0.4
"""Seconds over which a variant leaves or reaches a pinned pose. By definition: the time that an
animator sees as a blend; no unpinned variant has it."""
MAX_BATCH_VALUES = 20_000_000
"""Maximum count of values in the curves of the variants that are drawn together. It bounds the
memory."""
PLANT_SETTINGS = PlantSettings()


class Variant(NamedTuple):
    """A new motion, and the contacts of its feet."""

    motion: Motion
    contacts: NDArray[np.bool_] | None
    """Left and right, shape (n_frames, 2), as in the mixed examples; None for rigs without feet
    and for the published method, which mixes no examples."""
    loops: bool = False
    """Whether the variant is cyclic, because the examples are."""


def synthesize(
    model: VariationModel,
    n_variants: int,
    *,
    settings: VarySettings = DEFAULT_SETTINGS,
    planting: PlantSettings | None = PLANT_SETTINGS,
    progress: Progress = unwatched,
) -> tuple[Motion, ...]:
    """Draw variants from a model of the examples, and plant their feet; see `draw_variants`."""
    drawn = draw_variants(
        model, n_variants, settings=settings, planting=planting, progress=progress
    )
    return tuple(variant.motion for variant in drawn)


def draw_variants(
    model: VariationModel,
    n_variants: int,
    *,
    settings: VarySettings = DEFAULT_SETTINGS,
    planting: PlantSettings | None = PLANT_SETTINGS,
    progress: Progress = unwatched,
) -> tuple[Variant, ...]:
    """Draw variants from a model of the examples, and plant their feet.

    A variant deviates from the mean of the examples, in common time. `settings.method` decides
    how its curves are drawn: as a mixture of the examples' deviations (`mixtures`), or frame by
    frame (`published`). The time-warp rate is drawn likewise.

    Parameters
    ----------
    model : VariationModel
    n_variants : int
    settings : VarySettings
    planting : PlantSettings or None
        How feet are planted; None leaves them as they are drawn.
    progress : Progress
        Gets a remark if feet cannot be planted.

    Returns
    -------
    tuple of Variant
        The same for the same seed. They start at the height of the base example's first frame,
        above the origin and facing -Y.

    Raises
    ------
    InvalidMotionError
        Fewer than one variant is requested, there is no such example, or the model was learned
        for another method.
    """
    if n_variants < 1:
        raise InvalidMotionError(f"{n_variants} variants cannot be made; request at least one.")
    if settings.base > model.n_examples:
        raise InvalidMotionError(
            f"There is no example {settings.base}; the model has {model.n_examples}."
        )
    stepwise = model.stepwise
    needs_published = settings.method is VaryMethod.PUBLISHED
    if settings.method is not VaryMethod.MIXTURE and (
        stepwise is None or stepwise.published != needs_published
    ):
        raise InvalidMotionError(
            f"The model was not learned for the method {settings.method.value}; learn it with"
            " the same settings."
        )
    rng = np.random.default_rng(settings.seed)
    inputs = _prepare_inputs(model, settings)
    batch_size = max(
        MAX_BATCH_VALUES // (model.n_samples * (model.skeleton.n_joints + 2) * 3), 1
    )
    variants: list[Variant] = []
    while len(variants) < n_variants:
        n = min(batch_size, n_variants - len(variants))
        for drawn in zip(*_draw_deviations(model, settings.method, n, rng), strict=True):
            index = len(variants)
            step = within(progress, index / n_variants, (index + 1) / n_variants)
            step(0.0, f"Variant {index + 1}")
            variant = _build_variant(model, settings, inputs, drawn)
            if planting:
                motion = plant_variant(*variant, planting, step)
                variant = variant._replace(motion=motion)
            variants.append(variant)
    progress(1.0)
    return tuple(variants)


def _draw_deviations(
    model: VariationModel, method: VaryMethod, n_variants: int, rng: np.random.Generator
) -> tuple[Array, Array, Array, Array]:
    """Return deviations of n variants: joints, root, log warp rates and contact state."""
    weights = draw_mixing_weights(model, n_variants, rng)
    mixed = mix_deviations(model, weights)
    if method is VaryMethod.MIXTURE or model.stepwise is None:
        return mixed
    return model.stepwise.draw(mixed, weights, rng)


class _ExampleRange(NamedTuple):
    """Curves of the base example, the mean of all, and the range of each channel."""

    base_curve: Array
    mean: Array
    low: Array
    high: Array


class _SharedInputs(NamedTuple):
    """Inputs that all variants share."""

    joints: _ExampleRange
    root: _ExampleRange
    log_warp_rates: _ExampleRange
    contact_state: _ExampleRange
    by_joint: Array
    """Amount of each joint, shape (n_joints, 1)."""
    pin_weights: Array


def _prepare_inputs(model: VariationModel, settings: VarySettings) -> _SharedInputs:
    base = settings.base - 1 if settings.base else model.center
    by_joint = (settings.amounts()[:, None] * partition_joints(model.skeleton)).sum(axis=0)
    return _SharedInputs(
        joints=_range_from_curves(model.joints, base),
        root=_range_from_curves(model.root, base),
        log_warp_rates=_range_from_curves(model.log_warp_rates, base),
        contact_state=_range_from_curves(model.contact_state, base),
        by_joint=by_joint[:, None],
        pin_weights=_pin_weights(model, settings),
    )


def _range_from_curves(curves: Array, base: int) -> _ExampleRange:
    low, high = curves.min(axis=(0, 1)), curves.max(axis=(0, 1))
    return _ExampleRange(curves[base], curves.mean(axis=0), low, high)


def _build_variant(
    model: VariationModel,
    settings: VarySettings,
    inputs: _SharedInputs,
    drawn: tuple[Array, ...],
) -> Variant:
    """Return one variant from its deviations: joints, root, log warp rates, contact state."""
    amounts, pin_weights = settings.amounts(), inputs.pin_weights
    rig = model.skeleton, model.reference_rotations, model.frame_rate, np.zeros(3)
    joints = _apply_deviations(inputs.joints, inputs.by_joint, drawn[0], pin_weights)
    root = _apply_deviations(inputs.root, amounts[[0, 3, 4]].mean(), drawn[1], pin_weights)
    timing = np.asarray(settings.amount * settings.timing)
    log_warp_rates = _apply_deviations(
        inputs.log_warp_rates, timing, drawn[2], np.ones(len(pin_weights))
    )
    contact_state = _apply_deviations(
        inputs.contact_state, amounts[LEG_ROWS], drawn[3], pin_weights
    )
    curves = apply_time_warp(
        MotionCurves(root, joints, contact_state, model.moving_references),
        np.exp(log_warp_rates) * settings.length,
    )
    if settings.method is VaryMethod.PUBLISHED:
        return Variant(motion_from_curves(curves, *rig), None)
    if model.loops:
        may_change = np.array([not settings.pin_start, not settings.pin_end], dtype=np.float64)
        fractions = np.minimum(inputs.by_joint[:, 0], 1.0)
        curves = close_loop(curves, model.frame_rate, fractions, may_change)
        curves = replace(curves, joints=_clamp_to_range(inputs.joints, curves.joints))
    contacts = (
        None if curves.contact_state is None else contacts_from_state(curves.contact_state)
    )
    return Variant(
        motion_from_curves(curves, *rig), contacts, model.loops and is_closed(curves)
    )


def _apply_deviations(
    examples: _ExampleRange, amount: Array, deviations: Array, pin_weights: Array
) -> Array:
    """Return curves, (n_samples, ...), that deviate as far as the amount and the pins allow.

    They stay within the examples' range and a margin. Amount 0 gives the base example's curves.
    """
    centered = examples.base_curve + np.minimum(amount, 1.0) * (
        examples.mean - examples.base_curve
    )
    varied = _clamp_to_range(examples, centered + amount * deviations)
    weight = pin_weights.reshape(-1, *(1,) * (examples.base_curve.ndim - 1))
    return np.asarray(examples.base_curve + weight * (varied - examples.base_curve))


def _clamp_to_range(examples: _ExampleRange, curves: Array) -> Array:
    margin = RANGE_MARGIN * (examples.high - examples.low)
    return clamp_softly(curves, examples.low - margin, examples.high + margin, margin)


def _pin_weights(model: VariationModel, settings: VarySettings) -> Array:
    """Return the weight of each sample's deviation, shape (n_samples,): 0 at a pinned pose."""
    free = np.ones(model.n_samples)
    ease = smoothstep(np.arange(model.n_samples) / max(PIN_S * model.frame_rate, 1.0))
    if settings.pin_start:
        free = np.minimum(free, ease)
    if settings.pin_end:
        free = np.minimum(free, ease[::-1])
    return free
