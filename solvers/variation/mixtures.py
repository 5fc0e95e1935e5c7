"""Deviations drawn as mixtures of the examples' own, with shares that change in time.

A share vector is mostly drawn around one example and partly Gaussian: the first is a smoothed
bootstrap (Silverman 1986, Density estimation, 6.4.1), which keeps variants where examples are
dense, the second reaches between them. The first sums to 1: while one example gives way to
another a variant lies between the two, and what both have in common is not exaggerated.
"""

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from .curve_sampling import sample_curves
from .partitions import FEET, Partition, partition_joints
from .variation_model import VariationModel

Array = NDArray[np.float64]

NEAR = 0.9
"""Part of the variance of shares that is drawn around one example at a time, of many; of n
examples it is less by 1 / n, since two variants are often drawn around the same."""
SHARP = 8.0
"""How clearly one example prevails over others there; higher is closer to copying it."""
TOGETHER = np.array([0.95, 0.7, 0.7, 0.95, 0.95])
"""Part of the variance that each partition has in common with the others: limbs go with each
other, and legs with the hips that they carry."""
FARTHEST = 1.6
"""Times the usual length of a mixture's shares, beyond which it is drawn back: variants stay
near the examples."""
CALM = 0.1
"""Seconds: what changes more slowly is each partition's own."""
RATE = 30.0
"""Hertz at which shares are drawn; they change slowly."""
LONGEST = 2000
"""Moments at which shares are drawn at most; in clips over a minute they change more slowly."""
JITTER = 1e-9
COMMON = len(Partition)
"""Row of the shares that the way of the root and the time have, after those of partitions."""


def draw_shares(model: VariationModel, n_variants: int, rng: np.random.Generator) -> Array:
    """Return shares of the examples, shape (6, n_variants, n_moments, n_examples).

    For each partition and, last, for the root and the time.
    """
    n, moments = model.n_examples, model.n_moments
    seconds = (moments - 1) / model.frame_rate
    few = max(min(moments, round(seconds * RATE) + 1, LONGEST), 2)
    times = np.linspace(0.0, seconds, few)
    covariance = model.kernel.covariance(times, seconds if model.loops else None)
    root = np.linalg.cholesky(covariance + JITTER * few * np.eye(few))
    drawn = rng.normal(size=(2, COMMON + 1, n_variants, few, n))
    drawn = np.einsum("st,kpvtn->kpvsn", root, drawn)
    common = np.append(TOGETHER, 1.0)[:, None, None, None]
    mixed = np.sqrt(common) * drawn[:, -1:] + np.sqrt(1.0 - common) * drawn
    usual = 1.0 / np.sqrt(max(n - 1, 1))
    around = np.exp(SHARP * mixed[0])
    around /= around.sum(axis=-1, keepdims=True)
    near = max(NEAR - 1.0 / n, 0.0)
    shares = np.sqrt(near * n / max(n - 1, 1)) * around + np.sqrt(1.0 - near) * usual * mixed[1]
    length = np.linalg.norm(shares, axis=-1, keepdims=True)
    farthest = FARTHEST * np.sqrt(n) * usual
    shares *= np.where(length > farthest, farthest / np.maximum(length, 1e-12), 1.0)
    seen = np.linspace(0.0, few - 1.0, moments)
    return np.asarray(np.moveaxis(sample_curves(np.moveaxis(shares, 2, 0), seen), 0, 2))


def mixed_deviations(model: VariationModel, shares: Array) -> tuple[Array, Array, Array, Array]:
    """Return by how much variants deviate from the mean of the examples in common time.

    What changes quickly is mixed with the same shares everywhere: in captures the jitter of one
    joint makes up for that of another, and feet and hands shook if limbs had it from different
    examples.

    Returns
    -------
    joints : shape (n_variants, n_moments, n_joints, 3), radians
    root : shape (n_variants, n_moments, 4)
    haste : shape (n_variants, n_moments)
    footing : shape (n_variants, n_moments, 2), seconds
    """
    n, moments = model.n_examples, model.n_moments
    joints = _mixed(model.joints, shares[COMMON])
    calm = gaussian_filter1d(model.joints, CALM * model.frame_rate, axis=1, mode="nearest")
    for members, share in zip(partition_joints(model.skeleton), shares[:COMMON], strict=True):
        joints[:, :, members] += _mixed(calm[:, :, members], share - shares[COMMON])
    rest = np.concatenate([model.root, model.haste.reshape(n, moments, 1)], axis=-1)
    root = _mixed(rest, shares[COMMON])
    feet = [
        _mixed(model.footing[..., side : side + 1], shares[leg])
        for side, leg in enumerate(FEET)
    ]
    return joints, root[..., :-1], root[..., -1], np.concatenate(feet, axis=-1)


def _mixed(curves: Array, shares: Array) -> Array:
    """Return sums of deviations of curves, (n_examples, n_moments, ...), by shares."""
    n, moments = curves.shape[:2]
    beside = (curves - curves.mean(axis=0)).reshape(n, moments, -1)
    sums = np.matmul(shares.transpose(1, 0, 2), beside.transpose(1, 0, 2))
    shape = (shares.shape[0], moments, *curves.shape[2:])
    return np.asarray(sums.transpose(1, 0, 2).reshape(shape))
