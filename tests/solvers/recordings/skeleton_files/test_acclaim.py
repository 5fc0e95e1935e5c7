"""Acclaim motion is where the model that it was exported from says that it was."""

import ezc3d
import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidFileError, InvalidSettingError
from solvers.motion import forward_kinematics
from solvers.recordings import read_acclaim
from solvers.recordings.skeleton_files.acclaim import find_skeleton

SKELETON = """# a made-up arm
:version 1.10
:units
  mass 1.0
  length 0.45
  angle deg
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
  begin
     id 1
     name upper
     direction 1 0 0
     length 10
     axis 90 0 90 XYZ
    dof rx rz
    limits (-160.0 20.0)
           (-70.0 70.0)
  end
  begin
     id 2
     name lower
     direction 1 0 0
     length 5
     axis 0 0 0 XYZ
  end
:hierarchy
  begin
    root upper
    upper lower
  end
"""
MOTION = """#!OML:ASF made-up
:FULLY-SPECIFIED
:DEGREES
1
root 0 20 0 0 0 0
upper 0 0
2
root 1 20 3 90 90 0
upper 90 0
3
root 0 20 0 0 0 0
upper 0 90
"""
UNIT = 0.0254 / 0.45


@pytest.fixture
def read(tmp_path):
    """Read a recording of this text, with a skeleton of that text next to it."""

    def read_text(motion: str = MOTION, skeleton: str = SKELETON, **options):
        (tmp_path / "actor.asf").write_text(skeleton)
        (tmp_path / "actor_walk_01.amc").write_text(motion)
        return read_acclaim(tmp_path / "actor_walk_01.amc", **options)

    return read_text


def test_bones_become_joints_where_they_start(read):
    arm = read(scale=UNIT)

    assert arm.skeleton.names == ("root", "upper", "lower", "lower_end")
    assert arm.skeleton.parents == (-1, 0, 1, 2)
    assert arm.frame_rate == 120.0
    rest = np.array([[0, 0, 0], [0, 0, 0], [10, 0, 0], [15, 0, 0]]) * UNIT
    assert_allclose(arm.skeleton.rest_positions, rest, atol=1e-12)


@pytest.mark.parametrize("length", [1, 10, 1000])
def test_a_prop_has_its_stated_size(read, length):
    """One of 8 cm does not become as tall as a man."""
    arm = read(skeleton=SKELETON.replace("length 10\n", f"length {length}\n"))

    assert_allclose(arm.skeleton.rest_positions[2, 0], length * UNIT)
    assert arm.conventions.unit == UNIT


def test_turns_are_about_the_axes_of_each_bone(read):
    """By hand: C = Rz(90) Rx(90) puts X of `upper` along Y, and Z of it along X."""
    arm = read(scale=UNIT)

    elbow = forward_kinematics(arm).positions[:, 2] / UNIT

    assert_allclose(elbow[0], [10, 0, 20], atol=1e-12)
    # Frame 2: Ry(90) of the bone moves X to -Z; the root's Rz(0) Ry(90) Rx(90) takes -Z by Rx
    # to Y, which Ry leaves; and Y up is our Z. The root is at (1, 20, 3), ours (1, -3, 20).
    assert_allclose(elbow[1], [1, -3, 30], atol=1e-12)
    # Frame 3: rz turns about X, along which the bone lies.
    assert_allclose(elbow[2], [10, 0, 20], atol=1e-12)


def test_joints_agree_with_the_model_recorded_with_the_markers(recordings):
    """CMU's 05_13.c3d holds the joint centers that the same software computed.

    Its axes are turned by a quarter. The toes are left out: see `read_acclaim`.
    """
    file = ezc3d.c3d(str(recordings / "mocap" / "05_13.c3d"))
    labels = file["parameters"]["POINT"]["LABELS"]["value"]
    x, y, z = file["data"]["points"][:3, : len(labels)] / 1000
    centers = dict(zip(labels, np.stack([y, -x, z], axis=-1), strict=True))

    motion = read_acclaim(recordings / "mocap" / "05_13.amc")

    positions = forward_kinematics(motion).positions
    for label, joint in CENTERS.items():
        found = positions[:, motion.skeleton.index(joint)]
        assert_allclose(found, centers[f"Dance:{label}0"], atol=0.0005, err_msg=joint)


