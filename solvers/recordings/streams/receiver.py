"""Receive a live stream: on the loopback address, which other machines cannot reach, or from
listed addresses."""

import socket
from collections import deque
from collections.abc import Callable, Sequence
from ipaddress import IPv4Network, ip_address, ip_network
from time import monotonic
from typing import Self

from ...errors import InvalidSettingError

LOOPBACK = "127.0.0.1"
ALL_ADDRESSES = "0.0.0.0"
MIN_PREFIX_BITS = 24
"""Minimum number of fixed bits of a listed network, which then has up to 256 addresses. It
guards against lists that allow everyone."""
MAX_DATAGRAM_BYTES = 65_536
MAX_DATAGRAMS, MAX_POLL_BYTES = 512, 1 << 18
"""Maximum number of datagrams and bytes per poll: 15,000 datagrams per second at 30 polls, as
VMC sends a datagram for each bone. Later ones wait, and the system drops what exceeds the
buffer."""
BUFFER_BYTES = 1 << 20
"""Size of the system's receive buffer."""
SENDER_TIMEOUT_S = 1.0
"""Seconds of silence after which a sender is gone, and another one is followed. By definition
that of a body (`BODY_TIMEOUT_S`)."""
MAX_SENDERS = 32
"""Number of datagrams whose senders are remembered. It bounds memory."""

Address = tuple[str, int]


def allowed_networks(addresses: str) -> tuple[IPv4Network, ...]:
    """Return the networks of a list of IPv4 addresses, with commas or spaces between.

    Raises
    ------
    InvalidSettingError
        One is no address, or a network of more than 256 addresses.
    """
    networks = []
    for word in addresses.replace(",", " ").split():
        try:
            network = ip_network(word, strict=False)
        except ValueError:
            network = None
        if not isinstance(network, IPv4Network) or network.prefixlen < MIN_PREFIX_BITS:
            raise InvalidSettingError(
                f"{word} is not an IPv4 address, or a network of up to 256 addresses. Write"
                " 192.168.1.20 or 192.168.1.0/24."
            )
        networks.append(network)
    return tuple(networks)


class Receiver:
    """A non-blocking UDP socket that follows one sender at a time.

    The first sender is followed until it is silent for a second, or released.

    Parameters
    ----------
    port : int
        0 selects any free port.
    networks : sequence of IPv4Network
        Networks whose addresses may send, next to this machine. Without any, the socket is on
        127.0.0.1.
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
        networks: Sequence[IPv4Network] = (),
        *,
        now: Callable[[], float] = monotonic,
    ) -> None:
        self.sender: Address | None = None
        """The sender that is followed."""
        self.n_followed = 0
        """Number of senders that were followed, one after the other."""
        self.n_refused = 0
        """Number of datagrams from addresses that are not listed."""
        self._networks, self._now = tuple(networks), now
        self._heard_at = float("-inf")
        self._other: Address | None = None
        self._other_at = float("-inf")
        self._released: Address | None = None
        self._n_received = 0
        self._senders = deque[Address](maxlen=MAX_SENDERS)
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.setblocking(False)
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER_BYTES)
            if self._networks:
                self._socket.bind((ALL_ADDRESSES, port))
            else:
                self._socket.bind((LOOPBACK, port))
        except (OSError, OverflowError):
            self._socket.close()
            raise InvalidSettingError(
                f"Port {port} cannot be opened: another program uses it, or it is reserved."
                " Choose another port, here and in the sender."
            ) from None

    @property
    def address(self) -> Address:
        """Host and port of the socket."""
        host, port = self._socket.getsockname()
        return str(host), int(port)

    @property
    def other(self) -> Address | None:
        """Another sender, which is not followed, as long as it sends."""
        return self._other if self._now() - self._other_at <= SENDER_TIMEOUT_S else None

    def poll(self) -> list[bytes]:
        """Return datagrams of the followed sender since the last poll, up to the maximum."""
        received = self._receive()
        senders = [sender for _, sender in received]
        if not senders:
            return []
        if self.sender not in senders and self._now() - self._heard_at > SENDER_TIMEOUT_S:
            usable = [sender for sender in senders if sender != self._released]
            self._follow((usable or senders)[0])
            self.n_followed += 1
        return [datagram for datagram, sender in received if self._is_followed(sender)]

    def _is_followed(self, sender: Address) -> bool:
        """Count a datagram; return whether its sender is followed.

        Some programs send each datagram from a new port: one after a single datagram from the
        same address is the same sender.
        """
        if sender != self.sender and self._continues(sender):
            self._follow(sender)
        self._senders.append(sender)
        if sender != self.sender:
            self._other, self._other_at = sender, self._now()
            return False
        self._n_received += 1
        self._heard_at = self._now()
        return True

    def _continues(self, sender: Address) -> bool:
        is_new = sender not in self._senders
        is_same = self.sender is not None and sender[0] == self.sender[0]
        return is_new and is_same and self._n_received <= 1

    def _follow(self, sender: Address) -> None:
        self.sender, self._n_received, self._heard_at = sender, 0, self._now()
        self._other = None

    def release(self) -> None:
        """Follow another sender if there is one: what the followed one sends is of no use."""
        self._released, self.sender, self._heard_at = self.sender, None, float("-inf")

    def _receive(self) -> list[tuple[bytes, Address]]:
        received: list[tuple[bytes, Address]] = []
        n_bytes = 0
        for _ in range(MAX_DATAGRAMS):
            if n_bytes >= MAX_POLL_BYTES:
                break
            try:
                datagram, (host, port) = self._socket.recvfrom(MAX_DATAGRAM_BYTES)
            except BlockingIOError:
                break
            except OSError:  # On Windows: a datagram is too long or was returned.
                if self._socket.fileno() < 0:
                    break
                continue
            n_bytes += len(datagram)
            if self._allows(host):
                received.append((datagram, (host, port)))
            else:
                self.n_refused += 1
        return received

    def _allows(self, host: str) -> bool:
        if not self._networks:
            return True
        address = ip_address(host)
        return address.is_loopback or any(address in network for network in self._networks)

    def close(self) -> None:
        """Close the socket; may be repeated."""
        self._socket.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
