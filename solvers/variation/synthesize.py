"""New motions like the examples: different in space and in time, and none like another."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ..errors import InvalidMotionError
from ..motion import Motion
from ..progress import Progress, unwatched
from ..settings import Settings, setting
from .course import HEIGHT, Course, motion_of
from .partitions import Partition, partition_joints
from .variation_model import VariationModel

Array = NDArray[np.float64]

TOGETHER = 0.8
"""Part of the variance that all partitions have in common: limbs go with each other."""
FARTHEST = 1.6
"""Times the usual length of a mixture's shares, beyond which it is drawn back: variants stay
near the examples."""
MARGIN = 0.15
"""Part of a channel's range in the examples by which a variant may go beyond it."""
PIN = 0.4
"""Seconds over which a variant leaves a pinned pose and comes to it."""
RATE = 30.0
"""Hertz at which shares are drawn; they change slowly."""
JITTER = 1e-9


@dataclass(frozen=True, kw_only=True)
class VarySettings(Settings):
    """How strongly and in what variants differ."""

    amount: float = setting(
        1.0, "0 copies an example, 1 varies as much as the examples do, 2 boldly",
        minimum=0.0, maximum=2.0,
    )  # fmt: skip
    timing: float = setting(
        1.0, "The same for how fast it goes; 0 keeps the time of the example",
        minimum=0.0, maximum=2.0,
    )  # fmt: skip
    trunk: float = setting(
        1.0, "Share of the amount for trunk and head", minimum=0.0, maximum=2.0
    )
    left_arm: float = setting(
        1.0, "Share of the amount for the left arm", minimum=0.0, maximum=2.0
    )
    right_arm: float = setting(
        1.0, "Share of the amount for the right arm", minimum=0.0, maximum=2.0
    )
    left_leg: float = setting(
        1.0, "Share of the amount for the left leg", minimum=0.0, maximum=2.0
    )
    right_leg: float = setting(
        1.0, "Share of the amount for the right leg", minimum=0.0, maximum=2.0
    )
    length: float = setting(
        1.0, "Length of the variants by that of the examples; 2 is twice as slow",
        minimum=0.25, maximum=4.0,
    )  # fmt: skip
    pin_start: bool = setting(False, "Begin in the pose in which the example begins")
    pin_end: bool = setting(False, "End in the pose in which the example ends")
    base: int = setting(
        0, "Example that is copied where the amount is less than 1, counted from 1; 0 takes the"
        " one that is nearest to all others",
        minimum=0, maximum=10_000, advanced=True,
    )  # fmt: skip
    seed: int = setting(0, "Another seed makes other variants", minimum=0, maximum=2**31 - 1)

    def amounts(self) -> Array:
        """Return the amount of each partition, shape (5,)."""
        return self.amount * np.array([getattr(self, part.name.lower()) for part in Partition])


def synthesize(
    model: VariationModel,
    n_variants: int,
    *,
    settings: VarySettings = VarySettings(),
    progress: Progress = unwatched,
) -> tuple[Motion, ...]:
    """Draw variants from what was learned of the examples.

    A variant deviates from the mean of the examples by a mixture of their deviations, whose
    shares are drawn from Gaussian processes (`mixing_kernel`) for each partition of the body;
    how fast the common time passes is drawn likewise. All variants are drawn at once.

    Parameters
    ----------
    model : VariationModel
    n_variants : int
    settings : VarySettings
    progress : Progress

    Returns
    -------
    tuple of Motion
        The same for the same seed. They begin where the examples' first frame of the base
        does, above the origin and facing -Y. Feet are not planted: see `solvers.workflows`.

    Raises
    ------
    InvalidMotionError
        No variants are asked for, or there is no such example.
    """
    if n_variants < 1:
        raise InvalidMotionError(f"{n_variants} variants cannot be made; ask for at least one.")
    if settings.base > model.n_examples:
        raise InvalidMotionError(
            f"There is no example {settings.base}; the model has {model.n_examples}."
        )
    rng = np.random.default_rng(settings.seed)
    base = settings.base - 1 if settings.base else model.centre
    shares = _shares(model, n_variants, rng)
    variants = []
    for place in range(n_variants):
        progress(place / n_variants, f"Variant {place + 1}")
        variants.append(_variant(model, settings, base, shares[:, place]))
    progress(1.0)
    return tuple(variants)


