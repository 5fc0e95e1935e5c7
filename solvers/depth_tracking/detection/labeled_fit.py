"""Fit a body to depth pixels with soft part labels."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Integers
from ...rotations import nearest_rotations
from ..body import (
    CAPSULE_SEGMENTS,
    COORDINATES,
    LIMIT_WEIGHT,
    MAX_STEP,
    N_COORDINATES,
    N_ROOT,
    BodyModel,
    PoseEquations,
    SegmentEquations,
    equations_along_directions,
    equations_in_coordinates,
    equations_toward_targets,
    joint_limits,
    segment_frames,
    segment_twists,
    solve_step,
    stay_near,
    sum_equations,
)
from ..forest import PARTS
from ..terms import capsule_offsets
from .part_capsules import CAPSULE_OF_PART, PART_CAPSULES, PART_SEGMENTS, part_axes
from .robust_parts import FoundParts

EquationList = list[SegmentEquations]

REST_WEIGHT = 2e-3
"""Weight per square radian; a fully observed part weighs 1 per square meter. Chosen by hand;
`make sensitivity` varies it."""
MAX_RESIDUAL_M = 0.08
"""Pixels farther from the surface of their part have a limited pull. Chosen by hand;
`make sensitivity` varies it."""
SURFACE_STD_M = 0.06
"""Standard deviation of pixels from the surface of their part. Half and twice are no better
(`make sensitivity`)."""
CENTERS_WEIGHT = 0.3
"""Weight of the centers of parts, which are biased where a part is partly hidden, next to its
surface. Chosen by hand; `make sensitivity` varies it."""
MIN_PROBABILITY = 0.02
"""Minimum probability of a part. Half and twice are no better (`make sensitivity`)."""
TRUNK_PARTS = ("hips", "spine", "chest", "neck", "head", "Shoulder", "UpperArm")
"""Parts that determine position and heading; all parts if fewer than four are observed."""


def first_pose(body: BodyModel, parts: FoundParts) -> Array:
    """Return the pose (36,) at rest, aligned to the trunk parts by least squares."""
    trunk = np.array([part.endswith(TRUNK_PARTS) for part in PARTS])
    observed = np.flatnonzero(trunk & (parts.weights > 0.0))
    if len(observed) < 4:
        observed = np.flatnonzero(parts.weights)
    pose = np.zeros(N_COORDINATES)
    rest = _part_centers(body, segment_frames(body, pose))[observed]
    targets, weights = (
        parts.centers[observed],
        parts.weights[observed] / parts.weights[observed].sum(),
    )
    start, stop = weights @ rest, weights @ targets
    inverse_rotation, _ = nearest_rotations(
        (rest - start).T @ ((targets - stop) * weights[:, np.newaxis])
    )
    rotation = inverse_rotation.T
    pose[:3] = stop - rotation @ start
    for name, angle in zip(("yaw", "roll", "pitch"), _root_angles(rotation), strict=True):
        pose[COORDINATES.index(name)] = angle
    return pose


def fit_parts(
    body: BodyModel, parts: FoundParts, start: Array, *, iterations: int = 14
) -> Array:
    """Return the pose (36,) fitted to detected parts.

    First the part centers are aligned, as in Wei, Zhang, Chai 2012 (4.2). Centers of partly
    hidden parts are biased, so a second stage also fits the surface of each part to its pixels.
    """
    capsules = PART_CAPSULES[parts.labels]

    def middles(frames: Array) -> EquationList:
        return [_centers_term(body, frames, parts, 1.0)]

    def surfaces(frames: Array) -> EquationList:
        return [
            _centers_term(body, frames, parts, CENTERS_WEIGHT),
            _surface_term(body, frames, parts.points, capsules),
        ]

    near = _minimize(body, start, middles, iterations - iterations // 2)
    return _minimize(body, near, surfaces, iterations // 2)


def fit_pixels(
    body: BodyModel,
    points: Array,
    probabilities: NDArray[np.float32],
    start: Array,
    *,
    rounds: int = 2,
    iterations: int = 4,
) -> Array:
    """Return the pose (36,) fitted to pixels, each assigned to its most probable part.

    Two steps alternate: assign each pixel to the part that is likely by the forest and near by
    the pose, and fit the body to the assignment. This corrects legs that the forest confused.

    Parameters
    ----------
    body : BodyModel
    points : shape (n, 3), meters
    probabilities : shape (n, N_PARTS)
        Probability of each part for each point.
    start : shape (36,)
    rounds : int
        Number of assignments.
    iterations : int
        Steps of each round.
    """
    label_costs = -np.log(probabilities @ CAPSULE_OF_PART + MIN_PROBABILITY)
    pose = start
    for _ in range(rounds):
        distances = capsule_distances(body, segment_frames(body, pose), points)
        capsules = np.argmin(0.5 * (distances / SURFACE_STD_M) ** 2 + label_costs, axis=1)
        is_near = np.abs(distances[np.arange(len(points)), capsules]) < 2.0 * MAX_RESIDUAL_M

        def surfaces(
            frames: Array, of: Integers = capsules, kept: Integers = is_near
        ) -> EquationList:
            return [_surface_term(body, frames, points[kept], of[kept])]

        pose = _minimize(body, pose, surfaces, iterations)
    return pose


def capsule_distances(body: BodyModel, frames: Array, points: Array) -> Array:
    """Return the signed distances (n, 19), meters, of points (n, 3) to the capsules.

    First order for elliptic capsules.
    """
    frame = frames[CAPSULE_SEGMENTS]
    scales = 1.0 / body.radii[:, [0, 1, 1]]
    starts, stops = body.capsule_ends.swapaxes(0, 1) * scales
    axes = stops - starts
    local = np.einsum("nji,pnj->pni", frame[:, :3, :3], points[:, np.newaxis] - frame[:, :3, 3])
    out = local * scales - starts
    along = np.einsum("pni,ni->pn", out, axes / (axes**2).sum(axis=1, keepdims=True))
    out -= np.clip(along, 0.0, 1.0)[..., np.newaxis] * axes
    size = np.sqrt(np.einsum("pni,pni->pn", out, out)) + 1e-12
    gradient_norms = (
        np.sqrt(np.einsum("pni,pni->pn", out * scales, out * scales)) / size + 1e-12
    )
    distances: Array = (size - 1.0) / gradient_norms
    return distances


def _minimize(
    body: BodyModel,
    start: Array,
    equations_at: Callable[[Array], EquationList],
    iterations: int,
) -> Array:
    """Minimize by damped steps with soft joint limits; unobserved coordinates stay at rest."""
    rest = np.zeros(N_COORDINATES)
    damping, best, lowest = 1e-2, start, np.inf
    equations: PoseEquations | None = None
    pose = start
    for _ in range(iterations):
        frames = segment_frames(body, pose)
        rest[:N_ROOT] = pose[:N_ROOT]
        found = sum_equations([
            equations_in_coordinates(equations_at(frames), segment_twists(pose, frames)),
            joint_limits(pose, LIMIT_WEIGHT),
            stay_near(pose, rest, _REST_WEIGHTS),
        ])  # fmt: skip
        if equations is None or found.cost < lowest:
            equations, best, lowest, damping = found, pose, found.cost, 0.3 * damping
        else:
            damping = max(10.0 * damping, 1e-3)
        change = solve_step(equations, np.full(N_COORDINATES, max(damping, 1e-6)))
        pose = best + change * min(1.0, MAX_STEP / max(float(np.abs(change).max()), 1e-9))
    return best


_REST_WEIGHTS = np.array([0.0] * N_ROOT + [REST_WEIGHT] * (N_COORDINATES - N_ROOT))


def _centers_term(
    body: BodyModel, frames: Array, parts: FoundParts, weight: float
) -> SegmentEquations:
    observed = np.flatnonzero(parts.weights)
    return equations_toward_targets(
        _part_centers(body, frames)[observed],
        parts.centers[observed],
        weight * parts.weights[observed],
        PART_SEGMENTS[observed],
    )


def _surface_term(
    body: BodyModel, frames: Array, points: Array, capsules: Integers
) -> SegmentEquations:
    """Return equations that fit capsule surfaces to points, with equal capsule weights."""
    size, slope = capsule_offsets(body, frames, points, capsules)
    gradient_norms = np.maximum(np.linalg.norm(slope, axis=1), 1e-9)
    outside = (size - 1.0) / gradient_norms
    counts = np.bincount(capsules, minlength=len(CAPSULE_SEGMENTS))[capsules]
    robust = 1.0 / np.maximum(1.0, np.abs(outside) / MAX_RESIDUAL_M)
    return equations_along_directions(
        points,
        slope / gradient_norms[:, np.newaxis],
        outside,
        robust / np.maximum(counts, 10),
        CAPSULE_SEGMENTS[capsules],
    )


def _part_centers(body: BodyModel, frames: Array) -> Array:
    carriers = frames[PART_SEGMENTS]
    middles = part_axes(body).mean(axis=1)
    centers: Array = np.einsum("nij,nj->ni", carriers[:, :3, :3], middles) + carriers[:, :3, 3]
    return centers


def _root_angles(rotation: Array) -> tuple[float, float, float]:
    """Return yaw, roll and pitch of a rotation matrix: about y, then z, then x."""
    roll = np.arcsin(np.clip(rotation[1, 0], -1.0, 1.0))
    yaw = np.arctan2(-rotation[2, 0], rotation[0, 0])
    pitch = np.arctan2(-rotation[1, 2], rotation[1, 1])
    return float(yaw), float(roll), float(pitch)
