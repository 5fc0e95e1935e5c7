"""Encode a recording as the packets of a protocol, frame by frame."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import NamedTuple

from ...errors import InvalidMotionError
from ...motion import SENSOR_JOINTS, JointRecording, Motion, Sensor, Tracks, forward_kinematics
from ...motion.humanoid import posture_joint_indices, postures_from_motion
from ..live import MAX_JOINTS, PoseFrame, encode_frame, frames_from_recording
from .layouts import MOCOPI, XSENS, humanoid_layout, motion_in_layout
from .mediapipe import encode_mediapipe
from .mocopi import encode_frame_packet, encode_skeleton_packet
from .protocols import StreamProtocol
from .rokoko import encode_rokoko
from .vmc import encode_vmc
from .xsens import encode_xsens


N_SKELETON_FRAMES = 60
"""Number of frames from one skeleton of mocopi to the next: a receiver may start late."""


class Packets(NamedTuple):
    """The packets of one frame."""

    time: float
    """Seconds from the first frame."""
    datagrams: list[bytes]


def encode_recording(
    recording: Motion | Tracks | JointRecording, protocol: StreamProtocol
) -> Iterator[Packets]:
    """Yield the packets of each frame, as a tracker would send them, starting at time 0.

    Protocols of bones need a motion; those of joints take any recording of a body.

    Raises
    ------
    InvalidMotionError
        The recording does not fit the protocol.
    """
    if protocol in ENCODERS:
        if not isinstance(recording, Motion):
            raise InvalidMotionError(
                f"{protocol.label} streams rotations of bones, and the recording has points."
                " Reconstruct it first, or replay it as json or mediapipe."
            )
        return ENCODERS[protocol](recording)
    joints = joints_of(recording)
    if protocol is StreamProtocol.MEDIAPIPE:
        return _mediapipe(joints)
    return (Packets(frame.time, [encode_frame(frame)]) for frame in frames_from_recording(joints))


def joints_of(recording: Motion | Tracks | JointRecording) -> JointRecording:
    """Return the joints of any recording; of a skeleton, those that the Kinect v1 tracks.

    Raises
    ------
    InvalidMotionError
        There are more joints than a stream has.
    """
    if isinstance(recording, Motion):
        names = SENSOR_JOINTS[Sensor.KINECT_V1]
        tracks = Tracks(names, postures_from_motion(recording), recording.frame_rate)
        return JointRecording(tracks, None, Sensor.KINECT_V1)
    joints = (
        JointRecording(recording, None, Sensor.OTHER)
        if isinstance(recording, Tracks)
        else recording
    )
    if joints.n_joints > MAX_JOINTS:
        raise InvalidMotionError(
            f"The recording has {joints.n_joints} points; a live stream has at most"
            f" {MAX_JOINTS}. Choose a recording of joints or of a skeleton."
        )
    return joints


def _mediapipe(joints: JointRecording) -> Iterator[Packets]:
    roles = posture_joint_indices(joints.names)
    if not {"leftUpperLeg", "rightUpperLeg"} <= roles.keys():
        raise InvalidMotionError("The recording has no hips. Choose the recording of a body.")
    for frame in frames_from_recording(joints):
        yield Packets(frame.time, [encode_mediapipe(frame, roles)])


def _vmc(motion: Motion) -> Iterator[Packets]:
    for frame in _pose_frames(motion_in_layout(motion)):
        yield Packets(frame.time, encode_vmc(frame))


def _mocopi(motion: Motion) -> Iterator[Packets]:
    given = motion_in_layout(motion, MOCOPI)
    for number, frame in enumerate(_pose_frames(given)):
        skeleton = [encode_skeleton_packet(given.skeleton)] * (not number % N_SKELETON_FRAMES)
        yield Packets(frame.time, [*skeleton, encode_frame_packet(frame, number)])


def _xsens(motion: Motion) -> Iterator[Packets]:
    given = motion_in_layout(motion, XSENS)
    poses = forward_kinematics(given)
    for number, frame in enumerate(_pose_frames(given)):
        datagram = encode_xsens(frame, number, poses.positions[number], poses.rotations[number])
        yield Packets(frame.time, [datagram])


def _rokoko(motion: Motion) -> Iterator[Packets]:
    given = motion_in_layout(motion, partial(humanoid_layout, has_upper_chest=False))
    poses = forward_kinematics(given)
    for number, frame in enumerate(_pose_frames(given)):
        packet = encode_rokoko(frame, poses.positions[number], poses.rotations[number])
        yield Packets(frame.time, [packet])


def _pose_frames(motion: Motion) -> Iterator[PoseFrame]:
    for frame, (rotations, position) in enumerate(
        zip(motion.rotations, motion.root_positions, strict=True)
    ):
        yield PoseFrame(frame * motion.dt, 0, motion.skeleton, rotations, position)


ENCODERS: dict[StreamProtocol, Callable[[Motion], Iterator[Packets]]] = {
    StreamProtocol.VMC: _vmc,
    StreamProtocol.MOCOPI: _mocopi,
    StreamProtocol.XSENS: _xsens,
    StreamProtocol.ROKOKO: _rokoko,
}
"""Those of bones."""
