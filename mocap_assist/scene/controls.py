"""A rig as its keyed controls, the joints that they follow, and their carriers.

A control follows a joint: it rotates like that joint, from its own rest pose, and may keep its
position relative to another joint. The carrier of a control, a parent or constrained bones, is
represented by the control that it moves with. The channels of all controls therefore follow
from the joints' world transforms without evaluating the rig.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from ...solvers.arrays import Array
from ...solvers.motion import HumanoidMap, Skeleton, WorldPoses
from ...solvers.rotations import inverse, multiply, rotate

NO_CONTROL = -1
MIN_FLEXION_FRACTION, FULL_FLEXION_FRACTION = 0.001, 0.005
"""Distance of a hinge from the line of its limb, as a fraction of the limb's length. Below the
first, the upper bone defines the direction of the hinge; above the second, its flexion does.
They guard straight limbs, whose flexion has no direction."""


@dataclass(frozen=True, eq=False)
class Control:
    """A keyed bone.

    Attributes
    ----------
    bone : str
    joint : int
        Joint that defines its rotation; -1 for the travel over the ground.
    anchor : int
        Joint that defines its position, with an offset that rotates with `joint`.
    carrier : int
        Control that carries it, -1 for none.
    axes : shape (4,)
        Its rest pose in the stage.
    location_axes : shape (4,)
        Those of its location.
    head : shape (3,), meters
        Rest position.
    rotates, moves : bool
        Whether rotation and location are keyed.
    limb : upper joint, hinge and end for a pole target in front of the hinge
    """

    bone: str
    joint: int
    anchor: int
    carrier: int
    axes: Array
    location_axes: Array
    head: Array
    rotates: bool
    moves: bool
    limb: tuple[int, int, int] | None = None


@dataclass(frozen=True, eq=False)
class TargetRig:
    """Description of a rig for retargeting.

    The stage is the world relative to the armature's origin and rotation about the vertical.

    Attributes
    ----------
    skeleton : Skeleton
        The joints that play roles, in the stage, meters.
    humanoid : HumanoidMap
    controls : tuple of Control
    meters : float
        Length of the armature's own unit.
    """

    skeleton: Skeleton
    humanoid: HumanoidMap
    controls: tuple[Control, ...]
    meters: float


@dataclass(frozen=True, eq=False)
class BoneKeys:
    """Channels of one bone, NaN where its joint is missing."""

    rotations: Array | None
    """Shape (n_frames, 4), Blender's basis."""
    locations: Array | None
    """Shape (n_frames, 3), in the armature's unit."""


@dataclass(frozen=True, eq=False)
class Carried:
    """Motion from a rest pose: x maps to rotate(x - rest) + position."""

    rotations: Array
    rest: Array
    positions: Array

    def points(self, points: Array) -> Array:
        """Transform points of the rest pose, shape (3,), to the current pose."""
        return np.asarray(rotate(self.rotations, points - self.rest) + self.positions)

    def points_back(self, points: Array) -> Array:
        """Transform points, shape (n_frames, 3), back to the rest pose."""
        return np.asarray(rotate(inverse(self.rotations), points - self.positions) + self.rest)


def keys_of(target: TargetRig, poses: WorldPoses, travel: Carried) -> Mapping[str, BoneKeys]:
    """Return the channels that move each control to its joints.

    Parameters
    ----------
    target : TargetRig
    poses : WorldPoses
        Of its skeleton, without gaps.
    travel : Carried
        Of controls that follow the travel.
    """
    moved = [
        _move_control(control, target.skeleton, poses, travel) for control in target.controls
    ]
    n_frames = len(poses.positions)
    still = Carried(np.tile([1.0, 0.0, 0.0, 0.0], (n_frames, 1)), np.zeros(3), np.zeros(3))
    carriers = [
        still if control.carrier == NO_CONTROL else moved[control.carrier]
        for control in target.controls
    ]
    rotations = _basis_rotations(target.controls, carriers, moved)
    return {
        control.bone: BoneKeys(
            rotations[number] if control.rotates else None,
            _basis_shifts(control, carriers[number], moved[number]) / target.meters
            if control.moves
            else None,
        )
        for number, control in enumerate(target.controls)
    }


def _basis_rotations(
    controls: Sequence[Control], carriers: Sequence[Carried], moved: Sequence[Carried]
) -> Array:
    """Return the rotations of all controls at once, shape (n_controls, n_frames, 4)."""
    axes = np.array([control.axes for control in controls]).reshape(-1, 1, 4)
    carried = np.array([each.rotations for each in carriers]).reshape(len(controls), -1, 4)
    rotated = np.array([each.rotations for each in moved]).reshape(len(controls), -1, 4)
    local = multiply(inverse(carried), rotated)
    return np.asarray(multiply(multiply(inverse(axes), local), axes))


def _basis_shifts(control: Control, carrier: Carried, moved: Carried) -> Array:
    shift = carrier.points_back(moved.points(control.head)) - control.head
    return np.asarray(rotate(inverse(control.location_axes), shift))


def _move_control(
    control: Control, skeleton: Skeleton, poses: WorldPoses, travel: Carried
) -> Carried:
    if control.joint < 0:
        return travel
    rest = skeleton.rest_positions
    anchor = control.anchor
    moved = Carried(poses.rotations[:, control.joint], rest[anchor], poses.positions[:, anchor])
    if control.limb is None:
        return moved
    return Carried(moved.rotations, control.head, _pole_positions(control, rest, poses, moved))


def _pole_positions(control: Control, rest: Array, poses: WorldPoses, upper: Carried) -> Array:
    """Return points in front of a hinge, at their rest distance, (n_frames, 3)."""
    assert control.limb is not None
    start, hinge, end = (poses.positions[:, joint] for joint in control.limb)
    line = end - start
    length = np.linalg.norm(np.diff(rest[list(control.limb)], axis=0), axis=1).sum()
    along = ((hinge - start) * line).sum(axis=1, keepdims=True)
    foot = start + line * along / np.maximum((line * line).sum(axis=1, keepdims=True), 1e-12)
    bend = hinge - foot
    depth = np.linalg.norm(bend, axis=1, keepdims=True)
    straight = upper.points(control.head) - hinge
    axis = line / np.maximum(np.linalg.norm(line, axis=1, keepdims=True), 1e-9)
    straight -= axis * (straight * axis).sum(axis=1, keepdims=True)
    weight = np.clip(
        (depth / length - MIN_FLEXION_FRACTION)
        / (FULL_FLEXION_FRACTION - MIN_FLEXION_FRACTION),
        0.0,
        1.0,
    )
    ahead = weight * _unit(bend) + (1.0 - weight) * _unit(straight)
    distance = np.linalg.norm(control.head - rest[control.limb[1]])
    return np.asarray(hinge + distance * _unit(ahead))


def _unit(vectors: Array) -> Array:
    return np.asarray(vectors / np.maximum(np.linalg.norm(vectors, axis=1)[:, None], 1e-9))
