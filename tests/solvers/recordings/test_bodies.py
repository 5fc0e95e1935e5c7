"""Files with several people: who is in them, who is read, and what is said of the others."""

import json
import re

import numpy as np
import pytest
from joint_files import azure_json, azure_lines, moving, ntu
from numpy.testing import assert_allclose, assert_array_equal

from solvers.errors import InvalidSettingError
from solvers.motion import SENSOR_JOINTS, JointRecording, Sensor, Tracks
from solvers.progress import unwatched
from solvers.recordings import (
    list_bodies,
    open_bodies,
    read_recording,
    write_joint_csv,
    write_joint_json,
)

N = 100
NAMES = SENSOR_JOINTS[Sensor.KINECT_V2]
ANNA, BEN, GHOST = "72057594037944340", "72057594037944999", "9"


def three_bodies(n_joints: int) -> list[dict[str, np.ndarray]]:
    """Anna leaves at frame 80, Ben enters at 30, a ghost has 3 frames; the order changes."""
    anna, ben = moving(N, n_joints, 1), moving(N, n_joints, 1000)
    frames = []
    for index in range(N):
        frame = {ANNA: anna[index]} if index < 80 else {}
        frame |= {BEN: ben[index]} if index >= 30 else {}
        frame |= {GHOST: ben[0]} if 50 <= index < 53 else {}
        frames.append(dict(reversed(frame.items())) if index % 2 else frame)
    return frames


def crowd_ntu(path):
    path.write_text(ntu(three_bodies(25)))
    return path


def crowd_azure(path):
    path.write_text(azure_json(three_bodies(32)))
    return path


def crowd_azure_lines(path):
    path.write_text(azure_lines(three_bodies(32)))
    return path


def crowd_irds(path):
    words = ["NotTracked", "Inferred", "Tracked"]
    lines = ["Version0.1"]
    for number, frame in enumerate(three_bodies(25)):
        for body, values in frame.items():
            joints = ",".join(
                f"({name},{words[int(state)]},{x},{y},{z},1.7,2.5)"
                for name, (x, y, z, state) in zip(NAMES, values, strict=True)
            )
            lines.append(f"{number},{body},{33 * number},{joints}")
    path.write_text("\n".join(lines))
    return path


CROWDS = [crowd_ntu, crowd_azure, crowd_azure_lines, crowd_irds]


@pytest.mark.parametrize("crowd", CROWDS)
def test_bodies_are_listed_with_length_and_fraction(tmp_path, crowd):
    anna, ben = list_bodies(crowd(tmp_path / "take"))

    assert (anna.n_frames, anna.first, anna.last, anna.fraction) == (80, 0, 79, 0.8)
    assert (ben.n_frames, ben.first, ben.last, ben.fraction) == (70, 30, 99, 0.7)
    assert anna.duration_s == pytest.approx(80 / 30, rel=0.03)


@pytest.mark.parametrize("crowd", CROWDS)
def test_every_body_keeps_the_time_line_of_the_file(tmp_path, crowd):
    """Who enters later begins later; the order in a frame does not matter."""
    path = crowd(tmp_path / "take")
    anna, ben = (read_recording(path, body=body).tracks for body in ("1", "2"))

    observed = [np.flatnonzero(each.visible.any(axis=1)) for each in (anna, ben)]

    assert [each[0] for each in observed] == [0, 30]
    assert_allclose([each[-1] for each in observed], [79, 99], atol=1)  # stamps are rounded
    assert_allclose([len(each) for each in observed], [80, 70], atol=1)
    truth = moving(N, len(ben.names), 1000)
    extents = [np.sort(each[..., :3].ravel()) for each in (truth[40], ben.positions[40])]
    ratio = np.ptp(extents[1]) / np.ptp(extents[0])  # millimeters, or signs of axes, differ
    assert 0.0005 < ratio < 2.1
    assert not np.allclose(anna.positions[40], ben.positions[40])


@pytest.mark.parametrize("crowd", CROWDS)
def test_default_is_the_body_in_most_frames_and_others_are_reported(tmp_path, crowd):
    path, messages = crowd(tmp_path / "take"), []

    found = read_recording(path, progress=lambda fraction, message="": messages.append(message))

    first = read_recording(path, body="1")
    assert_array_equal(found.tracks.positions, first.tracks.positions)
    (sentence,) = [message for message in messages if "Left out" in message]
    assert re.search(r"Body \S+ of 2\. Left out: \S+ \(2\.\d s, 70 % of the frames\)", sentence)
    assert re.search(r"false detection: \S+ \(0\.\d s, 3 % of the frames\)", sentence)


