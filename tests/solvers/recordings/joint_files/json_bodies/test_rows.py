"""Rows and lists of JSON become people only if the file states that they are."""

import json

import pytest

from solvers.errors import InvalidFileError
from solvers.motion import find_humanoid_map, forward_kinematics
from solvers.recordings import list_bodies, read_recording, recordings_in
from solvers.samples import walking_gait

F = 60
PARTS = {"shoulder": "UpperArm", "elbow": "LowerArm", "wrist": "Hand", "hip": "UpperLeg",
         "knee": "LowerLeg", "ankle": "Foot"}  # fmt: skip
ROLES = {f"{side}_{part}": side + role for part, role in PARTS.items()
         for side in ("left", "right")}  # fmt: skip


@pytest.fixture(scope="module")
def joints():
    """Return the joints of a walker in a frame, meters, Y up."""
    motion = walking_gait()
    positions = forward_kinematics(motion).positions[..., [0, 2, 1]] * (1.0, 1.0, -1.0)
    roles = find_humanoid_map(motion.skeleton).indices(motion.skeleton)

    def found(frame, x_m=0.0):
        points = positions[frame % len(positions)] + (x_m, 0.0, 0.0)
        return {name: points[roles[role]].tolist() for name, role in ROLES.items()}

    return found


def points(joints, frame, x_m=0.0):
    found = joints(frame, x_m)
    return [found["left_shoulder"]] * 5 + [*found.values()]


def write(folder, content, name="take.json"):
    path = folder / name
    path.write_text(json.dumps(content))
    return path


def people_in(path):
    """Return the number of frames by person; of one person, by an empty name."""
    bodies = list_bodies(path)
    found = {body.name: body.n_frames for body in bodies}
    return found or {"": read_recording(path).tracks.n_frames}


def rows(joints, key, stamps):
    return [{key: stamp, "joints": joints(k)} for k, stamp in enumerate(stamps)]


def two(joints, frame):
    return [{"id": who, "joints": joints(frame, 2.0 * who)} for who in (1, 2)]


def test_rows_with_rounded_times_are_of_one_person(tmp_path, joints):
    """There is no second person in every fifth of them."""
    content = rows(joints, "time", [round(k / 120, 2) for k in range(240)])

    assert list(people_in(write(tmp_path, content))) == [""]


