"""Listen to the stream of one sender: receive, recognize, decode, and report what comes."""

from collections.abc import Callable, Sequence
from ipaddress import IPv4Network
from time import monotonic
from typing import NamedTuple, Self

from .frames import StreamCounts, StreamFrame, StreamReader
from .protocols import StreamDecoder, StreamProtocol
from .receiver import Receiver

MAX_USELESS_S = 3.0
"""Seconds without a valid frame after which another sender is followed. It guards against
programs that send something else to the port."""
SILENCE_S = 1.0
"""Seconds without a frame after which the stream is reported as silent. By definition those
after which another sender is followed."""


class ListenerState(NamedTuple):
    """What is known of a stream; see `StreamListener`."""

    sender: str
    """Its address and port; empty before one came."""
    protocol: StreamProtocol | None
    rate: float
    """Hertz."""
    counts: StreamCounts
    other: str
    """Address and port of another one that sends now; empty without one."""
    n_refused: int
    """Number of datagrams from addresses that are not allowed."""
    is_silent: bool
    """Whether frames came, but none in the last second."""
    n_people: int = 0
    """Number of people in the last second of the stream."""
    person: int = 0
    """Number of the one who is followed, from 1 in the order in which they appear."""
    is_present: bool = False
    """Whether that one was in the last second of the stream."""


class StreamListener:
    """Receives the frames of one body of one sender, whatever comes.

    Parameters
    ----------
    port : int
    protocol : StreamProtocol
    networks : sequence of IPv4Network
        Networks that may send, next to this machine.
    person : int
        Number of the person to follow, from 1; 0: the first one, until missing for a second.
    now : callable
        Returns seconds.

    Raises
    ------
    InvalidSettingError
        The port is invalid or in use.
    """

    def __init__(
        self,
        port: int,
        protocol: StreamProtocol = StreamProtocol.AUTO,
        networks: Sequence[IPv4Network] = (),
        *,
        person: int = 0,
        now: Callable[[], float] = monotonic,
    ) -> None:
        self.receiver = Receiver(port, networks, now=now)
        self._now = now
        self._decoder = StreamDecoder(protocol)
        self._reader = StreamReader(self._decoder, person)
        self._n_followed = 0
        self._useful_at = now()
        self._has_frames = False

    @property
    def counts(self) -> StreamCounts:
        """Number of received frames, and why others were dropped."""
        return self._reader.counts

    @property
    def state(self) -> ListenerState:
        """What is known of the stream now."""
        receiver = self.receiver
        return ListenerState(
            _text(receiver.sender),
            self._decoder.protocol,
            self._reader.rate,
            self.counts,
            _text(receiver.other),
            receiver.n_refused,
            self._has_frames and self._now() - self._useful_at > SILENCE_S,
            self._reader.n_people,
            self._reader.followed,
            self._reader.is_present,
        )

    def poll(self) -> list[StreamFrame]:
        """Return the frames that came since the last poll, in their order."""
        datagrams = self.receiver.poll()
        if not datagrams:
            return []
        now = self._now()
        if self.receiver.n_followed != self._n_followed:
            self._n_followed, self._useful_at = self.receiver.n_followed, now
            self._decoder.restart()
            self._reader.restart()
        n_others = self.counts.others
        frames = list(self._reader.read(*datagrams, arrived=now))
        if frames:
            self._useful_at, self._has_frames = now, True
        elif self.counts.others > n_others:
            self._useful_at = now
        elif now - self._useful_at > MAX_USELESS_S:
            self.receiver.release()
        return frames

    def close(self) -> None:
        """Close the socket; may be repeated."""
        self.receiver.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def _text(address: tuple[str, int] | None) -> str:
    return "" if address is None else f"{address[0]}:{address[1]}"
