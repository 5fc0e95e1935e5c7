"""Find the poses in which a body's markers lie nearest to the markers seen."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..progress import Progress, unwatched
from ..rotations import quaternion_from_matrix, rotation_vector_from_quaternion
from .body import Body, Placed, Poses
from .vectors import skewed, turned_by

Array = NDArray[np.float64]
FRAMES_AT_ONCE = 256
STRAY = 3.0
"""Of a marker's noise: from this distance on it counts less and less."""
DAMPING = 1e-3
LEAST_DAMPING, MOST_DAMPING = 1e-6, 1e6
LARGEST_STEP = 0.5
"""Radians."""
SETTLED = 1e-4
"""Of the cost: smaller gains end the search."""


class Wrong(NamedTuple):
    """What is left to be made small, in units of what is usual, and how poses change it."""

    residuals: Array
    """Shape (n_frames, n_residuals)."""
    slopes: Array
    """By the pose, shape (n_frames, n_residuals, n_unknowns)."""
    weights: Array
    """Of the markers, per metre, shape (n_frames, n_markers, 1)."""
    placed: Placed


def fit_poses(
    body: Body,
    seen: Array,
    poses: Poses,
    *,
    most_steps: int = 12,
    progress: Progress = unwatched,
) -> Poses:
    """Turn joints until the markers fit: global optimisation [1]_ by Levenberg-Marquardt.

    All frames are sought for themselves, many at a time. Distances count by a Cauchy weight,
    so that a marker that is far off pulls little.

    Parameters
    ----------
    body : Body
    seen : shape (n_frames, n_markers, 3), metres
        In the order of the body's markers; NaN where not seen.
    poses : Poses
        Where to begin.
    most_steps : int
    progress : Progress

    References
    ----------
    .. [1] Lu, O'Connor (1999). Bone position estimation from skin marker co-ordinates using
       global optimisation with joint constraints. J Biomech 32(2).
       doi:10.1016/S0021-9290(98)00158-4
    """
    parts = []
    for start in range(0, len(seen), FRAMES_AT_ONCE):
        some = slice(start, start + FRAMES_AT_ONCE)
        begun = Poses(poses.turns[some], poses.roots[some])
        parts.append(_fit(body, seen[some], begun, most_steps))
        progress(min(1.0, (start + FRAMES_AT_ONCE) / len(seen)), "Fitting poses")
    return Poses(*(np.concatenate(part) for part in zip(*parts, strict=True)))


def _fit(body: Body, seen: Array, poses: Poses, most_steps: int) -> Poses:
    damping = np.full(len(seen), DAMPING)
    cost = cost_of(body, seen, poses)
    for _ in range(most_steps):
        wrong = wrong_by(body, seen, poses)
        normal = np.swapaxes(wrong.slopes, 1, 2) @ wrong.slopes
        slope = np.einsum("fru,fr->fu", wrong.slopes, wrong.residuals)
        diagonal = np.einsum("fuu->fu", normal)
        diagonal += damping[:, None] * (diagonal + 1.0)
        step = -np.linalg.solve(normal, slope[..., None])[..., 0]
        tried = stepped(body, poses, step)
        new_cost = cost_of(body, seen, tried)
        better = new_cost < cost
        poses = Poses(
            np.where(better[:, None, None, None], tried.turns, poses.turns),
            np.where(better[:, None], tried.roots, poses.roots),
        )
        settled = (cost - new_cost)[better] <= SETTLED * cost[better]
        cost = np.where(better, new_cost, cost)
        damping = np.where(better, damping / 5.0, damping * 8.0)
        damping = damping.clip(LEAST_DAMPING, MOST_DAMPING)
        if settled.all() and better.mean() > 0.5:
            break
    return poses


def stepped(body: Body, poses: Poses, step: Array) -> Poses:
    """Return poses after a step, shape (n_frames, 3 + 3 per turning joint)."""
    turns = poses.turns.copy()
    vectors = step[:, 3:].reshape(len(step), -1, 3)
    size = np.linalg.norm(vectors, axis=-1).max(axis=1).clip(min=LARGEST_STEP)
    vectors = vectors * (LARGEST_STEP / size)[:, None, None]
    turns[:, body.turning] = turned_by(vectors) @ turns[:, body.turning]
    return Poses(turns, poses.roots + step[:, :3])