def _shares(model: VariationModel, n_variants: int, rng: np.random.Generator) -> Array:
    """Return shares of the examples, shape (6, n_variants, n_moments, n_examples).

    For each partition and, last, for the time; their squares sum to about 1.
    """
    n, moments = model.n_examples, model.n_moments
    seconds = (moments - 1) / model.frame_rate
    few = max(min(moments, round(seconds * RATE) + 1), 2)
    times = np.linspace(0.0, seconds, few)
    covariance = model.kernel.covariance(times, seconds if model.loops else None)
    root = np.linalg.cholesky(covariance + JITTER * few * np.eye(few))
    drawn = rng.normal(size=(len(Partition) + 2, n_variants, few, n))
    drawn = np.einsum("st,pvtn->pvsn", root, drawn)
    own, common, time = drawn[: len(Partition)], drawn[-2], drawn[-1]
    mixed = np.sqrt(TOGETHER) * common + np.sqrt(1.0 - TOGETHER) * own
    shares = np.concatenate([mixed, time[None]]) / np.sqrt(max(n - 1, 1))
    usual = np.sqrt(n / max(n - 1, 1))
    length = np.linalg.norm(shares, axis=-1, keepdims=True)
    farthest = FARTHEST * usual
    shares *= np.where(length > farthest, farthest / np.maximum(length, 1e-12), 1.0)
    return np.asarray(CubicSpline(times, shares, axis=2)(np.linspace(0.0, seconds, moments)))


def _variant(model: VariationModel, settings: VarySettings, base: int, shares: Array) -> Motion:
    """Return one variant, with these shares, (6, n_moments, n_examples)."""
    amounts = settings.amounts()
    pinned = _pinned(model, settings)
    joints = np.zeros(model.joints.shape[1:])
    for amount, members, share in zip(
        amounts, partition_joints(model.skeleton), shares, strict=False
    ):
        joints[:, members] = _mixed(model.joints[:, :, members], base, amount, share, pinned)
    way = shares[-3:-1].mean(axis=0) if len(shares) > 2 else shares[0]
    root = _mixed(model.root, base, float(amounts[[0, 3, 4]].mean()), way, pinned)
    haste = _mixed(model.haste, base, settings.timing, shares[-1], np.ones(len(pinned)))
    course = _in_own_time(Course(root, joints), np.exp(haste) * settings.length)
    return motion_of(course, model.skeleton, model.usual, model.frame_rate, np.zeros(3))


def _mixed(curves: Array, base: int, amount: float, shares: Array, pinned: Array) -> Array:
    """Return a mixture of curves, shape (n_moments, ...), by shares, (n_moments, n_examples).

    Within the examples' range and a little beyond; the base's curve where nothing may vary.
    """
    middle = curves.mean(axis=0)
    beside = np.einsum("sn,ns...->s...", shares, curves - middle)
    own = curves[base]
    centre = own + min(amount, 1.0) * (middle - own)
    low, high = curves.min(axis=(0, 1)), curves.max(axis=(0, 1))
    beyond = MARGIN * (high - low)
    free = _softly_within(centre + amount * beside, low - beyond, high + beyond, beyond)
    weight = pinned.reshape(-1, *(1,) * (own.ndim - 1)) * (amount > 0.0)
    return np.asarray(own + weight * (free - own))


def _softly_within(values: Array, low: Array, high: Array, soft: Array) -> Array:
    """Let values near a limit slow down and never pass it."""
    soft = np.maximum(soft, 1e-12)
    over, under = values - (high - soft), (low + soft) - values
    values = np.where(over > 0.0, high - soft + soft * np.tanh(over / soft), values)
    return np.where(under > 0.0, low + soft - soft * np.tanh(under / soft), values)


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


def _in_own_time(course: Course, durations: Array) -> Course:
    """Let each moment last for so many frames, and return what is seen at whole frames."""
    steps = (durations[1:] + durations[:-1]) / 2.0
    times = np.concatenate([[0.0], np.cumsum(steps)])
    n_frames = max(round(times[-1]), 1) + 1
    times *= (n_frames - 1) / times[-1]
    ways = np.cumsum(course.root[:, :HEIGHT], axis=0)
    told = np.column_stack([
        ways,
        course.root[:, HEIGHT:],
        course.joints.reshape(len(ways), -1),
    ])
    if len(told) > 2:
        seen = CubicSpline(times, told, axis=0)(np.arange(n_frames))
    else:
        seen = told[np.minimum(np.arange(n_frames), len(told) - 1)]
    root = np.diff(seen[:, :HEIGHT], axis=0, prepend=seen[:1, :HEIGHT])
    joints = seen[:, HEIGHT + 1 :].reshape(n_frames, *course.joints.shape[1:])
    return Course(np.column_stack([root, seen[:, HEIGHT]]), joints)
