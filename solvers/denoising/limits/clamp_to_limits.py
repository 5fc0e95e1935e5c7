"""Clamp a motion softly to the limits of its joints."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...errors import InvalidSettingError
from ...motion import Motion, Skeleton
from ...motion.humanoid import HumanoidMap, find_humanoid_map, t_pose_alignment
from ...motion.skeletons import ROTATION_VECTOR, JointLimits
from ...rotations import (
    euler_from_quaternion,
    inverse,
    multiply,
    quaternion_from_euler,
    quaternion_from_rotation_vector,
    rotation_vector_from_quaternion,
)

DEFAULT_SOFTNESS = np.radians(5.0)
"""Radians beyond a limit that a rotation approaches, however far it was beyond. Half and twice
gain less than 1 % (`make sensitivity`)."""


def clamp_to_limits(
    motion: Motion,
    limits: JointLimits,
    *,
    softness: float = DEFAULT_SOFTNESS,
    humanoid_map: HumanoidMap | None = None,
) -> Motion:
    """Return the motion with each joint softly clamped to its limits.

    An angle within its limits stays the same, bit for bit. An excess of x becomes
    softness * tanh(x / softness). This curve leaves the limit with the same slope and
    curvature, so the motion has no kink, and it never exceeds the limit by more than
    `softness`.

    Parameters
    ----------
    motion : Motion
        NaN stays NaN. Joints without limits stay the same.
    limits : JointLimits
    softness : float, radians
        Higher is smoother; 0 stops at the limit.
    humanoid_map : HumanoidMap
        Assigns joints to the roles of the limits; found if not given.

    Returns
    -------
    Motion

    Raises
    ------
    InvalidSettingError
        The softness is negative.
    """
    if not softness >= 0.0:
        raise InvalidSettingError(f"softness is {softness:g} rad; it must not be negative.")
    rotations = motion.rotations.copy()
    for joint, limit in _limits_of_skeleton(limits, motion.skeleton, humanoid_map):
        angles, signed_excess = limit.angles(motion.rotations[:, joint])
        outside = (signed_excess != 0.0).any(axis=1)
        if outside.any():
            clamped = (
                angles[outside]
                - signed_excess[outside]
                + _soften(signed_excess[outside], softness)
            )
            rotations[outside, joint] = limit.rotations(clamped)
    return motion.with_poses(rotations=rotations)


def limit_excess(
    motion: Motion, limits: JointLimits, humanoid_map: HumanoidMap | None = None
) -> Array:
    """Return the excess of each joint over its limits, shape (n_frames, n_joints), radians.

    It is the largest excess of the three angles; 0 within the limits, for joints without limits
    and where not observed.
    """
    excess = np.zeros((motion.n_frames, motion.n_joints))
    for joint, limit in _limits_of_skeleton(limits, motion.skeleton, humanoid_map):
        _, signed_excess = limit.angles(motion.rotations[:, joint])
        excess[:, joint] = np.maximum(
            excess[:, joint], np.nan_to_num(np.abs(signed_excess)).max(axis=1)
        )
    return excess


@dataclass(frozen=True, eq=False)
class _Limit:
    """The limit of one joint of one rig."""

    left: Array
    right: Array
    order: str
    lower: Array
    upper: Array

    def angles(self, rotations: Array) -> tuple[Array, Array]:
        """Return the limited coordinates and their signed excess, each (n_frames, 3)."""
        in_limit_frame = multiply(multiply(inverse(self.left), rotations), self.right)
        if self.order == ROTATION_VECTOR:
            vectors = rotation_vector_from_quaternion(in_limit_frame)
            return vectors, self._signed_excess(vectors)
        # Every rotation has two triples of Euler angles, each up to full turns. Choose the one
        # with the least excess and the least rotation about free axes. Otherwise a knee far
        # beyond its limit could be interpreted as half a turn about both other axes.
        first = euler_from_quaternion(in_limit_frame, self.order)
        forms = self._wrap_to_limits(np.stack([first, first * (1.0, -1.0, 1.0) + np.pi]))
        signed_excess = self._signed_excess(forms)
        free = np.isinf(self.lower) & np.isinf(self.upper)
        cost = np.sum(np.abs(signed_excess) + free * np.abs(forms), axis=-1)
        use_second = (cost[1] < cost[0])[:, None]
        return np.where(use_second, forms[1], forms[0]), np.where(
            use_second, signed_excess[1], signed_excess[0]
        )

    def rotations(self, angles: Array) -> Array:
        """Return the rotations (n_frames, 4) of angles (n_frames, 3), radians."""
        if self.order == ROTATION_VECTOR:
            in_limit_frame = quaternion_from_rotation_vector(angles)
        else:
            in_limit_frame = quaternion_from_euler(angles, self.order)
        return multiply(multiply(self.left, in_limit_frame), inverse(self.right))

    def _wrap_to_limits(self, angles: Array) -> Array:
        """Shift by full turns to the angle nearest to the center of bounded limits."""
        bounded = np.isfinite(self.lower) & np.isfinite(self.upper)
        center = 0.5 * (np.where(bounded, self.lower, 0.0) + np.where(bounded, self.upper, 0.0))
        return np.asarray(angles - 2 * np.pi * np.round((angles - center) / (2 * np.pi)))

    def _signed_excess(self, angles: Array) -> Array:
        """Return the signed distance from the box; 0 inside."""
        over = np.maximum(angles - self.upper, 0.0)
        return np.asarray(over + np.minimum(angles - self.lower, 0.0))


def _limits_of_skeleton(
    limits: JointLimits, skeleton: Skeleton, humanoid_map: HumanoidMap | None
) -> Iterator[tuple[int, _Limit]]:
    """Yield the limits whose joints this skeleton has, relative to its own rest pose."""
    joints = {name: joint for joint, name in enumerate(skeleton.names)}
    roles: dict[str, int] = {}
    alignment = np.empty((0, 4))
    if limits.by_role.any():
        humanoid_map = humanoid_map or find_humanoid_map(skeleton)
        roles = humanoid_map.indices(skeleton)
        alignment = t_pose_alignment(skeleton, humanoid_map)
    for index, name in enumerate(limits.names):
        by_role = limits.by_role[index]
        joint = (roles if by_role else joints).get(name)
        if joint is None:
            continue
        left, right = limits.left[index], limits.right[index]
        if by_role:
            # A canonical rotation is parent^-1 L own, see `canonical_rotations`.
            parent = skeleton.parents[joint]
            left = multiply(alignment[parent], left) if parent >= 0 else left
            right = multiply(alignment[joint], right)
        yield (
            joint,
            _Limit(left, right, limits.orders[index], limits.lower[index], limits.upper[index]),
        )


def _soften(signed_excess: Array, softness: float) -> Array:
    if softness == 0.0:
        return np.zeros_like(signed_excess)
    return np.asarray(softness * np.tanh(signed_excess / softness))
