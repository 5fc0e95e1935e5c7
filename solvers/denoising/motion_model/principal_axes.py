"""The axes along which joints move most and least."""

from typing import NamedTuple

import numpy as np

from ...arrays import Array

TIE_BREAK = 1e-9
"""Fraction of the variance by which each channel has more of it than the next. Guards joints
that move equally along two axes, whose axes rounding would choose."""
MIN_VARIANCE = np.finfo(float).tiny
"""Of all channels together. Guards joints that stand still."""
MIN_LENGTH = 1e-9
"""Degrees or centimeters: guards a division."""


class PrincipalAxes(NamedTuple):
    """The principal axes of the movement of joints, that of the largest movement first.

    They are orthogonal where the noise is equal along all axes. Otherwise they are
    oblique, so that the noise along one of them is independent of that along the others.
    """

    to_channels: Array
    """Unit vectors as columns, shape (n_joints, n_channels, n_channels)."""
    from_channels: Array
    """Its inverse, same shape."""
    variance: Array
    """Of the noise along each axis, shape (n_joints, n_channels)."""


def principal_axes(samples: Array, noise: Array) -> PrincipalAxes:
    """Return the axes that make a joint's movement and its noise independent.

    If a rig's bones are turned, the axes turn with them, so that the movement along them is the
    same but for its sign.

    Parameters
    ----------
    samples : shape (n_frames, n_joints, n_channels), without NaN
        Of joints, or of joints that are looked at together.
    noise : shape (n_joints, n_channels, n_channels)
        Covariance of the channels, positive definite.
    """
    factor = np.linalg.cholesky(noise)
    whiten = np.linalg.inv(factor)
    whitened = np.einsum("tjc,jac->tja", samples - samples.mean(axis=0), whiten)
    products = np.einsum("tjc,tjd->jcd", whitened, whitened)
    scale = np.maximum(np.einsum("jcc->j", products), MIN_VARIANCE)
    tie_break = TIE_BREAK * np.diag(np.arange(noise.shape[1])[::-1])
    movement, axes = np.linalg.eigh(products + scale[:, None, None] * tie_break)
    lengths = np.linalg.norm(factor @ axes, axis=1)
    order = np.argsort(-movement * lengths**2, axis=1, kind="stable")
    axes = np.take_along_axis(axes, order[:, None], axis=2)
    lengths = np.take_along_axis(lengths, order, axis=1)
    return PrincipalAxes(
        factor @ axes / lengths[:, None],
        axes.transpose(0, 2, 1) @ whiten * lengths[..., None],
        np.square(lengths),
    )


def robust_axes(samples: Array) -> Array:
    """Return the principal axes of the directions from the median, shape (3, 3), as columns.

    All frames count the same [1]_, so that an error of a few frames does not turn the axes.

    Parameters
    ----------
    samples : shape (n_frames, 3), without NaN

    References
    ----------
    .. [1] Visuri, Koivunen, Oja (2000). Sign and rank covariance matrices. Journal of
       Statistical Planning and Inference 91. doi:10.1016/S0378-3758(00)00199-3
    """
    centered = samples - np.median(samples, axis=0)
    lengths = np.linalg.norm(centered, axis=1, keepdims=True)
    directions = centered / np.maximum(lengths, MIN_LENGTH)
    axes = principal_axes(directions[:, None], np.eye(directions.shape[1])[None])
    return np.asarray(axes.to_channels[0])
