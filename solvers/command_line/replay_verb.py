"""`replay`: send a recording as a live stream, like the tracker of a camera."""

import argparse
import socket
import time
from collections.abc import Callable, Iterable, Iterator

from ..errors import InvalidSettingError
from ..motion import JointRecording, Motion, Tracks, resample
from ..progress import Progress, within
from ..recordings.streams import PORT, Packets, StreamProtocol, encode_recording
from .arguments import Outcome, Task, VerbWork, add_reading_options, read_recorded

PROTOCOLS = {each.value: each for each in StreamProtocol if each is not StreamProtocol.AUTO}
LOOPBACK = "127.0.0.1"
MAX_SPEED = 100.0
"""Factor of the recorded speed, at most. It bounds the load of the receiver: 3000 frames a
second of a take at 30 Hz."""
MAX_PORT = 65535


def add_replay_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `replay`."""
    add_reading_options(parser)
    parser.add_argument(
        "--as", dest="protocol", choices=PROTOCOLS, default=StreamProtocol.JSON.value,
        help="Protocol of the stream [default json]",
    )  # fmt: skip
    parser.add_argument(
        "--rate", type=float, metavar="HZ",
        help="Frames per second of the stream [default: that of the recording]",
    )  # fmt: skip
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
    if arguments.rate is not None:
        recording = _resample(recording, arguments.rate)
    packets = encode_recording(
        recording, PROTOCOLS[arguments.protocol], is_repeated=arguments.loop
    )
    report = within(progress, 0.1, 1.0)
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
        sender.connect((LOOPBACK, arguments.port))
        sent = 0
        for datagrams in pace_packets(packets, arguments.speed):
            for datagram in datagrams:
                send(sender, datagram)
            sent += 1
            report(sent % recording.n_frames / recording.n_frames, "Sending")
    message = (
        f"Sent {sent} frames as {arguments.protocol} at {recording.frame_rate:g} Hz to"
        f" {LOOPBACK}:{arguments.port}."
    )
    return Outcome(message, {"n_frames": sent, "port": arguments.port})


def _resample(
    recording: Motion | Tracks | JointRecording, frame_rate: float
) -> Motion | Tracks | JointRecording:
    """Return a recording at another rate; joints of sensors lose their tracking states."""
    if isinstance(recording, JointRecording):
        tracks = resample(recording.tracks, frame_rate)
        return JointRecording(tracks, None, recording.sensor)
    return resample(recording, frame_rate)


def pace_packets(
    packets: Iterable[Packets],
    speed: float,
    now: Callable[[], float] = time.monotonic,
    sleep: Callable[[float], None] = time.sleep,
) -> Iterator[list[bytes]]:
    """Yield the datagrams of each frame when it is due, without drift."""
    start = now()
    for frame in packets:
        delay = start + frame.time / speed - now()
        if delay > 0.0:
            sleep(delay)
        yield frame.datagrams


def send(sender: socket.socket, datagram: bytes) -> None:
    """Send a datagram; without a receiver it is dropped, as with a camera."""
    try:
        sender.send(datagram)
    except ConnectionRefusedError:
        return


REPLAY = VerbWork(add_replay_options, perform_replay)