@pytest.mark.parametrize("stamps", [[k // 30 for k in range(360)],
                                    [k // 2 * 33 for k in range(F)]])  # fmt: skip
def test_rows_of_the_same_time_are_refused(tmp_path, joints, stamps):
    with pytest.raises(InvalidFileError, match="most of its time stamps do not increase"):
        read_recording(write(tmp_path, rows(joints, "time", stamps)))


@pytest.mark.parametrize(("key", "stamps"), [
    ("time", [round(k / 120, 2) for k in range(240)]), ("frame", [k % 120 for k in range(240)]),
])  # fmt: skip
def test_people_with_identities_are_not_doubled(tmp_path, joints, key, stamps):
    content = [{key: stamp, "people": two(joints, k)} for k, stamp in enumerate(stamps)]

    assert people_in(write(tmp_path, content)) == {"1": 240, "2": 240}


def test_numbers_that_restart_are_of_one_person(tmp_path, joints):
    content = rows(joints, "frame", [k % 120 for k in range(240)])

    assert people_in(write(tmp_path, content)) == {"": 240}


def test_the_same_identity_twice_in_a_frame_is_one_person(tmp_path, joints):
    content = [row | {"id": 1} for row in rows(joints, "frame", [k // 2 for k in range(F)])]

    assert people_in(write(tmp_path, content)) == {"": F}


def test_people_whose_numbers_restart_are_joined_by_their_place(tmp_path, joints):
    content = {name: rows(joints, "frame", [k % 30 for k in range(F)])
               for name in ("anna", "ben")}  # fmt: skip

    bodies = list_bodies(write(tmp_path, content))

    assert [(each.name, each.first, each.last) for each in bodies] == [
        ("anna", 0, F - 1), ("ben", 0, F - 1)
    ]  # fmt: skip


@pytest.mark.parametrize("keyed", [True, False])
def test_rounded_numbers_have_no_gaps(tmp_path, joints, keyed):
    """Otherwise 29 frames without a body are between those of 24 of 60 frames per second."""
    numbers = [int(2.5 * k) for k in range(F)]
    content = {str(number): joints(k) for k, number in enumerate(numbers)}

    path = write(tmp_path, content if keyed else rows(joints, "frame", numbers))

    assert people_in(path) == {"": F}


def test_very_different_numbers_are_read(tmp_path, joints):
    """Their ratio is no finite number."""
    path = write(tmp_path, rows(joints, "frame", [0.0, 1e-300, 1e300]))

    assert people_in(path) == {"": 3}


@pytest.mark.parametrize("name", ["body_{:04}", "skeleton{:04}", "person {}"])
def test_many_numbered_members_are_frames(tmp_path, joints, name):
    content = {name.format(k): joints(k) for k in range(F)}

    assert people_in(write(tmp_path, content)) == {"": F}


def hand(frame):
    return [[0.01 * k, 0.001 * frame, 0.0] for k in range(21)]


@pytest.mark.parametrize("content", [
    lambda joints: {"pose": [points(joints, k) for k in range(F)],
                    "left_hand": [hand(k) for k in range(F)],
                    "rightHand": [hand(k) for k in range(F)]},
    lambda joints: {"lh": [hand(k) for k in range(F)], "rh": [hand(k) for k in range(F)],
                    "body": [points(joints, k) for k in range(F)],
                    "face": [hand(k) for k in range(F)]},
    lambda joints: {"raw": [joints(k) for k in range(F)],
                    "filtered": [joints(k) for k in range(F)]},
    lambda joints: {"frames": [joints(k) for k in range(F)], "tpose": [joints(0)] * 20},
    lambda joints: {"anna": [joints(k) for k in range(F)], "t_pose": [joints(0)] * 20},
])  # fmt: skip
def test_other_data_of_a_person_are_no_people(tmp_path, joints, content):
    assert people_in(write(tmp_path, content(joints))) == {"": F}


def test_a_pose_of_reference_hides_no_person(tmp_path, joints):
    content = {who: [joints(k, x_m) for k in range(F)]
               for who, x_m in (("Chandra", 0.0), ("Forrest", 2.0))}  # fmt: skip

    found = people_in(write(tmp_path, content | {"tpose": [joints(0)] * 20}))

    assert found == {"Chandra": F, "Forrest": F}


def of_openpose(joints, frame):
    """Return a frame of two people, whose keypoints have a score."""
    people = [
        [number for point in points(joints, frame, x_m) for number in (*point, 1.0)]
        for x_m in (0.0, 2.0)
    ]
    listed = [{"person_id": [-1], "pose_keypoints_3d": each} for each in people]
    return {"version": 1.3, "people": listed}


@pytest.mark.parametrize("content", [
    of_openpose,
    lambda joints, k: [points(joints, k), points(joints, k, 2.0)],
])  # fmt: skip
def test_files_with_two_people_each_are_frames(tmp_path, joints, content):
    """The first file alone would be a take of two frames, whose body jumps."""
    for k in range(F):
        path = write(tmp_path, content(joints, k), f"{k:04}_keypoints.json")

    assert [*people_in(path).values()] == [F, F]
    assert len(recordings_in(tmp_path)) == 1


def test_one_file_of_two_people_is_one_frame(tmp_path, joints):
    with pytest.raises(InvalidFileError, match="holds the joints of one frame"):
        read_recording(write(tmp_path, of_openpose(joints, 0)))


def test_many_rows_below_a_key_for_people_are_frames(tmp_path, joints):
    content = {"skeletons": [{"joints": joints(k)} for k in range(F)]}

    assert people_in(write(tmp_path, content)) == {"": F}


def test_short_takes_without_neighbors_stay_takes(tmp_path, joints):
    path = write(tmp_path, [points(joints, k) for k in range(9)], "walk_1.json")
    write(tmp_path, [points(joints, k) for k in range(9)], "walk_2.json")

    assert people_in(path) == {"": 9}
    assert len(recordings_in(tmp_path)) == 2
