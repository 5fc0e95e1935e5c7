"""Draw deviations as mixtures of the examples' own, with weights that change over time.

A weight vector is partly a smoothed bootstrap around one example (Silverman 1986, Density
estimation, 6.4.1) and partly Gaussian. The bootstrap keeps variants where examples are dense;
the Gaussian part reaches between them. Bootstrap weights sum to 1, so a transition from one
example to another stays between them and does not exaggerate what both share.
"""

import numpy as np

from ..arrays import Array
from ..signals import smooth_gaussian
from .curves import LEG_ROWS, ROOT_ROW, partition_joints, sample_curves
from .variation_model import VariationModel

BOOTSTRAP_VARIANCE = 0.9
"""Fraction of the weights' variance in the bootstrap, for many examples. Of n examples it is
less by 1 / n, since two variants often draw the same example. Half and twice gain less than 1 %
(`make sensitivity`)."""
SOFTMAX_GAIN = 8.0
"""Factor of the softmax over examples; higher values copy a single example more closely. Half
and twice are no better (`make sensitivity`)."""
SHARED_VARIANCE = (0.95, 0.7, 0.7, 0.95, 0.95)
"""Fraction of the variance that each partition shares with the others. Limbs move together, and
legs move with the hips that they carry. Chosen by hand; `make sensitivity` varies it."""
MAX_WEIGHT_RATIO = 1.6
"""Maximum length of a weight vector, relative to the typical one; longer ones are scaled back,
so that variants stay near the examples. Half and twice are no better (`make sensitivity`)."""
WEIGHT_SMOOTHING_S = 0.1
"""Standard deviation in seconds of the Gaussian that separates slow changes, with weights of
each partition, from fast ones. Half and twice are no better (`make sensitivity`)."""
DRAW_RATE_HZ = 30.0
"""Rate at which weights are drawn; they change slowly. Half and twice are no better
(`make sensitivity`)."""
MAX_DRAWN_SAMPLES = 2000
"""Maximum count of drawn samples; in clips of more than a minute weights change more slowly. It
bounds the memory."""
REGULARIZATION = 1e-9
"""Variance, relative to one, added to the kernel: it guards its Cholesky factor."""


def draw_mixing_weights(
    model: VariationModel, n_variants: int, rng: np.random.Generator
) -> Array:
    """Draw weights of the examples, shape (6, n_variants, n_samples, n_examples).

    One row for each partition and, last, one for the root and the time warp.
    """
    n, n_samples = model.n_examples, model.n_samples
    seconds = (n_samples - 1) / model.frame_rate
    n_drawn = max(min(n_samples, round(seconds * DRAW_RATE_HZ) + 1, MAX_DRAWN_SAMPLES), 2)
    times = np.linspace(0.0, seconds, n_drawn)
    covariance = model.kernel.covariance(times, seconds if model.loops else None)
    factor = np.linalg.cholesky(covariance + REGULARIZATION * n_drawn * np.eye(n_drawn))
    drawn = rng.normal(size=(2, ROOT_ROW + 1, n_variants, n_drawn, n))
    drawn = np.einsum("st,kpvtn->kpvsn", factor, drawn)
    shared = np.append(SHARED_VARIANCE, 1.0)[:, None, None, None]
    mixed = np.sqrt(shared) * drawn[:, -1:] + np.sqrt(1.0 - shared) * drawn
    typical_weight = 1.0 / np.sqrt(max(n - 1, 1))
    bootstrap = np.exp(SOFTMAX_GAIN * mixed[0])
    bootstrap /= bootstrap.sum(axis=-1, keepdims=True)
    bootstrap_variance = max(BOOTSTRAP_VARIANCE - 1.0 / n, 0.0)
    weights = (
        np.sqrt(bootstrap_variance * n / max(n - 1, 1)) * bootstrap
        + np.sqrt(1.0 - bootstrap_variance) * typical_weight * mixed[1]
    )
    lengths = np.linalg.norm(weights, axis=-1, keepdims=True)
    max_length = MAX_WEIGHT_RATIO * np.sqrt(n) * typical_weight
    weights *= np.where(lengths > max_length, max_length / np.maximum(lengths, 1e-12), 1.0)
    sample_times = np.linspace(0.0, n_drawn - 1.0, n_samples)
    return np.asarray(
        np.moveaxis(sample_curves(np.moveaxis(weights, 2, 0), sample_times), 0, 2)
    )


def mix_deviations(model: VariationModel, weights: Array) -> tuple[Array, Array, Array, Array]:
    """Return the deviations of variants from the mean of the examples, in common time.

    Fast changes use the same weights for the complete body. In captures the jitter of one joint
    compensates that of another; limbs mixed from different examples would shake hands and feet.

    Returns
    -------
    joints : shape (n_variants, n_samples, n_joints, 3), radians
    root : shape (n_variants, n_samples, 4)
    log_warp_rates : shape (n_variants, n_samples)
    contact_state : shape (n_variants, n_samples, 2), seconds
    """
    n, n_samples = model.n_examples, model.n_samples
    joints = _mix_curves(model.joints, weights[ROOT_ROW])
    width = WEIGHT_SMOOTHING_S * model.frame_rate
    smooth = np.stack([smooth_gaussian(example, width) for example in model.joints])
    for members, partition_weights in zip(
        partition_joints(model.skeleton), weights[:ROOT_ROW], strict=True
    ):
        joints[:, :, members] += _mix_curves(
            smooth[:, :, members], partition_weights - weights[ROOT_ROW]
        )
    root_curves = np.concatenate(
        [model.root, model.log_warp_rates.reshape(n, n_samples, 1)], axis=-1
    )
    root = _mix_curves(root_curves, weights[ROOT_ROW])
    feet = [
        _mix_curves(model.contact_state[..., side : side + 1], weights[leg])
        for side, leg in enumerate(LEG_ROWS)
    ]
    return joints, root[..., :-1], root[..., -1], np.concatenate(feet, axis=-1)


def _mix_curves(curves: Array, weights: Array) -> Array:
    """Return weighted sums of the deviations of curves, (n_examples, n_samples, ...)."""
    n, n_samples = curves.shape[:2]
    deviations = (curves - curves.mean(axis=0)).reshape(n, n_samples, -1)
    sums = np.matmul(weights.transpose(1, 0, 2), deviations.transpose(1, 0, 2))
    shape = (weights.shape[0], n_samples, *curves.shape[2:])
    return np.asarray(sums.transpose(1, 0, 2).reshape(shape))
