"""A walk as MediaPipe would see it becomes a motion of a skeleton again."""

import numpy as np
import pytest
from joint_files import npy
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from solvers.motion import Tracks, forward_kinematics, motion_from_points
from solvers.motion.skeletons.mediapipe import BODY_POINTS, HAND_POINTS
from solvers.recordings import read_bvh, read_freemocap

CMU = {
    "shoulder": "Arm", "elbow": "ForeArm", "wrist": "Hand", "hip": "UpLeg", "knee": "Leg",
    "ankle": "Foot", "foot_index": "ToeBase",
}  # fmt: skip
METERS = 0.0254 / 0.45
BESIDE = {"left": (0.08, 0.0, 0.0), "right": (-0.08, 0.0, 0.0)}


@pytest.fixture(scope="module")
def walk(recordings):
    """Points of the body by MediaPipe's names, meters, (n_frames, 3) each."""
    motion = read_bvh(recordings / "mocap" / "cmu_walk" / "07_01.bvh", scale=METERS)
    motion = motion.slice(1, motion.n_frames)
    joints = dict(
        zip(
            motion.skeleton.names,
            np.moveaxis(forward_kinematics(motion).positions, 1, 0),
            strict=True,
        )
    )
    positions = {
        f"{side}_{name}": joints[f"{side.title()}{cmu}"]
        for side in BESIDE
        for name, cmu in CMU.items()
    }
    for side, beside in BESIDE.items():
        for name in ("pinky", "index", "thumb"):
            positions[f"{side}_{name}"] = joints[f"{side.title()}HandIndex1"]
        positions[f"{side}_heel"] = joints[f"{side.title()}Foot"] - (0.0, 0.0, 0.05)
        positions[f"{side}_ear"] = joints["Head"] + beside
    rest = joints["Head"] - (0.0, 0.1, 0.0)
    return np.stack([positions.get(name, rest) for name in BODY_POINTS], axis=1)


def test_motion_follows_the_tracked_joints(walk, tmp_path):
    path = tmp_path / "body.npy"
    path.write_bytes(npy(1000.0 * walk))
    recording = read_freemocap(path)

    motion = motion_from_points(recording.tracks, recording.parents)

    found = forward_kinematics(motion).positions
    for name in ("left_wrist", "right_elbow", "left_ankle", "right_knee", "neck_center"):
        measured = recording.tracks.positions[:, recording.names.index(name)]
        away = np.linalg.norm(found[:, motion.skeleton.names.index(name)] - measured, axis=1)
        assert away.mean() < 0.03, name


@pytest.mark.parametrize("n_others", [0, 42])
@pytest.mark.parametrize("points", ["board", "face"])
def test_other_points_are_no_body_though_they_are_33(tmp_path, rng, points, n_others):
    """They came in as a body whose limbs were the corners of a board."""
    corners = 50.0 * np.argwhere(np.ones((3, 11, 1)))
    own = corners if points == "board" else rng.normal(scale=(70.0, 90.0, 50.0), size=(33, 3))
    turns = Rotation.from_euler("xyz", np.linspace((0, 0, 0), (0.9, 1.2, 0.5), 60))
    moved = np.stack([turn.apply(own) for turn in turns]) + np.array([200.0, 2000.0, 800.0])
    others = rng.normal(size=(60, n_others, 3)) + np.array([0.0, 2000.0, 0.0])
    path = tmp_path / "take.npy"
    path.write_bytes(npy(np.concatenate([moved, others], axis=1)))

    recording = read_freemocap(path)

    assert isinstance(recording, Tracks)
    assert recording.names[:2] == ("point_1", "point_2")


def test_a_body_without_legs_is_one(walk, tmp_path):
    points = walk.copy()
    points[:, 23:] = np.nan
    (tmp_path / "take.npy").write_bytes(npy(1000.0 * points))

    assert read_freemocap(tmp_path / "take.npy").names[:33] == BODY_POINTS


def test_the_rest_pose_is_a_t_pose(walk, tmp_path):
    path = tmp_path / "body.npy"
    path.write_bytes(npy(1000.0 * walk))
    recording = read_freemocap(path)

    skeleton = motion_from_points(recording.tracks, recording.parents).skeleton

    rest = dict(zip(skeleton.names, skeleton.rest_positions, strict=True))
    assert rest["left_wrist"][0] - rest["left_shoulder"][0] > 0.4
    assert rest["right_shoulder"][0] - rest["right_wrist"][0] > 0.4
    assert_allclose(rest["left_wrist"][2], rest["left_shoulder"][2], atol=0.05)
    assert rest["left_hip"][2] - rest["left_ankle"][2] > 0.6
    assert rest["left_foot_index"][1] < rest["left_ankle"][1]
    assert rest["left_heel"][1] > rest["left_ankle"][1]
    assert rest["head_center"][2] > rest["neck_center"][2] > rest["hips_center"][2]


def test_fingers_hang_on_the_wrist(walk, tmp_path):
    hand = np.zeros((len(walk), len(HAND_POINTS), 3))
    hand[:, 1:, 0] = np.tile(0.03 * np.arange(1, 5), 5)
    hand[:, 1:, 1] = np.repeat(0.02 * np.arange(-2, 3), 4)
    sides = [hand + walk[:, [BODY_POINTS.index(f"{side}_wrist")]] for side in ("right", "left")]
    path = tmp_path / "body.npy"
    path.write_bytes(npy(1000.0 * np.concatenate([walk, *sides], axis=1)))
    recording = read_freemocap(path)
    names, parents = recording.names, recording.parents

    above = {
        name: names[parent] for name, parent in zip(names, parents, strict=True) if parent >= 0
    }

    for side in BESIDE:
        assert above[f"{side}_hand_ring_1"] == f"{side}_wrist"
        assert above[f"{side}_hand_ring_4"] == f"{side}_hand_ring_3"
