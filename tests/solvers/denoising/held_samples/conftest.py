"""A walk that was recorded with a little jitter, as any tracker leaves it."""

import numpy as np
import pytest

from solvers.motion import Motion
from solvers.rotations import multiply, quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait


@pytest.fixture(scope="package")
def add_jitter():
    """Return a function that adds noise of these degrees to all rotations."""

    def add(motion: Motion, degrees: float) -> Motion:
        vectors = np.random.default_rng(3).normal(size=(*motion.rotations.shape[:2], 3))
        noise = quaternion_from_rotation_vector(np.radians(degrees) * vectors)
        return motion.with_poses(multiply(motion.rotations, noise))

    return add


@pytest.fixture(scope="package")
def hold():
    """Return a function that repeats the rotations before these frames."""

    def repeat(motion: Motion, frames: slice, joints: list[int]) -> Motion:
        rotations = motion.rotations.copy()
        rotations[frames, joints] = rotations[frames.start - 1, joints]
        return motion.with_poses(rotations)

    return repeat


@pytest.fixture(scope="package")
def walk(add_jitter) -> Motion:
    """Three seconds at 30 Hz, recorded with a jitter of 0.02 degrees."""
    return add_jitter(walking_gait(GaitSettings(duration=3.0, frame_rate=30.0)), 0.02)


@pytest.fixture(scope="package")
def arm(walk) -> list[int]:
    return list(walk.skeleton.subtree(walk.skeleton.index("RightArm")))
