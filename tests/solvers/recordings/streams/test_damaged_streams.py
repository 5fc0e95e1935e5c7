"""Damaged packets of every protocol raise nothing, and the next frame is read."""

import struct

import numpy as np
import pytest

from solvers.recordings.streams import (
    StreamDecoder,
    StreamProtocol,
    StreamReader,
    encode_recording,
)
from solvers.recordings.streams.protocols import mediapipe, rokoko
from solvers.recordings.streams.protocols.lz4 import MAGIC
from solvers.recordings.streams.protocols.osc import write_bundle, write_message
from solvers.recordings.streams.protocols.vmc import VmcDecoder
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
        for index in rng.integers(0, len(content), 8):
            content[index] = rng.integers(256)
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


def compressed(text):
    """One literal block, whose last match repeats the text up to 250,000 bytes."""
    n_more, rest = divmod(250_000 - 19, 255)
    length = bytes([len(text) << 4 | 15]) + text + struct.pack("<H", len(text))
    block = length + b"\xff" * n_more + bytes([rest])
    return MAGIC + b"\x60\x40\x00" + struct.pack("<I", len(block)) + block + bytes(4)


@pytest.mark.parametrize(("text", "n_parsed"), [(b"[],", 0), (b"1,  ", 5)])
def test_a_flood_of_compressed_text_is_parsed_up_to_a_bound(monkeypatch, text, n_parsed):
    parsed = []
    monkeypatch.setattr(rokoko, "parse_json", lambda text, **_: parsed.append(text) or {})
    reader = StreamReader(StreamDecoder())

    list(reader.read(*[compressed(text)] * 60, arrived=1.0))

    assert len(parsed) == n_parsed and reader.counts.unreadable == 60
    list(reader.read(compressed(text), arrived=1.1))
    assert len(parsed) == n_parsed + bool(n_parsed)


def test_lines_of_lists_are_not_parsed(monkeypatch):
    monkeypatch.setattr(mediapipe, "parse_json", lambda text, **_: pytest.fail("parsed"))
    reader = StreamReader(StreamDecoder(StreamProtocol.MEDIAPIPE))

    list(reader.read(b'{"a": [' + b"[]," * 5000 + b"[]]}"))

    assert "lists" in reader.counts.why


def test_a_packet_with_a_bone_many_times_is_no_frame():
    hips = write_message("/VMC/Ext/Bone/Pos", "Hips", 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)
    reader = StreamReader(StreamDecoder())

    assert not list(reader.read(*[write_bundle([hips] * 500)] * 8))
    assert reader.counts.unreadable == 8


def test_the_bound_is_that_of_the_protocol_that_is_recognized():
    """Expressions of VMC take the place of no bones."""
    face = write_message("/VMC/Ext/Blend/Val", "Joy", 1.0)
    hips = write_message("/VMC/Ext/Bone/Pos", "Hips", 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0)
    reader = StreamReader(StreamDecoder())

    list(reader.read(*[face, hips] * VmcDecoder.max_parts))
    assert reader.counts.skipped == 0
    list(reader.read(*[face, hips] * 2 * VmcDecoder.max_parts))
    assert reader.counts.skipped >= VmcDecoder.max_parts
