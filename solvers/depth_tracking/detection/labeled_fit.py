"""Fit a body to pixels of which it is told, more or less surely, what part they see."""

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ..body import (
    CAPSULE_SEGMENTS,
    COORDINATES,
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

Array = NDArray[np.float64]
Integers = NDArray[np.intp]
Asked = list[SegmentEquations]

LIMIT_WEIGHT = 1.0
REST_WEIGHT = 2e-3
"""Per square radian, where a part that is wholly seen weighs 1 per square metre."""
FARTHEST = 0.08
"""Metres. Pixels farther from their part's surface pull as if they were so far."""
ROUGHNESS = 0.06
"""Metres: standard deviation of pixels from the surface of their part."""
UNTOLD = 0.02
"""How likely a part is at least of which the forest tells nothing."""
LONGEST_STEP = 0.5
TRUNK = ("hips", "spine", "chest", "neck", "head", "Shoulder", "UpperArm")
"""Parts that tell where the body is and which way it faces; upper legs where these lack."""


def first_pose(body: BodyModel, parts: FoundParts) -> Array:
    """Return the pose (36,) at rest, moved and turned as the trunk's parts tell [1]_.

    References
    ----------
    .. [1] Kabsch (1976). A solution for the best rotation to relate two sets of vectors.
    """
    trunk = np.array([part.endswith(TRUNK) for part in PARTS])
    seen = np.flatnonzero(trunk & (parts.weights > 0.0))
    if len(seen) < 4:
        seen = np.flatnonzero(parts.weights)
    pose = np.zeros(N_COORDINATES)
    rest = _middles(body, segment_frames(body, pose))[seen]
    found, share = parts.centres[seen], parts.weights[seen] / parts.weights[seen].sum()
    start, stop = share @ rest, share @ found
    left, _, right = np.linalg.svd((rest - start).T @ ((found - stop) * share[:, np.newaxis]))
    mirror = np.sign(np.linalg.det(left @ right))
    turn = (left * [1.0, 1.0, mirror] @ right).T
    pose[:3] = stop - turn @ start
    for name, angle in zip(("yaw", "roll", "pitch"), _root_angles(turn), strict=True):
        pose[COORDINATES.index(name)] = angle
    return pose


def fit_parts(
    body: BodyModel, parts: FoundParts, start: Array, *, iterations: int = 14
) -> Array:
    """Return the pose (36,) whose parts lie where they were found.

    First the middles of parts are met, as in Wei, Zhang, Chai 2012 (4.2); then, since middles
    of parts half hidden are wrong, the surface of each part goes through its own pixels too.
    """
    capsules = PART_CAPSULES[parts.labels]

    def middles(frames: Array) -> Asked:
        return [_middles_term(body, frames, parts, 1.0)]

    def surfaces(frames: Array) -> Asked:
        return [
            _middles_term(body, frames, parts, 0.3),
            _surface_term(body, frames, parts.points, capsules),
        ]

    near = _descended(body, start, middles, iterations - iterations // 2)
    return _descended(body, near, surfaces, iterations // 2)


def fit_pixels(
    body: BodyModel,
    points: Array,
    shares: NDArray[np.float32],
    start: Array,
    *,
    rounds: int = 2,
    iterations: int = 4,
) -> Array:
    """Return the pose (36,) whose surface goes through the pixels, each on its likeliest part.

    In turn, each pixel is given to the part that is likely by the forest and near by the pose,
    and the body is fitted to what its parts were given. So what the forest took for the wrong
    leg comes to the right one.

    Parameters
    ----------
    body : BodyModel
    points : shape (n, 3), metres
    shares : shape (n, N_PARTS)
        How likely each point is of each part.
    start : shape (36,)
    rounds : int
        How often pixels are given to parts.
    iterations : int
        Steps of each round.
    """
    told = -np.log(shares @ CAPSULE_OF_PART + UNTOLD)
    pose = start
    for _ in range(rounds):
        far = capsule_distances(body, segment_frames(body, pose), points)
        capsules = np.argmin(0.5 * (far / ROUGHNESS) ** 2 + told, axis=1)
        given = np.abs(far[np.arange(len(points)), capsules]) < 2.0 * FARTHEST

        def surfaces(frames: Array, of: Integers = capsules, kept: Integers = given) -> Asked:
            return [_surface_term(body, frames, points[kept], of[kept])]

        pose = _descended(body, pose, surfaces, iterations)
    return pose


def capsule_distances(body: BodyModel, frames: Array, points: Array) -> Array:
    """Return how far points (n, 3) are outside each capsule, (n, 19), metres.

    Where a capsule is elliptic, to first order.
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
    steep = np.sqrt(np.einsum("pni,pni->pn", out * scales, out * scales)) / size + 1e-12
    distances: Array = (size - 1.0) / steep
    return distances


def _descended(
    body: BodyModel, start: Array, asked: Callable[[Array], Asked], iterations: int
) -> Array:
    """Take damped least-squares steps within soft joint limits; what nothing tells rests."""
    rest = np.zeros(N_COORDINATES)
    damping, best, lowest = 1e-2, start, np.inf
    equations: PoseEquations | None = None
    pose = start
    for _ in range(iterations):
        frames = segment_frames(body, pose)
        rest[:N_ROOT] = pose[:N_ROOT]
        found = sum_equations([
            equations_in_coordinates(asked(frames), segment_twists(pose, frames)),
            joint_limits(pose, LIMIT_WEIGHT),
            stay_near(pose, rest, _REST_WEIGHTS),
        ])  # fmt: skip
        if equations is None or found.cost < lowest:
            equations, best, lowest, damping = found, pose, found.cost, 0.3 * damping
        else:
            damping = max(10.0 * damping, 1e-3)
        change = solve_step(equations, np.full(N_COORDINATES, max(damping, 1e-6)))
        pose = best + change * min(1.0, LONGEST_STEP / max(float(np.abs(change).max()), 1e-9))
    return best


_REST_WEIGHTS = np.array([0.0] * N_ROOT + [REST_WEIGHT] * (N_COORDINATES - N_ROOT))


def _middles_term(
    body: BodyModel, frames: Array, parts: FoundParts, weight: float
) -> SegmentEquations:
    seen = np.flatnonzero(parts.weights)
    return equations_toward_targets(
        _middles(body, frames)[seen],
        parts.centres[seen],
        weight * parts.weights[seen],
        PART_SEGMENTS[seen],
    )


def _surface_term(
    body: BodyModel, frames: Array, points: Array, capsules: Integers
) -> SegmentEquations:
    """Ask the surface of each capsule to go through its points; each capsule weighs alike."""
    size, slope = capsule_offsets(body, frames, points, capsules)
    steep = np.maximum(np.linalg.norm(slope, axis=1), 1e-9)
    outside = (size - 1.0) / steep
    counts = np.bincount(capsules, minlength=len(CAPSULE_SEGMENTS))[capsules]
    robust = 1.0 / np.maximum(1.0, np.abs(outside) / FARTHEST)
    return equations_along_directions(
        points,
        slope / steep[:, np.newaxis],
        outside,
        robust / np.maximum(counts, 10),
        CAPSULE_SEGMENTS[capsules],
    )


def _middles(body: BodyModel, frames: Array) -> Array:
    carrier = frames[PART_SEGMENTS]
    middles = part_axes(body).mean(axis=1)
    placed: Array = np.einsum("nij,nj->ni", carrier[:, :3, :3], middles) + carrier[:, :3, 3]
    return placed


def _root_angles(turn: Array) -> tuple[float, float, float]:
    """Return yaw, roll and pitch of a rotation matrix: about y, then z, then x."""
    roll = np.arcsin(np.clip(turn[1, 0], -1.0, 1.0))
    yaw = np.arctan2(-turn[2, 0], turn[0, 0])
    pitch = np.arctan2(-turn[1, 2], turn[1, 1])
    return float(yaw), float(roll), float(pitch)
