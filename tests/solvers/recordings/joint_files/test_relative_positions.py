"""Positions relative to parent bones, local titles and frames in steps are no silent errors."""

import json

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion import Tracks
from solvers.recordings import list_bodies
from solvers.recordings.point_bodies import groups_by_suffix, names_of_positions
from solvers.recordings.point_bodies.relative_positions import refuse_parent_positions

F = 40


@pytest.fixture(scope="module")
def walk(walker):
    return {role: path[:F] for role, path in walker.items()}


@pytest.fixture(scope="module")
def local(walk):
    """Positions of joints relative to others, which bones of constant length keep."""
    rng = np.random.default_rng(1)
    return {
        role: path if role == "hips" else np.tile(0.2 * rng.normal(size=3), (F, 1))
        for role, path in walk.items()
    }


def table(form, *bodies, first="time", times=None):
    """Return a table with a column for each coordinate, of bodies with a form of title each."""
    titles = [
        title.format(role=role, axis=axis)
        for title, body in zip(form, bodies, strict=True)
        for role in body
        for axis in "xyz"
    ]
    times = [f"{k / 50:.3f}" for k in range(F)] if times is None else times
    rows = [
        ",".join([times[k], *(f"{v:.5f}" for body in bodies for path in body.values()
                              for v in path[k])])
        for k in range(F)
    ]  # fmt: skip
    return "\n".join([",".join([first, *titles]), *rows]) + "\n"


REFUSAL = "relative to the parent bones, from which no pose follows"


@pytest.mark.parametrize("title", ["{role}_localPosition_{axis}", "{role}_{axis}"])
def test_tables_of_positions_relative_to_the_parents_are_refused(read_any, local, title):
    """Otherwise an actor of constant offsets comes in without a word."""
    with pytest.raises(InvalidFileError, match=REFUSAL):
        read_any(table([title], local))


@pytest.mark.parametrize("axes", ["local_x,local_y,local_z", "x,y,z"])
def test_lines_of_positions_relative_to_the_parents_are_refused(read_any, local, axes):
    lines = [f"{k},{role}," + ",".join(map(str, path[k]))
             for k in range(F) for role, path in local.items()]  # fmt: skip

    with pytest.raises(InvalidFileError, match=REFUSAL):
        read_any("\n".join([f"frame,bone,{axes}", *lines]))


def test_json_of_positions_relative_to_the_parents_is_refused(read_any, local):
    frames = [{"bones": [{"name": role, "position": path[k].tolist()}
                         for role, path in local.items()]} for k in range(F)]  # fmt: skip

    with pytest.raises(InvalidFileError, match=REFUSAL):
        read_any(json.dumps({"fps": 60, "frames": frames}))


def test_positions_in_the_room_come_before_those_relative_to_the_parents(read_any, walk, local):
    forms = ["{role}_localPosition_{axis}", "{role}_position_{axis}"]

    recording = read_any(table(forms, local, walk))

    wrist = recording.tracks.positions[:, recording.names.index("left_wrist")]
    assert np.linalg.norm(np.diff(wrist, axis=0), axis=1) == pytest.approx(
        np.linalg.norm(np.diff(walk["leftHand"], axis=0), axis=1), abs=1e-4
    )


def test_a_still_actor_is_no_set_of_offsets(read_any, walk):
    still = {role: np.tile(path[:1], (F, 1)) for role, path in walk.items()}

    assert read_any(table(["{role}_{axis}"], still)).tracks.n_frames == F


def test_joints_that_are_never_observed_are_no_offsets(walk):
    """A body of which only arms and hips are seen is one in the room."""
    roles = {role: at for at, role in enumerate(walk)}
    points = np.stack([*walk.values()], axis=1)
    is_seen = np.isin([*walk], ["hips", "leftHand", "rightHand"])

    refuse_parent_positions("a", np.where(is_seen[:, None], points, np.nan), roles)


@pytest.mark.parametrize(
    ("step", "stated", "rate"), [(1, 60, 60.0), (2, 60, 30.0), (40, 25, 25.0)]
)
def test_frames_of_a_table_are_numbered_at_the_rate_of_its_comment(
    read_any, walk, step, stated, rate
):
    """Each second frame alone plays at its speed. Numbers may be milliseconds."""
    numbers = [str(7 + step * k) for k in range(F)]
    text = f"# fps: {stated}\n" + table(["{role}_{axis}"], walk, first="Frame #", times=numbers)

    assert read_any(text).frame_rate == rate


@pytest.mark.parametrize("comment", ["Frequency: 100", "# frame rate = 100"])
def test_velocities_of_a_suit_are_left_out_and_its_frequency_is_read(read_any, walk, comment):
    """Velocities are no markers next to the joints of Axis Studio."""
    forms = ["{role}-Joint-Posi-{axis}", "{role}-Joint-Velo-{axis}"]
    lines = table(forms, walk, walk, first="note").splitlines()
    text = "\n".join([comment, *(line.partition(",")[2] for line in lines)])

    recording = read_any(text)

    assert recording.frame_rate == 100.0
    assert "left_wrist" in recording.names


def test_people_may_end_the_names_of_their_joints(tmp_path, walk):
    """Two people are not the markers of one."""
    path = tmp_path / "take.csv"
    moved = {role: each + 1.0 for role, each in walk.items()}
    path.write_text(table(["{role}_p1_{axis}", "{role}_p2_{axis}"], walk, moved))

    assert [body.name for body in list_bodies(path)] == ["p1", "p2"]


def test_several_markers_of_each_segment_are_no_people(read_any, walk):
    """Markers of a cluster have the numbers that people have, too."""
    moved = {role: each + 0.05 for role, each in walk.items()}

    recording = read_any(table(["{role}_1_{axis}", "{role}_2_{axis}"], walk, moved))

    assert isinstance(recording, Tracks) and len(recording.names) == 2 * len(walk)


