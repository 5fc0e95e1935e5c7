"""A joint that is turned elsewhere in one frame is an issue; one that moves is none."""

import re

import numpy as np
import pytest

from solvers.denoising import find_worst_issues, measure_quality
from solvers.motion import Motion
from solvers.rotations import multiply, quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait


@pytest.fixture(scope="module", params=[30.0, 120.0])
def walk(request) -> Motion:
    return walking_gait(GaitSettings(duration=3.0, frame_rate=request.param))


def turned(motion: Motion, name: str, frames: slice, degrees: float) -> Motion:
    rotations, joint = motion.rotations.copy(), motion.skeleton.index(name)
    turn = quaternion_from_rotation_vector(np.radians([0.0, 0.0, degrees]))
    rotations[frames, joint] = multiply(rotations[frames, joint], turn)
    return motion.with_poses(rotations)


@pytest.mark.parametrize("name", ["LeftForeArm", "Head", "Hips"])
def test_joint_that_is_turned_elsewhere_is_listed(walk, name):
    half = walk.n_frames // 2
    jump = turned(walk, name, slice(half, None), 40.0)
    (found,) = measure_quality(jump).joint_jumps
    assert (found.signal.joint, found.frame) == (name, half)
    assert np.degrees(found.angle) == pytest.approx(40.0, abs=3.0)
    (issue,) = (each for each in find_worst_issues(jump) if each.kind == "jump")
    assert (issue.joint, issue.start_frame) == (name, half - 1)
    assert re.fullmatch(rf"{name} jumps by \d+\.\d° and stays there\.", issue.sentence)


def test_movement_noise_and_spikes_are_no_jumps(walk, rng):
    assert not measure_quality(walk).joint_jumps
    vectors = np.radians(3.0) * rng.normal(size=(*walk.rotations.shape[:2], 3))
    noise = quaternion_from_rotation_vector(vectors)
    noisy = walk.with_poses(multiply(walk.rotations, noise))
    assert not measure_quality(noisy).joint_jumps
    half = walk.n_frames // 2
    brief = slice(half, half + round(0.2 * walk.frame_rate))
    assert not measure_quality(turned(walk, "Head", brief, 40.0)).joint_jumps


def test_separate_pose_at_the_start_is_no_jump(walk):
    assert not measure_quality(turned(walk, "LeftArm", slice(0, 3), 80.0)).joint_jumps


def test_take_of_a_few_frames_is_accepted(walk):
    assert not measure_quality(walk.slice(0, 4)).joint_jumps
