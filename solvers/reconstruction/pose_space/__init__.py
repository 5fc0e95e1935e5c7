"""The local linear space of poses near a measured one, and the energy of a pose in it."""

from .posture_energy import N_BONES, EnergyTargets, posture_energy, style_distances
from .posture_space import MIN_VARIANCE_M2, PostureSpaces, local_pca

__all__ = [
    "MIN_VARIANCE_M2",
    "N_BONES",
    "EnergyTargets",
    "PostureSpaces",
    "local_pca",
    "posture_energy",
    "style_distances",
]
