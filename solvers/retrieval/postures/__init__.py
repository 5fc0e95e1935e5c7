"""Clips as postures of one standard body, and its five parts."""

from .body_parts import N_FEATURES, N_PARTS, BodyPart, part_coverage, part_features
from .clip_postures import ClipPostures, Recording, clip_postures, half_precision
from .mean_postures import N_COORDINATES, UsualPostures, is_covariance, usual_postures
from .part_reliability import part_reliability

__all__ = [
    "N_COORDINATES",
    "N_FEATURES",
    "N_PARTS",
    "BodyPart",
    "ClipPostures",
    "Recording",
    "UsualPostures",
    "clip_postures",
    "half_precision",
    "is_covariance",
    "part_coverage",
    "part_features",
    "part_reliability",
    "usual_postures",
]
