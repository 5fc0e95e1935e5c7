"""Azure Kinect joints, as JSON and as tables."""

import json

import numpy as np
import pytest
from joint_files import azure_columns, azure_json, azure_lines, moving, read_with
from numpy.testing import assert_allclose

from solvers.errors import InvalidFileError
from solvers.motion import SENSOR_JOINTS, Sensor
from solvers.recordings import read_recording
from solvers.recordings.joint_files import open_azure_csv, open_azure_json

NAMES = SENSOR_JOINTS[Sensor.AZURE_KINECT]


def upright(values):
    """Right, down, forward in millimeters to ours, as a matrix."""
    return values[..., :3] @ np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]) / 1000


@pytest.fixture
def write(make_writer):
    return make_writer("take.dat")


@pytest.fixture
def values():
    """Four frames in millimeters."""
    values = 1000 * moving(4, 32)
    values[..., 3] = 2
    return values


@pytest.mark.parametrize("sorted_keys", [True, False])
def test_json_in_either_order_of_keys(write, values, sorted_keys):
    """The library that writes it sorts the keys: the joints' names come after the frames."""
    frames = [{1: frame} for frame in values]

    recording = read_recording(write(azure_json(frames, sorted_keys=sorted_keys)))

    assert recording.names == NAMES
    assert (recording.frame_rate, recording.tracking_state) == (30.0, None)
    assert recording.sensor is Sensor.AZURE_KINECT
    assert_allclose(recording.tracks.positions, upright(values), atol=1e-4)  # stamps in us


def test_json_selects_the_longest_observed_body_and_keeps_gaps(write, values):
    other = {2: 9000 + values[0]}
    frames = [other | {1: values[0]}, {1: values[1]} | other, {}, {1: values[3]}]

    recording = read_recording(write(azure_json(frames, [0, 33333, 66667, 266667])))

    observed = recording.tracks.visible[:, 0]
    assert observed.tolist() == [True] * 2 + [False] * 6 + [True]
    assert_allclose(recording.tracks.positions[observed], upright(values[[0, 1, 3]]), atol=1e-4)


def test_json_spelt_as_the_manual_spells_it(write, values):
    text = azure_json([{1: frame} for frame in values]).replace("SPINE_NAVEL", "SPINE_NAVAL")

    assert read_recording(write(text)).names == NAMES


def test_json_without_times(write, values):
    messages = json.loads(azure_json([{1: frame} for frame in values]))
    for frame in messages["frames"]:
        del frame["timestamp_usec"]

    assert_allclose(
        read_recording(write(json.dumps(messages))).tracks.positions,
        upright(values),
        atol=1e-9,
    )


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (lambda text: text[: len(text) // 2], "damaged or cut short"),
        (lambda text: text.replace('"PELVIS", "SPINE', '"SPINE'), "each of the 31 joints"),
        (lambda text: text.replace('positions": [[', 'positions": [[1], ['), "1, joint_pos"),
        (
            lambda text: text.replace('"bodies": [', '"bodies": [3,'),
            "frame 1: a list of bodies",
        ),
        (lambda text: text.replace('usec": 0', 'usec": "noon"'), "frame 1, timestamp_usec"),
        (lambda text: '{"bone_list": [], "frames": []}', "no body in any frame"),
        (lambda text: "[" * 100_000, "damaged or cut short"),
        (lambda text: '{"frames": ' + "[" * 100_000, "damaged or cut short"),
        (lambda text: text.replace('"frames"', '"frames'), "damaged or cut short"),
    ],
)
def test_json_damage_is_named(write, values, spoil, sentence):
    text = spoil(azure_json([{1: frame} for frame in values], sorted_keys=False))
    with pytest.raises(InvalidFileError, match=sentence):
        read_with(open_azure_json)(write(text))


def test_a_line_per_joint(write, values):
    values[1, 3, 3], values[2, 5, 3] = 1, 0

    recording = read_recording(write(azure_lines([{1: frame} for frame in values])))

    expected = upright(values)
    expected[2, 5] = np.nan
    assert recording.names == NAMES
    assert_allclose(recording.tracks.positions, expected)
    assert_allclose(recording.tracking_state, values[..., 3])


def test_a_line_per_joint_of_two_bodies(write, values):
    _, two, three, four = values
    far = values[0] * (2, 2, 2, 1)
    frames = [{7: far}, {7: far, 1: two}, {1: three}, {1: four}]

    recording = read_recording(write(azure_lines(frames)))

    assert_allclose(recording.tracks.positions[1:], upright(values[1:]))
    assert not recording.tracks.visible[0].any()


def test_a_joint_that_comes_again_begins_a_frame(write, values):
    lines = azure_lines([{1: frame[:1]} for frame in values])

    recording = read_recording(write(lines))

    assert_allclose(recording.tracks.positions[:, 0], upright(values)[:, 0])
    assert recording.tracks.visible.sum() == 4


def test_a_line_per_frame(write, values):
    recording = read_recording(write(azure_columns(values)))

    assert recording.names == NAMES
    assert recording.tracking_state is None
    assert_allclose(recording.tracks.positions, upright(values))


@pytest.mark.parametrize("layout", [azure_lines, azure_columns])
@pytest.mark.parametrize("end", ["\r\n", "\r\r\n", "\r"])
def test_all_line_endings_are_read(write, values, layout, end):
    """A table that was twice written as text of Windows has a blank line after each."""
    text = layout([{1: frame} for frame in values] if layout is azure_lines else values)

    recording = read_recording(write(text.replace("\n", end)))

    assert_allclose(recording.tracks.positions, upright(values))


def test_scale_is_meters_per_unit(write, values):
    assert_allclose(
        read_recording(write(azure_columns(values)), scale=1.0).tracks.positions,
        1000 * upright(values),
    )


@pytest.mark.parametrize(
    ("layout", "spoil", "sentence"),
    [
        (azure_lines, lambda text: text.replace("\n1,3,", "\n1,32,"), "line 6: .* 32 joints"),
        (azure_lines, lambda text: text.replace("Medium", "Some"), "line 3: it does not end"),
        (azure_lines, lambda text: text[: text.index("\n1,0") + 1], "header but no joints"),
        (azure_columns, lambda text: text.split("\n")[0], "header but no joints"),
        (azure_columns, lambda text: text[:-30], r"line 5: 9\d numbers instead of 96"),
        (azure_columns, lambda text: "PELVIS.x,PELVIS.z\n1,2", "no columns x, y and z"),
    ],
)  # fmt: skip
def test_damage_of_tables_is_named(write, values, layout, spoil, sentence):
    frames = [{1: frame} for frame in values] if layout is azure_lines else values
    with pytest.raises(InvalidFileError, match=sentence):
        read_with(open_azure_csv)(write(spoil(layout(frames))))


def test_a_real_take_sits_upright_and_is_not_mirrored(recordings):
    recording = read_recording(recordings / "kinect" / "azure" / "joints_sync_1.csv")

    default = dict(
        zip(recording.names, np.nanmedian(recording.tracks.positions, axis=0), strict=True)
    )
    forward = default["Nose"] - default["Head"]
    to_left = default["EarLeft"] - default["EarRight"]
    assert recording.tracks.positions.shape == (10, 32, 3)
    assert default["Head"][2] > default["Pelvis"][2] > default["FootLeft"][2]
    assert np.cross((0, 0, 1), forward) @ to_left > 0
    assert (recording.tracking_state > 0).all()