def test_ghost_alone_is_no_reason_for_a_choice(tmp_path):
    frames = [{ANNA: values} for values in moving(N, 25)]
    frames[20][GHOST] = moving(1, 25)[0]
    path, messages = tmp_path / "take.skeleton", []
    path.write_text(ntu(frames))

    read_recording(path, progress=lambda fraction, message="": messages.append(message))

    assert list_bodies(path) == ()
    assert len(open_bodies(path).listed) == 2
    assert any(message.startswith("Left out as a false detection: 2") for message in messages)
    assert open_bodies(path).choose("all") == [0]
    assert open_bodies(path).choose("2") == [1]


@pytest.mark.parametrize(
    ("wanted", "indices"),
    [
        (None, [0]),
        ("", [0]),
        ("2", [1]),
        (" 2, 1 ", [1, 0]),
        ("all", [0, 1]),
        ("All", [0, 1]),
        ("3", [2]),
    ],
)
def test_bodies_are_chosen_by_name_and_number(tmp_path, wanted, indices):
    assert open_bodies(crowd_ntu(tmp_path / "take")).choose(wanted) == indices


def test_names_are_found_before_numbers(tmp_path):
    frames = [{2: values, 1: values} for values in moving(9, 32)]
    (tmp_path / "take").write_text(azure_json(frames))

    bodies = open_bodies(tmp_path / "take")

    assert [body.name for body in bodies.listed] == ["2", "1"]
    assert bodies.choose("2") == [0]


@pytest.mark.parametrize("wanted", ["4", "0", "Ben", "1,5", "²", "9" * 5000, ","])
def test_unknown_body_is_refused_with_the_list(tmp_path, wanted):
    with pytest.raises(InvalidSettingError, match=r"no body .* Name one of its 3 .*: 1 \(2\.7"):
        read_recording(crowd_ntu(tmp_path / "take"), body=wanted)


def test_reading_one_refuses_all(tmp_path):
    with pytest.raises(InvalidSettingError, match="2 bodies; only one can be read here"):
        read_recording(crowd_ntu(tmp_path / "take"), body="all")


def test_format_with_one_body_has_no_second(recordings):
    path = recordings / "mocap" / "05_13.amc"

    assert list_bodies(path) == ()
    assert read_recording(path, body="all").n_frames == read_recording(path, body="1").n_frames
    with pytest.raises(InvalidSettingError, match="has one body"):
        read_recording(path, body="2")


def test_a_thousand_ghosts_are_listed_in_short(tmp_path):
    values = moving(2, 25)
    frames = [{ANNA: values[0], f"{1000 + index}": values[1]} for index in range(1000)]
    (tmp_path / "take").write_text(ntu(frames))
    messages = []

    read_recording(
        tmp_path / "take", progress=lambda fraction, message="": messages.append(message)
    )

    (sentence,) = [message for message in messages if "Left out" in message]
    assert sentence.endswith("and 996 more")


@pytest.mark.parametrize("write", [write_joint_csv, write_joint_json])
def test_own_joint_files_hold_several_bodies(tmp_path, write):
    names = [f"{who}:{joint}" for who in ("Anna", "Ben") for joint in NAMES]
    positions = np.random.default_rng(1).uniform(0.1, 1.9, (20, 50, 3))
    positions[:5, 25:] = np.nan
    recording = JointRecording(Tracks(tuple(names), positions, 30.0), None, Sensor.KINECT_V2)
    write(recording, tmp_path / "take")

    ben = read_recording(tmp_path / "take", body="Ben")

    assert [body.name for body in list_bodies(tmp_path / "take")] == ["Anna", "Ben"]
    assert ben.names == NAMES
    assert_allclose(ben.tracks.positions, positions[:, 25:])
    assert read_recording(tmp_path / "take").names == NAMES


def test_azure_bodies_without_ids_are_numbered(tmp_path):
    content = json.loads(azure_json([{1: v, 2: v + 10} for v in moving(5, 32)]))
    for frame in content["frames"]:
        for body in frame["bodies"]:
            del body["body_id"]
    (tmp_path / "take").write_text(json.dumps(content))

    assert [body.name for body in list_bodies(tmp_path / "take")] == ["1", "2"]


def test_reading_a_body_twice_gives_the_same(tmp_path):
    bodies = open_bodies(crowd_azure_lines(tmp_path / "take"))

    one, two = (bodies.read(1, unwatched).tracks.positions for _ in range(2))

    assert_array_equal(one, two)
