"""Tables and JSON of any program come in as the body whose joints they name."""

import json

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion import (
    JointRecording,
    Tracks,
    roles_by_name,
)
from solvers.recordings import read_recording

F = 60
LIMBS = {"shoulder": "UpperArm", "elbow": "LowerArm", "wrist": "Hand", "hip": "UpperLeg",
         "knee": "LowerLeg", "ankle": "Foot", "bigtoe": "Toes"}  # fmt: skip
KEYPOINTS = {"nose": "head", "midhip": "hips", "neck": "neck"} | {
    side[0] + part: side + role for side in ("right", "left") for part, role in LIMBS.items()
}
TRUNK = {"Hip": "hips", "Spine1": "spine", "Spine2": "chest", "Neck": "neck", "Head": "head"}
ROKOKO = TRUNK | {
    f"{side.title()}{part}": side + role
    for side in ("left", "right")
    for part, role in {
        "Arm": "UpperArm", "ForeArm": "LowerArm", "Hand": "Hand", "Thigh": "UpperLeg",
        "Shin": "LowerLeg", "Foot": "Foot", "Toe": "Toes",
    }.items()
}  # fmt: skip

HUMAN36M = [
    "hips", *(side + part for side in ("right", "left")
              for part in ("UpperLeg", "LowerLeg", "Foot")),
    "spine", "neck", "neck", "head",
    *(side + part for side in ("left", "right")
      for part in ("UpperArm", "LowerArm", "Hand")),
]  # fmt: skip


@pytest.fixture(scope="module")
def walk(walker):
    return {role: path[:F] for role, path in walker.items()}


def table(walk, names, title, *, separator=",", unit=1.0, time=True, extra=""):
    """Return a table with a column for each coordinate, and columns that are no positions."""
    axes = [title(name, axis) for name in names for axis in "xyz"]
    others = [f"{name}{extra}" for name in names if extra]
    lines = [separator.join(["time"] * time + axes + others)]
    for frame in range(F):
        numbers = [unit * value for role in names.values() for value in walk[role][frame]]
        cells = [f"{frame / 60:.5f}"] * time + [f"{each:.6f}" for each in numbers]
        if separator == ";":
            cells = [cell.replace(".", ",") for cell in cells]
        lines.append(separator.join(cells + ["0"] * len(others)))
    return "\n".join(lines) + "\n"


def check(recording, walk):
    """Check that limbs are where they were, relative to the hips."""
    assert isinstance(recording, JointRecording)
    joints = {
        role: recording.tracks.positions[:, recording.names.index(name)]
        for role, name in roles_by_name(recording.names).items()
    }
    for role in ("leftHand", "rightLowerLeg", "leftFoot"):
        expected = walk[role] - walk["rightUpperLeg"]
        assert np.allclose(joints[role] - joints["rightUpperLeg"], expected, atol=1e-4), role
    assert sum(parent < 0 for parent in recording.parents) == 1


def read(tmp_path, content):
    (tmp_path / "take").write_text(content)
    said = []
    recording = read_recording(
        tmp_path / "take", progress=lambda _, text="": said.append(str(text))
    )
    return recording, " ".join(said)


@pytest.mark.parametrize(
    ("names", "title", "more"),
    [
        (KEYPOINTS, lambda name, axis: f"{name}_{axis}", {"unit": 1000.0, "extra": "_error"}),
        (KEYPOINTS, lambda name, axis: f"{name} {axis.upper()} (m)", {"separator": "\t"}),
        (KEYPOINTS, lambda name, axis: f"{name}.{axis}", {"separator": ";"}),
        (ROKOKO, lambda name, axis: f"{name}_position_{axis}", {"extra": "_rotation_x"}),
        (ROKOKO, lambda name, axis: f"{name}.translate{axis.upper()}", {"unit": 100.0}),
    ],
)
def test_a_table_of_named_points_is_a_body(tmp_path, walk, names, title, more):
    recording, _ = read(tmp_path, table(walk, names, title, **more))

    check(recording, walk)
    assert recording.tracks.frame_rate == pytest.approx(60.0, rel=1e-3)


