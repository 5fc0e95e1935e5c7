"""What the tests of readers share."""

import socket

import pytest

from solvers.recordings import read_bvh, read_recording


@pytest.fixture
def read(tmp_path):
    """Read a BVH file of this text."""

    def read_text(text: str | bytes, **options):
        path = tmp_path / "take.bvh"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return read_bvh(path, **options)

    return read_text


@pytest.fixture
def read_any(tmp_path):
    """Read a file of this text or these bytes, whose format its content decides."""

    def read_content(content: str | bytes, **options):
        path = tmp_path / "take.dat"
        path.write_bytes(content if isinstance(content, bytes) else content.encode())
        return read_recording(path, **options)

    return read_content


@pytest.fixture
def collected_messages():
    """Return a list, and a progress that collects the messages of a reader in it."""
    messages: list[str] = []
    return messages, lambda fraction, message="": messages.append(message)


@pytest.fixture
def send_to():
    """Send datagrams to a port of this machine, and no farther."""

    def send(port, *datagrams):
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as sender:
            for datagram in datagrams:
                sender.sendto(datagram, ("127.0.0.1", port))

    return send
