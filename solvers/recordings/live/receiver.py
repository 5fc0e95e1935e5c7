"""Receive a live stream on the loopback address, which other machines cannot reach."""

import socket
from typing import Self

from ...errors import InvalidSettingError

LOOPBACK = "127.0.0.1"
MAX_DATAGRAM_BYTES = 65_536
MAX_DATAGRAMS, MAX_POLL_BYTES = 64, 1 << 18
"""Maximum number of datagrams and bytes per poll: 1,900 datagrams per second at 30 polls.
Later ones wait, and the system drops what exceeds the buffer."""
BUFFER_BYTES = 1 << 20
"""Size of the system's receive buffer."""


class Receiver:
    """A non-blocking UDP socket on 127.0.0.1.

    Parameters
    ----------
    port : int
        0 selects any free port.

    Raises
    ------
    InvalidSettingError
        The port is invalid or in use.
    """

    def __init__(self, port: int) -> None:
        self._socket = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._socket.setblocking(False)
            self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER_BYTES)
            self._socket.bind((LOOPBACK, port))
        except (OSError, OverflowError):
            self._socket.close()
            raise InvalidSettingError(
                f"Port {port} cannot be opened: another program uses it, or it is reserved."
                " Choose another port, here and in the sender."
            ) from None

    @property
    def address(self) -> tuple[str, int]:
        """Host and port of the socket."""
        host, port = self._socket.getsockname()
        return str(host), int(port)

    def poll(self) -> list[bytes]:
        """Return datagrams received since the last poll, up to the maximum."""
        received: list[bytes] = []
        while len(received) < MAX_DATAGRAMS and sum(map(len, received)) < MAX_POLL_BYTES:
            try:
                received.append(self._socket.recv(MAX_DATAGRAM_BYTES))
            except BlockingIOError:
                break
            except OSError:  # On Windows: a datagram is too long or was returned.
                if self._socket.fileno() < 0:
                    break
                received.append(b"")
        return received

    def close(self) -> None:
        """Close the socket; may be repeated."""
        self._socket.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
