"""Model of joint movement within half a second: a mixture learned from many recordings."""

from .joint_noise import MAX_CONSTANT_RANGE, JointNoise, estimate_joint_noise
from .learn_mixture import learn_motion_mixture
from .motion_mixture import (
    N_CHANNELS,
    SHIPPED,
    SHIPPED_PAIRS,
    MotionMixture,
    load_motion_mixture,
)
from .noise_color import find_noise_spectrum
from .noise_levels import noise_levels
from .principal_axes import principal_axes, robust_axes
from .smooth_joints import MAX_LEVERAGE, MixtureSmoother

__all__ = [
    "MAX_CONSTANT_RANGE",
    "MAX_LEVERAGE",
    "N_CHANNELS",
    "SHIPPED",
    "SHIPPED_PAIRS",
    "JointNoise",
    "MixtureSmoother",
    "MotionMixture",
    "estimate_joint_noise",
    "find_noise_spectrum",
    "learn_motion_mixture",
    "load_motion_mixture",
    "noise_levels",
    "principal_axes",
    "robust_axes",
]
