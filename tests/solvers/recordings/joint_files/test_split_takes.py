"""Takes with a file per frame, with a line per joint, and several takes in one array."""

import json

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion.humanoid import SIDES
from solvers.motion.skeletons import BODY_POINTS
from solvers.recordings import folders, list_bodies, read_recording, recordings_in
from solvers.recordings.containers import names_by_number

F = 24
PARTS = {"UpperArm": "shoulder", "LowerArm": "elbow", "Hand": "wrist", "UpperLeg": "hip",
         "LowerLeg": "knee", "Foot": "ankle"}  # fmt: skip
NAMES = {f"{side}_{part}": side + role for side in SIDES for role, part in PARTS.items()}
"""Names of keypoints, with the role of the walker's joint."""
COCO = ["head"] * 5 + [side + role for role in PARTS for side in SIDES]


@pytest.fixture(scope="module")
def walk(walker):
    return {role: path[:F] for role, path in walker.items()}


@pytest.fixture
def coco(walk):
    return np.stack([walk[role] for role in COCO], axis=1)


def read(path, **which):
    """Return the recording and what the reader says."""
    said = []
    recording = read_recording(
        path, progress=lambda _, text="": said.append(str(text)), **which
    )
    return recording, " ".join(said)


def people(points):
    """Return a frame as EasyMocap stores it: with the confidence of each joint."""
    joints = np.concatenate([points, np.ones_like(points[:, :1])], axis=1)
    return [{"id": 3, "keypoints3d": joints.tolist()}]


def coordinates(points):
    """Return MediaPipe's landmarks by name, whose hips are at the origin and Y is down."""
    hips = points[[11, 12]].mean(axis=0)
    found = dict.fromkeys(BODY_POINTS, points[0] - hips)
    found |= {
        name: points[5 + 2 * part + side] - hips
        for part, word in enumerate(PARTS.values())
        for side, name in enumerate(f"{side}_{word}" for side in SIDES)
    }
    return {name: (x, -z, y) for name, (x, y, z) in found.items()}


def landmarks(points):
    """Return a frame of MediaPipe as programs save it."""
    return {"pose_world_landmarks": [
        {"x": x, "y": y, "z": z, "visibility": 1.0} for x, y, z in coordinates(points).values()
    ]}  # fmt: skip


def named(points):
    """Return a frame whose joints have names."""
    joints = {name: points[COCO.index(role)].tolist() for name, role in NAMES.items()}
    return {"joints": joints}


@pytest.mark.parametrize("make", [people, landmarks, named])
def test_one_file_per_frame_is_one_take(tmp_path, coco, make):
    for frame in [*range(7), *range(9, F)]:
        name = f"cam2_{frame:06d}_keypoints.json"
        (tmp_path / name).write_text(json.dumps(make(coco[frame])))
    (tmp_path / "cam2_notes.json").write_text("{}")
    chosen = tmp_path / "cam2_000003_keypoints.json"

    recording, said = read(chosen)

    assert f"{F} files in the folder, with a frame each, are read as one take" in said
    assert recording.tracks.n_frames == F
    missing = np.isnan(recording.tracks.positions).all(axis=(1, 2))
    assert np.flatnonzero(missing).tolist() == [7, 8]
    elbow = recording.tracks.positions[:, recording.names.index("left_elbow")]
    shoulder = recording.tracks.positions[:, recording.names.index("left_shoulder")]
    expected = (coco[:, 7] - coco[:, 5])[~missing]
    assert np.allclose((elbow - shoulder)[~missing], expected, atol=1e-6)
    assert recordings_in(tmp_path) == [tmp_path / "cam2_000000_keypoints.json"]


def test_one_frame_next_to_takes_is_refused(tmp_path, coco):
    for take in range(3):
        frames = [named(points) for points in coco[: F if take else 1]]
        (tmp_path / f"{take}.json").write_text(json.dumps({"frames": frames}))

    with pytest.raises(InvalidFileError, match=r"0.json holds the joints of one frame"):
        read(tmp_path / "0.json")
    assert len(recordings_in(tmp_path)) == 3


