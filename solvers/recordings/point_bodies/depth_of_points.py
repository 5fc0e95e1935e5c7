"""Tell the depth of points from scores that stand in its place."""

import numpy as np

from ...arrays import Array

MAX_FRAMES = 300
"""Frames that are compared, at most. It bounds the memory."""
MIN_TRADE = 0.7
"""Correlation, a ratio, from which the third coordinate is depth: how far bones that get
shorter in the picture get longer in depth. Measured: 1 for depth without noise, 0.05 to 0.55
for scores of takes of walk, dance and a bow."""


def has_depth(points: Array) -> bool:
    """Return whether the third coordinate is depth: bones keep their lengths with it.

    The unit of the depth does not matter.

    Parameters
    ----------
    points : shape (n_frames, n_points, 3), NaN where not observed
    """
    points = points[:: -(-len(points) // MAX_FRAMES)]
    squares = np.square(points[:, :, None] - points[:, None])
    squares = np.where(np.isfinite(squares).all(axis=-1, keepdims=True), squares, np.nan)
    known = ~np.isnan(squares[..., 0])
    n_known = np.maximum(known.sum(axis=0), 1)
    in_picture, in_depth = (
        np.where(known, each - np.nansum(each, axis=0) / n_known, 0.0)
        for each in (squares[..., 0] + squares[..., 1], squares[..., 2])
    )
    products = (in_picture * in_depth).sum(axis=0)
    powers = np.square(in_picture).sum(axis=0) * np.square(in_depth).sum(axis=0)
    trade = np.divide(-products, np.sqrt(powers), out=np.zeros_like(powers), where=powers > 0.0)
    return bool(np.median(trade.max(axis=1)) >= MIN_TRADE)