CENTERS = {
    "PEL": "root", "LHJ": "lfemur", "RHJ": "rfemur", "LFE": "ltibia", "RFE": "rtibia",
    "LTI": "lfoot", "RTI": "rfoot", "LBK": "upperback", "UBK": "thorax", "TRX": "lowerneck",
    "LNK": "upperneck", "UNK": "head", "HED": "head_end", "LCL": "lhumerus", "RCL": "rhumerus",
    "LHU": "lradius", "RHU": "rradius", "LRA": "lwrist", "RRA": "rwrist", "LWR": "lhand",
    "RWR": "rhand", "LHN": "lfingers", "RHN": "rfingers", "LTB": "lthumb_end",
}  # fmt: skip


def test_every_recording_at_hand_is_of_an_adult_on_the_floor(recordings):
    paths = sorted((recordings / "mocap" / "hdm05").glob("*.amc"))[::25]

    for path in paths:
        motion = read_acclaim(path)
        assert 1.4 < motion.skeleton.height < 1.9
        assert abs(forward_kinematics(motion).positions[..., 2].min()) < 0.12


def test_takes_the_skeleton_with_the_longest_fitting_name(read, tmp_path):
    (tmp_path / "actor_walk.asf").write_text(SKELETON.replace("length 10", "length 20"))
    (tmp_path / "actor_walks.asf").write_text("not for us")

    assert read(scale=1.0).skeleton.rest_positions[2, 0] == pytest.approx(20.0)


def test_missing_skeleton_is_reported_with_a_remedy(tmp_path):
    (tmp_path / "13_29.amc").write_text(MOTION)

    with pytest.raises(InvalidFileError, match=r"13_29\.amc\. Put the actor's \.asf file next"):
        read_acclaim(tmp_path / "13_29.amc")


def test_only_skeleton_of_a_folder_needs_no_name(tmp_path):
    """An animator drops both files, whatever their names are."""
    take, actor = tmp_path / "hop.amc", tmp_path / "Actor.ASF"
    for path in (take, actor):
        path.touch()
    assert find_skeleton(take) == actor

    (tmp_path / "other.asf").touch()
    with pytest.raises(InvalidFileError, match=r"or as the only one\."):
        find_skeleton(take)
    (tmp_path / "ho.asf").touch()
    assert find_skeleton(take) == tmp_path / "ho.asf"


def test_a_missing_folder_is_one_sentence(tmp_path):
    with pytest.raises(InvalidFileError, match=r"gone cannot be searched .* of 13_29\.amc"):
        find_skeleton(tmp_path / "gone" / "13_29.amc")


def test_what_a_frame_leaves_out_is_a_gap(read):
    """And a bone that is never mentioned, as `lower`, is at rest."""
    arm = read(MOTION.replace("upper 90 0\n", ""))

    assert np.isnan(arm.rotations[1, 1]).all()
    assert arm.observed.sum() == 11


@pytest.mark.parametrize(
    ("motion", "sentence"),
    [
        (MOTION.replace("upper 90 0", "upper 90"), r"line 9: 1 numbers instead of 2"),
        (MOTION.replace("upper 90 0", "upper 90 x"), r"line 9: 'x' is not a number"),
        (MOTION.replace("upper", "wing"), "does not have: wing"),
        ("1\n2\n3\n", "nothing moves"),
        ("upper 1 2\n", "line 1: neither a frame number"),
    ],
)
def test_damaged_recordings_are_refused(read, motion, sentence):
    with pytest.raises(InvalidFileError, match=sentence):
        read(motion)


@pytest.mark.parametrize(
    ("skeleton", "sentence"),
    [
        ("", "no :root section"),
        (SKELETON.replace("upper lower", "upper root"), "below upper is .* twice"),
        (SKELETON.replace("upper lower", "upper tail"), "'tail' that is not described"),
        (SKELETON.replace("direction 1 0 0", "direction 1 0"), "3 numbers are required"),
        (SKELETON.replace("dof rx rz", "dof rx rw"), "'rx rw'"),
        (SKELETON.replace("90 XYZ", "90 XYY"), "'XYY'"),
    ],
)
def test_damaged_skeletons_are_refused(read, skeleton, sentence):
    with pytest.raises(InvalidFileError, match=sentence):
        read(MOTION, skeleton)


def test_a_frame_rate_must_be_positive(read):
    with pytest.raises(InvalidSettingError, match="positive"):
        read(frame_rate=0.0)
