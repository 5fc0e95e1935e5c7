"""Tables are read from JSON, and without titles, as those with titles in text are."""

import json

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion import JointRecording, find_humanoid_map, forward_kinematics
from solvers.motion.skeletons.point_layouts import LAYOUTS
from solvers.samples import walking_gait

F, RATE_HZ = 40, 25.0
SMPL = (
    "hips", "leftUpperLeg", "rightUpperLeg", "spine", "leftLowerLeg", "rightLowerLeg", "chest",
    "leftFoot", "rightFoot", "upperChest", "leftToes", "rightToes", "neck", "leftShoulder",
    "rightShoulder", "head", "leftUpperArm", "rightUpperArm", "leftLowerArm", "rightLowerArm",
    "leftHand", "rightHand",
)  # fmt: skip
"""Roles in the order of SMPL."""
ROLES = {
    "LeftArm": "leftUpperArm", "LeftForeArm": "leftLowerArm", "LeftHand": "leftHand",
    "LeftUpLeg": "leftUpperLeg", "LeftLeg": "leftLowerLeg", "LeftFoot": "leftFoot",
}  # fmt: skip
ROLES |= {
    name.replace("Left", "Right"): role.replace("left", "right") for name, role in ROLES.items()
}
NAMES = [*ROLES]


@pytest.fixture(scope="module")
def walk():
    """Positions of the joints of a walker, shape (F, 12, 3), meters, Y up."""
    motion = walking_gait()
    roles = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    found = forward_kinematics(motion).positions[:F, [roles[role] for role in ROLES.values()]]
    return np.round(found[..., [0, 2, 1]] * (1.0, 1.0, -1.0), 5)


@pytest.fixture
def records(walk):
    """A row for each frame, by title."""
    return [
        {"time": k / RATE_HZ}
        | {
            f"{name}_{axis}": float(frame[at, "xyz".index(axis)])
            for at, name in enumerate(NAMES)
            for axis in "xyz"
        }
        for k, frame in enumerate(walk)
    ]


def assert_is(recording, walk, rate=RATE_HZ):
    """Compare distances between joints, which no axes change, and the rate."""
    assert isinstance(recording, JointRecording)
    assert recording.frame_rate == pytest.approx(rate)
    ends = [f"{side}_{part}" for side in ("left", "right") for part in (
        "shoulder", "elbow", "wrist", "hip", "knee", "ankle")]  # fmt: skip
    found = recording.tracks.positions[:, [recording.names.index(name) for name in ends]]
    assert len(found) == F
    distances = [
        np.linalg.norm(each[:, :, None] - each[:, None], axis=-1) for each in (found, walk)
    ]
    assert np.allclose(*distances, atol=1e-4)


def by_column(records):
    return {
        title: {str(k): each[title] for k, each in enumerate(records)} for title in records[0]
    }


@pytest.mark.parametrize(
    "orient",
    [
        by_column,
        lambda records: records,
        lambda records: {str(k): each for k, each in enumerate(records)},
        lambda records: {
            "columns": [*records[0]], "index": [*range(F)],
            "data": [[*each.values()] for each in records],
        },
        lambda records: {
            "schema": {"fields": [{"name": "index", "type": "integer"}], "primaryKey": []},
            "data": records,
        },
        lambda records: {title: [each[title] for each in records] for title in records[0]},
        lambda records: {"fps": 60, "frames": records},
    ],
    ids=["columns", "records", "index", "split", "table", "lists", "frames"],
)  # fmt: skip
def test_the_orients_of_pandas_are_one_table(read_any, walk, records, orient):
    """Before, each was of an unknown format, or a single frame."""
    assert_is(read_any(json.dumps(orient(records))), walk)


def test_a_row_in_each_line_is_a_table(read_any, walk, records):
    assert_is(read_any("\n".join(map(json.dumps, records))), walk)


def test_times_in_the_index_are_times(read_any, walk, records):
    times = [str(each.pop("time")) for each in records]
    columns = {
        title: {time: each[title] for time, each in zip(times, records, strict=True)}
        for title in records[0]
    }

    assert_is(read_any(json.dumps(columns)), walk)


def test_titles_of_two_levels_are_joined(read_any, walk, records):
    columns = [["time", ""], *([name, axis] for name in NAMES for axis in "xyz")]
    rows = [[*each.values()] for each in records]
    tuples = {
        str(tuple(title)): {str(k): row[at] for k, row in enumerate(rows)}
        for at, title in enumerate(columns)
    }

    assert_is(read_any(json.dumps({"columns": columns, "data": rows})), walk)
    assert_is(read_any(json.dumps(tuples)), walk)


def test_a_line_for_each_joint_is_a_table_in_json_too(read_any, walk):
    rows = [
        {"frame": k, "joint": name, **dict(zip("xyz", map(float, position), strict=True))}
        for k, frame in enumerate(walk)
        for name, position in zip(NAMES, frame, strict=True)
    ]

    assert_is(read_any(json.dumps(rows)), walk, 30.0)


