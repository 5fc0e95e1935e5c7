"""Our own CSV and JSON: what is written comes back, and any recorder can write them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.errors import InvalidFileError, InvalidMotionError
from solvers.motion import SENSOR_JOINTS, JointRecording, Sensor, Tracks
from solvers.recordings import (
    read_joints,
    read_recording,
    write_c3d,
    write_joint_csv,
    write_joint_json,
    write_joints,
)

CSV = """mocap-assist-joints,1,frame_rate=50,units=mm,up=y,sensor=kinect_v1
Head.x,Head.y,Head.z,Head.state,Hand.x,Hand.y,Hand.z,Hand.state
100,1700,20,2,300,900,10,1
101,1701,21,2,,,,0

102,1702,22,2,0,0,0,2
"""
JSON = """{"format": "mocap-assist-joints", "version": 1, "units": "mm", "up": "y",
 "sensor": "kinect_v1", "frame_rate": 50, "joints": ["Head", "Hand"], "frames": [
 {"positions": [[100, 1700, 20], [300, 900, 10]], "states": [2, 1]},
 {"positions": [[101, 1701, 21], null], "states": [2, 0]},
 {"positions": [[102, 1702, 22], [0, 0, 0]], "states": [2, 2]}]}"""
TEXTS = {"csv": CSV, "json": JSON}


@pytest.fixture
def write(tmp_path):
    def write_text(text: str):
        (tmp_path / "take.dat").write_text(text, encoding="utf-8")
        return tmp_path / "take.dat"

    return write_text


@pytest.fixture(params=["all", "no state", "no confidence", "no more than places"])
def recording(request, rng) -> JointRecording:
    names = ('left "hand", upper', "head.x", "Fuß", *SENSOR_JOINTS[Sensor.KINECT_V2])
    positions = rng.normal(size=(40, len(names), 3)) / 3
    state = rng.integers(0, 3, (40, len(names)))
    positions[20, 1] = 0.0
    positions[4:9, 2], state[4:9, 2] = np.nan, 0
    confidence = rng.uniform(size=(40, len(names)))
    with_confidence = request.param in {"all", "no state"}
    with_state = request.param in {"all", "no confidence"}
    tracks = Tracks(names, positions, 1001 / 33, confidence if with_confidence else None)
    return JointRecording(tracks, state if with_state else None, Sensor.AZURE_KINECT)


@pytest.mark.parametrize("ending", ["csv", "json"])
def test_what_is_written_is_read_back_to_the_last_bit(recording, tmp_path, ending):
    write_joints(recording, tmp_path / f"take.{ending}")

    back = read_recording(tmp_path / f"take.{ending}")

    assert back.names == recording.names
    assert (back.frame_rate, back.sensor) == (recording.frame_rate, recording.sensor)
    assert_array_equal(back.tracks.positions, recording.tracks.positions)
    for one, other in [
        (back.tracking_state, recording.tracking_state),
        (back.tracks.confidence, recording.tracks.confidence),
    ]:
        assert (one is None) == (other is None)
        if one is not None:
            assert_array_equal(one, other)


@pytest.mark.parametrize("kind", TEXTS)
def test_files_of_other_recorders_are_read(write, kind):
    recording = read_joints(write(TEXTS[kind]))

    assert recording.names == ("Head", "Hand")
    assert (recording.frame_rate, recording.sensor) == (50.0, Sensor.KINECT_V1)
    assert_allclose(recording.tracks.positions[0], [(0.1, -0.02, 1.7), (0.3, -0.01, 0.9)])
    assert_allclose(recording.tracks.positions[2, 0], (0.102, -0.022, 1.702))
    assert np.isnan(recording.tracks.positions[1, 1]).all()
    assert_array_equal(recording.tracks.positions[2, 1], 0.0)  # A place like others.
    assert recording.tracking_state.tolist() == [[2, 1], [2, 0], [2, 2]]


@pytest.mark.parametrize("kind", TEXTS)
def test_times_instead_of_a_rate(write, kind):
    text = TEXTS[kind].replace(",frame_rate=50", "").replace(' "frame_rate": 50,', "")
    text = text.replace("Head.x", "time,Head.x", 1)
    for number, start in enumerate(["100,", "101,", "102,"]):
        time = (5.0, 5.02, 5.08)[number]
        text = text.replace(f"\n{start}", f"\n{time},{start}")
        text = text.replace(
            f'{{"positions": [[{start}', f'{{"time": {time}, "positions": [[{start}'
        )

    recording = read_joints(write(text))

    assert recording.frame_rate == 50.0
    assert recording.tracks.visible[:, 0].tolist() == [True, True, False, False, True]


@pytest.mark.parametrize(
    ("up", "expected"),
    [("x", (2, 3, 1)), ("y", (1, -3, 2)), ("z", (1, 2, 3)), ("-x", (2, -3, -1)),
     ("-y", (1, 3, -2)), ("-z", (1, -2, -3))],
)  # fmt: skip
def test_up_axis_is_that_of_the_header(write, up, expected):
    path = write(f"mocap-assist-joints,1,frame_rate=1,up={up}\nA.x,A.y,A.z\n1,2,3\n")

    assert_allclose(read_recording(path).tracks.positions[0, 0], expected)


@pytest.mark.parametrize("kind", TEXTS)
def test_a_given_scale_wins(write, kind):
    assert_allclose(read_joints(write(TEXTS[kind]), scale=1.0).tracks.positions[0, 0, 0], 100)


def test_the_least_that_a_recorder_must_write(write):
    path = write("mocap-assist-joints,1\ntime,A.x,A.y,A.z\n0,1,2,3\n0.1,1,2,3\n")

    recording = read_recording(path)

    assert (recording.frame_rate, recording.sensor) == (10.0, Sensor.OTHER)
    assert recording.tracking_state is None


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ("joints,1", "joints,2", "reads mocap-assist-joints 1, not mocap-assist-joints 2"),
        ("units=mm", "units=miles", "line 1: units is 'miles'; write one of mm, "),
        ("up=y", "up=w", "up is 'w'; write one of x, y, z"),
        ("kinect_v1", "kinect", "sensor is 'kinect'; write one of kinect_v1"),
        ("rate=50", "rate=fast", "a frame_rate of fast is not above 0"),
        ("rate=50", "rate=0", "a frame_rate of 0 is not above 0"),
        (",frame_rate=50", "", "has no times: its first line has no frame_rate"),
        ("Hand.x", "Head.x", "more than one column is called 'Head.x'"),
        ("Hand.y", "Hend.y", "Hand has no column .y"),
        ("Hand.state", "Hand.stale", "Hand has no column .state"),
        ("1700", "high", "line 3: 'high' is not a number"),
        ("20,2,", "20,4,", "tracking states other"),
        (",0\n", "\n", r"line 4: 7 numbers instead of 8"),
    ],
)
def test_csv_damage_is_named(write, old, new, sentence):
    with pytest.raises(InvalidFileError, match=sentence):
        read_recording(write(CSV.replace(old, new, 1)))


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        ('"version": 1', '"version": "x"', "not mocap-assist-joints x"),
        ('"Head", "Hand"', '"Head", "Head"', "more than one joint is called 'Head'"),
        ('"Head", "Hand"', '"Head"', "frame 1: 2 positions for 1 joints"),
        ('"frame_rate": 50, ', "", "has no times: it has no frame_rate"),
        ("[100, 1700, 20]", "[100, 1700]", "frame 1, positions: 2 x 3 numbers are required"),
        ('"states": [2, 1]', '"states": [2]', "frame 1, states: 2 numbers are required"),
        ('"states": [2, 1]', '"confidence": [2, 1]', "not between 0 and 1"),
        ('"states": [2, 1]', '"states": [2, 9]', "tracking states other"),
        ("null", "nil", "damaged or cut short"),
        ('"frames"', '"fames"', "no joints or no frames"),
        ('"frames": [', '"frames": [7, ', "frame 1: a list"),
    ],
)  # fmt: skip
def test_json_damage_is_named(write, old, new, sentence):
    with pytest.raises(InvalidFileError, match=sentence):
        read_recording(write(JSON.replace(old, new, 1)))


@pytest.mark.parametrize("write_it", [write_joint_csv, write_joint_json])
def test_name_that_cannot_be_read_back_is_refused(tmp_path, write_it):
    tracks = Tracks(("head\nhand", "foot"), np.ones((2, 2, 3)), 30.0)
    with pytest.raises(InvalidMotionError, match=r"'head\\nhand'\. Rename"):
        write_it(JointRecording(tracks, None, Sensor.OTHER), tmp_path / "take")
    assert not list(tmp_path.iterdir())


def test_joints_are_read_and_written_only_as_such(tmp_path):
    tracks = Tracks(("head",), np.ones((2, 1, 3)), 30.0)
    write_c3d(tracks, tmp_path / "take.c3d")

    with pytest.raises(InvalidFileError, match="no joints of a depth camera"):
        read_joints(tmp_path / "take.c3d")
    with pytest.raises(InvalidFileError, match=r"Use \.csv or \.json"):
        write_joints(JointRecording(tracks, None, Sensor.OTHER), tmp_path / "take.bvh")
