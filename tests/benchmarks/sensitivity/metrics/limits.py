"""Joint limits: a knee that bends the wrong way for a while, and rotations far beyond."""

import numpy as np

from solvers.denoising import (
    clamp_to_limits,
    denoise,
    learn_filter_bases,
    learn_joint_limits,
)
from solvers.motion import Motion
from solvers.rotations.representations import multiply, quaternion_from_rotation_vector
from solvers.samples import CorruptionSettings, corrupt

from ..takes import angle_error, pruned, walk

EXAMPLES = ("10_04", "27_01", "32_01", "07_11")
WRONG_FRAMES = slice(12, 34)
"""Long enough that the estimate without limits follows it."""


def prepare() -> dict[str, object]:
    """Bend a knee and an elbow by 70 degrees against their limits, and shake a walk."""
    truth = pruned(walk("07_03")).slice(20, 76)
    given = corrupt(truth, CorruptionSettings(jitter=1.0, seed=5))
    rotations = given.rotations.copy()
    for joint, axis in (("LeftLeg", (-1.0, 0.0, 0.0)), ("RightForeArm", (0.0, 1.0, 0.0))):
        column = truth.skeleton.names.index(joint)
        rotation = quaternion_from_rotation_vector(np.radians(70.0) * np.array(axis))
        rotations[WRONG_FRAMES, column] = multiply(rotations[WRONG_FRAMES, column], rotation)
    return {
        "truth": truth,
        "given": given.with_poses(rotations),
        "shaken": corrupt(truth, CorruptionSettings(jitter=15.0, seed=6)),
        "examples": tuple(pruned(walk(name)) for name in EXAMPLES),
    }


def measure(
    truth: Motion, given: Motion, shaken: Motion, examples: tuple[Motion, ...]
) -> dict[str, float]:
    """Mean angle error of what was bent, and of what is clamped."""
    bases, limits = learn_filter_bases(examples), learn_joint_limits(examples)
    cleaned = denoise(given, bases, limits=limits).recording
    assert isinstance(cleaned, Motion)
    return {
        "bent: deg": angle_error(cleaned, truth),
        "clamped: deg": angle_error(clamp_to_limits(shaken, limits), truth),
        "clamped truth: deg": 0.01 + angle_error(clamp_to_limits(truth, limits), truth),
    }
