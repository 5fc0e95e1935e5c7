"""Postures of clips on a standard body, and its five parts."""

from .body_parts import N_FEATURES, N_PARTS, BodyPart, part_coverage, part_features
from .clip_postures import ClipPostures, Recording, clip_postures, half_precision
from .mean_postures import (
    N_COORDINATES,
    PostureDistribution,
    is_covariance,
    learn_posture_distribution,
)
from .part_reliability import part_reliability

__all__ = [
    "N_COORDINATES",
    "N_FEATURES",
    "N_PARTS",
    "BodyPart",
    "ClipPostures",
    "PostureDistribution",
    "Recording",
    "clip_postures",
    "half_precision",
    "is_covariance",
    "learn_posture_distribution",
    "part_coverage",
    "part_features",
    "part_reliability",
]
