"""Fit lengths and radii of a body to many frames jointly, without a reference pose."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...depth_scene import DepthRecording
from ...errors import InvalidMotionError
from ...progress import Progress, unwatched
from ...settings import Settings, setting
from ..body import (
    CAPSULE_SEGMENTS,
    MEASURES,
    N_COORDINATES,
    N_LENGTHS,
    BodyModel,
    SurfaceRows,
    concatenate_rows,
    joint_limits,
    resize_body,
    screw_rows,
    shape_jacobian,
)
from ..terms import (
    DEFAULT_TRACKER,
    REFERENCE_AREA_M2,
    Hypothesis,
    Observation,
    TrackerSettings,
    closest_surface_term,
    depth_image_term,
    group_pixels,
    observe,
    off_actor_term,
    pixel_area,
    render_hypothesis,
)

_POSE_DAMPING = 5.0
"""Weight per square radian of a change of pose in one step. Half and twice are no better
(`make sensitivity`)."""
_PRIOR_WEIGHT_PIXELS = 100.0
"""Number of pixels that weigh as much as the prior. Chosen by hand; `make sensitivity` varies
it."""
_MAX_POSE_STEP, _MAX_SHAPE_STEP = 0.2, 0.1
"""Maximum change in one step: of the pose, radians or meters; of the shape, a ratio. Chosen by
hand; `make sensitivity` varies them."""


@dataclass(frozen=True, kw_only=True)
class RefineBodySettings(Settings):
    """Settings of the body fit."""

    n_frames: int = setting(
        24, "Frames sampled over the recording; higher is more robust and slower",
        minimum=1, maximum=1000,
    )  # fmt: skip
    rounds: int = setting(
        6, "Gauss-Newton steps of body and poses; higher is slower", minimum=1, maximum=100
    )
    length_spread: float = setting(
        0.08, "Relative standard deviation of lengths from the initial body; higher follows"
        " images more", minimum=1e-3, maximum=1.0,
    )  # fmt: skip
    radius_spread: float = setting(
        0.2, "Relative standard deviation of radii from the initial body",
        minimum=1e-3, maximum=1.0,
    )  # fmt: skip


DEFAULT_REFINING = RefineBodySettings()


def refine_body(
    depth: DepthRecording,
    body: BodyModel,
    poses: Array,
    *,
    frames: NDArray[np.intp] | None = None,
    settings: RefineBodySettings = DEFAULT_REFINING,
    tracker: TrackerSettings = DEFAULT_TRACKER,
    progress: Progress = unwatched,
) -> BodyModel:
    """Return the symmetric body with the best fit to the images.

    Damped Gauss-Newton steps solve jointly for lengths, radii and the poses of many frames.
    They use the depth image, closest surface and off-actor terms of the tracker. The poses are
    eliminated frame by frame (Schur complement), so that the cost grows linearly with the
    frames. A prior keeps unobserved lengths and radii near the initial body.

    Parameters
    ----------
    depth : DepthRecording
    body : BodyModel
        Initial body, such as `default_body` of about the right stature.
    poses : shape (n_frames, 36)
        Poses of all frames, tracked with this body.
    frames : int array, optional
        Frames to use. Default: evenly spaced frames.
    settings : RefineBodySettings
    tracker : TrackerSettings
        Weights of the terms.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        The poses do not match the recording, or no frame shows an actor.
    SolveCancelled
        Raised by `progress`.
    """
    if np.shape(poses) != (depth.n_frames, N_COORDINATES):
        raise InvalidMotionError(
            f"The poses have shape {np.shape(poses)}, not {(depth.n_frames, N_COORDINATES)}."
        )
    sampled = _evenly_spaced(depth.n_frames, settings.n_frames) if frames is None else frames
    observations = [observe(depth, int(frame), tracker.image_width) for frame in sampled]
    non_empty = [i for i, one in enumerate(observations) if not one.empty]
    if not non_empty:
        raise InvalidMotionError(
            "No frame shows an actor. Check the segmentation of the depth images."
        )
    visible_observations = [observations[i] for i in non_empty]
    current = [np.array(poses[sampled[i]], dtype=np.float64) for i in non_empty]
    body = body.symmetric()
    change = np.zeros(len(MEASURES))
    for round_index in range(settings.rounds):
        shape_step, steps = _gauss_newton_step(
            resize_body(body, change), current, visible_observations, change, settings, tracker
        )
        change = change + shape_step
        current = [pose + step for pose, step in zip(current, steps, strict=True)]
        progress((round_index + 1) / settings.rounds, "Refining the body")
    return resize_body(body, change)


def _evenly_spaced(n_frames: int, n_samples: int) -> NDArray[np.intp]:
    positions = np.linspace(0, n_frames - 1, min(n_samples, n_frames))
    return np.unique(positions.round().astype(np.intp)).astype(np.intp)


def _gauss_newton_step(
    body: BodyModel,
    poses: list[Array],
    observations: list[Observation],
    change: Array,
    settings: RefineBodySettings,
    tracker: TrackerSettings,
) -> tuple[Array, list[Array]]:
    """Return the step of the log measures, and of each pose."""
    relative_spread = np.full(len(MEASURES), settings.radius_spread)
    relative_spread[:N_LENGTHS] = settings.length_spread
    rigidity = _PRIOR_WEIGHT_PIXELS * tracker.depth_weight * 1e-4 / relative_spread**2
    matrix, vector = np.diag(rigidity), -rigidity * change
    eliminated = []
    for pose, observation in zip(poses, observations, strict=True):
        pose_matrix, shape_matrix, coupling, pose_vector, shape_vector = _frame_equations(
            body, pose, observation, tracker
        )
        solved = np.linalg.solve(
            pose_matrix, np.concatenate([coupling, pose_vector[:, np.newaxis]], axis=1)
        )
        matrix = matrix + (shape_matrix - coupling.T @ solved[:, :-1]) / len(poses)
        vector = vector + (shape_vector - coupling.T @ solved[:, -1]) / len(poses)
        eliminated.append(solved)
    shape_step = np.linalg.solve(matrix, vector)
    shape_step *= min(1.0, _MAX_SHAPE_STEP / np.abs(shape_step).max())
    steps: list[Array] = [solved[:, -1] - solved[:, :-1] @ shape_step for solved in eliminated]
    return shape_step, [one * min(1.0, _MAX_POSE_STEP / np.abs(one).max()) for one in steps]


def _frame_equations(
    body: BodyModel, pose: Array, observation: Observation, tracker: TrackerSettings
) -> tuple[Array, Array, Array, Array, Array]:
    """Return blocks of a frame's normal equations: pose, shape, coupling, right-hand sides."""
    hypothesis = render_hypothesis(body, pose, observation.camera, observation.occluders)
    limits = joint_limits(pose, tracker.limit_weight)
    pose_matrix: Array = limits.matrix + _POSE_DAMPING * np.eye(N_COORDINATES)
    rows = _rows(hypothesis, observation, tracker)
    by_pose = pose_jacobian(hypothesis, rows)
    by_shape = shape_jacobian(body, hypothesis.frames, rows)
    weighted_pose = rows.weights[:, np.newaxis] * by_pose
    weighted_shape = rows.weights[:, np.newaxis] * by_shape
    return (
        np.add(pose_matrix, by_pose.T @ weighted_pose),
        by_shape.T @ weighted_shape, weighted_pose.T @ by_shape,
        limits.vector + weighted_pose.T @ rows.residuals, weighted_shape.T @ rows.residuals,
    )  # fmt: skip


def _rows(
    hypothesis: Hypothesis, observation: Observation, tracker: TrackerSettings
) -> SurfaceRows:
    groups = group_pixels(hypothesis, observation, tracker.limit)
    area, scale = pixel_area(observation) / REFERENCE_AREA_M2, tracker.robust_scale
    return concatenate_rows([
        depth_image_term(hypothesis, observation, groups, area * tracker.depth_weight),
        closest_surface_term(
            hypothesis, observation.points, area * tracker.closest_weight, scale
        ),
        off_actor_term(hypothesis, observation, groups, area * tracker.off_actor_weight, scale),
    ])  # fmt: skip


def pose_jacobian(hypothesis: Hypothesis, rows: SurfaceRows) -> Array:
    """Return the derivatives (n, 36) of the rows' residuals by the coordinates."""
    lines = screw_rows(rows.points, rows.directions)
    segments = CAPSULE_SEGMENTS[rows.capsules]
    jacobian = np.empty((len(lines), N_COORDINATES))
    for segment in np.unique(segments):
        these = segments == segment
        jacobian[these] = lines[these] @ hypothesis.twists[segment]
    return jacobian
