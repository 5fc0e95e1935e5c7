"""Tables of numbers: NTU RGB+D, Kinect v2 CSV, MSR Action3D."""

import numpy as np
import pytest
from joint_files import kinect_csv, moving, msr, ntu, read_with
from numpy.testing import assert_allclose, assert_array_equal

from solvers.errors import InvalidFileError
from solvers.motion import SENSOR_JOINTS, JointRecording, Sensor
from solvers.progress import collect_remarks, unwatched
from solvers.recordings import (
    read_kinect_csv,
    read_msr_action3d,
    read_recording,
)
from solvers.recordings.joint_files import open_ntu_skeleton

V2 = SENSOR_JOINTS[Sensor.KINECT_V2]
ONE, TWO = "72057594037931101", "72057594037931691"


def upright(values):
    """Camera space to ours, unlike in the readers, as a matrix."""
    return values[..., :3] @ np.array([[-1, 0, 0], [0, 0, 1], [0, 1, 0]], dtype=float)


@pytest.fixture
def write(make_writer):
    return make_writer("take.txt")


def test_ntu_joints_and_states(write):
    values = moving(4, 25)
    values[1, 3, 3], values[2, 5, 3], values[3, 7, :3] = 1, 0, 0

    recording = read_recording(write(ntu([{ONE: frame} for frame in values])), scale=1.0)

    expected = upright(values)
    expected[2, 5] = expected[3, 7] = np.nan
    assert (recording.names, recording.frame_rate) == (V2, 30.0)
    assert recording.sensor is Sensor.KINECT_V2
    assert_allclose(recording.tracks.positions, expected)
    assert recording.tracking_state[1, 3] == 1
    assert (recording.tracking_state == 0).sum() == 2


def test_ntu_selects_the_longest_observed_body_in_any_order(write):
    """The first one vanishes for a frame, the other comes and goes before and after it."""
    mine, other = moving(5, 25), moving(5, 25, seed=50)
    frames = [
        {ONE: mine[0]},
        {TWO: other[1], ONE: mine[1]},
        {TWO: other[2]},
        {},
        {ONE: mine[4], TWO: other[4]},
    ]
    frames += [{ONE: mine[0]}]

    recording = read_recording(write(ntu(frames)), scale=1.0)

    observed = [0, 1, 4]
    assert_allclose(recording.tracks.positions[observed], upright(mine[observed]))
    assert np.isnan(recording.tracks.positions[[2, 3]]).all()
    assert (recording.tracking_state[[2, 3]] == 0).all()
    assert recording.n_frames == 6


def test_ntu_recognized_when_it_begins_with_empty_frames(write):
    recording = read_recording(write(ntu([{}, {}, {ONE: moving(1, 25)[0]}])))

    assert recording.tracks.visible.sum() == 25


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (
            lambda text: text[: text.rindex("\r\n", 0, -2)],
            "cut short: it ends within the joints",
        ),
        (lambda text: "9" + text[1:], "states 9 frames, but it has 3"),
        (
            lambda text: text.replace("\r\n25\r\n", "\r\n20\r\n", 1),
            "20 joints instead of 25",
        ),
        (lambda text: text.replace("\r\n1\r\n", "\r\n7\r\n", 1), "line 2: .*number of bodies"),
        (lambda text: text.replace(" 2\r\n", " 5\r\n"), "states other than 0, 1 and 2"),
        (lambda text: text.replace("278.3", "x", 1), "line 5: 'x' is not a number"),
        (lambda text: "3\r\n0\r\n0\r\n0\r\n", "no body in any frame"),
        (
            lambda text: text.replace(" 0.02 -0.3 2", "", 1),
            "line 3: found .* words instead of a body's id",
        ),
        (lambda text: text.replace("\r\n278", "\r\n\r\n278"), None),
        (lambda text: "", "ends before the number of frames"),
    ],
)
def test_ntu_damage_is_named(write, spoil, sentence):
    path = write(spoil(ntu([{ONE: frame} for frame in moving(3, 25)])))
    if sentence is None:
        assert read_recording(path).n_frames == 3
        return
    with pytest.raises(InvalidFileError, match=sentence):
        read_with(open_ntu_skeleton)(path)


def test_ntu_opens_the_other_bodies_where_one_is_damaged(write):
    mine, other = moving(3, 25), moving(3, 25, seed=50)
    text = ntu([{ONE: frame, TWO: each} for frame, each in zip(mine, other, strict=True)])
    damaged = text.replace("278.3", "x", 1)
    remarks = []
    path = write(damaged)

    bodies = open_ntu_skeleton(path, scale=1.0, progress=collect_remarks(unwatched, remarks))

    (left,) = bodies.listed
    assert left.n_frames == 3
    assert_allclose(bodies.read(0, unwatched).tracks.positions, upright(other))
    (remark,) = remarks
    assert remark.startswith("Body 1 is damaged and is left out: ")
    assert "line 5: 'x' is not a number" in remark
    with pytest.raises(InvalidFileError, match="line 5: 'x' is not a number"):
        open_ntu_skeleton(write(text.replace("278.3", "x")))


