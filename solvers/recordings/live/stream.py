"""A live stream of joints: what comes in order and from one body, and a recording of it."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np

from ...errors import InvalidFileError, InvalidMotionError
from ...motion import JointRecording
from ...progress import unwatched
from ..conventions import joint_recording
from .frames import LiveFrame, decode_frame

NEW_STREAM_S = 2.0
"""Seconds by which a frame must be too old to be the first of another stream."""
N_RESTART_FRAMES = 5
"""Late frames in a row, each later than the one before, that tell of another stream, too."""
MAX_LINES = 128
"""Lines that are looked at in one go: two seconds of two bodies, which take some 35 ms."""
BODY_TIMEOUT_S = 1.0
"""Seconds without the body that is followed, after which another is."""
PERFORMANCE = "The performance"


@dataclass
class StreamCounts:
    """How many frames came in, and why others were dropped."""

    frames: int = 0
    unreadable: int = 0
    """Damaged, too long, or of another format."""
    late: int = 0
    """Not later than one before."""
    others: int = 0
    """Of bodies that are not followed."""
    skipped: int = 0
    """Lines that were not looked at, since too many came at once."""
    why: str = field(default="")
    """What was wrong with the last unreadable one."""

    @property
    def dropped(self) -> int:
        """All that did not count."""
        return self.unreadable + self.late + self.others + self.skipped


class StreamReader:
    """Turns datagrams into the frames of one body, in order; nothing in them raises.

    The body that came first is followed until it has been away for a second. Frames that are
    two seconds too old, or more, are those of a sender that was started again; so are some in
    a row that are late, but in order.
    """

    def __init__(self) -> None:
        self.heard = StreamCounts()
        self._body: int | None = None
        self._time = float("-inf")
        self._late: list[float] = []

    def read(self, *datagrams: bytes) -> Iterator[LiveFrame]:
        """Yield the frames that count of what came in at once, in their order.

        Lines behind the first `MAX_LINES` are counted as skipped: whoever sends junk costs no
        more time than that.
        """
        left = MAX_LINES
        for datagram in datagrams:
            if not left:
                self.heard.skipped += max(datagram.count(b"\n"), 1)
                continue
            lines = datagram.splitlines()
            self.heard.skipped += max(len(lines) - left, 0)
            yield from self._frames(lines[:left])
            left = max(left - len(lines), 0)

    def _frames(self, lines: Iterable[bytes]) -> Iterator[LiveFrame]:
        for line in filter(bytes.strip, lines):
            try:
                frame = decode_frame(line)
            except InvalidMotionError as error:
                self.heard.unreadable += 1
                self.heard.why = str(error)
                continue
            if self._counts(frame):
                yield frame

    def _counts(self, frame: LiveFrame) -> bool:
        since = frame.time - self._time
        fresh = since > BODY_TIMEOUT_S or since <= -NEW_STREAM_S
        if frame.body != self._body and not fresh:
            self.heard.others += 1
            return False
        if not (fresh or since > 0.0 or self._restarts(frame.time)):
            self.heard.late += 1
            return False
        self._body, self._time = frame.body, frame.time
        self._late.clear()
        self.heard.frames += 1
        return True

    def _restarts(self, time: float) -> bool:
        """Note a late frame; tell whether it is one of another stream."""
        if self._late and time <= self._late[-1]:
            self._late.clear()
        self._late.append(time)
        return len(self._late) >= N_RESTART_FRAMES


def recording_from_frames(frames: Sequence[LiveFrame]) -> JointRecording:
    """Return frames of a stream as a recording of a constant rate; gaps stay gaps.

    Frames whose joints have other names than most are left out.

    Raises
    ------
    InvalidFileError
        There are no frames, no joint was tracked in any, or their times make no sense.
    """
    if not frames:
        raise InvalidFileError(f"{PERFORMANCE} has no frames.")
    named = [frame.names for frame in frames]
    names = max(set(named), key=named.count)
    frames = [frame for frame in frames if frame.names == names]
    states = [frame.states for frame in frames if frame.states is not None]
    return joint_recording(
        PERFORMANCE,
        names,
        np.stack([frame.positions for frame in frames]),
        frames[0].sensor,
        states=np.stack(states) if len(states) == len(frames) else None,
        confidence=np.stack([frame.confidence for frame in frames]),
        times=np.array([frame.time for frame in frames]),
        nan_only=True,
        scale=1.0,
        progress=unwatched,
    )
