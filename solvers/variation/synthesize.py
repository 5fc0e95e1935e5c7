"""New motions like the examples: different in space and in time, and none like another."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..motion import Motion
from ..progress import Progress, unwatched
from .footing import contacts_from
from .loops import close_loop, is_closed
from .mixtures import draw_shares, mixed_deviations
from .motion_curves import MotionCurves, motion_from_curves
from .own_time import in_own_time
from .partitions import FEET, partition_joints
from .soft_limits import softly_within
from .stepwise_draw import stepwise_deviations
from .variation_model import VariationModel
from .vary_settings import USUAL, Method, VarySettings

Array = NDArray[np.float64]

MARGIN = 0.15
"""Part of a channel's range in the examples by which a variant may go beyond it."""
PIN = 0.4
"""Seconds over which a variant leaves a pinned pose and comes to it."""
BATCH = 20_000_000
"""Numbers in the curves of all variants that are drawn at once."""


class Variant(NamedTuple):
    """A new motion, and when its feet should stand."""

    motion: Motion
    contacts: NDArray[np.bool_] | None
    """Left and right, shape (n_frames, 2), as in the examples that were mixed there; None for
    rigs without feet, and as published, where no examples are mixed."""
    loops: bool = False
    """Whether it ends as it begins, because the examples do."""


def synthesize(
    model: VariationModel,
    n_variants: int,
    *,
    settings: VarySettings = USUAL,
    progress: Progress = unwatched,
) -> tuple[Motion, ...]:
    """Draw variants from what was learned of the examples; see `draw_variants`.

    Returns
    -------
    tuple of Motion
        Their feet are not planted: see `solvers.workflows`.
    """
    drawn = draw_variants(model, n_variants, settings=settings, progress=progress)
    return tuple(variant.motion for variant in drawn)


