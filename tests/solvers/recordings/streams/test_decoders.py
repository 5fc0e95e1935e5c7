"""Packets of other programs, written here by hand: axes, units, clocks, and several packets."""

import json
import struct

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidMotionError, MocapAssistError
from solvers.motion import forward_kinematics
from solvers.recordings.live import StreamReader, motion_from_poses
from solvers.recordings.streams import StreamDecoder, StreamProtocol, encode_recording
from solvers.recordings.streams.lz4 import MAGIC, decompress
from solvers.recordings.streams.mediapipe import MediaPipeDecoder
from solvers.recordings.streams.mocopi import MocopiDecoder
from solvers.recordings.streams.osc import write_bundle, write_message
from solvers.recordings.streams.rokoko import BONES, T_POSE, RokokoDecoder
from solvers.recordings.streams.vmc import MAX_MISSED_FRAMES, VmcDecoder
from solvers.recordings.streams.xsens import HEADER, N_SEGMENTS, SEGMENT, XsensDecoder
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


def bone(name, position, rotation=STILL):
    return write_message("/VMC/Ext/Bone/Pos", name, *map(float, (*position, *rotation)))


def unity_body(arm=STILL, at=(0.0, 1.0, 0.0)):
    """Hips and an arm of Unity, which faces +Z with the left side at -X."""
    return [
        bone("Hips", at),
        bone("Spine", (0.0, 0.2, 0.0)),
        bone("LeftUpperArm", (-0.2, 0.3, 0.0), arm),
        bone("LeftLowerArm", (-0.3, 0.0, 0.0)),
    ]