def test_numbered_points_are_recognized_by_their_bones(tmp_path, walk):
    arm, leg = ("UpperArm", "LowerArm", "Hand"), ("UpperLeg", "LowerLeg", "Foot")
    limbs = {side + each[0]: [side + part for part in each]
             for side in ("left", "right") for each in (arm, leg)}  # fmt: skip
    order = [
        "neck", "neck", *limbs["rightUpperArm"], *limbs["leftUpperArm"], "hips",
        *limbs["rightUpperLeg"], *limbs["leftUpperLeg"], *["head"] * 4,
        "leftToes", "leftToes", "leftFoot", "rightToes", "rightToes", "rightFoot",
    ]  # fmt: skip
    names = {str(number): role for number, role in enumerate(order)}

    recording, said = read(
        tmp_path, table(walk, names, lambda name, axis: f"{axis}{name}", time=False)
    )

    check(recording, walk)
    assert "in the order of BODY_25" in said
    assert "30 Hz is assumed" in said


def test_named_markers_stay_markers(tmp_path, walk):
    names = dict(zip(("LASI", "RASI", "LKNE", "RKNE", "LANK", "RANK", "C7", "CLAV"),
                     ("leftUpperLeg", "rightUpperLeg", "leftLowerLeg", "rightLowerLeg",
                      "leftFoot", "rightFoot", "neck", "neck"), strict=True))  # fmt: skip

    markers, _ = read(tmp_path, table(walk, names, lambda name, axis: f"{name}:{axis}"))

    assert isinstance(markers, Tracks)
    assert markers.names == tuple(names)


def in_camera(points):
    return np.stack([points[..., 0], -points[..., 2], points[..., 1] + 3.0], axis=-1).tolist()


@pytest.mark.parametrize("wrap", [
    lambda frames: {"meta_info": {}, "instance_info": [
        {"frame_id": n, "instances": [{"keypoints": one, "keypoint_scores": [1.0]}]}
        for n, one in enumerate(frames)]},
    lambda frames: [
        {"people": [{"pose_keypoints_3d": [x for point in one for x in (*point, 0.9)]}]}
        for one in frames],
    lambda frames: frames,
])  # fmt: skip
def test_json_of_frames_without_names_is_a_body(tmp_path, walk, wrap):
    frames = in_camera(np.stack([walk[role] for role in HUMAN36M], axis=1))

    recording, said = read(tmp_path, json.dumps(wrap(frames)))

    check(recording, walk)
    assert "in the order of Human3.6M" in said


def test_json_of_named_joints_is_a_body(tmp_path, walk):
    frames = [
        {"timestamp": frame / 60.0,
         "joints": {name: dict(zip("xyz", walk[role][frame], strict=True))
                    for name, role in ROKOKO.items()}}
        for frame in range(F)
    ]  # fmt: skip

    recording, _ = read(tmp_path, json.dumps({"fps": 60, "frames": frames}))

    check(recording, walk)
    assert recording.tracks.frame_rate == pytest.approx(60.0)


def test_named_joints_may_be_missing_in_some_frames(tmp_path, walk):
    frames = [
        {"joints": {name: list(walk[role][frame]) for name, role in ROKOKO.items()}}
        for frame in range(F)
    ]
    del frames[0]["joints"]["LeftHand"], frames[5]["joints"]["Head"]
    frames[7]["joints"]["Neck"] = None

    recording, _ = read(tmp_path, json.dumps(frames))

    missing = np.isnan(recording.tracks.positions).any(axis=2)
    assert [(frame, recording.names[joint]) for frame, joint in np.argwhere(missing)] == [
        (0, "left_wrist"), (5, "head"), (7, "neck"),
    ]  # fmt: skip


def test_points_without_confidence_are_not_observed(tmp_path, walk):
    points = np.stack([walk[role] for role in HUMAN36M], axis=1)
    points = np.concatenate([points, np.ones((F, len(HUMAN36M), 1))], axis=2)
    points[4, HUMAN36M.index("leftHand")] = 0.0
    np.save(tmp_path / "joints.npy", points)

    from_json, _ = read(tmp_path, json.dumps(points.tolist()))

    for recording in (from_json, read_recording(tmp_path / "joints.npy")):
        missing = np.isnan(recording.tracks.positions).any(axis=2)
        assert [(frame, recording.names[joint]) for frame, joint in np.argwhere(missing)] == [
            (4, "WristLeft")
        ]


