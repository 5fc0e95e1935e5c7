"""A motion while it is fitted: its poses, and how points and bones move."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
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
)


@dataclass(frozen=True, eq=False)
class FittedMotion:
    """A motion between two steps of the fit.

    Its variables are, in each frame, the position of the root in meters, if it may move, and
    then for each joint that may turn a rotation vector in radians, in the axes of the joint's
    parent, or the angle of a hinge.

    Attributes
    ----------
    source : Motion
        As it was before the fit.
    motion : Motion
    joints : tuple of int
        Joints that may turn.
    root_moves : bool
    hinges : mapping of joint to shape (3,) or (n_frames, 3)
        Unit vectors about which some of the joints turn, in the axes of their parents; all
        others turn freely.
    """

    source: Motion
    motion: Motion
    joints: tuple[int, ...]
    root_moves: bool = True
    hinges: Mapping[int, Array] = field(default_factory=dict)

    @property
    def n_variables(self) -> int:
        """Number of variables of a frame."""
        return self._bounds[-1]

    @cached_property
    def _bounds(self) -> list[int]:
        """Where the variables of each joint begin, and the end of the last one."""
        sizes = [1 if joint in self.hinges else 3 for joint in self.joints]
        return [int(n) for n in np.cumsum([3 * self.root_moves, *sizes])]

    @cached_property
    def poses(self) -> WorldPoses:
        """Of all joints."""
        return forward_kinematics(self.motion)

    @cached_property
    def _axes(self) -> list[Array]:
        """World axes of each joint's variables as columns, (n_frames, 3, 1 or 3)."""
        axes = []
        for joint in self.joints:
            parent, own = self.motion.skeleton.parents[joint], self.axes_of(joint)
            rotations = matrix_from_quaternion(self.poses.rotations[:, parent])
            axes.append((rotations if parent >= 0 else np.eye(3)) @ own)
        return axes

    def axes_of(self, joint: int) -> Array:
        """Return the axes of a joint's variables as columns, in the axes of its parent.

        The shape is (3, 3), or (3, 1) or (n_frames, 3, 1) for a hinge.
        """
        return self.hinges[joint][..., None] if joint in self.hinges else np.eye(3)

    def columns(self, joint: int) -> slice:
        """Return the columns of a joint's variables."""
        index = self.joints.index(joint)
        return slice(*self._bounds[index : index + 2])

    def deviations(self) -> Array:
        """Return the change of each variable since the source, (n_frames, n_variables)."""
        chosen = list(self.joints)
        rotations = multiply(
            self.motion.rotations[:, chosen], inverse(self.source.rotations[:, chosen])
        )
        vectors = rotation_vector_from_quaternion(rotations)
        changes = np.empty((self.motion.n_frames, self.n_variables))
        if self.root_moves:
            changes[:, :3] = self.motion.root_positions - self.source.root_positions
        for index, joint in enumerate(chosen):
            along = vectors[:, index, None] @ self.axes_of(joint)
            changes[:, self.columns(joint)] = along[:, 0]
        return changes

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
            jacobian[:, :, :3] = np.eye(3)
        for index, joint in self._carriers(bone):
            levers = points - self.poses.positions[:, joint]
            jacobian[:, :, self.columns(joint)] = np.cross(
                self._axes[index], levers[..., None], axis=1
            )
        return jacobian

    def rotation_jacobian(self, bone: int) -> Array:
        """Return the derivative of a bone's world rotation, (n_frames, 3, n_variables)."""
        jacobian = np.zeros((self.motion.n_frames, 3, self.n_variables))
        for index, joint in self._carriers(bone):
            jacobian[:, :, self.columns(joint)] = self._axes[index]
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
        vectors = np.zeros((len(step), len(self.joints), 3))
        for index, joint in enumerate(self.joints):
            along = step[:, self.columns(joint), None]
            vectors[:, index] = (self.axes_of(joint) @ along)[..., 0]
        chosen, rotations = list(self.joints), self.motion.rotations.copy()
        changes = quaternion_from_rotation_vector(vectors)
        rotations[:, chosen] = multiply(changes, rotations[:, chosen])
        root = self.motion.root_positions
        if self.root_moves:
            root = root + step[:, :3]
        return replace(self, motion=self.motion.with_poses(rotations, root))