def cost_of(body: Body, seen: Array, poses: Poses) -> Array:
    """Return what is wrong with each pose, shape (n_frames,)."""
    off = _off(body, seen, body.place_in(poses))
    square = (off**2).sum(axis=-1) / STRAY**2
    eases, _ = _ease(body, poses)
    return np.asarray(STRAY**2 * np.log1p(square).sum(axis=1) + (eases**2).sum(axis=1))


def wrong_by(body: Body, seen: Array, poses: Poses) -> Wrong:
    """Return the weighted residuals of markers, then those of what joints usually do."""
    placed = body.place_in(poses)
    off = _off(body, seen, placed)
    square = (off**2).sum(axis=-1, keepdims=True) / STRAY**2
    weight = 1.0 / np.sqrt(1.0 + square) / body.noise[:, None]
    weight = np.where(np.isfinite(seen).all(axis=-1, keepdims=True), weight, 0.0)
    moved = weight[..., None] * marker_slopes(body, placed)
    eases, ease_slopes = _ease(body, poses)
    n_frames, n_markers = off.shape[:2]
    residuals = (off * weight * body.noise[:, None]).reshape(n_frames, -1)
    return Wrong(
        np.concatenate([residuals, eases], axis=1),
        np.concatenate([moved.reshape(n_frames, 3 * n_markers, -1), ease_slopes], axis=1),
        weight,
        placed,
    )


def _off(body: Body, seen: Array, placed: Placed) -> Array:
    """Return how far each marker is off, in units of its noise; 0 where it is not seen."""
    return np.nan_to_num((placed.markers - seen) / body.noise[:, None])


def marker_slopes(body: Body, placed: Placed) -> Array:
    """Return how markers move with the pose, shape (n_frames, n_markers, 3, n_unknowns).

    A joint turns by a small rotation vector in its parent's axes.
    """
    n_frames, n_markers = placed.markers.shape[:2]
    slopes = np.zeros((n_frames, n_markers, 3, 1 + len(body.turning), 3))
    slopes[:, :, :, 0] = np.eye(3)
    number = {int(joint): index for index, joint in enumerate(body.turning, start=1)}
    for joint, index in number.items():
        below = [m for m in range(n_markers) if joint in body.path(int(body.bones[m]))]
        above = body.parents[joint]
        axes = placed.frames[:, above] if above >= 0 else np.eye(3)[None]
        arms = placed.markers[:, below] - placed.joints[:, [joint]]
        slopes[:, :, :, index][:, below] = -skewed(arms) @ axes[:, None]
    return slopes.reshape(n_frames, n_markers, 3, -1)


def _ease(body: Body, poses: Poses) -> tuple[Array, Array]:
    """Return residuals and slopes of what joints usually do."""
    n_unknowns = 3 + 3 * len(body.turning)
    residuals, slopes = [], []
    for number, joint in enumerate(body.turning):
        usual = body.joints[joint]
        for widths, wrong in ((usual.ease, _vector), (usual.hinge, _axis)):
            used = np.flatnonzero(widths)
            if not len(used):
                continue
            value, slope = wrong(poses.turns[:, joint])
            width = np.array(widths)[used]
            row = np.zeros((len(value), len(used), n_unknowns))
            row[:, :, 3 + 3 * number : 6 + 3 * number] = slope[:, used] / width[:, None]
            residuals.append(value[:, used] / width)
            slopes.append(row)
    return np.concatenate(residuals, axis=1), np.concatenate(slopes, axis=1)


def _vector(turns: Array) -> tuple[Array, Array]:
    """Return rotation vectors, and how a small turn before them changes them."""
    vectors = rotation_vector_from_quaternion(quaternion_from_matrix(turns))
    angle = np.linalg.norm(vectors, axis=-1)[:, None, None]
    small = angle < 1e-4
    safe = np.where(small, 1.0, angle)
    factor = 1.0 / safe**2 - (1.0 + np.cos(safe)) / (2.0 * safe * np.sin(safe) + 1e-9)
    skew = skewed(vectors)
    return vectors, np.eye(3) - 0.5 * skew + np.where(small, 1.0 / 12.0, factor) * skew @ skew


def _axis(turns: Array) -> tuple[Array, Array]:
    """Return where a joint's own X axis points, seen from its parent, and how it moves."""
    axis = turns[:, :, 0]
    return axis - np.array([1.0, 0.0, 0.0]), -skewed(axis)
