"""Packets of other programs, written here by hand: axes, units, clocks, and several packets."""

import json
import struct

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidMotionError, MocapAssistError
from solvers.motion import forward_kinematics
from solvers.recordings.streams import (
    StreamDecoder,
    StreamProtocol,
    StreamReader,
    encode_recording,
    motion_from_poses,
)
from solvers.recordings.streams.protocols.lz4 import MAGIC, decompress
from solvers.recordings.streams.protocols.mediapipe import MediaPipeDecoder
from solvers.recordings.streams.protocols.mocopi import MocopiDecoder
from solvers.recordings.streams.protocols.rokoko import BONES, T_POSE, RokokoDecoder
from solvers.recordings.streams.protocols.xsens import HEADER, N_SEGMENTS, SEGMENT, XsensDecoder
from solvers.samples import GaitSettings, walking_gait

HALF = 0.5**0.5
STILL = (0.0, 0.0, 0.0, 1.0)


@pytest.fixture(scope="module")
def walk():
    return walking_gait(GaitSettings(duration=0.5, frame_rate=30.0))


def positions_of(frame):
    """Joint positions by name."""
    poses = forward_kinematics(motion_from_poses([frame], 30.0))
    return dict(zip(frame.names, poses.positions[0], strict=True))


class TestXsens:
    def datagram(self, segments, *, sample=1, number=0x80, kind=b"MXTP02", character=3):
        content = segments.tobytes()
        header = (kind, sample, number, len(segments), 40, character, 23, 0, 0, 0, len(content))
        return HEADER.pack(*header) + content

    def segments(self, unit):
        """A rod of segments that goes 0.1 m forward (X) with each."""
        segments = np.zeros(N_SEGMENTS, SEGMENT)
        segments["id"] = np.arange(1, N_SEGMENTS + 1)
        segments["position"][:, 0] = 0.1 * unit * np.arange(N_SEGMENTS)
        segments["rotation"][:, 0] = 1.0
        return segments

    @pytest.mark.parametrize("unit", [1.0, 100.0])
    def test_unit_and_axes_are_found(self, unit):
        (frame,) = XsensDecoder().decode(self.datagram(self.segments(unit)), 0.0)

        assert (frame.time, frame.body) == (0.04, 3)
        assert_allclose(positions_of(frame)["L5"], (0.0, -0.1, 0.0), atol=1e-6)

    def test_a_sample_in_two_datagrams_is_one_frame(self):
        decoder, segments = XsensDecoder(), self.segments(1.0)

        first = list(decoder.decode(self.datagram(segments[:10], number=0), 0.0))
        second = list(decoder.decode(self.datagram(segments[10:], number=0x81), 0.0))

        assert (len(first), len(second)) == (0, 1)

    def test_a_lost_datagram_loses_its_sample_only(self):
        decoder, segments = XsensDecoder(), self.segments(1.0)
        list(decoder.decode(self.datagram(segments[:10], number=0), 0.0))

        (frame,) = decoder.decode(self.datagram(segments, sample=2), 0.0)

        assert len(frame.names) == N_SEGMENTS

    def test_two_characters_keep_their_skeletons_and_their_samples(self):
        decoder, both = XsensDecoder(), {0: self.segments(1.0), 1: self.segments(1.2)}
        frames = [
            frame
            for sample in range(3)
            for start, number in ((0, 0), (10, 0x81))
            for character, segments in both.items()
            for frame in decoder.decode(
                self.datagram(segments[start:][: 13 if start else 10], sample=sample,
                              number=number, character=character), 0.0)
        ]  # fmt: skip

        assert [frame.body for frame in frames] == [0, 1] * 3
        for body in both:
            assert len({id(frame.skeleton) for frame in frames[body::2]}) == 1

    def test_datagrams_next_to_the_poses_are_no_frames(self):
        decoder = XsensDecoder()
        (_,) = decoder.decode(self.datagram(self.segments(1.0)), 0.0)

        assert not list(decoder.decode(self.datagram(self.segments(1.0), kind=b"MXTP20"), 0.0))

    def test_other_datagrams_are_reported_with_advice(self):
        with pytest.raises(InvalidMotionError, match="switch on the position and orientation"):
            list(XsensDecoder().decode(self.datagram(self.segments(1.0), kind=b"MXTP20"), 0.0))