def test_times_without_a_unit_may_be_milliseconds(tmp_path, walk):
    frames = [
        {"time": 1000.0 * frame / 60.0,
         "joints": {name: list(walk[role][frame]) for name, role in ROKOKO.items()}}
        for frame in range(F)
    ]  # fmt: skip
    header, *lines = table(walk, ROKOKO, lambda name, axis: f"{name}_{axis}").splitlines()
    rows = [f"{16.6667 * frame},{line.split(',', 1)[1]}" for frame, line in enumerate(lines)]

    for content in (json.dumps(frames), "\n".join([header, *rows])):
        recording, said = read(tmp_path, content)
        assert recording.tracks.frame_rate == pytest.approx(60.0, rel=1e-3)
        assert "interpreted as milliseconds" in said


def test_json_of_two_people_in_two_frames_is_read(tmp_path, walk):
    person = {name: list(walk[role][0]) for name, role in ROKOKO.items()}
    frame = {"people": [{"id": 1, "joints": person}, {"id": 2, "joints": person}]}

    recording, _ = read(tmp_path, json.dumps([frame, frame]))

    assert recording.tracks.n_frames == 2


@pytest.mark.parametrize("unobserved", ["rightHand", "rightFoot", "head"])
def test_a_joint_that_is_never_observed_does_not_hide_the_up_axis(tmp_path, walk, unobserved):
    partial = walk | {unobserved: np.full((F, 3), np.nan)}

    recording, said = read(
        tmp_path, table(partial, ROKOKO, lambda name, axis: f"{name}_{axis}")
    )

    check(recording, walk)
    assert "interpreted as up" not in said


def test_json_of_one_frame_is_refused(tmp_path):
    points = np.zeros((25, 4)).tolist()

    with pytest.raises(InvalidFileError, match="joints of one frame"):
        read(tmp_path, json.dumps([{"id": 0, "keypoints3d": points}]))


LANDMARKS = {"nose": "head"} | {
    f"{side}_{part}": side + role
    for side in ("left", "right")
    for part, role in LIMBS.items()
    if part != "bigtoe"
}
"""MediaPipe's names, as far as the walker has such joints."""


@pytest.mark.parametrize("unit", [1.0, 1000.0])
def test_landmarks_that_cameras_triangulated_are_a_body_that_travels(tmp_path, walk, unit):
    names = LANDMARKS | {f"{side}_{part}": "head" for side in ("left", "right")
                         for part in ("eye", "ear")}  # fmt: skip
    path = {role: points + np.array([0.5, 4.0, 0.0]) for role, points in walk.items()}

    recording, _ = read(
        tmp_path, table(path, names, lambda name, axis: f"{name}_{axis}", unit=unit)
    )

    check(recording, walk)
    hips = recording.tracks.positions[:, recording.names.index("left_hip")]
    travel = np.linalg.norm(np.ptp(hips[:, :2], axis=0))
    assert travel == pytest.approx(
        np.linalg.norm(np.ptp(walk["leftUpperLeg"][:, :2], axis=0)), rel=0.1
    )


def test_world_landmarks_without_the_face_are_read(tmp_path, walk):
    """Landmarks that no frame has must not hide where the hips are."""
    hips = (walk["leftUpperLeg"] + walk["rightUpperLeg"]) / 2.0
    downward = {
        role: (points - hips)[..., [0, 2, 1]] * (1, -1, 1) for role, points in walk.items()
    }
    names = LANDMARKS | {f"{side}_{part}": f"{side}Foot" for side in ("left", "right")
                         for part in ("heel", "foot_index")}  # fmt: skip

    recording, _ = read(tmp_path, table(downward, names, lambda name, axis: f"{name}_{axis}"))

    check(recording, walk)
