"""Select the frames of one body from a live stream, and build a recording from them."""

from collections import Counter, deque
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import Protocol

import numpy as np

from ....errors import InvalidFileError, MocapAssistError
from ....motion import JointRecording
from ....progress import unwatched
from ...conventions import JointSamples, joint_recording
from ...identities import BODY_TIMEOUT_S
from .joint_frames import LiveFrame, decode_frame
from .people import NEW_STREAM_S, Person, StreamPeople
from .pose_frames import PoseFrame

N_RESTART_FRAMES = 5
"""Number of consecutive late frames in ascending order that also start a new stream."""
MAX_LINES = 128
"""Maximum number of lines to read at a time: two seconds of two bodies, about 35 ms."""
N_RATE_STEPS = 30
"""Number of steps between frames from which the rate is measured: a second at 30 Hz."""
PERFORMANCE = "The performance"

StreamFrame = LiveFrame | PoseFrame


class FrameDecoder(Protocol):
    """Decodes the datagrams of a protocol; see `JointLines`."""

    @property
    def max_parts(self) -> int:
        """Maximum number of parts to decode at a time; `parts` may change it."""

    def parts(self, datagram: bytes) -> list[bytes]:
        """Return what is decoded by itself."""

    def decode(self, part: bytes, arrived: float) -> Iterable[StreamFrame]:
        """Return the frames that a part completes, or raise MocapAssistError.

        Streams without a clock have the time at which the part arrived, in seconds.
        """


class JointLines:
    """Decodes this project's own lines of JSON."""

    max_parts = MAX_LINES

    def parts(self, datagram: bytes) -> list[bytes]:
        """Return the lines."""
        return datagram.splitlines()

    def decode(self, part: bytes, arrived: float) -> list[LiveFrame]:
        """Return the frame of a line."""
        return [decode_frame(part)]


@dataclass
class StreamCounts:
    """Number of received frames, and of dropped ones by reason."""

    frames: int = 0
    unreadable: int = 0
    """Damaged, too long, or of another format."""
    late: int = 0
    """Not later than a previous frame."""
    others: int = 0
    """Of people who are not followed."""
    skipped: int = 0
    """Lines that were not read because too many arrived at once."""
    why: str = field(default="")
    """Why the last unreadable frame was dropped."""

    @property
    def dropped(self) -> int:
        """Number of all dropped frames."""
        return self.unreadable + self.late + self.others + self.skipped


class StreamReader:
    """Decode datagrams to the frames of one body, in order; invalid input never raises.

    The first person is followed until missing for a second, or the one with a chosen number.
    Frames have the body that the sender first called this person, also where the sender
    exchanges identities. Frames that are at least two seconds too old come from a restarted
    sender, and so do consecutive late frames in ascending order.

    Parameters
    ----------
    decoder : FrameDecoder, optional
        By default `JointLines`.
    chosen : int
        Number of the person to follow, from 1 in the order in which people appear; 0: the
        first one.
    """

    def __init__(self, decoder: FrameDecoder | None = None, chosen: int = 0) -> None:
        self.counts = StreamCounts()
        self._people, self._chosen = StreamPeople(), chosen
        self._decoder = decoder or JointLines()
        self._steps = deque[float](maxlen=N_RATE_STEPS)
        self._late: list[float] = []
        self.restart()

    def restart(self) -> None:
        """Forget body and time: another sender comes."""
        self._people.forget()
        self._followed: Person | None = None
        self._time = float("-inf")
        self._late.clear()
        self._steps.clear()

    @property
    def n_people(self) -> int:
        """Number of people in the last second of the stream."""
        return self._people.n_present

    @property
    def followed(self) -> int:
        """Number of the person who is followed; 0 before the first frame."""
        return self._chosen or (self._followed.number if self._followed else 0)

    @property
    def is_present(self) -> bool:
        """Whether the person who is followed was in the last second of the stream."""
        return self._people.is_present(self.followed)

    @property
    def rate(self) -> float:
        """Mean rate of the last frames, hertz; 0 before there are two."""
        return 1.0 / float(np.mean(self._steps)) if self._steps else 0.0

    def read(self, *datagrams: bytes, arrived: float = 0.0) -> Iterator[StreamFrame]:
        """Yield the valid frames of datagrams that arrived together, in their order.

        Parts after the first `max_parts` of the decoder are counted as skipped, which limits
        the time that invalid input takes.
        """
        n_read = 0
        for datagram in datagrams:
            if n_read >= self._decoder.max_parts:
                self.counts.skipped += max(datagram.count(b"\n"), 1)
                continue
            parts = self._decoder.parts(datagram)
            n_remaining = max(self._decoder.max_parts - n_read, 0)
            self.counts.skipped += max(len(parts) - n_remaining, 0)
            yield from self._frames(parts[:n_remaining], arrived)
            n_read += len(parts)

    def _frames(self, parts: Iterable[bytes], arrived: float) -> Iterator[StreamFrame]:
        for part in filter(bytes.strip, parts):
            try:
                frames = list(self._decoder.decode(part, arrived))
            except MocapAssistError as error:
                self.counts.unreadable += 1
                self.counts.why = str(error)
                continue
            for frame in frames:
                person = self._people.add(frame)
                if self._accepts(frame, person):
                    body = frame.body if person is None else person.body
                    yield frame if body == frame.body else replace(frame, body=body)

    def _accepts(self, frame: StreamFrame, person: Person | None) -> bool:
        elapsed = frame.time - self._time
        starts_stream = elapsed > BODY_TIMEOUT_S or elapsed <= -NEW_STREAM_S
        if self._chosen and (person is None or person.number != self._chosen):
            self.counts.others += 1
            return False
        if self._followed is None:
            is_other = person is None and self._people.n_present > 0
        else:
            is_other = person is not self._followed
        if is_other and not starts_stream:
            self.counts.others += 1
            return False
        if not (starts_stream or elapsed > 0.0 or self._restarts(frame.time)):
            self.counts.late += 1
            return False
        if 0.0 < elapsed <= BODY_TIMEOUT_S:
            self._steps.append(elapsed)
        self._followed, self._time = person, frame.time
        self._late.clear()
        self.counts.frames += 1
        return True

    def _restarts(self, time: float) -> bool:
        """Record a late frame; return whether it starts a new stream."""
        if self._late and time <= self._late[-1]:
            self._late.clear()
        self._late.append(time)
        return len(self._late) >= N_RESTART_FRAMES


def recording_from_frames(frames: Sequence[LiveFrame]) -> JointRecording:
    """Build a recording with a constant rate from frames of a stream; gaps stay gaps.

    Frames whose joint names differ from those of most frames are dropped.

    Raises
    ------
    InvalidFileError
        There are no frames, no joint is tracked in any, or the times are invalid.
    """
    if not frames:
        raise InvalidFileError(f"{PERFORMANCE} has no frames.")
    ((names, _),) = Counter(frame.names for frame in frames).most_common(1)
    frames = [frame for frame in frames if frame.names == names]
    states = [frame.states for frame in frames if frame.states is not None]
    return joint_recording(
        PERFORMANCE,
        JointSamples(
            names,
            np.stack([frame.positions for frame in frames]),
            frames[0].sensor,
            states=np.stack(states) if len(states) == len(frames) else None,
            confidence=np.stack([frame.confidence for frame in frames]),
            times=np.array([frame.time for frame in frames]),
        ),
        nan_only=True,
        scale=1.0,
        progress=unwatched,
    )