class TestRokoko:
    def packet(self, **more):
        body = {
            BONES[role]: {
                "position": dict(zip("xyz", position, strict=True)),
                "rotation": dict(zip("wxyz", T_POSE[role], strict=True)),
            }
            for role, position in {
                "hips": (0, 1, 0), "spine": (0, 1.1, 0), "leftUpperArm": (-0.2, 1.4, 0),
                "leftHand": (-0.7, 1.4, 0),
            }.items()
        }  # fmt: skip
        return {"name": "Ann", "body": body, **more}

    def test_the_pose_of_the_reference_is_the_rest_pose(self):
        scene = {"timestamp": 2.5, "actors": [self.packet()]}
        (frame,) = RokokoDecoder().decode(
            json.dumps({"version": "3,0", "scene": scene}).encode(), 0.0
        )

        assert frame.time == 2.5
        assert_allclose(np.abs(frame.rotations[:, 0]), 1.0, atol=1e-5)
        assert_allclose(positions_of(frame)["leftHand"], (0.7, 0.0, 1.4), atol=1e-6)

    def test_times_that_are_none_are_refused(self):
        scene = {"timestamp": 1e12, "actors": [self.packet()]}
        with pytest.raises(InvalidMotionError, match="time is not a number up to"):
            list(RokokoDecoder().decode(json.dumps({"scene": scene}).encode(), 0.0))

    def test_version_2_and_several_actors_are_read(self):
        bones = self.packet()["body"]
        fields = {"version": 2, "timestamp": 1.0, "actors": [
            {"name": "Ann", **bones}, {"name": "Bob", **bones},
        ]}  # fmt: skip

        frames = list(RokokoDecoder().decode(json.dumps(fields).encode(), 0.0))

        assert [frame.body for frame in frames] == [0, 1]

    def test_streams_that_are_compressed_are_read(self):
        text = json.dumps({"scene": {"timestamp": 0.0, "actors": [self.packet()]}}).encode()
        raw = struct.pack("<I", 0x8000_0000 | len(text)) + text
        decoder = StreamDecoder()

        frames = list(StreamReader(decoder).read(MAGIC + b"\x40\x40\x00" + raw + bytes(4)))

        assert decoder.protocol is StreamProtocol.ROKOKO and len(frames) == 1


@pytest.mark.parametrize("time", [1e12, np.inf])
def test_times_of_mocopi_that_are_none_are_refused(walk, time):
    (packets, *_) = encode_recording(walk, StreamProtocol.MOCOPI)
    packet = packets.datagrams[-1]
    clock = packet.index(b"uttm") + 4
    changed = packet[:clock] + struct.pack("<d", time) + packet[clock + 8 :]

    assert len(list(MocopiDecoder().decode(packet, 0.0))) == 1
    with pytest.raises(InvalidMotionError, match="mocopi is damaged"):
        list(MocopiDecoder().decode(changed, 0.0))


def test_matches_of_compressed_blocks_are_repeated():
    """Literals "ab", a match of 6 at distance 2, and the literals "!" that end a block."""
    block = bytes([0x22]) + b"ab" + b"\x02\x00" + bytes([0x10]) + b"!"
    frame = MAGIC + b"\x60\x40\x00" + struct.pack("<I", len(block)) + block + bytes(4)

    assert decompress(frame) == b"abababab!"


def test_a_compressed_bomb_is_refused():
    block = bytes([0x1F]) + b"a" + b"\x01\x00" + b"\xff" * 2000 + b"\x00"
    frame = MAGIC + b"\x60\x40\x00" + struct.pack("<I", len(block)) + block + bytes(4)

    with pytest.raises(InvalidMotionError):
        decompress(frame)


class TestMediaPipe:
    def line(self, walk, **more):
        (packets, *_) = encode_recording(walk, StreamProtocol.MEDIAPIPE)
        fields = json.loads(packets.datagrams[0])
        del fields["timestamp"]
        return fields | more

    def test_stamps_may_be_milliseconds_or_missing(self, walk):
        decoder = MediaPipeDecoder()
        times = [
            next(iter(decoder.decode(json.dumps(self.line(walk, **stamp)).encode(), 7.0))).time
            for stamp in ({}, {"timestamp": 70_000}, {"timestamp": 70_033})
        ]

        assert times[0] == 7.0 and times[2] == pytest.approx(70.033)

    @pytest.mark.parametrize("unit", [1.0, 1000.0])
    @pytest.mark.parametrize("steps", [(0.1, 5.0, 0.1), (5.0, 0.1)])
    def test_a_gap_does_not_change_the_unit_of_the_stamps(self, walk, unit, steps):
        decoder, moments = MediaPipeDecoder(), np.cumsum([40.0, *steps])
        times = []
        for time in moments:
            line = json.dumps(self.line(walk, timestamp=unit * time)).encode()
            times += [frame.time for frame in decoder.decode(line, 90.0 + time)]

        assert_allclose(times[1:], moments[1:])

    def test_landmarks_of_the_image_are_refused(self, walk):
        fields = self.line(walk)
        for point in fields["pose_world_landmarks"]:
            point["x"], point["y"] = 0.5 + 0.2 * point["x"], 0.5 + 0.2 * point["y"]

        with pytest.raises(MocapAssistError, match="image landmarks"):
            list(MediaPipeDecoder().decode(json.dumps(fields).encode(), 0.0))

    def test_frames_without_a_body_are_none(self):
        decoder = MediaPipeDecoder()
        for point in ({"x": None, "y": None, "z": None}, {"x": 0, "y": 0, "z": 0}):
            line = json.dumps({"pose_world_landmarks": [point] * 33}).encode()
            assert not list(decoder.decode(line, 0.0))
        assert not list(decoder.decode(b'{"pose_world_landmarks": []}', 0.0))
