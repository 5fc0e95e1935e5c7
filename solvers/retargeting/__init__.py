"""Retarget motions to other rigs.

>>> from solvers.motion import Skeleton, find_humanoid_map
>>> from solvers.retargeting import retarget
>>> from solvers.samples import GaitSettings, walker_skeleton, walking_gait
>>> walk = walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))
>>> walker = walker_skeleton()
>>> taller = Skeleton(walker.names, walker.parents, 1.1 * walker.offsets)
>>> roles = find_humanoid_map(taller)
>>> retarget(walk, roles, taller, roles).n_frames
60
"""

from typing import TYPE_CHECKING

from ..import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .error_points import find_error_points
    from .key_curves import KeyCurve, fit_curve
    from .reduce_keys import SparseMotion, UnbakeSettings, load_sparse_motion, reduce_keys
    from .retarget import LiveRetargeting, RetargetSettings, RootMotion, retarget
    from .root_motion import GroundPath, ground_path
    from .rotation_channels import RotationChannels

__all__ = [
    "GroundPath",
    "KeyCurve",
    "LiveRetargeting",
    "RetargetSettings",
    "RootMotion",
    "RotationChannels",
    "SparseMotion",
    "UnbakeSettings",
    "find_error_points",
    "fit_curve",
    "ground_path",
    "load_sparse_motion",
    "reduce_keys",
    "retarget",
]

import_on_demand(__name__)
