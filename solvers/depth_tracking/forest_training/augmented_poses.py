"""Training poses: diverse recorded poses, mixed and with random limbs."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...motion import world_poses
from ...motion.humanoid import LEG_ROLES, SIDES
from ...rotations import (
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotation_between,
    twist_about,
)
from .skinned_body import SkinnedBody

UP = np.array([0.0, 0.0, 1.0])
MAX_ARM_BACK = 0.35
"""Maximum component, a cosine, of the arm direction backward or across the chest. Chosen by
hand; used in training only."""


def remove_heading(rotations: Array) -> Array:
    """Return poses (F, n_joints, 4) without rotation of the root about the vertical."""
    upright = rotations.copy()
    heading = twist_about(rotations[:, 0], UP)
    upright[:, 0] = multiply(inverse(heading), rotations[:, 0])
    return upright


def select_diverse_poses(
    body: SkinnedBody, rotations: Array, spacing: float, max_poses: int
) -> Array:
    """Return diverse poses (n, n_joints, 4) by farthest-point sampling.

    Poses have no heading. The distance of two poses is the largest distance of a joint. No two
    selected poses are closer than `spacing`, meters.
    """
    roots = np.zeros((len(rotations), 3))
    joints = world_poses(body.skeleton, rotations, roots).positions.astype(np.float32)
    selected = [0]
    min_distances = np.full(len(rotations), np.inf, dtype=np.float32)
    while len(selected) < min(max_poses, len(rotations)):
        distances = np.square(joints - joints[selected[-1]]).sum(axis=-1).max(axis=1)
        min_distances = np.minimum(min_distances, distances)
        farthest = int(min_distances.argmax())
        if min_distances[farthest] <= spacing**2:
            break
        selected.append(farthest)
    return rotations[selected]


@dataclass(frozen=True, eq=False)
class PoseMixer:
    """Sampler of new poses: legs of another pose, and random limbs.

    Attributes
    ----------
    body : SkinnedBody
        Body with the joints of the poses.
    poses : shape (n, n_joints, 4)
        T-pose rotations by joint, without heading.
    """

    body: SkinnedBody
    poses: Array

    def draw(self, rng: np.random.Generator, loose: float) -> Array:
        """Return one pose (n_joints, 4); `loose` is the probability of changed limbs."""
        joints = self.body.humanoid.indices(self.body.skeleton)
        pose: Array = self.poses[rng.integers(len(self.poses))].copy()
        if rng.random() < loose:
            other = self.poses[rng.integers(len(self.poses))]
            legs = [
                joints[f"{side}{role}"]
                for side in SIDES
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
        """Place the legs side by side, the most frequent stance in front of a camera."""
        pose[joints["hips"]] = quaternion_from_rotation_vector(0.05 * rng.standard_normal(3))
        for sign, side in ((1.0, "left"), (-1.0, "right")):
            hip = [0.06 * rng.standard_normal(), -sign * rng.uniform(-0.06, 0.15), 0.0]
            rotation_vectors = (hip, [rng.uniform(0.0, 0.1), 0.0, 0.0], [0.0] * 3)
            for role, rotation in zip(LEG_ROLES, rotation_vectors, strict=False):
                if f"{side}{role}" in joints:
                    pose[joints[f"{side}{role}"]] = quaternion_from_rotation_vector(rotation)

    @staticmethod
    def _loosen_arm(
        pose: Array, joints: dict[str, int], side: str, sign: float, rng: np.random.Generator
    ) -> None:
        """Point an arm in a random feasible direction, and flex the elbow."""
        straight = np.array([sign, 0.0, 0.0])
        direction = np.array([-sign, 0.0, 0.0])
        while direction[0] * sign < -MAX_ARM_BACK or direction[1] > MAX_ARM_BACK:
            direction = rng.standard_normal(3)
            direction /= np.linalg.norm(direction)
        twist = quaternion_from_rotation_vector(straight * rng.uniform(-1.6, 1.6))
        flexion = rng.uniform(0.0, 2.5) * rng.choice([0.2, 1.0])
        hinge = quaternion_from_rotation_vector([0.0, 0.0, -sign * flexion])
        for role, rotation in (
            ("UpperArm", multiply(rotation_between(straight, direction), twist)),
            ("LowerArm", hinge),
        ):
            if f"{side}{role}" in joints:
                pose[joints[f"{side}{role}"]] = rotation

    @staticmethod
    def _loosen_leg(
        pose: Array, joints: dict[str, int], side: str, sign: float, rng: np.random.Generator
    ) -> None:
        """Flex or abduct a hip, and flex the knee."""
        forward, aside = rng.uniform(-0.4, 1.9), rng.uniform(-0.2, 0.8)
        lift = quaternion_from_rotation_vector([-forward, 0.0, 0.0])
        spread = quaternion_from_rotation_vector([0.0, -sign * aside, 0.0])
        yaw = quaternion_from_rotation_vector([0.0, 0.0, sign * rng.uniform(-0.3, 0.6)])
        knee = quaternion_from_rotation_vector([rng.uniform(0.0, 2.2), 0.0, 0.0])
        for role, rotation in (
            ("UpperLeg", multiply(multiply(spread, lift), yaw)),
            ("LowerLeg", knee),
        ):
            if f"{side}{role}" in joints:
                pose[joints[f"{side}{role}"]] = rotation
