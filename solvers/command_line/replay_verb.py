"""`replay`: send a recording as a live stream, like the tracker of a camera."""

import argparse
import itertools
import socket
import time
from collections.abc import Callable, Iterator
from dataclasses import replace

from ..errors import InvalidMotionError, InvalidSettingError
from ..motion import SENSOR_JOINTS, JointRecording, Motion, Sensor, Tracks
from ..motion.humanoid import postures_from_motion
from ..progress import Progress, within
from ..recordings.live import MAX_JOINTS, PORT, LiveFrame, encode_frame, frames_from_recording
from .files import add_reading_options, read_recorded
from .verb_description import Outcome, Task

LOOPBACK = "127.0.0.1"
MAX_SPEED = 100.0
MAX_PORT = 65535


def add_replay_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `replay`."""
    add_reading_options(parser)
    parser.add_argument(
        "--port", type=int, default=PORT, metavar="N",
        help=f"UDP port of this machine to send to [1 to {MAX_PORT}, default {PORT}]",
    )  # fmt: skip
    parser.add_argument(
        "--speed", type=float, default=1.0, metavar="X",
        help=f"Playback speed relative to real time [up to {MAX_SPEED:g}, default 1]",
    )  # fmt: skip
    parser.add_argument("--loop", action="store_true", help="Repeat until Ctrl+C")


def perform_replay(task: Task, prepared: None, progress: Progress) -> Outcome:
    """Send one recording in real time."""
    arguments = task.arguments
    if not 1 <= arguments.port <= MAX_PORT:
        raise InvalidSettingError(
            f"port is {arguments.port}; it must be between 1 and {MAX_PORT}."
        )
    if not 0.0 < arguments.speed <= MAX_SPEED:
        raise InvalidSettingError(
            f"speed is {arguments.speed:g}; it must be above 0 and at most {MAX_SPEED:g}."
        )
    recording = read_recorded(task.source, arguments, within(progress, 0.0, 0.1))
    joints = _joints(recording)
    if joints.n_joints > MAX_JOINTS:
        raise InvalidMotionError(
            f"{task.source} has {joints.n_joints} points; a live stream has at most"
            f" {MAX_JOINTS}. Choose a recording of joints or of a skeleton."
        )
    frames = loop_frames(joints) if arguments.loop else frames_from_recording(joints)
    report = within(progress, 0.1, 1.0)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.connect((LOOPBACK, arguments.port))
        sent = 0
        for line in pace_frames(frames, arguments.speed):
            send(sender, line)
            sent += 1
            report(sent % joints.n_frames / joints.n_frames, "Sending")
    message = f"Sent {sent} frames at {joints.frame_rate:g} Hz to {LOOPBACK}:{arguments.port}."
    return Outcome(message, {"n_frames": sent, "port": arguments.port})


def loop_frames(recording: JointRecording) -> Iterator[LiveFrame]:
    """Yield the frames of a recording in an endless loop, with increasing time."""
    duration = recording.n_frames / recording.frame_rate
    for cycle in itertools.count():
        for frame in frames_from_recording(recording):
            yield replace(frame, time=frame.time + cycle * duration)


def pace_frames(
    frames: Iterator[LiveFrame],
    speed: float,
    now: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], None] = time.sleep,
) -> Iterator[bytes]:
    """Yield the line of each frame when it is due, without drift."""
    start = now()
    for frame in frames:
        delay = start + frame.time / speed - now()
        if delay > 0.0:
            sleep(delay)
        yield encode_frame(frame)


def send(sender: socket.socket, line: bytes) -> None:
    """Send one line; without a receiver it is dropped, as with a camera."""
    try:
        sender.send(line)
    except ConnectionRefusedError:
        return


def _joints(recording: Motion | Tracks | JointRecording) -> JointRecording:
    """Return the joints of any recording; of a skeleton, those that the Kinect v1 tracks."""
    if isinstance(recording, JointRecording):
        return recording
    if isinstance(recording, Tracks):
        return JointRecording(recording, None, Sensor.OTHER)
    names = SENSOR_JOINTS[Sensor.KINECT_V1]
    tracks = Tracks(names, postures_from_motion(recording), recording.frame_rate)
    return JointRecording(tracks, None, Sensor.KINECT_V1)