def draw_variants(
    model: VariationModel,
    n_variants: int,
    *,
    settings: VarySettings = USUAL,
    progress: Progress = unwatched,
) -> tuple[Variant, ...]:
    """Draw variants from what was learned of the examples, and when their feet should stand.

    A variant deviates from the mean of the examples, in common time, by curves that are drawn
    as `settings.method` says: as a mixture of the examples' deviations (`mixtures`), or step by
    step (`stepwise_draw`). How fast the common time passes is drawn likewise. Variants are
    drawn many at once.

    Parameters
    ----------
    model : VariationModel
    n_variants : int
    settings : VarySettings
    progress : Progress

    Returns
    -------
    tuple of Variant
        The same for the same seed. They begin where the examples' first frame of the base
        does, above the origin and facing -Y.

    Raises
    ------
    InvalidMotionError
        No variants are asked for, there is no such example, or the model was learned for
        another method.
    """
    if n_variants < 1:
        raise InvalidMotionError(f"{n_variants} variants cannot be made; ask for at least one.")
    if settings.base > model.n_examples:
        raise InvalidMotionError(
            f"There is no example {settings.base}; the model has {model.n_examples}."
        )
    stepwise = model.stepwise
    wanted = settings.method is Method.PUBLISHED
    if settings.method is not Method.MIXTURE and (
        stepwise is None or stepwise.published != wanted
    ):
        raise InvalidMotionError(
            f"The model was not learned for the method {settings.method.value}; learn it with"
            " the same settings."
        )
    rng = np.random.default_rng(settings.seed)
    given = _given(model, settings)
    at_once = max(BATCH // (model.n_moments * (model.skeleton.n_joints + 2) * 3), 1)
    variants: list[Variant] = []
    while len(variants) < n_variants:
        n = min(at_once, n_variants - len(variants))
        for drawn in zip(*_deviations(model, settings.method, n, rng), strict=True):
            variants.append(_variant(model, settings, given, drawn))
            progress(len(variants) / n_variants, f"Variant {len(variants)}")
    return tuple(variants)


def _deviations(
    model: VariationModel, method: Method, n_variants: int, rng: np.random.Generator
) -> tuple[Array, Array, Array, Array]:
    """Return by how much n variants deviate from the mean: joints, root, haste, footing."""
    shares = draw_shares(model, n_variants, rng)
    joints, root, haste, footing = mixed_deviations(model, shares)
    if method is not Method.MIXTURE and model.stepwise:
        own = stepwise_deviations(model.stepwise, shares, model.skeleton.n_joints, rng)
        if model.stepwise.published:
            return *own, haste, np.full_like(footing, np.nan)
        return joints + own[0], root + own[1], haste, footing
    return joints, root, haste, footing


class _Range(NamedTuple):
    """What examples do: the one that is varied, their mean, and how far they go."""

    own: Array
    middle: Array
    low: Array
    high: Array


class _Given(NamedTuple):
    """What all variants have in common."""

    joints: _Range
    root: _Range
    haste: _Range
    footing: _Range
    by_joint: Array
    """Amount of each joint, shape (n_joints, 1)."""
    pinned: Array


def _given(model: VariationModel, settings: VarySettings) -> _Given:
    base = settings.base - 1 if settings.base else model.centre
    by_joint = (settings.amounts()[:, None] * partition_joints(model.skeleton)).sum(axis=0)
    return _Given(
        joints=_range(model.joints, base),
        root=_range(model.root, base),
        haste=_range(model.haste, base),
        footing=_range(model.footing, base),
        by_joint=by_joint[:, None],
        pinned=_pinned(model, settings),
    )


def _range(curves: Array, base: int) -> _Range:
    low, high = curves.min(axis=(0, 1)), curves.max(axis=(0, 1))
    return _Range(curves[base], curves.mean(axis=0), low, high)


def _variant(
    model: VariationModel, settings: VarySettings, given: _Given, drawn: tuple[Array, ...]
) -> Variant:
    """Return one variant that deviates so from the mean: joints, root, haste, footing."""
    amounts, pinned = settings.amounts(), given.pinned
    known = model.skeleton, model.usual, model.frame_rate, np.zeros(3)
    joints = _free(given.joints, given.by_joint, drawn[0], pinned)
    root = _free(given.root, amounts[[0, 3, 4]].mean(), drawn[1], pinned)
    hasty = np.asarray(settings.amount * settings.timing)
    haste = _free(given.haste, hasty, drawn[2], np.ones(len(pinned)))
    footing = _free(given.footing, amounts[FEET], drawn[3], pinned)
    course = in_own_time(
        MotionCurves(root, joints, footing, model.carrier), np.exp(haste) * settings.length
    )
    if settings.method is Method.PUBLISHED:
        return Variant(motion_from_curves(course, *known), None)
    if model.loops:
        may_change = np.array([not settings.pin_start, not settings.pin_end], dtype=np.float64)
        parts = np.minimum(given.by_joint[:, 0], 1.0)
        course = close_loop(course, model.frame_rate, parts, may_change)
        course = replace(course, joints=_within_range(given.joints, course.joints))
    contacts = None if course.footing is None else contacts_from(course.footing)
    return Variant(
        motion_from_curves(course, *known), contacts, model.loops and is_closed(course)
    )


def _free(seen: _Range, amount: Array, beside: Array, pinned: Array) -> Array:
    """Return curves, (n_moments, ...), that deviate so far as an amount and pins allow.

    Within the examples' range and a little beyond; the base's curve where nothing may vary.
    """
    centre = seen.own + np.minimum(amount, 1.0) * (seen.middle - seen.own)
    free = _within_range(seen, centre + amount * beside)
    weight = pinned.reshape(-1, *(1,) * (seen.own.ndim - 1))
    return np.asarray(seen.own + weight * (free - seen.own))


def _within_range(seen: _Range, curves: Array) -> Array:
    beyond = MARGIN * (seen.high - seen.low)
    return softly_within(curves, seen.low - beyond, seen.high + beyond, beyond)


def _pinned(model: VariationModel, settings: VarySettings) -> Array:
    """Return how free each moment is, shape (n_moments,), 0 where a pose is pinned."""
    free = np.ones(model.n_moments)
    ramp = np.arange(model.n_moments) / max(PIN * model.frame_rate, 1.0)
    ease = np.clip(ramp, 0.0, 1.0) ** 2 * (3.0 - 2.0 * np.clip(ramp, 0.0, 1.0))
    if settings.pin_start:
        free = np.minimum(free, ease)
    if settings.pin_end:
        free = np.minimum(free, ease[::-1])
    return free
