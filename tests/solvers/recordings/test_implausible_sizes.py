"""Counts and numbers that no recording has are refused, or left out, without using memory."""

import json
import re

import numpy as np
import pytest
from complete_files import COMPLETE, KEYPOINTS, RECORDING, SKELETON, V2
from exports.complete_exports import EXPORTS

from solvers.errors import InvalidFileError
from solvers.recordings import read_as, read_recording
from solvers.recordings.containers import size_limits

ROOT = "ROOT a{}\n{{\nOFFSET 0 1 0\nCHANNELS 3 Xrotation Yrotation Zrotation\n}}\n"
LINES = "frame,joint,x,y,z\n"


@pytest.fixture
def refused(tmp_path):
    """Return the sentence with which the content of a file is refused."""

    def read(content, name="take"):
        (tmp_path / name).write_bytes(
            content if isinstance(content, bytes) else content.encode()
        )
        with pytest.raises(InvalidFileError) as error:
            read_recording(tmp_path / name)
        return str(error.value)

    return read


def test_too_many_joints_are_refused(refused, tmp_path):
    n_joints = size_limits.MAX_JOINTS + 1
    bodies = "".join(map(ROOT.format, range(n_joints)))
    bvh = f"HIERARCHY\n{bodies}MOTION\nFrames: 1\nFrame Time: 0.1\n"
    table = LINES + "".join(f"0,j{joint},1,2,3\n" for joint in range(n_joints))

    bones = "begin\nend\n" * n_joints
    skeleton = f":root\n:bonedata\n{bones}:hierarchy\n"

    assert "10,001 joints; 10,000 can be read" in refused(bvh)
    (tmp_path / "take.asf").write_text(skeleton)
    assert "10,001 joints; 10,000 can be read" in refused(RECORDING, "take.amc")
    assert "10,001 joints; 10,000 can be read" in refused(table)


def test_frames_without_rotations_are_refused(refused, monkeypatch, tmp_path):
    monkeypatch.setattr(size_limits, "MAX_UNCHECKED_POSES", 0)
    (tmp_path / "take.asf").write_bytes(SKELETON)
    still = b"JOINT still\n{\nOFFSET 0 1 0\nCHANNELS 0\n}\n"
    bvh = b"HIERARCHY\n" + ROOT.format("").encode()[:-2] + 30 * still + b"}\n"
    bvh += b"MOTION\nFrame Time: 0.1\n" + 300 * b"0 0 0\n"

    assert "300 frames of 31 joints, but hardly any rotations in them" in refused(bvh)
    assert "hardly any rotations" in refused(RECORDING + 900 * b"1\n", "take.amc")
    for kind in ("bvh", "amc"):
        (tmp_path / f"take.{kind}").write_bytes(COMPLETE[kind])
        read_recording(tmp_path / f"take.{kind}")


def test_few_lines_of_many_people_and_frames_are_refused(refused):
    table = "frame,person,joint,x,y,z\n" + "".join(f"{n},{n},m{n},1,2,3\n" for n in range(300))

    assert "does not fit its lines" in refused(table)


def test_other_names_in_each_frame_are_refused(refused):
    frames = [{"joints": {f"{k}_{n}": [1, 2, 3] for k in KEYPOINTS}} for n in range(900)]

    assert "has joints with other names in each frame" in refused(json.dumps(frames))


@pytest.mark.parametrize("times", ["1" + 400 * "0", "NaN", "1e999"])
def test_endless_times_and_rates_are_not_used(tmp_path, times):
    joints = dict(zip(KEYPOINTS, V2[0][:, :3].tolist(), strict=False))
    frames = ",".join([f'{{"time": {times}, "joints": {json.dumps(joints)}}}'] * 3)
    (tmp_path / "take").write_text(f'{{"fps": {times}, "frames": [{frames}]}}')

    assert read_recording(tmp_path / "take").tracks.frame_rate == 30.0


@pytest.mark.parametrize("program", ["zed", "nuitrack_json"])
def test_a_superscript_is_no_time(refused, program):
    text = re.sub(r'(?i)("timestamp\w*": )"?[\d.]+"?', r'\1"²"', EXPORTS[program].decode())

    assert "numbers are required" in refused(text)


def test_a_superscript_as_the_name_of_a_frame_is_no_time(tmp_path):
    text = re.sub(r'("timestamp": )\d+', r"\1null", EXPORTS["zed"].decode())
    (tmp_path / "take").write_text(re.sub(r'"\d(\d{12})": {', r'"²\1": {', text))

    assert read_recording(tmp_path / "take").tracks.frame_rate == 30.0


def test_a_signaling_nan_is_no_frame_time(tmp_path):
    content = re.sub(rb"(Frame Time:).*", rb"\1 sNaN", COMPLETE["bvh"])
    (tmp_path / "take.bvh").write_bytes(content)

    assert read_recording(tmp_path / "take.bvh").frame_rate == 30.0


@pytest.mark.parametrize("number", ["1e300", 5000 * "1"])
def test_an_endless_number_of_a_frame_or_joint_is_read(tmp_path, number):
    frames, joints = ["0", "1", "2", number], [*map(str, range(8)), number]
    lines = [f"{frame},{joint},1.5,2,3\n" for frame in frames for joint in joints]
    (tmp_path / "take").write_text(LINES + "".join(lines))

    points = read_recording(tmp_path / "take")

    assert points.positions.shape == ((4, 9, 3) if number == "1e300" else (3, 9, 3))
    assert np.isfinite(points.positions).all()


def test_joints_at_one_point_are_refused(tmp_path):
    """They would come in as a body without a size."""
    joints = [f"{side}{part}" for side in ("Left", "Right")
              for part in ("Shoulder", "Elbow", "Wrist", "Hip", "Knee", "Ankle")]  # fmt: skip
    titles = ",".join(f"{joint}_{axis}" for joint in joints for axis in "xyz")
    rows = [",".join([f"{0.1 * k},1,0"] * len(joints)) for k in range(30)]
    (tmp_path / "take.csv").write_text("\n".join([titles, *rows]))
    bone = "{} a{}\n{{\nOFFSET 0 0 0\nCHANNELS 3 Zrotation Xrotation Yrotation\n"
    bones = "".join(bone.format("JOINT" if k else "ROOT", k) for k in range(3))
    motion = "MOTION\nFrames: 2\nFrame Time: 0.1\n" + 2 * (9 * " 0" + "\n")
    (tmp_path / "take.bvh").write_text("HIERARCHY\n" + bones + 3 * "}\n" + motion)

    for name in ("take.csv", "take.bvh"):
        with pytest.raises(InvalidFileError, match="has all joints at one point"):
            read_as(tmp_path / name)
