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
    write_c3d,
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

    seen = [np.flatnonzero(each.visible.any(axis=1)) for each in (anna, ben)]

    assert [each[0] for each in seen] == [0, 30]
    assert_allclose([each[-1] for each in seen], [79, 99], atol=1)  # stamps are rounded
    assert_allclose([len(each) for each in seen], [80, 70], atol=1)
    truth = moving(N, len(ben.names), 1000)
    extents = [np.sort(each[..., :3].ravel()) for each in (truth[40], ben.positions[40])]
    ratio = np.ptp(extents[1]) / np.ptp(extents[0])  # millimeters, or signs of axes, differ
    assert 0.0005 < ratio < 2.1
    assert not np.allclose(anna.positions[40], ben.positions[40])


@pytest.mark.parametrize("crowd", CROWDS)
def test_default_is_the_best_seen_body_and_others_are_reported(tmp_path, crowd):
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


def person(rng, n_markers=20):
    """Markers that move relative to each other, meters, (n_frames, n_markers, 3)."""
    still = rng.uniform(0.1, 1.8, (1, n_markers, 3))
    return still + rng.normal(0.0, 0.06, (60, n_markers, 3))


def box(rng, n_markers=14):
    travel = np.linspace(0.1, 0.9, 60)[:, None, None]
    return rng.uniform(0.1, 0.4, (n_markers, 3)) + travel


def named(prefix, n):
    return [f"{prefix}:M{number}" for number in range(n)]


def test_subjects_of_c3d_are_bodies_and_a_box_is_a_prop(tmp_path, rng):
    points = np.concatenate([person(rng), box(rng), person(rng), person(rng, 2)], axis=1)
    labels = [*named("Anna", 20), *named("box", 14), *named("Ben", 20), "stick1", "stick2"]
    path = tmp_path / "take.c3d"
    write_c3d(Tracks(tuple(labels), points, 100.0), path)

    bodies = open_bodies(path)

    assert [(body.name, body.is_person) for body in bodies.listed] == [
        ("Anna", True), ("box", False), ("Ben", True), ("unlabeled", False)
    ]  # fmt: skip
    assert read_recording(path, body="ben").names == tuple(f"M{n}" for n in range(20))
    assert read_recording(path, body="box").n_points == 14
    assert bodies.choose("all") == [0, 1, 2, 3]
    assert read_recording(path).n_points == 20


def test_one_person_with_a_box_is_one_recording(recordings):
    path = recordings / "corpus" / "lab" / "c3d_vicon" / "Vicon.c3d"

    bodies = open_bodies(path)

    assert [(body.name, body.is_person) for body in bodies.listed] == [
        ("boite", False), ("Daphnee", True)
    ]  # fmt: skip
    assert list_bodies(path) == ()
    assert read_recording(path).n_points == 51
    daphnee = read_recording(path, body="Daphnee")
    assert daphnee.n_points == 43
    assert not any(":" in name for name in daphnee.names)


def test_clusters_of_one_person_are_no_people(recordings):
    """Each segment of a wheelchair athlete is a subject of the file."""
    path = recordings / "formats" / "c3d" / "sprintbasket.c3d"

    assert list_bodies(path) == ()
    assert read_recording(path).n_points == 26


def test_subjects_of_mvnx(tmp_path, recordings):
    text = (recordings / "corpus/lab/xsens_mvnx/test_mocap.mvnx").read_text("utf-8")
    start, stop = text.index("<subject"), text.index("</subject>") + len("</subject>")
    first = text[start:stop]
    label = re.search(r'label="([^"]*)"', first)[1]
    second = first.replace(f'label="{label}"', 'label="Ben"', 1)
    (tmp_path / "two.mvnx").write_text(text[:stop] + second + text[stop:], "utf-8")

    listed = list_bodies(tmp_path / "two.mvnx")

    assert [body.name for body in listed] == [label, "Ben"]
    assert listed[0].n_frames == 112
    ben = read_recording(tmp_path / "two.mvnx", body="Ben")
    one = read_recording(recordings / "corpus/lab/xsens_mvnx/test_mocap.mvnx")
    assert_allclose(ben.root_positions, one.root_positions)


@pytest.mark.parametrize("people_first", [True, False])
def test_people_of_smpl_parameters(tmp_path, people_first, rng):
    poses = rng.normal(0.0, 0.05, (2, 40, 72))
    poses[1, :10] = np.nan
    trans = np.cumsum(rng.normal(0.0, 0.01, (2, 40, 3)), axis=1)
    if not people_first:
        poses, trans = np.swapaxes(poses, 0, 1), np.swapaxes(trans, 0, 1)
    path = tmp_path / "two.npz"
    np.savez(path, poses=poses, trans=trans, betas=np.zeros((2, 10)), fps=30.0)

    one, two = list_bodies(path)

    assert (one.n_frames, two.n_frames, two.first) == (40, 30, 10)
    assert two.duration_s == 1.0
    second = read_recording(path, body="2")
    assert not second.observed[:10].any() and second.observed[10:].all()
    alone = tmp_path / "alone.npz"
    axis = 0 if people_first else 1
    np.savez(alone, poses=poses.take(1, axis), trans=trans.take(1, axis), fps=30.0)
    assert_allclose(second.rotations, read_recording(alone).rotations)


def test_body_parts_of_several_people(tmp_path, rng):
    np.savez(
        tmp_path / "two.npz",
        global_orient=rng.normal(0, 0.1, (2, 30, 3)),
        body_pose=rng.normal(0, 0.1, (2, 30, 21, 3)),
        transl=np.zeros((2, 30, 3)),
    )

    assert len(list_bodies(tmp_path / "two.npz")) == 2
    assert read_recording(tmp_path / "two.npz", body="2").n_frames == 30


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