class TestVmc:
    def decode(self, packets, arrived=0.0, decoder=None):
        decoder = decoder or VmcDecoder()
        return [frame for packet in packets for frame in decoder.decode(packet, arrived)]

    def test_axes_are_those_of_unity(self):
        """A quarter turn about +Z, the front, swings the left arm from -X up or down.

        In left-handed axes a positive rotation about +Z takes +X to +Y, and so -X to -Y.
        """
        (frame,) = self.decode([*unity_body((0.0, 0.0, HALF, HALF)), bone("Hips", (0, 1, 0))])

        found = positions_of(frame)
        assert_allclose(found["hips"], (0.0, 0.0, 1.0), atol=1e-6)
        assert_allclose(found["leftUpperArm"], (0.2, 0.0, 1.5), atol=1e-6)
        assert_allclose(found["leftLowerArm"], (0.2, 0.0, 1.2), atol=1e-6)

    def test_the_root_moves_and_turns_the_hips(self):
        """A quarter turn about +Y takes the front +Z to +X; the root is one meter ahead."""
        root = write_message("/VMC/Ext/Root/Pos", "root", 0.0, 0.0, 1.0, 0.0, HALF, 0.0, HALF)
        body = unity_body(at=(0.0, 1.0, 0.5))
        (frame,) = self.decode([root, *body, body[0]])

        found = positions_of(frame)
        assert_allclose(found["hips"], (-0.5, -1.0, 1.0), atol=1e-6)
        assert_allclose(found["leftUpperArm"], (-0.5, -1.2, 1.5), atol=1e-6)

    def test_a_frame_is_complete_when_its_last_bone_has_come(self):
        decoder = VmcDecoder()
        self.decode(unity_body(), decoder=decoder)
        times = [write_message("/VMC/Ext/T", number / 30.0) for number in range(3)]
        for time in times:
            came = [self.decode([packet], decoder=decoder) for packet in [time, *unity_body()]]

        assert [len(frames) for frames in came] == [0, 0, 0, 0, 1]
        assert came[-1][0].time == pytest.approx(2 / 30.0)

    def test_a_lost_bone_keeps_its_last_rotation(self):
        decoder = VmcDecoder()
        for _ in range(2):
            self.decode([write_bundle(unity_body())], decoder=decoder)
        swung = unity_body((0.0, 0.0, HALF, HALF))
        self.decode([*swung[:2], *swung[3:]], decoder=decoder)

        (late, *_) = self.decode([write_bundle(swung)], decoder=decoder)

        assert_allclose(positions_of(late)["leftLowerArm"], (0.5, 0.0, 1.5), atol=1e-6)

    def test_a_bone_that_no_longer_comes_is_left_out(self):
        decoder = VmcDecoder()
        self.decode(unity_body(), decoder=decoder)
        for _ in range(MAX_MISSED_FRAMES + 2):
            frames = self.decode([write_bundle(unity_body()[:3])], decoder=decoder)

        assert frames[-1].names == ("hips", "spine", "leftUpperArm")

    def test_lengths_that_the_sender_leaves_out_are_those_of_an_adult(self):
        still = [bone("Hips", (0, 0.9, 0)), bone("LeftUpperLeg", (0, 0, 0)),
                 bone("LeftLowerLeg", (0, 0, 0)), bone("Hips", (0, 0.9, 0))]  # fmt: skip

        (frame,) = self.decode(still)

        assert (
            0.4 < positions_of(frame)["hips"][2] - positions_of(frame)["leftLowerLeg"][2] < 0.6
        )

    def test_senders_without_a_clock_have_that_of_arrival(self):
        decoder = VmcDecoder()
        self.decode([write_bundle(unity_body())], 5.0, decoder)

        assert [frame.time for frame in self.decode(unity_body(), 5.1, decoder)][-1] == 5.1

    @pytest.mark.parametrize("is_first", [True, False])
    def test_two_frames_of_a_poll_have_times_of_their_own(self, is_first):
        """A message in each packet at 60 Hz, polled 30 times a second."""
        reader, frames = StreamReader(VmcDecoder()), []
        for poll in range(15):
            packets = []
            for number in (2 * poll, 2 * poll + 1):
                time = write_message("/VMC/Ext/T", 10.0 + number / 60.0)
                packets += [time, *unity_body()] if is_first else [*unity_body(), time]
            frames += list(reader.read(*packets, arrived=7.0 + poll / 30.0))

        assert reader.counts.late == 0 and len(frames) >= 28
        assert_allclose(np.diff([frame.time for frame in frames[2:]]), 1 / 60.0, atol=1e-5)

    def test_a_clock_that_stands_still_is_left_out(self):
        """Seconds since 1970 as a 32-bit number."""
        decoder = VmcDecoder()
        packet = write_bundle([write_message("/VMC/Ext/T", 1.7e9), *unity_body()])
        times = [
            frame.time
            for poll in range(9)
            for frame in self.decode([packet], poll / 30, decoder)
        ]

        assert_allclose(times[-4:], np.arange(5, 9) / 30)

    def test_a_bone_without_a_rotation_is_left_out(self):
        still = bone("Spine", (0.0, 0.2, 0.0), (0.0, 0.0, 0.0, 0.0))
        root = write_message("/VMC/Ext/Root/Pos", "root", *[0.0] * 7)
        body = unity_body()

        frames = self.decode([write_bundle([root, body[0], still, *body[2:]])] * 3)

        assert frames[-1].names == ("hips", "leftUpperArm", "leftLowerArm")
        assert_allclose(frames[-1].root_position, (0.0, 0.0, 1.0))

    def test_whole_numbers_are_numbers(self):
        hips = write_message("/VMC/Ext/Bone/Pos", "Hips", 0, 1, 0, 0, 0, 0, 1)

        frame, *_ = self.decode([hips, hips])

        assert_allclose(frame.root_position, (0.0, 0.0, 1.0))

    def test_a_packet_with_a_damaged_bone_changes_nothing(self):
        decoder = VmcDecoder()
        self.decode([write_bundle(unity_body())] * 2, decoder=decoder)
        wrong = write_bundle([bone("Hips", (5.0, 1.0, 0.0)), bone("Spine", (np.nan, 0.0, 0.0))])
        with pytest.raises(InvalidMotionError):
            self.decode([wrong], decoder=decoder)

        frame, *_ = self.decode(unity_body()[1:] + unity_body(), decoder=decoder)

        assert_allclose(frame.root_position, (0.0, 0.0, 1.0))

    @pytest.mark.parametrize("value", [np.nan, np.inf, 1e6])
    def test_numbers_that_are_none_change_nothing(self, value):
        decoder = VmcDecoder()
        with pytest.raises(InvalidMotionError, match="not one up to 100"):
            self.decode([bone("Hips", (value, 1.0, 0.0))], decoder=decoder)

        (frame,) = self.decode([*unity_body(), bone("Hips", (0, 1, 0))], decoder=decoder)
        assert_allclose(frame.root_position, (0.0, 0.0, 1.0))


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
