"""Damaged packets of every protocol raise nothing, and the next frame is read."""

import numpy as np
import pytest

from solvers.recordings.live import StreamReader
from solvers.recordings.streams import StreamDecoder, StreamProtocol, encode_recording
from solvers.samples import GaitSettings, walking_gait

PROTOCOLS = [each for each in StreamProtocol if each is not StreamProtocol.AUTO]
N_DAMAGED = 60


@pytest.fixture(scope="module")
def walk():
    return walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))


def damaged(datagram, rng):
    """A datagram that is cut short, doubled in part, or has other bytes in some places."""
    content = bytearray(datagram)
    start, stop = sorted(rng.integers(0, len(content), 2))
    kind = rng.integers(4)
    if kind == 0:
        return bytes(content[:start])
    if kind == 1:
        return bytes(content[:stop] + content[start:])
    if kind == 2:
        content[start:stop] = bytes(stop - start)
    else:
        for place in rng.integers(0, len(content), 8):
            content[place] = rng.integers(256)
    return bytes(content)


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_damaged_packets_raise_nothing_and_the_next_frame_is_read(walk, protocol):
    rng = np.random.default_rng(7)
    packets = [each.datagrams for each in encode_recording(walk, protocol)]
    reader = StreamReader(StreamDecoder(protocol))
    for number in range(N_DAMAGED):
        intact = packets[number % 30]
        list(reader.read(damaged(intact[rng.integers(len(intact))], rng), arrived=0.0))

    came = [
        frame for datagrams in packets[30:] for frame in reader.read(*datagrams, arrived=1.0)
    ]

    assert len(came) >= 20
    values = came[-1].rotations if hasattr(came[-1], "rotations") else came[-1].positions
    assert np.isfinite(values).any()


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_a_flood_is_decoded_up_to_a_bound(walk, protocol):
    (packets, *_) = encode_recording(walk, protocol)
    decoder = StreamDecoder(protocol)
    reader = StreamReader(decoder)

    list(reader.read(*packets.datagrams * 2000))

    decoded = reader.counts.frames + reader.counts.late + reader.counts.unreadable
    assert decoded <= decoder.max_parts
    assert reader.counts.skipped >= 2000 - decoder.max_parts
