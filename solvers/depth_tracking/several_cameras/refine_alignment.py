"""Refine where and when cameras recorded, by the images themselves."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy

from ...arrays import Array
from ...progress import Progress
from ...rotations import skew_matrices
from ..body import (
    CAPSULE_SEGMENTS,
    N_COORDINATES,
    joint_limits,
    natural_stance,
    screw_rows,
    sum_equations,
)
from ..capturing import prior_near
from ..terms import likelihood_rows
from .align_tracks import CameraAlignment
from .track_views import ViewedActor
from .views import CameraTake, View, render_view

N_FRAMES, _N_STEPS = 32, 4
"""Number of frames from which the cameras are refined, and of Gauss-Newton steps. They bound
the run time."""
_N_UNKNOWNS = 7
"""Twist of a camera and its time offset, by definition."""
_STIFFNESS = np.array([3e4, 3e4, 3e4, 1e4, 1e4, 1e4, 3e5])
"""Weights per square radian, square meter and square second of a change of the alignment by
skeletons. They guard a straight walk, which shows no difference between a later time and
another position (`test_straight_walk_keeps_the_time_of_the_skeletons`)."""


@dataclass(frozen=True, eq=False)
class _Equations:
    """Normal equations of one frame: its pose, the cameras, and their coupling."""

    pose: Array
    cameras: Array
    coupling: Array
    pose_vector: Array
    camera_vector: Array


def refine_alignment(
    actor: ViewedActor, poses: dict[int, Array], rates: Array, progress: Progress
) -> ViewedActor:
    """Return the actor before cameras whose transforms and offsets fit the images better.

    Gauss-Newton steps solve jointly for the poses of some frames and for seven unknowns of
    each camera but the first: the twist of the scene in its frame, and its time offset, which
    moves the body along its velocity. The poses are eliminated frame by frame (Schur
    complement), as in a bundle adjustment [1]_. The alignment by skeletons is the prior.

    Parameters
    ----------
    actor : ViewedActor
    poses : dict of int and shape (36,)
        Of some frames that several cameras show.
    rates : shape (n_frames, 36)
        Their change in a frame.
    progress : Progress

    References
    ----------
    .. [1] Triggs, McLauchlan, Hartley, Fitzgibbon (2000). Bundle adjustment: a modern
       synthesis. Vision Algorithms: Theory and Practice. doi:10.1007/3-540-44480-7_21
    """
    current = dict(poses)
    change = np.zeros((len(actor.cameras), _N_UNKNOWNS))
    for step in range(_N_STEPS):
        moved, steps = _step(actor, current, rates, change)
        change = change + moved
        others = map(_moved, actor.cameras[1:], moved[1:])
        actor = replace(actor, cameras=(actor.cameras[0], *others))
        current = {frame: pose + steps[frame] for frame, pose in current.items()}
        progress((step + 1) / _N_STEPS, "Refining the cameras")
    return actor


def frames_to_refine(actor: ViewedActor) -> list[int]:
    """Return frames, evenly spaced, that as many cameras as possible show."""
    n_views = np.array([
        sum(camera.image_at(frame / actor.frame_rate) is not None for camera in actor.cameras)
        for frame in range(actor.n_frames)
    ])
    shared = np.flatnonzero(n_views == n_views.max())
    chosen = np.linspace(0, len(shared) - 1, min(N_FRAMES, len(shared))).round()
    return [int(frame) for frame in shared[chosen.astype(np.intp)]]


def _step(
    actor: ViewedActor, poses: dict[int, Array], rates: Array, change: Array
) -> tuple[Array, dict[int, Array]]:
    """Return the step of the cameras (n_cameras, 7), and of each pose (36,)."""
    n_cameras = len(actor.cameras)
    stiffness = np.tile(_STIFFNESS, n_cameras)
    matrix, vector = np.diag(stiffness), -stiffness * change.ravel()
    eliminated = {}
    for frame, pose in poses.items():
        found = _frame_equations(actor, frame, pose, rates[frame])
        both = np.concatenate([found.coupling, found.pose_vector[:, np.newaxis]], axis=1)
        solved = np.linalg.solve(found.pose, both)
        matrix = matrix + found.cameras - found.coupling.T @ solved[:, :-1]
        vector = vector + found.camera_vector - found.coupling.T @ solved[:, -1]
        eliminated[frame] = solved
    free = np.arange(_N_UNKNOWNS, matrix.shape[0])
    step = np.zeros(matrix.shape[0])
    step[free] = np.linalg.solve(matrix[np.ix_(free, free)], vector[free])
    poses_steps = {
        frame: solved[:, -1] - solved[:, :-1] @ step for frame, solved in eliminated.items()
    }
    return step.reshape(n_cameras, _N_UNKNOWNS), poses_steps


def _frame_equations(actor: ViewedActor, frame: int, pose: Array, rate: Array) -> _Equations:
    size = len(actor.cameras) * _N_UNKNOWNS
    prior = sum_equations([
        joint_limits(pose, actor.tracker.limit_weight),
        natural_stance(pose, 0.0, actor.tracker.ankle_weight),
        prior_near(pose)(pose),
    ])
    pose_matrix, pose_vector = prior.matrix, prior.vector
    cameras, camera_vector = np.zeros((size, size)), np.zeros(size)
    coupling = np.zeros((N_COORDINATES, size))
    for view in actor.views(frame, rate):
        number = _camera_of(actor.cameras, view)
        by_pose, by_camera, weights, residuals = _rows(actor, pose, rate, view)
        weighted = weights[:, np.newaxis] * by_pose
        pose_matrix = pose_matrix + by_pose.T @ weighted
        pose_vector = pose_vector + weighted.T @ residuals
        if number:
            these = slice(number * _N_UNKNOWNS, (number + 1) * _N_UNKNOWNS)
            cameras[these, these] += by_camera.T @ (weights[:, np.newaxis] * by_camera)
            camera_vector[these] += by_camera.T @ (weights * residuals)
            coupling[:, these] += weighted.T @ by_camera
    return _Equations(pose_matrix, cameras, coupling, pose_vector, camera_vector)


def _camera_of(cameras: Sequence[CameraTake], view: View) -> int:
    return next(
        number
        for number, camera in enumerate(cameras)
        if camera.alignment.camera_from_first is view.camera_from_first
    )


def _rows(
    actor: ViewedActor, pose: Array, rate: Array, view: View
) -> tuple[Array, Array, Array, Array]:
    """Return derivatives by pose (n, 36) and camera (n, 7), weights and residuals (n,)."""
    hypothesis = render_view(actor.body, pose, view)
    rows = likelihood_rows(hypothesis, view.observation, actor.tracker)
    screws = screw_rows(rows.points, rows.directions)
    segments = CAPSULE_SEGMENTS[rows.capsules]
    by_pose = np.einsum("ni,nik->nk", screws, hypothesis.twists[segments])
    by_time = by_pose @ (rate * actor.frame_rate)
    by_camera = np.concatenate([screws, by_time[:, np.newaxis]], axis=1)
    return by_pose, by_camera, rows.weights, rows.residuals


def _moved(camera: CameraTake, step: Array) -> CameraTake:
    """Return a camera after a twist of the scene in its frame, and a change of its offset."""
    old = camera.alignment
    moved = _exponential(step[:6]) @ old.camera_from_first
    return replace(
        camera, alignment=CameraAlignment(moved, old.offset + float(step[6]), old.mismatch)
    )


def _exponential(twist: Array) -> Array:
    """Return the rigid transform (4, 4) of a twist."""
    generator = np.zeros((4, 4))
    generator[:3, :3] = skew_matrices(twist[:3])
    generator[:3, 3] = twist[3:]
    return np.asarray(scipy.linalg.expm(generator))
