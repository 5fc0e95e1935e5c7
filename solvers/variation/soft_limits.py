"""Limits that are neared more and more slowly."""

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def softly_within(values: Array, low: Array, high: Array, soft: Array) -> Array:
    """Let values near a limit slow down and never pass it."""
    soft = np.maximum(soft, 1e-12)
    over, under = values - (high - soft), (low + soft) - values
    values = np.where(over > 0.0, high - soft + soft * np.tanh(over / soft), values)
    return np.where(under > 0.0, low + soft - soft * np.tanh(under / soft), values)
