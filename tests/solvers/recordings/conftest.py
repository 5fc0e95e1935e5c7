"""What the tests of readers share."""

import socket

import numpy as np
import pytest

from solvers.motion import find_humanoid_map, forward_kinematics
from solvers.recordings import read_bvh, read_recording
from solvers.samples import walking_gait


@pytest.fixture(scope="session")
def walker() -> dict[str, np.ndarray]:
    """Positions of the joints of a walk by role, shape (n_frames, 3) each, meters, Z up."""
    motion = walking_gait()
    positions = forward_kinematics(motion).positions
    positions.flags.writeable = False
    roles = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    return {role: positions[:, joint] for role, joint in roles.items()}


@pytest.fixture
def make_writer(tmp_path):
    """Return a function that writes text or bytes to a file of this name, and its path."""

    def make(name: str):
        def write(content: str | bytes):
            path = tmp_path / name
            path.write_bytes(content if isinstance(content, bytes) else content.encode())
            return path

        return write

    return make


@pytest.fixture
def make_reader(make_writer):
    """Return a function that reads text or bytes as a file of this name."""

    def make(name: str, reader=read_recording):
        write = make_writer(name)
        return lambda content, **options: reader(write(content), **options)

    return make


@pytest.fixture
def read(make_reader):
    """Read a BVH file of this text."""
    return make_reader("take.bvh", read_bvh)


@pytest.fixture
def read_any(make_reader):
    """Read a file of this text or these bytes, whose format its content decides."""
    return make_reader("take.dat")


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
