"""Open Sound Control: the examples of its specification, and what is damaged."""

import pytest

from solvers.errors import InvalidMotionError
from solvers.recordings.streams.protocols.osc import (
    BUNDLE,
    IMMEDIATELY,
    MAX_DEPTH,
    MAX_MESSAGES,
    read_packet,
    write_bundle,
    write_message,
)

OSCILLATOR = bytes.fromhex("2f6f7363696c6c61746f722f342f6672657175656e637900 2c660000 43dc0000")
FOO = bytes.fromhex(
    "2f666f6f00000000 2c69697366660000 000003e8 ffffffff 68656c6c6f000000 3f9df3b6 40b5b22d"
)
"""Both of the specification, section "OSC Message Examples"."""


def test_examples_of_the_specification_are_read_and_written():
    assert read_packet(OSCILLATOR) == [("/oscillator/4/frequency", (440.0,))]
    ((address, (*others, one, two)),) = read_packet(FOO)
    assert (address, others) == ("/foo", [1000, -1, "hello"])
    assert (one, two) == pytest.approx((1.234, 5.678), rel=1e-6)
    assert write_message("/oscillator/4/frequency", 440.0) == OSCILLATOR
    assert write_message("/foo", 1000, -1, "hello", 1.234, 5.678) == FOO


def test_bundles_may_hold_bundles():
    inner = write_bundle([write_message("/b", 2), write_message("/c", "x")])

    messages = read_packet(write_bundle([write_message("/a", 1), inner]))

    assert messages == [("/a", (1,)), ("/b", (2,)), ("/c", ("x",))]


def test_other_types_are_skipped_over():
    packet = b"/a\0\0,TbhNdf\0" + b"\0\0\0\3abc\0" + bytes(8) + bytes(8) + b"\x3f\x80\0\0"

    assert read_packet(packet) == [("/a", (True, b"abc", 0, None, 0.0, 1.0))]


@pytest.mark.parametrize(
    "packet",
    [
        b"",
        b"/a",
        b"a\0\0\0,\0\0\0",
        b"/a\0\0i\0\0\0\0\0\0\1",
        b"/a\0\0,i\0\0\0\0",
        b"/a\0\0,q\0\0\0\0\0\0",
        b"/a\0\0,s\0\0abcd",
        b"/\xff\0\0,\0\0\0",
        b"/a\0\0,b\0\0\x7f\xff\xff\xffabcd",
        BUNDLE + IMMEDIATELY + b"\0\0\0\x10/a\0\0",
        BUNDLE + IMMEDIATELY + b"\xff\xff\xff\xff",
        BUNDLE + IMMEDIATELY + b"\0\0\0\0",
        BUNDLE + IMMEDIATELY + b"\0",
    ],
)
def test_damaged_packets_are_refused(packet):
    with pytest.raises(InvalidMotionError, match="damaged"):
        read_packet(packet)


def test_nested_and_crowded_packets_are_refused():
    packet = write_message("/a")
    for _ in range(MAX_DEPTH + 1):
        packet = write_bundle([packet])
    with pytest.raises(InvalidMotionError, match="damaged"):
        read_packet(packet)
    with pytest.raises(InvalidMotionError, match="more than 512"):
        read_packet(write_bundle([write_message("/a")] * (MAX_MESSAGES + 1)))
