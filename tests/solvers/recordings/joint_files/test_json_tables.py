"""Tables are read from JSON as those with titles in text are."""

import json

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion import JointRecording

F, RATE_HZ = 40, 25.0
ROLES = {
    "LeftArm": "leftUpperArm", "LeftForeArm": "leftLowerArm", "LeftHand": "leftHand",
    "LeftUpLeg": "leftUpperLeg", "LeftLeg": "leftLowerLeg", "LeftFoot": "leftFoot",
}  # fmt: skip
ROLES |= {
    name.replace("Left", "Right"): role.replace("left", "right") for name, role in ROLES.items()
}
NAMES = [*ROLES]


@pytest.fixture(scope="module")
def walk(walker):
    """Positions of joints, shape (F, 12, 3), meters, Y up."""
    found = np.stack([walker[role][:F] for role in ROLES.values()], axis=1)
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


def as_index(records, keys, orient):
    """Return records with an index in an orient of pandas."""
    rows = [{k: v for k, v in each.items() if k != "time"} for each in records]
    pairs = [*zip(keys, rows, strict=True)]
    titles = [*rows[0]]
    return {
        "columns": lambda: {title: {key: row[title] for key, row in pairs} for title in titles},
        "index": lambda: dict(pairs),
        "split": lambda: {"columns": titles, "index": [key for key, _ in pairs],
                          "data": [[*row.values()] for row in rows]},
        "table": lambda: {"schema": {"fields": [{"name": "when"}], "primaryKey": ["when"]},
                          "data": [{"when": key, **row} for key, row in pairs]},
        "records": lambda: [{"index": key, **row} for key, row in pairs],
    }[orient]()  # fmt: skip


@pytest.mark.parametrize("orient", ["columns", "index", "split", "table", "records"])
@pytest.mark.parametrize(
    ("key", "rate"),
    [
        (lambda k: str(1577836800000 + int(40 * k)), RATE_HZ),
        (lambda k: str(25 * k), 40.0),
        (lambda k: f"2020-01-01T00:00:0{k / RATE_HZ:.3f}Z", RATE_HZ),
        (lambda k: str(100 + k), 30.0),
    ],
    ids=["epoch", "ms", "date", "frames"],
)
def test_the_index_of_rows_is_a_time_or_a_number(read_any, walk, records, orient, key, rate):
    """Milliseconds without fractions are no numbers of frames, in any orient."""
    content = as_index(records, map(key, range(F)), orient)

    assert_is(read_any(json.dumps(content)), walk, rate)


@pytest.mark.parametrize("orient", ["columns", "index", "split"])
def test_rows_are_in_the_order_of_their_index(read_any, walk, records, orient):
    """Keys in the order of texts (0, 1, 10, 11) would make the actor jump."""
    order = sorted(range(F), key=str)
    content = as_index([records[k] for k in order], map(str, order), orient)

    assert_is(read_any(json.dumps(content)), walk, 30.0)


def test_an_index_that_restarts_changes_nothing(read_any, walk, records):
    content = as_index(records, [k % 20 for k in range(F)], "split")

    assert_is(read_any(json.dumps(content)), walk, 30.0)


def test_columns_of_a_table_with_a_line_for_each_joint(read_any, walk):
    """The first column fills the begin of the file, by which formats are recognized."""
    rows = [(k, name, *p) for k, frame in enumerate(walk.tolist())
            for name, p in zip(NAMES, frame, strict=True)]  # fmt: skip
    columns = zip(("frame", "joint", *"xyz"), zip(*rows, strict=True), strict=True)
    content = {title: dict(enumerate(cells)) for title, cells in columns}

    assert_is(read_any(json.dumps(content)), walk, 30.0)


@pytest.mark.parametrize(
    ("other", "remark"),
    [
        ({"timestamps": [k / 60.0 for k in range(72)]}, ""),
        ({"rest": [0.5] * 36}, ""),
        ({"tPose": [[[0.5] * 3] * 12]}, ""),
        ({"rotations": [[[0.5] * 3] * 12] * F}, ""),
        ({"velocities": [[0.5] * 36] * F}, ""),
        ({"root_offsets": [0.5] * 36}, ""),
        ({"counts": [1] * 36}, ""),
        ({"bone_names": [f"bone{k}" for k in range(12)]}, ""),
        ({"local_positions": [[[0.5] * 3] * 12] * F}, "world_positions, and not from local_po"),
        ({"landmarks": [[[0.5] * 3] * 12] * F}, "world_positions, and not from landmarks"),
    ],
    ids=lambda value: next(iter(value), "") if isinstance(value, dict) else "",
)
def test_other_arrays_next_to_names_are_no_positions(
    make_reader, collected_messages, walk, other, remark
):
    """Other arrays of a fitting size come first."""
    content = {"fps": RATE_HZ, "joint_names": NAMES, **other, "world_positions": walk.tolist()}
    text = json.dumps(content, sort_keys=True)
    messages, progress = collected_messages

    assert_is(make_reader("take.json")(text, progress=progress), walk)

    assert remark in next((each for each in messages if "Positions are read" in each), "")


@pytest.mark.parametrize("other", ["rotations", "local_positions", "rest_pose"])
def test_arrays_of_frames_are_chosen_by_their_keys(read_any, walk, other):
    """With names at the end, the file is one of frames; before, the first array was taken."""
    content = {"fps": RATE_HZ, other: (walk / 2.0).tolist(), "positions": walk.tolist()}

    assert_is(read_any(json.dumps({**content, "joint_names": NAMES})), walk)


def test_times_next_to_an_array_keep_their_unit(read_any, walk):
    content = {"joint_names": NAMES, "time_us": [20000 * k for k in range(F)]}

    assert_is(read_any(json.dumps({**content, "data": walk.tolist()})), walk, 50.0)


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
    """Such a giant is not scaled to an adult."""
    value = {"fps": RATE_HZ, "joint_names": NAMES, **unit, "data": (500.0 * walk).tolist()}

    assert_is(read_any(json.dumps(value)), 5.0 * walk)
    assert_is(read_any(json.dumps(value), scale=0.002), walk)


def test_a_unit_of_time_is_none_of_length(read_any, walk):
    value = {"fps": RATE_HZ, "joint_names": NAMES, "unit": "ms", "data": (1e3 * walk).tolist()}

    assert_is(read_any(json.dumps(value)), walk)


@pytest.mark.parametrize("inner", ["skeleton", "meta"])
@pytest.mark.parametrize("key", ["positions", "frames", "motion"])
def test_names_may_be_next_to_the_rate_in_another_member(read_any, walk, inner, key):
    """20 named joints are not those of a Kinect because of their number."""
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