def test_a_body_without_identity_replaces_no_other(tmp_path, coco):
    frames = [
        {"people": [{"id": each, "joints": points.tolist()} for each in (1, -1)]}
        for points in coco
    ]
    (tmp_path / "two.json").write_text(json.dumps(frames))

    assert [each.name for each in list_bodies(tmp_path / "two.json")] == ["1", "untracked 1"]


def test_one_array_per_frame_is_one_take(tmp_path, coco):
    for frame in range(F):
        np.save(tmp_path / f"{frame}.npy", coco[frame])

    recording, _ = read(tmp_path / "0.npy")

    assert np.allclose(recording.tracks.positions[:, :17], coco)
    assert recordings_in(tmp_path) == [tmp_path / "0.npy"]
    np.save(tmp_path / "5.npy", coco[0, :16])
    with pytest.raises(InvalidFileError, match=r"5.npy holds an array of shape \(16, 3\)"):
        read(tmp_path / "0.npy")


def test_complete_takes_with_numbers_stay_separate(tmp_path, coco):
    for take in range(3):
        np.save(tmp_path / f"take_{take}.npy", coco)

    assert len(recordings_in(tmp_path)) == 3


def test_a_folder_of_numbered_names_is_looked_through_once(tmp_path, monkeypatch):
    """It is compared name by name otherwise, which takes minutes for dates and hashes."""
    chosen = [tmp_path / f"{k}_{k * k}.json" for k in range(2, 9)]
    looked_at = []

    def look(names):
        looked_at.extend(names)
        return names_by_number(looked_at)

    monkeypatch.setattr(folders, "names_by_number", look)

    assert folders.one_path_per_take(chosen) == chosen
    assert looked_at == [path.name for path in chosen]


