"""Joint rotations of a skeleton from the positions of its joints."""

from .follow_joints import follow_joints
from .library_body import BodyPostures, anatomy_turns, on_body
from .limb_angles import Complex, angles_about
from .limb_twist import bend_share
from .other_joints import all_joints, anchors
from .result import Reconstruction
from .trunk_twist import (
    N_TWISTED,
    TWISTED,
    LimbTwists,
    bend_normals,
    mean_twists,
    mirrored_twists,
    plain_hinges,
)
from .turn_to_postures import turn_to_postures

__all__ = [
    "N_TWISTED",
    "TWISTED",
    "BodyPostures",
    "Complex",
    "LimbTwists",
    "Reconstruction",
    "all_joints",
    "anatomy_turns",
    "anchors",
    "angles_about",
    "bend_normals",
    "bend_share",
    "follow_joints",
    "mean_twists",
    "mirrored_twists",
    "on_body",
    "plain_hinges",
    "turn_to_postures",
]
