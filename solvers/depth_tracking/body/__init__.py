"""The tracked body: a pose as coordinates, segments, capsules and their derivatives."""

from .capsule_surface import BodySurface, capsule_surface
from .coordinates import COORDINATES, N_COORDINATES, N_ROOT
from .kinematics import N_SEGMENTS, joint_positions, segment_frames, segment_twists
from .learn_motion_prior import learn_motion_prior
from .model import BodyModel, load_body_model, usual_body
from .motion import body_motion, body_skeleton, motion_frames, rest_frames, scene_from_camera
from .motion_prior import LocalPca, MotionPrior, load_motion_prior, local_pca
from .normal_equations import (
    NO_ROWS,
    Integers,
    PoseEquations,
    SegmentEquations,
    SurfaceRows,
    added,
    in_coordinates,
    joined,
    move_along,
    move_toward,
    screws,
    segment_equations,
    step,
    toward,
)
from .pose_from_joints import pose_from_frames
from .pose_priors import foretell, joint_limits, natural_stance, stay_near
from .ray_capsules import BodyPicture, cast_rays
from .shape import MEASURES, N_LENGTHS, resized, shape_jacobian
from .tables import (
    CAPSULE_SEGMENTS,
    CAPSULES,
    END_SEGMENTS,
    JOINTS,
    LENGTHS,
    SEGMENTS,
    SIDES,
    USUAL_STATURE,
)

__all__ = [
    "CAPSULES",
    "CAPSULE_SEGMENTS",
    "COORDINATES",
    "END_SEGMENTS",
    "JOINTS",
    "LENGTHS",
    "MEASURES",
    "NO_ROWS",
    "N_COORDINATES",
    "N_LENGTHS",
    "N_ROOT",
    "N_SEGMENTS",
    "SEGMENTS",
    "SIDES",
    "USUAL_STATURE",
    "BodyModel",
    "BodyPicture",
    "BodySurface",
    "Integers",
    "LocalPca",
    "MotionPrior",
    "PoseEquations",
    "SegmentEquations",
    "SurfaceRows",
    "added",
    "body_motion",
    "body_skeleton",
    "capsule_surface",
    "cast_rays",
    "foretell",
    "in_coordinates",
    "joined",
    "joint_limits",
    "joint_positions",
    "learn_motion_prior",
    "load_body_model",
    "load_motion_prior",
    "local_pca",
    "motion_frames",
    "move_along",
    "move_toward",
    "natural_stance",
    "pose_from_frames",
    "resized",
    "rest_frames",
    "scene_from_camera",
    "screws",
    "segment_equations",
    "segment_frames",
    "segment_twists",
    "shape_jacobian",
    "stay_near",
    "step",
    "toward",
    "usual_body",
]
