"""Encode a recording as the packets of a protocol, frame by frame."""

import itertools
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from typing import NamedTuple

from ...arrays import Array
from ...errors import InvalidMotionError
from ...motion import SENSOR_JOINTS, JointRecording, Motion, Sensor, Tracks, forward_kinematics
from ...motion.humanoid import posture_joint_indices, postures_from_motion
from .frames import MAX_JOINTS, LiveFrame, PoseFrame, encode_frame, frames_from_recording
from .protocols import (
    MOCOPI,
    XSENS,
    StreamLayout,
    StreamProtocol,
    encode_frame_packet,
    encode_mediapipe,
    encode_rokoko,
    encode_skeleton_packet,
    encode_vmc,
    encode_xsens,
    humanoid_layout,
    motion_in_layout,
)

N_SKELETON_FRAMES = 60
"""Number of frames from one skeleton of mocopi to the next: a receiver may start late."""
Encode = Callable[[int, float], list[bytes]]
"""Returns the packets of a frame, by its number and time."""


class Packets(NamedTuple):
    """The packets of one frame."""

    time: float
    """Seconds from the first frame."""
    datagrams: list[bytes]


def encode_recording(
    recording: Motion | Tracks | JointRecording,
    protocol: StreamProtocol,
    *,
    is_repeated: bool = False,
) -> Iterator[Packets]:
    """Yield the packets of each frame, as a tracker would send them, starting at time 0.

    Protocols of bones need a motion; those of joints take any recording of a body. A repeated
    recording has no end, and its time goes on.

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
        motion = motion_in_layout(recording, LAYOUTS[protocol])
        encode = ENCODERS[protocol](motion)
        return _packets_in_time(motion.n_frames, motion.dt, is_repeated, encode)
    joints = joints_of(recording)
    frames = list(frames_from_recording(joints))
    encode = _mediapipe(frames) if protocol is StreamProtocol.MEDIAPIPE else _json(frames)
    return _packets_in_time(len(frames), joints.tracks.dt, is_repeated, encode)


def _packets_in_time(
    n_frames: int, dt: float, is_repeated: bool, encode: Encode
) -> Iterator[Packets]:
    """Yield the packets of frames, which repeat if wanted."""
    for number in itertools.count() if is_repeated else range(n_frames):
        yield Packets(number * dt, encode(number % n_frames, number * dt))


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


def _json(frames: Sequence[LiveFrame]) -> Encode:
    return lambda frame, time: [encode_frame(replace(frames[frame], time=time))]


def _mediapipe(frames: Sequence[LiveFrame]) -> Encode:
    roles = posture_joint_indices(frames[0].names)
    if not {"leftUpperLeg", "rightUpperLeg"} <= roles.keys():
        raise InvalidMotionError("The recording has no hips. Choose the recording of a body.")
    return lambda frame, time: [encode_mediapipe(replace(frames[frame], time=time), roles)]


def _vmc(motion: Motion) -> Encode:
    return lambda frame, time: encode_vmc(_pose(motion, frame, time))


def _mocopi(motion: Motion) -> Encode:
    skeleton = encode_skeleton_packet(motion.skeleton)

    def encode(frame: int, time: float) -> list[bytes]:
        packet = encode_frame_packet(_pose(motion, frame, time), frame)
        return [packet] if frame % N_SKELETON_FRAMES else [skeleton, packet]

    return encode


def _xsens(motion: Motion) -> Encode:
    return _in_world(motion, encode_xsens)


def _rokoko(motion: Motion) -> Encode:
    return _in_world(motion, encode_rokoko)


def _in_world(motion: Motion, encode: Callable[[PoseFrame, Array, Array], bytes]) -> Encode:
    """Return the encoder of a protocol with positions and rotations in the world."""
    poses = forward_kinematics(motion)
    return lambda frame, time: [
        encode(_pose(motion, frame, time), poses.positions[frame], poses.rotations[frame])
    ]


def _pose(motion: Motion, frame: int, time: float) -> PoseFrame:
    rotations, position = motion.rotations[frame], motion.root_positions[frame]
    return PoseFrame(time, 0, motion.skeleton, rotations, position)


LAYOUTS: dict[StreamProtocol, StreamLayout | Callable[[Sequence[str]], StreamLayout]] = {
    StreamProtocol.VMC: humanoid_layout,
    StreamProtocol.MOCOPI: MOCOPI,
    StreamProtocol.XSENS: XSENS,
    StreamProtocol.ROKOKO: partial(humanoid_layout, has_upper_chest=False),
}
ENCODERS: dict[StreamProtocol, Callable[[Motion], Encode]] = {
    StreamProtocol.VMC: _vmc,
    StreamProtocol.MOCOPI: _mocopi,
    StreamProtocol.XSENS: _xsens,
    StreamProtocol.ROKOKO: _rokoko,
}
"""Those of bones."""