@pytest.mark.parametrize("axis", [0, 1])
def test_people_of_one_array_are_listed(tmp_path, coco, axis):
    other = np.add(coco, (2.0, 0.0, 0.0))
    other[F // 2 :] = 0.0  # where a tracker lost the person
    np.save(tmp_path / "people.npy", np.stack([other, coco], axis=axis))

    first, _ = read(tmp_path / "people.npy", body="1")
    longest, said = read(tmp_path / "people.npy")

    assert [each.n_frames for each in list_bodies(tmp_path / "people.npy")] == [F // 2, F]
    assert "Body 2 of 2. Left out: 1 (" in said
    assert np.allclose(first.tracks.positions[: F // 2, :17], other[: F // 2])
    assert np.isnan(first.tracks.positions[F // 2 :]).all()
    assert np.allclose(longest.tracks.positions[:, :17], coco)


@pytest.mark.parametrize("padding", [0.0, np.nan])
@pytest.mark.parametrize("axis", [0, 1])
@pytest.mark.parametrize("n_people", [1, 2])
def test_empty_slots_for_people_are_no_bodies(tmp_path, coco, axis, padding, n_people):
    slots = np.full((4, *coco.shape), padding)
    slots[0] = coco
    if n_people > 1:
        slots[2, 1:] = np.add(coco[1:], (2.0, 0.0, 0.0))
    np.save(tmp_path / "slots.npy", np.moveaxis(slots, 0, axis))

    recording, _ = read(tmp_path / "slots.npy")

    assert len(list_bodies(tmp_path / "slots.npy")) == (n_people if n_people > 1 else 0)
    assert np.allclose(recording.tracks.positions[:, :17], coco)


@pytest.mark.parametrize("width", [3, 4])
def test_rotations_are_no_points(tmp_path, rng, width):
    rotations = np.linalg.qr(rng.normal(size=(F, 22, width, width)))[0]
    np.save(tmp_path / "pose.npy", rotations[..., 0] if width == 4 else rotations[:, 0])

    with pytest.raises(InvalidFileError, match="holds rotations without a skeleton"):
        read(tmp_path / "pose.npy")


def test_landmarks_of_images_are_refused(tmp_path, coco):
    """MediaPipe's image landmarks are fractions of the width and height of the picture."""
    points = np.stack([list(frame.values()) for frame in map(coordinates, coco)])
    sized = 0.4 * points + (0.5, 0.5, 0.0)
    np.save(tmp_path / "image.npy", sized)
    np.save(tmp_path / "world.npy", points)

    recording, _ = read(tmp_path / "world.npy")

    assert "left_elbow" in recording.names
    with pytest.raises(InvalidFileError, match="2D points of images"):
        read(tmp_path / "image.npy")


def lines(walk, title="frame,person,joint,x,y,z,score", frame="{}", people=1):
    """Return a table with a line for each joint, without those of frame 5."""
    rows = [title]
    for k in range(F):
        for person in range(people):
            for name, role in NAMES.items():
                x, y, z = walk[role][k] + (2.0 * person, 0.0, 0.0)
                row = f"{frame.format(k)},{person},{name},{x:.6f},{y:.6f},{z:.6f},0.9"
                rows += [row] * (k != 5)
    return "\n".join(rows) + "\n"


@pytest.mark.parametrize(
    ("title", "frame"),
    [
        ("frame,person,joint,x,y,z,score", "{}"),
        ("Frame_ID,track_id,Landmark Name,pos_x,pos_y,pos_z,score", "run2_{:05d}.png"),
        ("frame,id,joint,x,y,z,score", "{:.18e}"),
    ],
)
def test_a_line_per_joint_is_read(tmp_path, walk, title, frame):
    path = tmp_path / "long.csv"
    path.write_text(lines(walk, title, frame, people=2))

    recording, _ = read(path, body="2")

    assert [each.name for each in list_bodies(path)] == ["0", "1"]
    assert recording.tracks.n_frames == F
    wrist = recording.tracks.positions[:, recording.names.index("right_wrist")]
    assert np.isnan(wrist[5]).all()
    known = np.arange(F) != 5
    assert np.allclose(wrist[known], walk["rightHand"][known] + (2.0, 0.0, 0.0), atol=1e-5)


def test_joints_by_number_may_have_decimals(tmp_path, coco):
    rows = [
        "{:.3e},{:.1f},{},{},{},{}".format(k, joint, joint, *coco[k, joint])
        for k in range(F)
        for joint in range(17)
    ]
    (tmp_path / "long.csv").write_text("\n".join(["frame,joint,id,x,y,z", *rows]))

    recording, _ = read(tmp_path / "long.csv")

    assert np.allclose(recording.tracks.positions[:, :17], coco)


@pytest.mark.parametrize(
    "title", ["frame,row,joint,x,y,z,score", "frame,person,joint,x,y,z,id"]
)
def test_a_joint_twice_in_a_frame_is_refused(tmp_path, walk, title):
    text = lines(walk, title, people=2).replace(",1,", ",0,")
    (tmp_path / "long.csv").write_text(text)

    with pytest.raises(
        InvalidFileError, match="joint left_shoulder of one person twice in fra"
    ):
        read(tmp_path / "long.csv")


def test_times_of_a_line_per_joint_give_the_rate(tmp_path, walk):
    rows = [line.split(",") for line in lines(walk).splitlines()[1:]]
    timed = [f"{int(row[0]) / 60:.5f};{row[2]};{row[3]};{row[4]};{row[5]}" for row in rows]
    (tmp_path / "long.csv").write_text("\n".join(["time;marker;x;y;z", *timed]))

    recording, _ = read(tmp_path / "long.csv")

    assert recording.tracks.frame_rate == pytest.approx(60.0, rel=1e-3)


@pytest.mark.parametrize(
    ("x", "sentence"), [("nan", "no points that are observed"), ("9e307", "from the origin")]
)
def test_lines_of_points_without_a_place_are_refused(tmp_path, x, sentence):
    path = tmp_path / "points.csv"
    lines = [f"{frame},m{joint},{x},{joint},1" for frame in range(4) for joint in range(9)]
    path.write_text("\n".join(["frame,joint,x,y,z", *lines]) + "\n")

    with pytest.raises(InvalidFileError, match=sentence):
        read_recording(path)