def test_of_both_ends_of_bones_the_heads_are_the_joints(read_any, walk):
    """Heads and tails of Blender's bones are no markers."""
    forms = ["{role}_head_{axis}", "{role}_tail_{axis}"]
    tails = {role: each + np.array([0.0, 0.0, 0.1]) for role, each in walk.items()}

    recording = read_any(table(forms, walk, tails))

    knees = [recording.names.index(f"{side}_knee") for side in ("left", "right")]
    displacement = (
        recording.tracks.positions[:, knees[0]] - recording.tracks.positions[:, knees[1]]
    )
    expected = walk["leftLowerLeg"] - walk["rightLowerLeg"]
    assert np.linalg.norm(displacement, axis=1) == pytest.approx(
        np.linalg.norm(expected, axis=1), abs=1e-4
    )


def test_numbers_at_the_end_of_some_names_are_no_people(read_any):
    """The points of a face or a prop have numbers, too."""
    names = [f"cloth_{n}" for n in range(24)]
    rng = np.random.default_rng(2)
    text = table(["{role}_{axis}"], {name: rng.normal(size=(F, 3)) for name in names})

    recording = read_any(text)

    assert isinstance(recording, Tracks) and len(recording.names) == 24


@pytest.mark.parametrize("end", ["_{axis}_3d", "_{axis}3d", " {axis} 3D", "_{axis}_world"])
def test_points_in_3d_come_before_those_in_the_picture(read_any, walk, end):
    """x and y are not those of the picture."""
    flat = {role: 900.0 * path for role, path in walk.items()}

    recording = read_any(table(["{role}_{axis}", "{role}" + end], flat, walk))

    wrist = recording.tracks.positions[:, recording.names.index("left_wrist")]
    assert np.linalg.norm(np.diff(wrist, axis=0), axis=1) == pytest.approx(
        np.linalg.norm(np.diff(walk["leftHand"], axis=0), axis=1), abs=1e-4
    )


def test_keypoints_in_3d_next_to_the_picture_are_read(read_any, walk):
    """They are no landmarks of a picture."""
    names = {
        f"{side}_{part}": walk[side + role]
        for side in ("left", "right")
        for part, role in (
            ("shoulder", "UpperArm"), ("elbow", "LowerArm"), ("wrist", "Hand"),
            ("hip", "UpperLeg"), ("knee", "LowerLeg"), ("ankle", "Foot"),
            ("eye", "Hand"), ("ear", "Hand"),
        )
    } | {"nose": walk["head"]}  # fmt: skip
    flat = {name: 900.0 * path for name, path in names.items()}

    recording = read_any(table(["{role}_{axis}", "{role}_{axis}3d"], flat, names))

    hips = recording.tracks.positions[:, recording.names.index("left_hip")]
    assert np.ptp(hips, axis=0).max() == pytest.approx(
        np.ptp(walk["leftUpperLeg"], axis=0).max(), abs=1e-3
    )


def test_letters_of_positions_are_no_part_of_names(read_any, walk):
    """`Hips.px` is not the marker `Hips.p`."""
    turns = {role: np.ones_like(path) for role, path in walk.items()}

    recording = read_any(table(["{role}.p{axis}", "{role}.q{axis}"], walk, turns))

    assert "left_wrist" in recording.names


def test_points_of_no_body_are_reported_as_markers(read_any, collected_messages):
    """Otherwise the points of a dog are markers without a word."""
    messages, progress = collected_messages
    rng = np.random.default_rng(2)
    names = [f"cloth_{n}" for n in range(24)]

    read_any(
        table(["{role}_{axis}"], {name: rng.normal(size=(F, 3)) for name in names}),
        progress=progress,
    )

    assert "The names are those of no body; the points become markers" in messages


def test_the_bones_decide_on_joints_with_names_of_no_known_skeleton(read_any, walk):
    """The joints of a headset are no markers."""
    order = ["hips", "spine", "chest", "upperChest", "neck", "head"] + [
        side + part
        for parts in (("Shoulder", "UpperArm", "LowerArm", "Hand"),
                      ("UpperLeg", "LowerLeg", "Foot", "Toes"))
        for side in ("left", "right") for part in parts
    ]  # fmt: skip
    paths = {role: walk.get(role, walk["chest"]) for role in order}
    renamed = {f"Body_{k:02}x": path for k, path in enumerate(paths.values())}

    recording = read_any(table(["{role}.p{axis}"], renamed))

    assert not isinstance(recording, Tracks)


def test_the_foot_next_to_an_ankle_is_the_toes(read_any, walk):
    """The feet of a Kinect are not left out."""
    parts = {"Shoulder": "UpperArm", "Elbow": "LowerArm", "Wrist": "Hand", "Hip": "UpperLeg",
             "Knee": "LowerLeg", "Ankle": "Foot", "Foot": "Toes"}  # fmt: skip
    kinect = {
        part + side.title(): walk[side + role]
        for side in ("left", "right") for part, role in parts.items()
    }  # fmt: skip

    recording = read_any(table(["{role}_{axis}"], kinect))

    assert {"left_foot_index", "right_foot_index"} <= {*recording.names}


def test_points_whose_names_differ_before_the_suffix_are_no_people(walk):
    names = [f"{role}_1" for role in walk] + [f"prop{n}_2" for n in range(len(walk))]
    points = np.stack([*walk.values(), *(path + 2.0 for path in walk.values())], axis=1)

    assert groups_by_suffix(names, points) == []


def test_names_of_local_positions_are_left_out_next_to_a_body(walk):
    assert names_of_positions([*walk, *(f"{role}_local" for role in walk)]) == [*walk]
