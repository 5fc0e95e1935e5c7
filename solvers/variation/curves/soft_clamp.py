"""Clamp values softly (smooth saturation)."""

import numpy as np

from ...arrays import Array


def clamp_softly(values: Array, low: Array, high: Array, width: Array) -> Array:
    """Saturate values near a limit by tanh over `width`, so that they never pass it.

    All have shapes and the unit that the values have, or shapes that broadcast to theirs.
    """
    width = np.maximum(width, 1e-12)
    above, below = values - (high - width), (low + width) - values
    values = np.where(above > 0.0, high - width + width * np.tanh(above / width), values)
    return np.where(below > 0.0, low + width - width * np.tanh(below / width), values)
