"""A BVH file means what other programs take it to mean, however its exporter spelled it."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.errors import InvalidFileError
from solvers.motion import Motion, Skeleton, forward_kinematics
from solvers.recordings import read_bvh, write_bvh
from solvers.rotations.representations import normalize

ARM = """HIERARCHY
ROOT shoulder
{
  OFFSET 0 140 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT elbow
  {
    OFFSET 30 0 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 25 0 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.0333333
0 140 0  0 0 0  0 0 0
5 141 7  90 0 0  0 0 90
"""
SECOND_FRAME = [[0.05, -0.07, 1.41], [0.05, -0.07, 1.71], [0.05, 0.18, 1.71]]


def test_stands_up_and_faces_us(read):
    """Up (Y) becomes Z, and forward (Z) becomes -Y; centimeters become meters."""
    arm = read(ARM)

    assert arm.skeleton.names == ("shoulder", "elbow", "elbow_end")
    assert arm.skeleton.parents == (-1, 0, 1)
    assert_allclose(arm.skeleton.offsets, [[0, 0, 1.4], [0.3, 0, 0], [0.25, 0, 0]], atol=1e-12)
    # By hand, in the file's axes: the shoulder's Rz(90) lifts the upper arm to +Y. The forearm
    # is at Rz(90) Ry(90) (25, 0, 0) = Rz(90) (0, 0, -25) = (0, 0, -25), our +Y.
    assert_allclose(forward_kinematics(arm).positions[1], SECOND_FRAME, atol=1e-9)


@pytest.mark.parametrize(
    "spelled",
    [
        ARM.replace("\n", "\r\n"),
        ARM.replace("\n", "\r"),
        ARM.replace("  ", "\t"),
        ARM.replace("\n", "\n\n"),
        ARM.replace("\n", " \n"),
        "\ufeff" + ARM,
        ARM.replace("Zrotation", "ZROTATION").replace("JOINT", "Joint"),
        ARM.replace("MOTION", "motion"),
        ARM.replace("ROOT shoulder\n{", "ROOT shoulder {"),
        ARM.replace("Frames: 2", "Frames:\t2"),
        ARM.replace("Frames: 2", "Frames: 999999999"),
        ARM.replace("Frames: 2", "Frames: 1"),
        ARM.replace("Frames: 2\n", ""),
        ARM.replace("Frame Time: 0.0333333\n", ""),
        ARM.replace("Frame Time: 0.0333333", "Frame Time: 0"),
        ARM.replace("5 141 7", "5.0e0 141,0 +7"),
        ARM.rstrip("\n"),
    ],
)
def test_spelling_does_not_matter(read, spelled):
    arm = read(spelled)

    assert arm.skeleton.names == ("shoulder", "elbow", "elbow_end")
    assert arm.frame_rate == 30.0
    assert_allclose(forward_kinematics(arm).positions[1], SECOND_FRAME, atol=1e-9)


@pytest.mark.parametrize(
    ("time", "is_assumed"),
    [("Frame Time: 0\n", True), ("", True), ("Frame Time: 0.0333333\n", False)],
)
def test_a_rate_that_is_assumed_is_reported(read, collected_messages, time, is_assumed):
    read(ARM.replace("Frame Time: 0.0333333\n", time), progress=collected_messages[1])

    assert ("The file has no frame rate; 30 Hz is assumed" in collected_messages[0]) == (
        is_assumed
    )


@pytest.mark.parametrize("order", ["XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX"])
def test_any_rotation_order_survives_writing_and_reading(swinging_leg, tmp_path, order):
    write_bvh(swinging_leg, tmp_path / "leg.bvh", order=order)

    back = read_bvh(tmp_path / "leg.bvh")

    assert back.skeleton.same_joints(swinging_leg.skeleton)
    assert back.frame_rate == swinging_leg.frame_rate
    # Six decimals of centimeters and degrees are 1e-8 m, and 1e-8 rad times a leg's length.
    assert_allclose(back.skeleton.offsets, swinging_leg.skeleton.offsets, atol=1e-8)
    theirs = forward_kinematics(back).positions
    assert_allclose(theirs, forward_kinematics(swinging_leg).positions, atol=5e-8)


def test_any_skeleton_survives_writing_and_reading(rng, tmp_path):
    """BVH lists each joint with all that is below it; ours may come in any other order."""
    parents = (-1, 0, 0, 1, 2, 1, 0, 4)
    names = tuple("abcdefgh")
    skeleton = Skeleton(names, parents, rng.normal(size=(8, 3)))
    rotations = normalize(rng.normal(size=(20, 8, 4)))
    motion = Motion(skeleton, rotations, rng.normal(scale=3, size=(20, 3)), 48.0)
    write_bvh(motion, tmp_path / "take.bvh", scale=0.05)

    back = read_bvh(tmp_path / "take.bvh", scale=0.05, up="Y")

    indices = [back.skeleton.index(name) for name in names]
    theirs = forward_kinematics(back).positions[:, indices]
    assert_allclose(theirs, forward_kinematics(motion).positions, atol=1e-6)
    assert_allclose(back.skeleton.offsets[indices], skeleton.offsets, atol=1e-7)


@pytest.mark.parametrize(
    ("word", "rate"),
    [("0.00833333", 120.0), (".0083333", 120.0), ("0.008333", 120.0), ("0.016667", 60.0),
     ("0.0333667", 29.97), ("0.04", 25.0), ("0.008", 125.0), ("0.033", 30.0),
     ("0.0138888889", 72.0), ("1e-2", 100.0), ("0.008342", 119.88), ("0.0417084", 23.976)],
)  # fmt: skip
def test_rounded_frame_time_gives_a_common_rate(read, word, rate):
    assert read(ARM.replace("0.0333333", word)).frame_rate == pytest.approx(rate, rel=1e-6)


def test_a_file_of_blender_stands_upright_too(read):
    """Blender writes its own axes, Z up. The same file with Y up must not be touched."""
    lying = BODY.replace("OFFSET 0 {a} {b}", "OFFSET 0 0 {h}")
    standing = BODY.replace("OFFSET 0 {a} {b}", "OFFSET 0 {h} 0")

    for text in (lying, standing):
        body = read(text.replace("{h}", "50"))
        assert body.skeleton.height == pytest.approx(2.0)
        assert np.ptp(forward_kinematics(body).positions[0, :, 2]) == pytest.approx(2.0)
    assert read(lying.replace("{h}", "50"), up="Y").skeleton.height == 0.0
    horse = read(
        BODY.replace("{a} {b}", "40 60"), scale=0.01
    )  # Longer than high, all the same.
    assert horse.skeleton.height == pytest.approx(1.6)


@pytest.mark.parametrize(
    ("offset", "frame", "size"),
    [
        ("0 50 0", "0 90 0", (0, 2, 0)),  # An actor who lies down.
        ("0 0 50", "0 -90 0", (0, 0, 2)),  # A lying rest pose that the root stands up.
        ("50 0 2", "0 0 -90", (0.08, 2, 0)),  # All bones along one axis, and lying down.
    ],
)
def test_lying_body_is_not_rotated(read, offset, frame, size):
    text = BODY.replace("0 {a} {b}", offset).replace("\n0 0 0 0", f"\n{frame} 0")

    body = read(text, scale=0.01)

    assert_allclose(np.ptp(forward_kinematics(body).positions[0], axis=0), size, atol=1e-9)


def test_names_are_made_different(read):
    text = ARM.replace("elbow", "shoulder").replace(
        "    End Site", "    End Site\n    {\n      OFFSET 0 9 0\n    }\n    End Site"
    )

    expected = ("shoulder", "shoulder_2", "shoulder_2_end", "shoulder_2_2_end")
    assert read(text).skeleton.names == expected


def test_many_equal_names_do_not_hold_up(read):
    """If each search for a free number began at 2, this would take minutes."""
    tips = "    End Site\n    {\n      OFFSET 0 9 0\n    }\n" * 8_000

    names = read(ARM.replace("    End Site", f"{tips}    End Site")).skeleton.names

    assert names[-2:] == ("elbow_8000_end", "elbow_8001_end")


@pytest.mark.parametrize("name", ["Left  Arm", "Root", "Joint", "End"])
def test_names_may_be_spaced_or_keywords(read, name):
    assert read(ARM.replace("elbow", name)).skeleton.names[1] == "_".join(name.split())


def test_what_is_no_number_is_a_gap(read):
    arm = read(ARM.replace("5 141 7  90", "5 NaN 7  -1.#IND"))

    assert_array_equal(arm.observed, [[True, True, True], [False, True, True]])
    assert np.isnan(arm.rotations[1, 0]).all()
    assert np.isfinite(arm.rotations[1, 1]).all()


@pytest.mark.parametrize(
    ("reach", "unit"),
    [(230, 0.01), (2.3, 1.0), (2300, 0.001), (90, 0.0254), (140, 0.01)],
)
def test_the_unit_is_guessed_from_the_length_of_the_bones(read, reach, unit):
    body = read(BODY.replace("OFFSET 0 {a} {b}", f"OFFSET 0 {reach / 4} 0"))

    assert body.skeleton.height == pytest.approx(reach * unit)


def test_cmu_walkers_have_the_size_of_their_acclaim_skeleton(recordings):
    walk = read_bvh(recordings / "mocap/cmu_walk/05_01.bvh")

    shank = walk.skeleton.offsets[walk.skeleton.index("LeftFoot")]
    assert np.linalg.norm(shank) == pytest.approx(7.94618 * 0.0254 / 0.45, rel=1e-4)


def test_every_real_file_is_a_person_on_or_near_the_floor(recordings):
    for path in (recordings / "formats" / "bvh").iterdir():
        motion = read_bvh(path)
        assert 1.4 < motion.skeleton.height < 1.8, path
        assert motion.frame_rate in {30.0, 100.0, 120.0, 125.0}


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("", "does not begin with HIERARCHY"),
        (ARM.split("MOTION")[0], "no MOTION section: it is cut short"),
        (ARM.split("0 140 0  ")[0], "no frames"),
        (ARM.rsplit(" ", 1)[0], r"take\.bvh, line 20: 8 numbers instead of 9"),
        (ARM.replace("141", "abc"), "line 20: 'abc' is not a number"),
        (ARM.replace("CHANNELS 3", "CHANNELS 4"), "line 10: elbow has a channel 'end'"),
        (ARM.replace("30 0 0", "30 0"), "line 9: 'CHANNELS' is not a plausible number"),
        (ARM.replace("OFFSET 25", "25"), "line 12: OFFSET is missing"),
        (ARM.replace("}\n}\nMOTION", "}\nMOTION"), "the hierarchy ends too early"),
        (ARM.replace("MOTION", "ROOT second\n{\n}\nMOTION"), "OFFSET is missing"),
        (ARM.replace("MOTION", "JOINT second\nMOTION"), "'JOINT' is after the end"),
        (ARM.replace("JOINT elbow", "TWIG elbow"), "'TWIG' instead of JOINT"),
        (ARM.replace("CHANNELS 6", "CHANNELS inf"), "'inf' is not a plausible number"),
        (ARM.replace("OFFSET 30", "OFFSET nan"), "'nan' is not a plausible number"),
        (
            ARM.replace("elbow", "elbow " * 200),
            r"the name '(elbow_){6}elbo\.\.\.' does not end",
        ),
        (
            ARM.replace("elbow", "el\x1bbow").replace("S 3", "S 4"),
            "line 10: elbow has a channel",
        ),
    ],
)
def test_damage_is_one_sentence_with_the_line(read, text, sentence):
    with pytest.raises(InvalidFileError, match=sentence):
        read(text)


BODY = (
    "HIERARCHY\nROOT a\n{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
    + "".join(f"JOINT b{n}\n{{\nOFFSET 0 {{a}} {{b}}\nCHANNELS 1 Xrotation\n" for n in range(4))
    + "".join(f"JOINT c{n}\n{{\nOFFSET 0 0 0\nCHANNELS 0\n}}\n" for n in range(4))
    + "}\n" * 5
    + "MOTION\nFrames: 1\nFrame Time: 0.01\n0 0 0 0 0 0 0\n"
)
