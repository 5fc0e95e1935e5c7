"""Fit the lengths and radii of a body to many frames at once; no reference pose is needed."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

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

Array = NDArray[np.float64]

_POSE_DAMPING = 5.0
_PRIOR_PIXELS = 100.0
"""How many pixels a prior counts as much as."""
_LONGEST_TURN, _LONGEST_GROWTH = 0.2, 0.1


@dataclass(frozen=True, kw_only=True)
class RefineBodySettings(Settings):
    """How a body is fitted to a recording."""

    n_frames: int = setting(
        24, "Frames looked at, spread over the recording; more is surer and slower",
        minimum=1, maximum=1000,
    )  # fmt: skip
    rounds: int = setting(
        6, "Times that body and poses are corrected; more is slower", minimum=1, maximum=100
    )
    length_spread: float = setting(
        0.08, "How much lengths may differ from those given, as a share; more trusts the"
        " pictures more", minimum=1e-3, maximum=1.0,
    )  # fmt: skip
    radius_spread: float = setting(
        0.2, "How much radii may differ from those given, as a share",
        minimum=1e-3, maximum=1.0,
    )  # fmt: skip


USUAL_REFINING = RefineBodySettings()


def refine_body(
    depth: DepthRecording,
    body: BodyModel,
    poses: Array,
    *,
    frames: NDArray[np.intp] | None = None,
    settings: RefineBodySettings = USUAL_REFINING,
    tracker: TrackerSettings = DEFAULT_TRACKER,
    progress: Progress = unwatched,
) -> BodyModel:
    """Return the body whose pictures fit best, and which is the same left and right.

    Lengths, radii and the poses of many frames are solved for together by damped Gauss-Newton
    steps over the depth image, closest surface and off-actor terms of the tracker; the poses
    are eliminated frame by frame (Schur complement), so that the cost grows linearly with the
    frames. Lengths and radii stay near those given as far as the pictures leave it open.

    Parameters
    ----------
    depth : DepthRecording
    body : BodyModel
        To start from, such as `default_body` of about the right stature.
    poses : shape (n_frames, 36)
        Of every frame, as tracked with this body.
    frames : int array, optional
        Which frames to look at; without them, evenly spread ones.
    settings : RefineBodySettings
    tracker : TrackerSettings
        Weights of the terms.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        The poses do not fit the recording, or no frame shows an actor.
    SolveCancelled
        Raised by `progress`.
    """
    if np.shape(poses) != (depth.n_frames, N_COORDINATES):
        raise InvalidMotionError(
            f"The poses have shape {np.shape(poses)}, not {(depth.n_frames, N_COORDINATES)}."
        )
    chosen = _spread(depth.n_frames, settings.n_frames) if frames is None else frames
    observations = [observe(depth, int(frame), tracker.picture_width) for frame in chosen]
    shown = [i for i, one in enumerate(observations) if not one.empty]
    if not shown:
        raise InvalidMotionError("No frame shows an actor; check how depth was cut out.")
    seen = [observations[i] for i in shown]
    current = [np.array(poses[chosen[i]], dtype=np.float64) for i in shown]
    body = body.symmetric()
    change = np.zeros(len(MEASURES))
    for turn in range(settings.rounds):
        growth, steps = _correction(resize_body(body, change), current, seen, change, settings,
                                    tracker)  # fmt: skip
        change = change + growth
        current = [pose + step for pose, step in zip(current, steps, strict=True)]
        progress((turn + 1) / settings.rounds, "Refining the body")
    return resize_body(body, change)


def _spread(n_frames: int, wanted: int) -> NDArray[np.intp]:
    places = np.linspace(0, n_frames - 1, min(wanted, n_frames))
    return np.unique(places.round().astype(np.intp)).astype(np.intp)


def _correction(
    body: BodyModel,
    poses: list[Array],
    observations: list[Observation],
    change: Array,
    settings: RefineBodySettings,
    tracker: TrackerSettings,
) -> tuple[Array, list[Array]]:
    """Return the step of the logarithms of measures, and of each pose."""
    spread = np.full(len(MEASURES), settings.radius_spread)
    spread[:N_LENGTHS] = settings.length_spread
    rigidity = _PRIOR_PIXELS * tracker.depth_weight * 1e-4 / spread**2
    matrix, vector = np.diag(rigidity), -rigidity * change
    back = []
    for pose, observation in zip(poses, observations, strict=True):
        of_pose, of_body, both, asked, grown = _frame_equations(
            body, pose, observation, tracker
        )
        solved = np.linalg.solve(of_pose, np.concatenate([both, asked[:, np.newaxis]], axis=1))
        matrix = matrix + (of_body - both.T @ solved[:, :-1]) / len(poses)
        vector = vector + (grown - both.T @ solved[:, -1]) / len(poses)
        back.append(solved)
    growth = np.linalg.solve(matrix, vector)
    growth *= min(1.0, _LONGEST_GROWTH / np.abs(growth).max())
    steps: list[Array] = [solved[:, -1] - solved[:, :-1] @ growth for solved in back]
    return growth, [one * min(1.0, _LONGEST_TURN / np.abs(one).max()) for one in steps]


def _frame_equations(
    body: BodyModel, pose: Array, observation: Observation, tracker: TrackerSettings
) -> tuple[Array, Array, Array, Array, Array]:
    """Return blocks of a frame's normal equations: pose, body, both, and right-hand sides."""
    hypothesis = render_hypothesis(body, pose, observation.camera)
    limits = joint_limits(pose, tracker.limit_weight)
    of_pose: Array = limits.matrix + _POSE_DAMPING * np.eye(N_COORDINATES)
    rows = _rows(hypothesis, observation, tracker)
    by_pose = pose_jacobian(hypothesis, rows)
    by_shape = shape_jacobian(body, hypothesis.frames, rows)
    heavy = rows.weights[:, np.newaxis] * by_pose
    heavy_shape = rows.weights[:, np.newaxis] * by_shape
    return (
        np.add(of_pose, by_pose.T @ heavy), by_shape.T @ heavy_shape, heavy.T @ by_shape,
        limits.vector + heavy.T @ rows.residuals, heavy_shape.T @ rows.residuals,
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
    """Return how each row's point moves along its direction with each coordinate, (n, 36)."""
    lines = screw_rows(rows.points, rows.directions)
    segments = CAPSULE_SEGMENTS[rows.capsules]
    moved = np.empty((len(lines), N_COORDINATES))
    for segment in np.unique(segments):
        these = segments == segment
        moved[these] = lines[these] @ hypothesis.twists[segment]
    return moved
