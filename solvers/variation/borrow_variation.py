"""Learn variation for a single clip from other behaviors or from a generic model."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..errors import InvalidMotionError
from ..motion import Motion
from ..signals import smooth_gaussian
from .curves import HEIGHT_COLUMN, partition_joints, sample_curves
from .learn_variation import learn_variation_model
from .variation_model import VariationModel

N_PAIRS = 5
"""Pairs of synthetic examples; the two of a pair deviate in opposite directions. Half and twice
are no better (`make sensitivity`)."""
SWING_FRACTION = 0.2
"""Standard deviation of a limb's change of amplitude, as a fraction of its movement. Half and
twice gain less than 1 % (`make sensitivity`)."""
DELAY_S = 0.04
"""Standard deviation of a limb's time shift, in seconds. Half and twice are no better
(`make sensitivity`)."""
OFFSET_FRACTION = 0.25
"""Standard deviation of a pose offset, as a fraction of the joint's movement. Half and twice
are no better (`make sensitivity`)."""
LOG_SPEED_STD = 0.1
"""Standard deviation of the logarithm of the playback speed. Chosen by hand; `make sensitivity`
varies it."""
MOVEMENT_SMOOTHING_S = 0.05
"""Standard deviation in seconds of the Gaussian that smooths movement before it is amplified,
so that noise is not. Half and twice gain less than 1 % (`make sensitivity`)."""
SHARED_VARIANCE = 0.7
"""Fraction of the variance that joints of a partition share. Half is worse
(`make sensitivity`), and twice is no fraction."""
LEG_FACTOR, ROOT_FACTOR = 0.5, 0.3
"""Factors for legs, whose feet stand on the ground, and for the trajectory of the root. Half
and twice gain less than 1 % (`make sensitivity`)."""
MAX_SCALE = 2.0
"""Maximum factor by which borrowed deviations grow where the clip moves more. It guards clips
that move much more than the motion from which variation is borrowed."""


def borrow_variation(motion: Motion, others: Sequence[VariationModel] = ()) -> VariationModel:
    """Learn a model of one clip whose variation comes from elsewhere.

    With `others`, models of the same rig, the clip takes over the deviations of their examples.
    They are matched by normalized time and scaled by how much each joint moves here and there.
    Without others, each limb varies a little in amplitude, timing and offset, with joints of a
    limb correlated. Loops stay loops, and joints at rest stay at rest.

    Parameters
    ----------
    motion : Motion
    others : sequence of VariationModel

    Returns
    -------
    VariationModel
        Its `warning` says that the variation is borrowed.

    Raises
    ------
    InvalidMotionError
        The clip has gaps or fewer than two frames, or a model is of another rig.
    """
    model = learn_variation_model([motion])
    for index, other in enumerate(others):
        if other.skeleton.names != model.skeleton.names:
            raise InvalidMotionError(
                f"Model {index + 1} to borrow from has a different rig than the clip. Retarget"
                " its examples first."
            )
    deviations = [_borrow_deviations(model, other) for other in others if other.n_examples > 1]
    joints, root, log_warp_rates = (
        (np.concatenate(part) for part in zip(*deviations, strict=True))
        if deviations
        else _generic_deviations(model)
    )
    return replace(
        model,
        joints=np.concatenate([model.joints, model.joints + joints]),
        root=np.concatenate([model.root, model.root + root]),
        log_warp_rates=np.concatenate([
            model.log_warp_rates,
            model.log_warp_rates + log_warp_rates,
        ]),
        contact_state=np.repeat(model.contact_state, 1 + len(joints), axis=0),
        warning="There is only one example; its variation is borrowed from other motions.",
    )


def _borrow_deviations(
    model: VariationModel, other: VariationModel
) -> tuple[Array, Array, Array]:
    """Return deviations of another behavior's examples, resampled and scaled for this one."""
    times = np.linspace(0.0, other.n_samples - 1.0, model.n_samples)
    borrowed = []
    for own_curves, other_curves in ((model.joints, other.joints), (model.root, other.root)):
        deviations = np.moveaxis(other_curves - other_curves.mean(axis=0), 0, 1)
        scale = np.minimum(
            _movement_range(own_curves) / np.maximum(_movement_range(other_curves), 1e-9),
            MAX_SCALE,
        )
        borrowed.append(np.moveaxis(sample_curves(deviations, times), 1, 0) * scale)
    log_rates = (other.log_warp_rates - other.log_warp_rates.mean(axis=0)).T
    return borrowed[0], borrowed[1], sample_curves(log_rates, times).T


def _movement_range(curves: Array) -> Array:
    """Return the standard deviation over time of curves, (n_examples, n_samples, ...)."""
    spread = curves.std(axis=1).mean(axis=0)
    if spread.ndim > 1:
        spread = np.linalg.norm(spread, axis=-1, keepdims=True)
    return np.asarray(spread)


def _generic_deviations(model: VariationModel) -> tuple[Array, Array, Array]:
    """Return deviations of synthetic examples: joints, root and log warp rates."""
    rng = np.random.default_rng(0)
    members = partition_joints(model.skeleton)
    n_joints, n_samples = model.skeleton.n_joints, model.n_samples
    curve = model.joints[0]
    swing, delay = (
        _correlate_partitions(rng.normal(size=(2, N_PAIRS, n_joints)), members)
        for _ in range(2)
    )
    offset = rng.normal(size=(N_PAIRS, n_joints, 3))
    smooth = smooth_gaussian(curve, MOVEMENT_SMOOTHING_S * model.frame_rate)
    centered, velocity = (
        smooth - smooth.mean(axis=0),
        np.gradient(smooth, 1.0 / model.frame_rate, axis=0),
    )
    joints = SWING_FRACTION * swing[:, None, :, None] * centered
    joints += DELAY_S * delay[:, None, :, None] * velocity
    joints += OFFSET_FRACTION * offset[:, None] * curve.std(axis=0)
    joints *= (np.array([1.0, 1.0, 1.0, LEG_FACTOR, LEG_FACTOR]) @ members)[:, None]
    root_curve = model.root[0].copy()
    root_curve[:, HEIGHT_COLUMN] -= root_curve[:, HEIGHT_COLUMN].mean()
    root = ROOT_FACTOR * SWING_FRACTION * rng.normal(size=(N_PAIRS, 1, 1)) * root_curve
    log_warp_rates = LOG_SPEED_STD * rng.normal(size=(N_PAIRS, 1)) * np.ones(n_samples)
    return (
        _mirror_deviations(joints),
        _mirror_deviations(root),
        _mirror_deviations(log_warp_rates),
    )


def _correlate_partitions(drawn: Array, members: NDArray[np.bool_]) -> Array:
    """Correlate draws, two arrays (n, n_joints), among the joints of each partition."""
    first = members.argmax(axis=1)[members.argmax(axis=0)]
    return np.asarray(
        np.sqrt(SHARED_VARIANCE) * drawn[0][:, first]
        + np.sqrt(1.0 - SHARED_VARIANCE) * drawn[1]
    )


def _mirror_deviations(deviations: Array) -> Array:
    return np.concatenate([deviations, -deviations])