@pytest.mark.parametrize("key", ["joint_names", "joints", "names", "labels", "keypoint_names"])
@pytest.mark.parametrize("shape", [(F, 12, 3), (F, 36), (-1,)])
def test_an_array_next_to_names_has_these(read_any, walk, key, shape):
    value = {"fps": RATE_HZ, key: NAMES, "data": walk.reshape(shape).tolist()}

    assert_is(read_any(json.dumps(value)), walk)


@pytest.mark.parametrize(
    "unit", [{"unit": "cm"}, {"meta": {"units": "Centimeters"}}, {"length_unit": "cm"}]
)
def test_a_unit_next_to_names_counts(read_any, walk, unit):
    """Before, such a giant was scaled to an adult."""
    value = {"fps": RATE_HZ, "joint_names": NAMES, **unit, "data": (500.0 * walk).tolist()}

    assert_is(read_any(json.dumps(value)), 5.0 * walk)
    assert_is(read_any(json.dumps(value), scale=0.002), walk)


def test_a_unit_of_time_is_none_of_length(read_any, walk):
    value = {"fps": RATE_HZ, "joint_names": NAMES, "unit": "ms", "data": (1e3 * walk).tolist()}

    assert_is(read_any(json.dumps(value)), walk)


@pytest.mark.parametrize("inner", ["skeleton", "meta"])
@pytest.mark.parametrize("key", ["positions", "frames", "motion"])
def test_names_may_be_next_to_the_rate_in_another_member(read_any, walk, inner, key):
    """Before, 20 named joints were those of a Kinect by their number, or the format unknown."""
    value = {inner: {"fps": RATE_HZ, "joints": NAMES, "parents": [-1]}, key: walk.tolist()}

    assert_is(read_any(json.dumps(value)), walk)


def test_names_of_something_else_change_nothing(read_any, walk):
    frames = [{"joints": dict(zip(NAMES, each, strict=True))} for each in walk.tolist()]
    value = {"labels": [f"a{k}" for k in range(9)], "fps": RATE_HZ, "frames": frames}
    value["corners"] = [[[0.0, 1.0, 2.0]]]

    assert_is(read_any(json.dumps(value)), walk)


def test_a_table_of_other_values_is_refused_with_what_to_export(read_any):
    value = {"Hip_x": [1.0] * 5, "Hip_y": [1.0] * 5, "speed": [2.0] * 5}

    with pytest.raises(InvalidFileError, match=r"no table of points\. Export columns such as"):
        read_any(json.dumps(value))


def test_rows_with_other_titles_each_use_no_memory(read_any, monkeypatch):
    monkeypatch.setattr("solvers.recordings.joint_files.json_table.MAX_CELLS", 1000)
    columns = {f"p{k}_{axis}": {str(k): 1.0} for k in range(40) for axis in "xyz"}

    with pytest.raises(InvalidFileError, match="has no table of points"):
        read_any(json.dumps(columns))


@pytest.mark.parametrize("above", [[], ["time"], ["frame", "time"]])
@pytest.mark.parametrize("confidence", [False, True])
def test_numbers_of_a_known_order_need_no_titles(read_any, above, confidence):
    """Before, they were refused for the lack of titles."""
    motion = walking_gait()
    roles = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    order = [roles[role] for role in SMPL]
    body = forward_kinematics(motion).positions[:F, order]
    if confidence:
        body = np.concatenate([body, np.ones((*body.shape[:2], 1))], axis=-1)
    stamps = {"frame": str, "time": lambda k: str(k / RATE_HZ)}
    lines = [
        ",".join([*(stamps[each](k) for each in above), *(f"{x:.5f}" for x in frame.flat)])
        for k, frame in enumerate(body)
    ]

    recording = read_any("\n".join(lines))

    assert isinstance(recording, JointRecording)
    assert recording.frame_rate == (RATE_HZ if above else 20.0)
    assert recording.names == LAYOUTS["SMPL"]
    sizes = [np.ptp(each[..., 2]) for each in (recording.tracks.positions, body)]
    assert sizes[0] == pytest.approx(sizes[1], abs=1e-3)


def test_numbers_of_frames_are_no_seconds(read_any):
    """As in UTKinect: without titles, the first cell counts the frames from any number."""
    motion = walking_gait()
    roles = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    body = forward_kinematics(motion).positions[:F, [roles[role] for role in SMPL]]
    lines = [
        f"{250 + k} " + " ".join(f"{x:.5f}" for x in frame.flat) for k, frame in enumerate(body)
    ]

    recording = read_any("\n".join(lines))

    assert (recording.n_frames, recording.frame_rate) == (F, 20.0)


def test_numbers_of_no_body_are_refused(read_any, rng):
    lines = [",".join(f"{x:.4f}" for x in row) for row in rng.normal(size=(20, 51))]

    with pytest.raises(InvalidFileError, match=r"form no body in a known order.*LeftHand_x"):
        read_any("\n".join(lines))
