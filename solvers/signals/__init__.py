"""Plain arrays over time: noise, spikes, gaps, smoothing and smooth corrections."""

from .gaussian_smoothing import steadied
from .linear_gaps import bridged, bridged_rotations
from .noise import DIFFERENCE_GAIN, DIFFERENCE_ORDER, alike, hampel, interpolated, rough_noise
from .smooth_correction import FADES, smooth_correction
from .spikes import disturbance, runs

__all__ = [
    "DIFFERENCE_GAIN",
    "DIFFERENCE_ORDER",
    "FADES",
    "alike",
    "bridged",
    "bridged_rotations",
    "disturbance",
    "hampel",
    "interpolated",
    "rough_noise",
    "runs",
    "smooth_correction",
    "steadied",
]
