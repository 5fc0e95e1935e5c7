"""Poses for learning: thinned out to different ones, mixed, and with arms that go anywhere."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...motion import world_poses
from ...rotations import (
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotation_between,
    twist_about,
)
from .skinned_body import SkinnedBody

Array = NDArray[np.float64]
UP = np.array([0.0, 0.0, 1.0])
LEG_ROLES = ("UpperLeg", "LowerLeg", "Foot", "Toes")
ARM_ROLES = ("Shoulder", "UpperArm", "LowerArm", "Hand")
SOLES = 0.35
"""Of a reach: how far an arm may go back, or across the chest, from straight to its side."""


def remove_heading(rotations: Array) -> Array:
    """Return poses (F, n_joints, 4) of which the root has no turn about the vertical."""
    upright = rotations.copy()
    heading = twist_about(rotations[:, 0], UP)
    upright[:, 0] = multiply(inverse(heading), rotations[:, 0])
    return upright


def select_diverse_poses(
    body: SkinnedBody, rotations: Array, spacing: float, most: int
) -> Array:
    """Return those poses (n, n_joints, 4) that differ most, by farthest-point sampling.

    Poses have no heading. The difference of two is the largest distance between the same joint
    in both; none that is kept is nearer than `spacing`, metres, to another one.
    """
    nowhere = np.zeros((len(rotations), 3))
    joints = world_poses(body.skeleton, rotations, nowhere).positions.astype(np.float32)
    kept = [0]
    gaps = np.full(len(rotations), np.inf, dtype=np.float32)
    while len(kept) < min(most, len(rotations)):
        far = np.square(joints - joints[kept[-1]]).sum(axis=-1).max(axis=1)
        gaps = np.minimum(gaps, far)
        farthest = int(gaps.argmax())
        if gaps[farthest] <= spacing**2:
            break
        kept.append(farthest)
    return rotations[kept]


@dataclass(frozen=True, eq=False)
class PoseMixer:
    """Draws poses that no clip holds: parts of different poses, and limbs at random.

    Attributes
    ----------
    body : SkinnedBody
        Whose joints the poses are of.
    poses : shape (n, n_joints, 4)
        T-pose rotations by joint, without heading.
    """

    body: SkinnedBody
    poses: Array

    def draw(self, rng: np.random.Generator, loose: float) -> Array:
        """Return one pose (n_joints, 4); `loose` is how often a limb is not the clip's."""
        joints = self.body.humanoid.indices(self.body.skeleton)
        pose: Array = self.poses[rng.integers(len(self.poses))].copy()
        if rng.random() < loose:
            other = self.poses[rng.integers(len(self.poses))]
            legs = [
                joints[f"{side}{role}"]
                for side in ("left", "right")
                for role in LEG_ROLES
                if f"{side}{role}" in joints
            ]
            pose[legs] = other[legs]
        if rng.random() < loose / 2.0:
            self._stand(pose, joints, rng)
        for side, sign in (("left", 1.0), ("right", -1.0)):
            if rng.random() < loose:
                self._loosen_arm(pose, joints, side, sign, rng)
            if rng.random() < loose / 4.0:
                self._loosen_leg(pose, joints, side, sign, rng)
        return pose

    @staticmethod
    def _stand(pose: Array, joints: dict[str, int], rng: np.random.Generator) -> None:
        """Let the legs stand side by side, as most people before a camera mostly do."""
        pose[joints["hips"]] = quaternion_from_rotation_vector(0.05 * rng.standard_normal(3))
        for sign, side in ((1.0, "left"), (-1.0, "right")):
            hip = [0.06 * rng.standard_normal(), -sign * rng.uniform(-0.06, 0.15), 0.0]
            turns = (hip, [rng.uniform(0.0, 0.1), 0.0, 0.0], [0.0] * 3)
            for role, turn in zip(LEG_ROLES, turns, strict=False):
                if f"{side}{role}" in joints:
                    pose[joints[f"{side}{role}"]] = quaternion_from_rotation_vector(turn)

    @staticmethod
    def _loosen_arm(
        pose: Array, joints: dict[str, int], side: str, sign: float, rng: np.random.Generator
    ) -> None:
        """Point an arm anywhere but back and through the chest, and bend it forward."""
        straight = np.array([sign, 0.0, 0.0])
        way = np.array([-sign, 0.0, 0.0])
        while way[0] * sign < -SOLES or way[1] > SOLES:
            way = rng.standard_normal(3)
            way /= np.linalg.norm(way)
        twist = quaternion_from_rotation_vector(straight * rng.uniform(-1.6, 1.6))
        bend = rng.uniform(0.0, 2.5) * rng.choice([0.2, 1.0])
        hinge = quaternion_from_rotation_vector([0.0, 0.0, -sign * bend])
        for role, turn in (
            ("UpperArm", multiply(rotation_between(straight, way), twist)),
            ("LowerArm", hinge),
        ):
            if f"{side}{role}" in joints:
                pose[joints[f"{side}{role}"]] = turn

    @staticmethod
    def _loosen_leg(
        pose: Array, joints: dict[str, int], side: str, sign: float, rng: np.random.Generator
    ) -> None:
        """Lift a leg forward or aside, and bend it backward."""
        forward, aside = rng.uniform(-0.4, 1.9), rng.uniform(-0.2, 0.8)
        lift = quaternion_from_rotation_vector([-forward, 0.0, 0.0])
        spread = quaternion_from_rotation_vector([0.0, -sign * aside, 0.0])
        turn = quaternion_from_rotation_vector([0.0, 0.0, sign * rng.uniform(-0.3, 0.6)])
        knee = quaternion_from_rotation_vector([rng.uniform(0.0, 2.2), 0.0, 0.0])
        for role, rotation in (
            ("UpperLeg", multiply(multiply(spread, lift), turn)),
            ("LowerLeg", knee),
        ):
            if f"{side}{role}" in joints:
                pose[joints[f"{side}{role}"]] = rotation
