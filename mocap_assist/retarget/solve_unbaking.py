"""Solve of the button Unbake: sparse keys for each bone, in its own channels."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...solvers.arrays import Array
from ...solvers.motion import Motion, Skeleton
from ...solvers.motion.skeletons import world_poses
from ...solvers.progress import Progress, unwatched, within
from ...solvers.retargeting import (
    KeyCurve,
    RotationChannels,
    UnbakeSettings,
    find_error_points,
    fit_curve,
    reduce_keys,
)
from ...solvers.rotations import IDENTITY, angle_between, inverse, multiply, rotate
from ..actions.rotation_modes import (
    channels_from_quaternions,
    quaternions_from_channels,
    rotation_property,
)

MIN_ROTATION_RAD = 1e-6
"""Radians that are only rounding: a bone that rotates less does not move."""
MIN_TOLERANCE_RAD_PER_M = 0.1
"""Radians for each meter of tolerance that angles between keys may always be off. Chosen by
hand: 0.06 degrees for 1 cm."""
MIN_KEYS = 2
"""Number of keys without which nothing moves. By definition."""
TIGHTENING_FACTOR, N_TRIES = 0.6, 6
"""Euler angles and axis-angles are interpolated differently from quaternions. Where that moves
an end too far, the keys are chosen again, for the tolerance times this factor, at most this
often. The second bounds the run time."""
AXIS_ANGLE, QUATERNION = "AXIS_ANGLE", "QUATERNION"


@dataclass(frozen=True, eq=False)
class BoneShape:
    """Channels and rotation mode of a joint's bone."""

    bone: str
    mode: str
    """Blender's rotation mode."""
    axes: Array
    """Its rest pose in the world, shape (4,)."""
    rotates: bool
    """Whether its rotation is keyed."""


@dataclass(frozen=True, eq=False)
class KeyedMotion:
    """A motion, and the bones of its joints; None for joints that are none."""

    motion: Motion
    shapes: tuple[BoneShape | None, ...]
    root_moves: bool
    """Whether the location of the topmost bone is keyed."""
    head: Array
    """Rest position of the bone, meters."""
    meters: float


@dataclass(frozen=True, eq=False)
class UnbakeProblem:
    """All that Unbake depends on."""

    trees: tuple[KeyedMotion, ...]
    tolerance: float
    settings: UnbakeSettings


@dataclass(frozen=True, eq=False)
class SparseKeys:
    """Few keys for the channels of a bone; frames count from the first of the take."""

    rotations: KeyCurve | None
    locations: KeyCurve | None


@dataclass(frozen=True, eq=False)
class Unbaked:
    """Keys of all bones, and the error of the ends of limbs, meters."""

    keys: Mapping[str, SparseKeys]
    error: float


def unbake(problem: UnbakeProblem, *, progress: Progress = unwatched) -> Unbaked:
    """Reduce the keys of each tree of bones."""
    keys: dict[str, SparseKeys] = {}
    error, n_trees = 0.0, len(problem.trees)
    for index, tree in enumerate(problem.trees):
        tree_progress = within(progress, index / n_trees, (index + 1) / n_trees)
        found, off = _unbake_tree(_without_still_bones(tree), problem, tree_progress)
        keys |= found
        error = max(error, off)
    return Unbaked(keys, error)


def _unbake_tree(
    tree: KeyedMotion, problem: UnbakeProblem, progress: Progress
) -> tuple[dict[str, SparseKeys], float]:
    tolerance = problem.tolerance
    for attempt in range(N_TRIES):
        tree_progress = within(progress, attempt / N_TRIES, (attempt + 1) / N_TRIES)
        sparse = reduce_keys(
            tree.motion,
            tolerance,
            channels=tuple(map(_channels_of, tree.shapes)),
            settings=problem.settings,
            progress=tree_progress,
        )
        rotation_curves = [
            None
            if shape is None
            else _bone_curve(
                tree.motion.rotations[:, joint],
                shape,
                curve,
                MIN_TOLERANCE_RAD_PER_M * tolerance,
            )
            for joint, (shape, curve) in enumerate(
                zip(tree.shapes, sparse.rotations, strict=True)
            )
        ]
        off = _error(tree, rotation_curves, sparse.root)
        if off <= problem.tolerance:
            break
        tolerance *= TIGHTENING_FACTOR
    keys = {
        shape.bone: SparseKeys(
            curve if shape.rotates else None,
            _location_curve(tree, sparse.root) if not joint and tree.root_moves else None,
        )
        for joint, (shape, curve) in enumerate(zip(tree.shapes, rotation_curves, strict=True))
        if shape is not None
    }
    return keys, off


