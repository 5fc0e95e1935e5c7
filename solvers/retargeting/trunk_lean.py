"""Match the lean of the trunk to the source's for different positions of the spine joints."""

import numpy as np

from ..arrays import Array
from ..motion import WorldPoses
from ..rotations import (
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
    rotation_between,
    rotation_vector_from_quaternion,
)
from ..signals import smoothstep
from .body import HumanoidBody

CHEST_FRACTION = 0.5
"""Fraction of the swing that is applied to the chest, which otherwise matches the source's.
Half and twice gain less than 1 % (`make sensitivity`)."""
STRAIGHT_COSINE, BENT_COSINE = np.cos(np.radians([10.0, 30.0]))
"""Cosines of the flexion of the trunk: below the first angle there is no swing, since rest
poses differ; above the second the lean is the source's."""
NOISE_SWING_RAD = np.radians(5.0)
"""Half of a swing of this size is removed, and most of smaller ones: they are noise. Chosen by
hand; `make sensitivity` varies it."""
N_ITERATIONS = 6
"""Fixed-point iterations; each leaves less than half of the error. Half and twice are no better
(`make sensitivity`)."""


def leaning_swings(
    source: HumanoidBody,
    target: HumanoidBody,
    source_poses: WorldPoses,
    hips: Array,
    rotations: dict[int, Array],
    trunk: list[int],
) -> dict[int, Array]:
    """Return world rotations, (n_frames, 4), to add to those of the trunk's joints.

    The spine joints of another body have other positions: with the source's rotations, the
    line from hips to neck differs by 10 to 20 degrees in deep bows. A swing of all spine joints
    gives this line the source's direction, relative to that in the rest pose. Nearly straight
    trunks are unchanged. Descendants of the trunk keep their world rotation.

    Parameters
    ----------
    source, target : HumanoidBody
    source_poses : WorldPoses
    hips : shape (n_frames, 4)
        World rotations of the hips, from the canonical T-pose.
    rotations : dict of the target's joint to shape (n_frames, 4)
        World rotations from the rest pose.
    trunk : list of int
        The target's spine joints, from the lowest.
    """
    top = next((r for r in ("neck", "head") if r in source.joints and r in target.joints), None)
    if (
        top is None
        or not trunk
        or trunk[-1] not in target.skeleton.ancestors(target.joints[top])
    ):
        return {}
    target_vector = _target_vector(source, target, source_poses, hips, top)
    fractions = dict.fromkeys(trunk[:-1], 1.0) | {trunk[-1]: CHEST_FRACTION}
    swing = np.zeros_like(target_vector)
    for _ in range(N_ITERATIONS):
        swung = rotations | {
            joint: multiply(quaternion_from_rotation_vector(fraction * swing), rotations[joint])
            for joint, fraction in fractions.items()
        }
        vector = _trunk_vector(target, swung, target.joints[top])
        swing = swing + rotation_vector_from_quaternion(rotation_between(vector, target_vector))
    swing = swing * _bend_weight(hips, target_vector, _rest_vector(target, top))
    square = (swing * swing).sum(axis=1, keepdims=True)
    swing = swing * square / (square + NOISE_SWING_RAD**2)
    return {
        joint: quaternion_from_rotation_vector(fraction * swing)
        for joint, fraction in fractions.items()
    }


def _bend_weight(hips: Array, vector: Array, rest: Array) -> Array:
    """Return 0 for straight trunks, 1 for bent ones, with a smooth transition, (n_frames, 1).

    It depends on one frame only, so that a clip leans as it does within its take.
    """
    length = np.linalg.norm(vector, axis=1) * np.linalg.norm(rest)
    straight = (rotate(inverse(hips), vector) @ rest) / np.maximum(length, 1e-9)
    return smoothstep(straight, STRAIGHT_COSINE, BENT_COSINE)[:, None]


def _target_vector(
    source: HumanoidBody, target: HumanoidBody, source_poses: WorldPoses, hips: Array, top: str
) -> Array:
    """Return the direction that the target's neck should have from its hips, (n_frames, 3)."""
    rest_vectors = [_rest_vector(body, top) for body in (source, target)]
    positions = source_poses.positions
    vector = positions[:, source.joints[top]] - positions[:, source.joints["hips"]]
    upright = rotate(inverse(hips), vector)
    return np.asarray(rotate(hips, rotate(rotation_between(*rest_vectors), upright)))


def _rest_vector(body: HumanoidBody, top: str) -> Array:
    """Return the vector from hips to neck in the canonical T-pose, shape (3,), meters."""
    low, high = body.joints["hips"], body.joints[top]
    return np.asarray(rotate(inverse(body.alignment[low]), body.rest[high] - body.rest[low]))


def _trunk_vector(target: HumanoidBody, rotations: dict[int, Array], top: int) -> Array:
    """Return the vector from hips to neck, shape (n_frames, 3), meters."""
    skeleton, hips = target.skeleton, target.joints["hips"]
    chain = [top, *skeleton.ancestors(top)]
    chain = chain[: chain.index(hips) + 1][::-1]
    rotation, vector = rotations[hips], np.zeros((len(rotations[hips]), 3))
    for joint in chain[1:]:
        vector = vector + rotate(rotation, skeleton.offsets[joint])
        rotation = rotations.get(joint, rotation)
    return np.asarray(vector)
