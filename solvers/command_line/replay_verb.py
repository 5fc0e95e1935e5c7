"""`replay`: send a recording as a live stream, as the tracker of a camera would."""

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
from ..recordings import read_tracked
from ..recordings.live import MAX_JOINTS, PORT, LiveFrame, encode_frame, frames_from_recording
from .files import add_reading_options
from .verb import Outcome, Task

LOOPBACK = "127.0.0.1"
FASTEST = 100.0
LAST_PORT = 65535


def add_replay_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `replay`."""
    add_reading_options(parser)
    parser.add_argument(
        "--port", type=int, default=PORT, metavar="N",
        help=f"UDP port of this machine to send to [1 to {LAST_PORT}, default {PORT}]",
    )  # fmt: skip
    parser.add_argument(
        "--speed", type=float, default=1.0, metavar="X",
        help=f"How many times faster than it was recorded [up to {FASTEST:g}, default 1]",
    )  # fmt: skip
    parser.add_argument(
        "--loop", action="store_true", help="Begin again at the end, until Ctrl+C"
    )


def perform_replay(task: Task, prepared: None, progress: Progress) -> Outcome:
    """Send one recording, each frame at its time."""
    arguments = task.arguments
    if not 1 <= arguments.port <= LAST_PORT:
        raise InvalidSettingError(f"port is {arguments.port}; take one up to {LAST_PORT}.")
    if not 0.0 < arguments.speed <= FASTEST:
        raise InvalidSettingError(
            f"speed is {arguments.speed:g}; it must be above 0 and at most {FASTEST:g}."
        )
    recording = read_tracked(
        task.source, scale=arguments.scale, progress=within(progress, 0.0, 0.1)
    )
    joints = _joints(recording)
    if joints.n_joints > MAX_JOINTS:
        raise InvalidMotionError(
            f"{task.source} has {joints.n_joints} points; a live stream has at most"
            f" {MAX_JOINTS}. Take a recording of joints, or of a skeleton."
        )
    frames = looped(joints) if arguments.loop else frames_from_recording(joints)
    told = within(progress, 0.1, 1.0)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.connect((LOOPBACK, arguments.port))
        sent = 0
        for line in paced(frames, arguments.speed):
            send(sender, line)
            sent += 1
            told(sent % joints.n_frames / joints.n_frames, "Sending")
    said = f"Sent {sent} frames at {joints.frame_rate:g} Hz to {LOOPBACK}:{arguments.port}."
    return Outcome(said, {"n_frames": sent, "port": arguments.port})


def looped(recording: JointRecording) -> Iterator[LiveFrame]:
    """Yield the frames of a recording again and again; time goes on."""
    duration = recording.n_frames / recording.frame_rate
    for turn in itertools.count():
        for frame in frames_from_recording(recording):
            yield replace(frame, time=frame.time + turn * duration)


def paced(
    frames: Iterator[LiveFrame],
    speed: float,
    now: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], None] = time.sleep,
) -> Iterator[bytes]:
    """Yield the line of each frame when its time has come, on a clock that does not drift."""
    start = now()
    for frame in frames:
        early = start + frame.time / speed - now()
        if early > 0.0:
            sleep(early)
        yield encode_frame(frame)


def send(sender: socket.socket, line: bytes) -> None:
    """Send one line; where nobody listens yet, it is lost, as with a camera."""
    try:
        sender.send(line)
    except ConnectionRefusedError:
        return


def _joints(recording: Motion | Tracks | JointRecording) -> JointRecording:
    """Return the joints of anything: of a skeleton, those that the first Kinect tracks."""
    if isinstance(recording, JointRecording):
        return recording
    if isinstance(recording, Tracks):
        return JointRecording(recording, None, Sensor.OTHER)
    names = SENSOR_JOINTS[Sensor.KINECT_V1]
    tracks = Tracks(names, postures_from_motion(recording), recording.frame_rate)
    return JointRecording(tracks, None, Sensor.KINECT_V1)
