"""A motion while it is fitted: its poses, and how points and bones move."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from ..arrays import Array
from ..motion import Motion, WorldPoses, forward_kinematics
from ..rotations import (
    inverse,
    matrix_from_quaternion,
    multiply,
    quaternion_from_rotation_vector,
    rotation_vector_from_quaternion,
    skew_matrices,
)


@dataclass(frozen=True, eq=False)
class FittedMotion:
    """A motion between two steps of the fit.

    Its variables are, in each frame, the position of the root in meters, if it may move, and
    then a rotation vector in radians for each joint that may turn, in the axes of the joint's
    parent.

    Attributes
    ----------
    source : Motion
        As it was before the fit.
    motion : Motion
    joints : tuple of int
        Joints that may turn.
    root_moves : bool
    """

    source: Motion
    motion: Motion
    joints: tuple[int, ...]
    root_moves: bool = True

    @property
    def root_columns(self) -> slice:
        """Where the variables of the root's position are."""
        return slice(0, 3 if self.root_moves else 0)

    @property
    def n_variables(self) -> int:
        """Number of variables of a frame."""
        return 3 * (len(self.joints) + self.root_moves)

    @cached_property
    def poses(self) -> WorldPoses:
        """Of all joints."""
        return forward_kinematics(self.motion)

    @cached_property
    def _axes(self) -> Array:
        """World axes of each joint's variables, (n_frames, n_joints, 3, 3)."""
        parents = np.array(self.motion.skeleton.parents)[list(self.joints)]
        axes = matrix_from_quaternion(self.poses.rotations[:, np.maximum(parents, 0)])
        axes[:, parents < 0] = np.eye(3)
        return axes

    def columns(self, joint: int) -> slice:
        """Return where the variables of a joint are."""
        first = self.root_columns.stop + 3 * self.joints.index(joint)
        return slice(first, first + 3)

    def deviations(self) -> Array:
        """Return the change of each variable since the source, (n_frames, n_variables)."""
        chosen = list(self.joints)
        turns = multiply(
            self.motion.rotations[:, chosen], inverse(self.source.rotations[:, chosen])
        )
        vectors = rotation_vector_from_quaternion(turns)
        moved = self.motion.root_positions - self.source.root_positions
        parts = [moved, vectors.reshape(len(moved), -1)]
        return np.concatenate(parts if self.root_moves else parts[1:], axis=1)

    def point_jacobian(self, points: Array, bone: int) -> Array:
        """Return the derivatives of points that are fixed to a bone.

        Parameters
        ----------
        points : shape (n_frames, 3), meters
        bone : int
            The joint that carries them.

        Returns
        -------
        Array
            Shape (n_frames, 3, n_variables).
        """
        jacobian = np.zeros((len(points), 3, self.n_variables))
        if self.root_moves:
            jacobian[:, :, self.root_columns] = np.eye(3)
        for index, joint in self._carriers(bone):
            levers = points - self.poses.positions[:, joint]
            jacobian[:, :, self.columns(joint)] = -skew_matrices(levers) @ self._axes[:, index]
        return jacobian

    def rotation_jacobian(self, bone: int) -> Array:
        """Return the derivative of a bone's world rotation, (n_frames, 3, n_variables)."""
        jacobian = np.zeros((self.motion.n_frames, 3, self.n_variables))
        for index, joint in self._carriers(bone):
            jacobian[:, :, self.columns(joint)] = self._axes[:, index]
        return jacobian

    def _carriers(self, bone: int) -> list[tuple[int, int]]:
        """Return index and joint of the variables that turn a bone."""
        return [
            (index, joint)
            for index, joint in enumerate(self.joints)
            if joint in (bone, *self.motion.skeleton.ancestors(bone))
        ]

    def moved(self, step: Array) -> "FittedMotion":
        """Return the motion after a step of the variables, shape (n_frames, n_variables)."""
        rotations = self.motion.rotations.copy()
        turns = quaternion_from_rotation_vector(
            step[:, self.root_columns.stop :].reshape(len(step), len(self.joints), 3)
        )
        chosen = list(self.joints)
        rotations[:, chosen] = multiply(turns, rotations[:, chosen])
        root = self.motion.root_positions
        if self.root_moves:
            root = root + step[:, self.root_columns]
        return replace(self, motion=self.motion.with_poses(rotations, root))
