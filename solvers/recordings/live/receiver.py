"""Listens to a live stream on the machine's own address; nothing else can reach it."""

import socket
from typing import Self

from ...errors import InvalidSettingError

LOOPBACK = "127.0.0.1"
MAX_DATAGRAM_BYTES = 65_536
MAX_DATAGRAMS, MAX_POLL_BYTES = 64, 1 << 18
"""Datagrams, and bytes, after which no more are taken in one go: 1,900 datagrams in a second of
30 looks. Those behind them wait, and the system drops too many."""
BUFFER_BYTES = 1 << 20
"""Bytes that may wait."""


class Receiver:
    """A UDP socket on 127.0.0.1 that never waits.

    Parameters
    ----------
    port : int
        0 takes any that is free.

    Raises
    ------
    InvalidSettingError
        The port is no port, or another program has it.
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
                f"Nobody can listen on port {port}: another program does, or the system keeps"
                " it. Choose another port, here and where it is sent from."
            ) from None

    @property
    def address(self) -> tuple[str, int]:
        """Where it listens."""
        host, port = self._socket.getsockname()
        return str(host), int(port)

    def poll(self) -> list[bytes]:
        """Return the first datagrams that have come in since; none if none have."""
        came: list[bytes] = []
        while len(came) < MAX_DATAGRAMS and sum(map(len, came)) < MAX_POLL_BYTES:
            try:
                came.append(self._socket.recv(MAX_DATAGRAM_BYTES))
            except BlockingIOError:
                break
            except OSError:  # Windows tells of datagrams too long, or sent back, like this.
                if self._socket.fileno() < 0:
                    break
                came.append(b"")
        return came

    def close(self) -> None:
        """Listen no more; again does nothing."""
        self._socket.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