@pytest.mark.parametrize("position", [0, 1, 2])
def test_ntu_body_with_an_impossible_state_is_damaged(write, position):
    bodies = [moving(3, 25, seed=seed) for seed in (0, 50, 90)]
    bodies[position][1, 7, 3] = 9
    ids = (ONE, TWO, "72057594037944741")
    text = ntu([dict(zip(ids, frame, strict=True)) for frame in zip(*bodies, strict=True)])
    remarks = []

    opened = open_ntu_skeleton(
        write(text), scale=1.0, progress=collect_remarks(unwatched, remarks)
    )

    kept = [body for index, body in enumerate(bodies) if index != position]
    assert len(opened.listed) == 2
    for index, body in enumerate(kept):
        assert_allclose(opened.read(index, unwatched).tracks.positions, upright(body))
    (remark,) = remarks
    assert remark.startswith(f"Body {position + 1} is damaged and is left out: ")
    assert "tracking states other than 0, 1 and 2" in remark


def test_kinect_csv_with_blank_lines_and_without_times(write):
    values = moving(5, 25)
    values[2, 4, 3] = 0

    recording = read_recording(write("\n\n\n" + kinect_csv(values)), scale=1.0)

    expected = upright(values)
    expected[2, 4] = np.nan
    assert_allclose(recording.tracks.positions, expected)
    assert_array_equal(recording.tracking_state, values[..., 3])
    assert recording.frame_rate == 30.0


def test_kinect_csv_with_times_keeps_holes(write):
    ticks = [89810293609 + 333333 * frame for frame in (0, 1, 2, 7, 8)]

    recording = read_recording(write(kinect_csv(moving(5, 25), ticks)))

    assert recording.frame_rate == 30.0
    assert recording.tracks.visible[:, 0].tolist() == [True] * 3 + [False] * 4 + [True] * 2


def test_another_frame_rate_and_scale_can_be_given(write):
    values = moving(3, 25)
    path = write(kinect_csv(values))

    recording = read_kinect_csv(path, frame_rate=15.0, scale=0.5)

    assert recording.frame_rate == 15.0
    assert_allclose(recording.tracks.positions, 0.5 * upright(values))


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (lambda text: text.replace(",2,", ",7,", 1), "states other"),
        (lambda text: text[:-9], r"line 3: 9\d numbers instead of 100"),
        (lambda text: "1,2,3", "100 numbers are required"),
        (lambda text: text.replace(",2,", ",two,", 1), "'two' is not a number"),
        (lambda text: text.replace(",2,", ",0,"), "no joint that is observed"),
    ],
)
def test_kinect_csv_damage_is_named(write, spoil, sentence):
    with pytest.raises(InvalidFileError, match=sentence):
        read_kinect_csv(write(spoil(kinect_csv(moving(2, 25)))))


def test_msr_action3d_in_the_order_of_the_sensor(write):
    values = moving(3, 20) / 4

    recording = read_recording(write(msr(values)))

    position = {"ShoulderLeft": 0, "HipCenter": 6, "HandRight": 12, "FootLeft": 17, "Head": 19}
    for name, at in position.items():
        joint = recording.names.index(name)
        assert_allclose(recording.tracks.positions[:, joint], upright(values)[:, at])
        assert_allclose(recording.tracks.confidence[:, joint], values[:, at, 3])
    assert (recording.frame_rate, recording.tracking_state) == (15.0, None)
    assert recording.sensor is Sensor.KINECT_V1


def test_msr_action3d_cut_within_a_frame(write):
    with pytest.raises(InvalidFileError, match=r"30 lines of joints.* not a multiple of 20"):
        read_msr_action3d(write("\n".join(["0.1 0.2 2.5 1"] * 30)))


@pytest.mark.parametrize(
    ("folder", "n_joints", "n_files"),
    [("kimore", 25, 5), ("laban", 25, 7), ("msr_action3d", 20, 200)],
)
def test_real_takes_stand_upright_and_are_not_mirrored(recordings, folder, n_joints, n_files):
    paths = sorted((recordings / "kinect" / folder).iterdir())
    for path in paths[::10] if len(paths) > 20 else paths:
        recording = read_recording(path)
        assert isinstance(recording, JointRecording), path
        assert recording.n_joints == n_joints
        assert_upright_and_not_mirrored(recording)
    assert len(paths) >= min(n_files, 7) - 2


def assert_upright_and_not_mirrored(recording):
    """The head is above the feet, and left is left of where the toes point.

    Left is up x forward; forward is from ankle to foot. None of that knows the camera.
    """
    default = dict(
        zip(recording.names, np.nanmedian(recording.tracks.positions, axis=0), strict=True)
    )
    up = default["Head"] - default["AnkleLeft"] / 2 - default["AnkleRight"] / 2
    forward = (
        default["FootLeft"]
        - default["AnkleLeft"]
        + default["FootRight"]
        - default["AnkleRight"]
    )
    to_left = default["ShoulderLeft"] - default["ShoulderRight"]
    assert up[2] > 0.5 * np.linalg.norm(up)
    assert np.cross(up, forward) @ to_left > 0.0
