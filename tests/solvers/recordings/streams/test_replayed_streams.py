"""What is sent over a socket arrives as it was, within the rounding of the protocol."""

import socket

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidMotionError
from solvers.motion import (
    Motion,
    Skeleton,
    Tracks,
    canonical_rotations,
    find_humanoid_map,
    forward_kinematics,
)
from solvers.motion.humanoid import posture_joint_indices, postures_from_motion
from solvers.recordings.streams import (
    StreamListener,
    StreamProtocol,
    encode_recording,
    joints_from_pose,
    motion_from_poses,
)
from solvers.rotations import angle_between, quaternion_from_rotation_vector, rotate
from solvers.samples import GaitSettings, walking_gait

BONES = [
    StreamProtocol.VMC, StreamProtocol.MOCOPI, StreamProtocol.XSENS, StreamProtocol.ROKOKO,
]  # fmt: skip
JOINTS = [StreamProtocol.MEDIAPIPE, StreamProtocol.JSON]
ROUNDING_M = 2e-5
"""Meters: Rokoko's JSON is rounded to 0.01 mm."""
ROKOKO_TRUNK_M = 0.005
"""Meters: its trunk has one bone less, which bends by a few degrees."""
ROUNDING_DEG = 5e-3


@pytest.fixture(scope="module")
def walk():
    return walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))


def received(recording, protocol, chosen=StreamProtocol.AUTO):
    """The frames that come out of a socket, and what is known of the stream."""
    frames = []
    with (
        StreamListener(0, chosen) as listener,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender,
    ):
        sender.connect(listener.receiver.address)
        for packets in encode_recording(recording, protocol):
            for datagram in packets.datagrams:
                sender.send(datagram)
            frames += listener.poll()
        return frames, listener.state


@pytest.mark.parametrize("protocol", BONES)
def test_bones_have_the_positions_and_rotations_that_were_sent(walk, protocol):
    frames, state = received(walk, protocol)

    assert state.protocol is protocol
    assert (state.counts.frames, state.counts.dropped) == (walk.n_frames, 0)
    assert state.rate == pytest.approx(30.0, abs=0.1)
    times = np.array([frame.time for frame in frames])
    assert_allclose(times - times[0], np.arange(walk.n_frames) / 30.0, atol=1e-3)
    motion = motion_from_poses(frames, 30.0)
    assert all(frame.skeleton is frames[0].skeleton for frame in frames)
    sent, came = find_humanoid_map(walk.skeleton), find_humanoid_map(motion.skeleton)
    joints, others = sent.indices(walk.skeleton), came.indices(motion.skeleton)
    roles = [role for role in joints if role in others and role != "chest"]
    assert len(roles) >= 20
    columns, other_columns = [joints[role] for role in roles], [others[role] for role in roles]
    assert_allclose(
        forward_kinematics(motion).positions[:, other_columns],
        forward_kinematics(walk).positions[:, columns],
        atol=ROKOKO_TRUNK_M if protocol is StreamProtocol.ROKOKO else ROUNDING_M,
    )
    limbs = [role for role in roles if "Lower" in role or "Upper" in role]
    angles = angle_between(
        canonical_rotations(motion, came)[:, [others[role] for role in limbs]],
        canonical_rotations(walk, sent)[:, [joints[role] for role in limbs]],
    )
    assert np.degrees(angles.max()) < ROUNDING_DEG


@pytest.mark.parametrize("protocol", JOINTS)
def test_joints_have_the_positions_that_were_sent(walk, protocol):
    frames, state = received(walk, protocol)

    assert state.protocol is protocol and len(frames) == walk.n_frames
    true, joints = postures_from_motion(walk), posture_joint_indices(frames[0].names)
    legs = [10 + 2, 13, 14, 16, 17, 18]
    center = np.zeros((walk.n_frames, 3))
    if protocol is StreamProtocol.MEDIAPIPE:  # keeps the hips at the origin
        center = true[:, [12, 16]].mean(axis=1)
    names = ("leftUpperLeg", "leftLowerLeg", "leftFoot", "rightUpperLeg", "rightLowerLeg",
             "rightFoot")  # fmt: skip
    came = np.stack([frame.positions[[joints[name] for name in names]] for frame in frames])
    assert_allclose(came, true[:, legs] - center[:, None], atol=1e-4)


def test_frames_of_landmarks_without_a_body_are_left_out(walk):
    names = ("HipLeft", "HipRight", "KneeLeft", "Head")
    positions = np.tile(
        [[0.1, 0.0, 0.9], [-0.1, 0.0, 0.9], [0.1, 0.0, 0.5], [0.0, 0.0, 1.6]], (9, 1, 1)
    )
    positions[2:4], positions[5, 0] = np.nan, np.nan

    frames, state = received(Tracks(names, positions, 30.0), StreamProtocol.MEDIAPIPE)

    assert (len(frames), state.counts.dropped, state.counts.why) == (6, 0, "")


@pytest.mark.parametrize("protocol", BONES)
def test_a_rig_that_rests_in_another_pose_arrives_the_same(walk, protocol):
    """Arms that hang in the rest pose hang in the stream only if they hang in the motion."""
    roles = find_humanoid_map(walk.skeleton)
    joints = roles.indices(walk.skeleton)
    offsets = walk.skeleton.offsets.copy()
    for side, sign in (("left", 1.0), ("right", -1.0)):
        down = quaternion_from_rotation_vector(np.array([0.0, sign * np.radians(60.0), 0.0]))
        for role in ("LowerArm", "Hand"):
            offsets[joints[f"{side}{role}"]] = rotate(down, offsets[joints[f"{side}{role}"]])
    skeleton = Skeleton(walk.skeleton.names, walk.skeleton.parents, offsets)
    still = np.tile([1.0, 0.0, 0.0, 0.0], (2, skeleton.n_joints, 1))
    resting = Motion(skeleton, still, np.tile(skeleton.offsets[0], (2, 1)), 30.0)

    frames, _ = received(resting, protocol)

    came = joints_from_pose(frames[-1])
    elbow, hand = (came.positions[came.names.index(f"left{part}")]
                   for part in ("LowerArm", "Hand"))  # fmt: skip
    true = rotate(down, [-1.0, 0.0, 0.0]) * (-1.0, 1.0, 1.0)
    assert_allclose((hand - elbow) / np.linalg.norm(hand - elbow), true, atol=0.02)


def test_a_chosen_protocol_refuses_others(walk):
    frames, state = received(walk, StreamProtocol.XSENS, StreamProtocol.MOCOPI)

    assert not frames
    assert state.counts.unreadable == walk.n_frames
    assert "mocopi is damaged" in state.counts.why


def test_points_cannot_be_sent_as_bones():
    points = Tracks(("hips", "head"), np.zeros((3, 2, 3)), 30.0)

    with pytest.raises(InvalidMotionError, match="VMC streams rotations of bones"):
        encode_recording(points, StreamProtocol.VMC)
    with pytest.raises(InvalidMotionError, match="has no hips"):
        encode_recording(points, StreamProtocol.MEDIAPIPE)


def test_a_skeleton_that_is_no_body_cannot_be_sent_as_bones():
    pair = Skeleton(("a", "b"), (-1, 0), np.ones((2, 3)))
    motion = Motion(pair, np.tile([1.0, 0, 0, 0], (2, 2, 1)), np.zeros((2, 3)), 30.0)

    with pytest.raises(InvalidMotionError, match="no joint for"):
        encode_recording(motion, StreamProtocol.XSENS)
