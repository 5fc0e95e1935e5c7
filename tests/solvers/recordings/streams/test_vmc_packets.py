"""Packets of VMC, written here by hand: axes, clocks, lost and damaged bones."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidMotionError
from solvers.motion import forward_kinematics
from solvers.recordings.streams import StreamReader, motion_from_poses
from solvers.recordings.streams.protocols.osc import write_bundle, write_message
from solvers.recordings.streams.protocols.vmc import MAX_MISSED_FRAMES, VmcDecoder
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

    def test_integers_are_numbers(self):
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