def _channels_of(shape: BoneShape | None) -> RotationChannels:
    """Return the intrinsic order: Blender's XYZ is about fixed axes, so intrinsic Z Y X."""
    if shape is None:
        return RotationChannels()
    keyed_by_angles = shape.mode not in {QUATERNION, AXIS_ANGLE}
    return RotationChannels(shape.mode[::-1] if keyed_by_angles else "", shape.axes)


def _bone_curve(rotations: Array, shape: BoneShape, curve: KeyCurve, finest: float) -> KeyCurve:
    """Return the curve of Blender's channels; one key where nothing moves."""
    basis = multiply(multiply(inverse(shape.axes), rotations), shape.axes)
    _, width = rotation_property(shape.mode)
    near = np.zeros((1, width))
    near[:, 0] = float(shape.mode == QUATERNION)
    if not len(curve.frames):
        channels = channels_from_quaternions(basis[:1], shape.mode, near)
        return fit_curve(channels, np.zeros(1, dtype=np.intp))
    if shape.mode == QUATERNION:
        return curve
    if shape.mode != AXIS_ANGLE:
        columns = np.argsort(["XYZ".index(axis) for axis in shape.mode[::-1]])
        return KeyCurve(curve.frames, curve.values[:, columns], curve.slopes[:, columns])
    channels = channels_from_quaternions(basis, shape.mode, near)
    allowed = max(float(_curve_errors(curve, basis, QUATERNION).max()), finest)
    return _add_needed_keys(channels, curve.frames, basis, shape.mode, allowed)


def _add_needed_keys(
    channels: Array, frames: NDArray[np.intp], basis: Array, mode: str, allowed: float
) -> KeyCurve:
    """Add keys where interpolated axis-angles deviate too far from quaternions."""
    while True:
        curve = fit_curve(channels, frames)
        off = _curve_errors(curve, basis, mode)
        worse = np.setdiff1d(np.flatnonzero(off > allowed), frames)
        if len(frames) < MIN_KEYS or not len(worse):
            return curve
        segments = np.searchsorted(frames, worse)
        worst = [
            worse[segments == each][off[worse[segments == each]].argmax()]
            for each in np.unique(segments)
        ]
        frames = np.union1d(frames, worst).astype(np.intp)


def _curve_errors(curve: KeyCurve, rotations: Array, mode: str) -> Array:
    """Return the angle between a curve and the rotations at each frame, radians."""
    played = quaternions_from_channels(curve.at(np.arange(len(rotations))), mode)
    return np.asarray(angle_between(played, rotations))


def _location_curve(tree: KeyedMotion, curve: KeyCurve) -> KeyCurve:
    shape = tree.shapes[0]
    assert shape is not None
    back = inverse(shape.axes)
    return KeyCurve(
        curve.frames,
        rotate(back, curve.values - tree.head) / tree.meters,
        rotate(back, curve.slopes) / tree.meters,
    )


def _error(tree: KeyedMotion, curves: Sequence[KeyCurve | None], root: KeyCurve) -> float:
    """Return by how much any end is off when Blender plays the curves, meters."""
    motion, frames = tree.motion, np.arange(tree.motion.n_frames)
    rotations = np.tile(IDENTITY, (*motion.rotations.shape[:2], 1))
    for joint, (shape, curve) in enumerate(zip(tree.shapes, curves, strict=True)):
        if shape is not None and curve is not None:
            basis = quaternions_from_channels(curve.at(frames), shape.mode)
            rotations[:, joint] = multiply(multiply(shape.axes, basis), inverse(shape.axes))
    points = find_error_points(motion.skeleton)
    played = points.positions(world_poses(motion.skeleton, rotations, root.at(frames)))
    truth = world_poses(motion.skeleton, motion.rotations, motion.root_positions)
    return float(np.linalg.norm(played - points.positions(truth), axis=-1).max())


def _without_still_bones(tree: KeyedMotion) -> KeyedMotion:
    """Leave out bones that never move; a control rig has hundreds of helpers."""
    motion = tree.motion
    skeleton = motion.skeleton
    angles = angle_between(motion.rotations, IDENTITY)
    moves = ~(np.nan_to_num(angles, nan=1.0).max(axis=0) <= MIN_ROTATION_RAD)
    moves[0] = True
    needed = moves.copy()
    for joint in range(skeleton.n_joints - 1, 0, -1):
        needed[skeleton.parents[joint]] |= needed[joint]
    kept = [
        joint
        for joint, parent in enumerate(skeleton.parents)
        if needed[joint] or (parent >= 0 and moves[parent])
    ]
    selected: Skeleton = skeleton.select(kept)
    smaller = Motion(
        selected, motion.rotations[:, kept], motion.root_positions, motion.frame_rate
    )
    return replace(tree, motion=smaller, shapes=tuple(tree.shapes[joint] for joint in kept))
