"""Trackers by iterative closest points, written from their papers on our body and solver.

Neither is its authors' code. Both get our body, joint limits, damping and prediction, so that
what is compared is how they tie the picture to the body.
"""

from collections.abc import Callable

import numpy as np
from scipy.spatial import cKDTree

from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.body.model import BodyModel
from solvers.depth_tracking.body.normal_equations import (
    SurfaceRows,
    concatenate_rows,
    equations_in_coordinates,
    rows_toward_targets,
    segment_equations,
    solve_step,
    sum_equations,
)
from solvers.depth_tracking.body.pose_priors import joint_limits, predict_pose, stay_near
from solvers.depth_tracking.body.segment_kinematics import joint_positions, segment_frames
from solvers.depth_tracking.terms.hypothesis import Hypothesis, render_hypothesis
from solvers.depth_tracking.terms.observation import Observation, observe, rays_through_pixels

ITERATIONS = 10
MAX_DISTANCE_M = 0.2
"""Meters; pairs with a larger distance are left out."""
DAMPING, LIMIT_WEIGHT, ROTATION_WEIGHT = 0.05, 1.0, 0.02
PREDICTION_WEIGHT = 0.7
Pairs = Callable[[Hypothesis, Observation], SurfaceRows]


def articulated_icp(depth: DepthRecording, body: BodyModel, pose: np.ndarray) -> np.ndarray:
    """Return joints (n_frames, 21, 3): every observed point pulls the closest visible point.

    Knoop, Vacek, Dillmann (2006), Sensor fusion for 3D human body tracking with an articulated
    3D body model, ICRA; Grest, Krueger, Koch (2007), Single view motion tracking by depth and
    silhouette information, SCIA: nonlinear least squares over joint angles.
    """
    return _track(depth, body, pose, _closest_points)


def ray_constrained_icp(depth: DepthRecording, body: BodyModel, pose: np.ndarray) -> np.ndarray:
    """Return joints (n_frames, 21, 3): closest points, and free space along the rays.

    Ganapathi, Plagemann, Koller, Thrun (2012), Real-time human pose tracking from range data,
    ECCV, section 3: a visible point of the model that lies in front of what its ray measured
    goes back along the ray, one whose ray met nothing goes to the nearest ray that did.
    """
    return _track(depth, body, pose, _with_rays)


def _closest_points(hypothesis: Hypothesis, observation: Observation) -> SurfaceRows:
    distances, nearest = cKDTree(hypothesis.points).query(observation.points)
    near = distances < MAX_DISTANCE_M
    moved = nearest[near]
    return rows_toward_targets(
        hypothesis.points[moved], observation.points[near], np.full(len(moved), 1.0),
        hypothesis.image.capsules[moved],
    )  # fmt: skip


def _with_rays(hypothesis: Hypothesis, observation: Observation) -> SurfaceRows:
    pixels, points = hypothesis.image.pixels, hypothesis.points
    depths = observation.flat[pixels]
    nearest = observation.nearest_pixel[pixels]
    off = depths == 0.0
    targets = points.copy()
    targets[off] = points[off, 2:] * rays_through_pixels(observation.camera, nearest[off])
    before = ~off & (hypothesis.image.depths < depths)
    targets[before] = hypothesis.rays[before] * depths[before][:, np.newaxis]
    broken = np.flatnonzero(off | before)
    weights = np.full(len(broken), 1.0)
    far = np.linalg.norm(targets[broken] - points[broken], axis=1) > MAX_DISTANCE_M
    weights[far] = 0.0
    rays = rows_toward_targets(
        points[broken], targets[broken], weights, hypothesis.image.capsules[broken]
    )
    return concatenate_rows([_closest_points(hypothesis, observation), rays])


def _track(
    depth: DepthRecording, body: BodyModel, pose: np.ndarray, pairs: Pairs
) -> np.ndarray:
    poses = [pose]
    for frame in range(depth.n_frames):
        observation = observe(depth, frame, 160)
        expected = predict_pose(poses[1:] or poses, PREDICTION_WEIGHT)
        poses.append(_registered(body, expected, observation, pairs))
    return joint_positions(body, segment_frames(body, np.array(poses[1:])))


def _registered(
    body: BodyModel, expected: np.ndarray, observation: Observation, pairs: Pairs
) -> np.ndarray:
    pose = expected
    if not len(observation.points):
        return pose
    for _ in range(ITERATIONS):
        hypothesis = render_hypothesis(body, pose, observation.camera)
        if not len(hypothesis.points):
            return pose
        rows = segment_equations(pairs(hypothesis, observation))
        equations = sum_equations([
            equations_in_coordinates([rows], hypothesis.twists),
            joint_limits(pose, LIMIT_WEIGHT),
            stay_near(pose, expected, np.full(36, ROTATION_WEIGHT)),
        ])
        change = solve_step(equations, np.full(36, DAMPING))
        pose = pose + change * min(1.0, 0.35 / np.abs(change).max())
        if np.abs(change).max() < 1e-3:
            break
    return pose
