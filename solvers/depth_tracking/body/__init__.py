"""The tracked body: a pose as coordinates, segments, capsules and their derivatives."""

from typing import TYPE_CHECKING

from ...import_on_demand import import_on_demand

if TYPE_CHECKING:
    from .capsule_surface import BodySurface, capsule_surface
    from .coordinates import COORDINATES, N_COORDINATES, N_ROOT
    from .learn_motion_prior import learn_motion_prior
    from .model import BodyModel, default_body, load_body_model
    from .motion import (
        body_motion,
        body_skeleton,
        motion_frames,
        rest_frames,
        scene_from_camera,
    )
    from .motion_prior import LocalPca, MotionPrior, load_motion_prior, local_pca
    from .normal_equations import (
        NO_ROWS,
        PoseEquations,
        SegmentEquations,
        SurfaceRows,
        concatenate_rows,
        equations_along_directions,
        equations_in_coordinates,
        equations_toward_targets,
        rows_toward_targets,
        screw_rows,
        segment_equations,
        solve_step,
        sum_equations,
    )
    from .pose_from_joints import pose_from_frames
    from .pose_priors import (
        LIMIT_WEIGHT,
        MAX_STEP,
        joint_limits,
        natural_stance,
        predict_pose,
        stay_near,
    )
    from .ray_capsules import MIN_DEPTH_M, BodyImage, cast_rays
    from .segment_kinematics import N_SEGMENTS, joint_positions, segment_frames, segment_twists
    from .shape import MEASURES, N_LENGTHS, resize_body, shape_jacobian
    from .tables import (
        CAPSULE_SEGMENTS,
        CAPSULES,
        END_SEGMENTS,
        JOINTS,
        LENGTHS,
        SEGMENTS,
    )

__all__ = [
    "CAPSULES",
    "CAPSULE_SEGMENTS",
    "COORDINATES",
    "END_SEGMENTS",
    "JOINTS",
    "LENGTHS",
    "LIMIT_WEIGHT",
    "MAX_STEP",
    "MEASURES",
    "MIN_DEPTH_M",
    "NO_ROWS",
    "N_COORDINATES",
    "N_LENGTHS",
    "N_ROOT",
    "N_SEGMENTS",
    "SEGMENTS",
    "BodyImage",
    "BodyModel",
    "BodySurface",
    "LocalPca",
    "MotionPrior",
    "PoseEquations",
    "SegmentEquations",
    "SurfaceRows",
    "body_motion",
    "body_skeleton",
    "capsule_surface",
    "cast_rays",
    "concatenate_rows",
    "default_body",
    "equations_along_directions",
    "equations_in_coordinates",
    "equations_toward_targets",
    "joint_limits",
    "joint_positions",
    "learn_motion_prior",
    "load_body_model",
    "load_motion_prior",
    "local_pca",
    "motion_frames",
    "natural_stance",
    "pose_from_frames",
    "predict_pose",
    "resize_body",
    "rest_frames",
    "rows_toward_targets",
    "scene_from_camera",
    "screw_rows",
    "segment_equations",
    "segment_frames",
    "segment_twists",
    "shape_jacobian",
    "solve_step",
    "stay_near",
    "sum_equations",
]

import_on_demand(__name__)
