"""One sender is followed and the others named; junk and silence cost nothing."""

import socket
from contextlib import ExitStack

import numpy as np
import pytest

from solvers.errors import InvalidSettingError
from solvers.recordings.streams import (
    LiveFrame,
    Receiver,
    StreamListener,
    StreamProtocol,
    allowed_networks,
    encode_frame,
    encode_recording,
)
from solvers.samples import GaitSettings, walking_gait


class Clock:
    def __init__(self):
        self.time = 100.0

    def __call__(self):
        return self.time


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def listener(clock):
    with StreamListener(0, now=clock) as listener:
        yield listener


@pytest.fixture
def sender(listener):
    """Open senders to the listener; each has an address of its own."""
    with ExitStack() as stack:

        def open_sender():
            one = stack.enter_context(socket.socket(socket.AF_INET, socket.SOCK_DGRAM))
            one.connect(listener.receiver.address)
            return one

        yield open_sender


@pytest.fixture(scope="module")
def vmc():
    walk = walking_gait(GaitSettings(duration=0.5, frame_rate=30.0))
    return [each.datagrams for each in encode_recording(walk, StreamProtocol.VMC)]


def line(time, position=0.0):
    return encode_frame(LiveFrame(time, 0, ("Head",), np.full((1, 3), position), np.ones(1)))


def name_of(sender):
    return "{}:{}".format(*sender.getsockname())


def test_the_first_sender_is_followed_and_the_other_named(listener, sender, clock):
    first, second = sender(), sender()
    came = []
    for number in range(5):
        first.send(line(0.1 * number, 1.0))
        first.send(line(0.1 * number + 0.05, 1.0))
        second.send(line(0.1 * number, 2.0))
        came += listener.poll()
        clock.time += 0.1

    assert {frame.positions[0, 0] for frame in came} == {1.0} and len(came) == 10
    state = listener.state
    assert (state.sender, state.other) == (name_of(first), name_of(second))
    assert state.protocol is StreamProtocol.JSON and state.rate == pytest.approx(20.0)


def test_another_sender_is_followed_when_the_first_is_silent(listener, sender, clock, vmc):
    first, second = sender(), sender()
    for time in (0.0, 0.1):
        first.send(line(time))
        listener.poll()
    clock.time += 1.1
    assert listener.state.is_silent
    for datagrams in vmc[:3]:
        for datagram in datagrams:
            second.send(datagram)

    assert len(listener.poll()) == 3
    state = listener.state
    assert (state.sender, state.protocol) == (name_of(second), StreamProtocol.VMC)
    assert not state.is_silent


def test_another_sender_is_named_as_long_as_it_sends_and_is_not_followed(
    listener, sender, clock
):
    first, second = sender(), sender()
    for number in range(20):
        if number < 3:
            first.send(line(0.1 * number))
            first.send(line(0.1 * number + 0.05))
        second.send(line(0.1 * number))
        listener.poll()
        clock.time += 0.1
        if number == 2:
            assert listener.state.other == name_of(second)
    assert (listener.state.sender, listener.state.other) == (name_of(second), "")

    first.send(line(9.0))
    second.send(line(2.0))
    listener.poll()
    assert listener.state.other == name_of(first)
    clock.time += 1.1
    assert listener.state.other == ""


def test_a_sender_of_nothing_useful_does_not_block_the_tracker(listener, sender, clock):
    chatter, tracker = sender(), sender()
    came = []
    for number in range(40):
        for junk in (b"\x00\x01junk", b"more junk"):
            chatter.send(junk)
        tracker.send(line(0.1 * number))
        came += listener.poll()
        clock.time += 0.1

    assert len(came) > 5
    assert listener.state.sender == name_of(tracker)


def test_a_sender_without_the_chosen_person_is_not_given_up(clock):
    with (
        StreamListener(0, person=2, now=clock) as listener,
        socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as tracker,
    ):
        tracker.connect(listener.receiver.address)
        for number in range(50):
            tracker.send(line(0.1 * number))
            assert listener.poll() == []
            clock.time += 0.1
            assert listener.state.sender == name_of(tracker)
        assert (listener.state.n_people, listener.state.person) == (1, 2)


def test_a_program_that_sends_each_datagram_from_a_new_port_is_one_sender(listener, sender):
    for number in range(5):
        sender().send(line(0.1 * number))

    assert len(listener.poll()) == 5
    assert listener.state.other == ""


def test_unknown_packets_are_reported_in_one_sentence(listener, sender):
    sender().send(b"hello")

    assert listener.poll() == []
    assert listener.state.counts.why.startswith("These packets are of no known protocol")


def test_only_listed_addresses_may_send(monkeypatch):
    """127.0.0.2 stands for another machine: it is refused unless it is listed."""
    monkeypatch.setattr(
        "solvers.recordings.streams.receiver.ip_address",
        lambda host: __import__("ipaddress").ip_address(host.replace("127.0.0.2", "10.1.1.2")),
    )
    for listed, expected in (("10.1.1.0/24", [b"near", b"far"]), ("10.1.2.7", [b"near"])):
        with Receiver(0, allowed_networks(listed)) as receiver:
            host, port = receiver.address
            assert host == "0.0.0.0"
            came = []
            for source, content in (("127.0.0.1", b"near"), ("127.0.0.2", b"far")):
                with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as one:
                    one.bind((source, 0))
                    one.sendto(content, ("127.0.0.1", port))
                came += receiver.poll()
                receiver.release()
            assert came == expected
            assert receiver.n_refused == 2 - len(expected)


@pytest.mark.parametrize("wrong", ["0.0.0.0/0", "10.0.0.0/8", "phone", "::1", "1.2.3"])
def test_lists_of_anyone_are_refused(wrong):
    with pytest.raises(InvalidSettingError, match="not an IPv4 address, or a network of up to"):
        allowed_networks(f"192.168.1.20, {wrong}")


def test_addresses_may_have_commas_or_spaces_between():
    assert [str(each) for each in allowed_networks(" 192.168.1.20,10.0.0.0/24 ")] == [
        "192.168.1.20/32", "10.0.0.0/24",
    ]  # fmt: skip
    assert allowed_networks("") == ()
