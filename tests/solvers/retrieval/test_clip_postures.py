"""Postures of a clip do not depend on actor, position and size."""

from dataclasses import replace

import numpy as np
import pytest
from acted_clips import act
from numpy.testing import assert_allclose

from solvers.errors import InvalidMotionError
from solvers.motion import Tracks, find_humanoid_map
from solvers.motion.humanoid.body_size import ADULT_BONE_LENGTHS_M, segment_lengths
from solvers.motion.humanoid.posture_joints import POSTURE_JOINTS, postures_from_motion
from solvers.recordings import read_recording
from solvers.retrieval.postures.clip_postures import clip_postures
from solvers.samples import GaitSettings, walking_gait


@pytest.mark.parametrize("name", ["step", "kick"])
def test_postures_ignore_heading_position_and_size(name):
    here = clip_postures(act(name))
    moved = clip_postures(act(name, heading=2.5, position=(7.0, -2.0)))
    assert_allclose(moved.positions, here.positions, atol=1e-9)
    assert_allclose(moved.root_velocity, here.root_velocity, atol=1e-9)
    assert_allclose(clip_postures(act(name, size=1.3)).positions, here.positions, atol=1e-9)


def test_bones_have_default_lengths():
    found = segment_lengths(clip_postures(act("kick", size=0.8)).positions)
    assert_allclose(found, np.tile(ADULT_BONE_LENGTHS_M, (60, 1)), atol=1e-9)


def test_velocity_is_in_the_actors_frame():
    observed = clip_postures(act("step", heading=1.0))
    forward = -observed.root_velocity[5:-5, 1]
    assert_allclose(observed.root_velocity[5:-5, 0], 0.0, atol=1e-9)
    assert forward.min() > 1.0
    assert_allclose(observed.root_velocity[:, 3], 0.0, atol=1e-9)


def test_turning_rate_is_in_radians_per_second():
    still = act("kick", seconds=3.0, amount=0.0)
    angles = 1.5 * np.arange(90) / 30.0
    cos, sin = np.cos(angles)[:, None], np.sin(angles)[:, None]
    x, y, z = np.moveaxis(still.positions, -1, 0)
    rotated = np.stack([cos * x - sin * y, sin * x + cos * y, z], axis=-1)
    root_velocity = clip_postures(replace(still, positions=rotated)).root_velocity
    assert_allclose(root_velocity[20:-20, 3], 1.5, atol=0.01)


def test_another_frame_rate_has_the_same_times():
    fine = clip_postures(act("kick", frame_rate=60.0), 20.0)
    coarse = clip_postures(act("kick", frame_rate=20.0))
    assert fine.n_frames == coarse.n_frames == 40
    assert_allclose(fine.positions, coarse.positions, atol=0.01)


def test_short_gaps_of_motions_and_points_are_filled_equally():
    """Four frames of a forearm at 60 Hz, and three fifths of a second of the other."""
    walk = walking_gait(GaitSettings(duration=2.0, frame_rate=60.0))
    joints = find_humanoid_map(walk.skeleton).indices(walk.skeleton)
    rotations = walk.rotations.copy()
    rotations[30:34, joints["leftLowerArm"]] = np.nan
    rotations[50:86, joints["rightLowerArm"]] = np.nan
    motion = walk.with_poses(rotations)
    points = Tracks(POSTURE_JOINTS, postures_from_motion(motion), 60.0)
    left, right = (POSTURE_JOINTS.index(f"{side}Hand") for side in ("left", "right"))
    assert np.isnan(points.positions[30:34, left]).all()

    of_motion, of_points = (clip_postures(each, 20.0).positions for each in (motion, points))

    for observed in (of_motion, of_points):
        assert np.isfinite(observed[:, left]).all()
        assert np.isnan(observed[18:28, right]).all()
    assert_allclose(of_motion, of_points, atol=0.01)


def test_joint_below_a_missing_one_keeps_its_observed_position():
    complete, missing = act("wave", size=1.2), act("wave", size=1.2)
    elbow, wrist = (POSTURE_JOINTS.index(f"right{part}") for part in ("LowerArm", "Hand"))
    missing.positions[:, elbow] = np.nan
    observed = clip_postures(missing).positions
    assert not np.isfinite(observed[:, elbow]).any()
    assert_allclose(observed[:, wrist], clip_postures(complete).positions[:, wrist], atol=0.05)


@pytest.mark.parametrize(
    "missing", [("leftUpperLeg", "rightUpperArm"), ("leftUpperArm", "leftUpperLeg")]
)
def test_heading_needs_one_joint_of_each_pair(missing):
    complete, part = act("bow", heading=2.0), act("bow", heading=2.0)
    part.positions[:, [POSTURE_JOINTS.index(name) for name in missing]] = np.nan
    head = POSTURE_JOINTS.index("head")
    assert_allclose(
        clip_postures(part).positions[:, head],
        clip_postures(complete).positions[:, head],
        atol=0.03,
    )


def test_motions_points_and_sensors_are_read(recordings):
    motion = walking_gait(GaitSettings(duration=1.0))
    assert np.isfinite(clip_postures(motion).positions[:, 1:4]).all()
    for name in ("mocap/hdm05", "mocap/cmu_walk", "kinect/irds", "kinect/msr_action3d"):
        files = sorted((recordings / name).iterdir())
        file = next(file for file in files if file.suffix in {".amc", ".bvh", ".txt"})
        observed = clip_postures(read_recording(file), 20.0)
        assert np.isfinite(observed.positions).mean() > 0.8
        assert np.abs(observed.positions[np.isfinite(observed.positions)]).max() < 1.5


def test_clip_without_a_body_is_refused():
    points = Tracks(("a", "b"), np.zeros((3, 2, 3)), 30.0)
    with pytest.raises(InvalidMotionError, match="No body was recognized"):
        clip_postures(points)
