"""JSON of several people lists each of them, however people and frames are nested."""

import json

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion import find_humanoid_map, forward_kinematics
from solvers.recordings import list_bodies, read_recording
from solvers.samples import walking_gait

F = 30
DISTANCE_M = 2.0
PARTS = {"shoulder": "UpperArm", "elbow": "LowerArm", "wrist": "Hand", "hip": "UpperLeg",
         "knee": "LowerLeg", "ankle": "Foot"}  # fmt: skip
ROLES = {f"{side}_{part}": side + role for part, role in PARTS.items()
         for side in ("left", "right")}  # fmt: skip
NAMES_OF_UNREAL = {
    f"{side}_{part}": f"{name}_{side[0]}"
    for part, name in {"shoulder": "upperarm", "elbow": "lowerarm", "wrist": "hand",
                       "hip": "thigh", "knee": "calf", "ankle": "foot"}.items()
    for side in ("left", "right")
}  # fmt: skip


@pytest.fixture(scope="module")
def two():
    """Return the joints of the first or second of two walkers in a frame, meters, Y up."""
    motion = walking_gait()
    positions = forward_kinematics(motion).positions[:F][..., [0, 2, 1]] * (1.0, 1.0, -1.0)
    roles = find_humanoid_map(motion.skeleton).indices(motion.skeleton)

    def joints(who, frame):
        offset = (DISTANCE_M * who, 0.0, 0.0)
        return {name: (positions[frame, roles[role]] + offset).tolist()
                for name, role in ROLES.items()}  # fmt: skip

    return joints


def by_number(two, who, first=0):
    return {str(first + k): two(who, k) for k in range(F)}


def listed(two, who):
    return [two(who, k) for k in range(F)]


def by_joint(two, who):
    return {name: [two(who, k)[name] for k in range(F)] for name in ROLES}


def by_identity(two, who):
    return {"id": who, "frames": listed(two, who)}


def with_identity(two, who):
    return {"id": who, "joints": two(who, 0)}


def rows(two, order):
    return [{"frame": k, "id": who, "joints": two(who, k)} for who, k in order]


def distance_between(path, first, second):
    """Return how far the second person is from the first one in each frame."""
    one, other = (read_recording(path, body=name).tracks for name in (first, second))
    knee = one.names.index("left_knee")
    return np.linalg.norm(other.positions[:, knee] - one.positions[:, knee], axis=1)


LAYOUTS = {
    "by name, by number": lambda two: {"anna": by_number(two, 0), "ben": by_number(two, 1)},
    "by name, a list": lambda two: {"fps": 30, "anna": listed(two, 0), "ben": listed(two, 1)},
    "by name, by joint": lambda two: {"anna": by_joint(two, 0), "ben": by_joint(two, 1)},
    "by name, both": lambda two: {"anna": listed(two, 0), "ben": by_number(two, 1)},
    "below a key": lambda two: {"data": {"anna": by_number(two, 0), "ben": listed(two, 1)}},
    "below people": lambda two: {"people": {"anna": listed(two, 0), "ben": listed(two, 1)}},
    "by number, by number": lambda two: {"0": by_number(two, 0), "1": by_number(two, 1)},
    "by number, below a key": lambda two: {
        "tracks": {str(who): {"frames": by_number(two, who)} for who in (0, 1)}
    },
    "numbered people": lambda two: {f"person_{who}": by_number(two, who) for who in (0, 1)},
    "list of people": lambda two: [by_identity(two, 0), by_identity(two, 1)],
    "list of people below a key": lambda two: {
        "people": [by_identity(two, 0), by_identity(two, 1)]
    },
    "list of lists": lambda two: [listed(two, 0), listed(two, 1)],
    "rows by frame": lambda two: rows(two, [(who, k) for k in range(F) for who in (0, 1)]),
    "rows by person": lambda two: rows(two, [(who, k) for who in (0, 1) for k in range(F)]),
    "rows by time": lambda two: [
        {"time": k / 30, "id": who, "joints": two(who, k)} for who in (0, 1) for k in range(F)
    ],
    "rows without identities": lambda two: [
        {"frame": k, "joints": two(who, k)} for k in range(F) for who in (0, 1)
    ],
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_people_are_listed_with_all_their_frames(tmp_path, two, layout):
    """None is left out without a word, or jumps to the other's place."""
    path = write(tmp_path, LAYOUTS[layout](two))

    bodies = list_bodies(path)

    assert [body.n_frames for body in bodies] == [F, F]
    distances = distance_between(path, *sorted(body.name for body in bodies))
    assert distances == pytest.approx([DISTANCE_M] * F, abs=1e-6)


@pytest.mark.parametrize("axes", ["frames, people", "people, frames"])
@pytest.mark.parametrize("wrap", [lambda array: array, lambda array: {"frames": array}])
def test_arrays_have_more_frames_than_people(tmp_path, two, axes, wrap):
    def points(who, k):
        joints = two(who, k)
        return [joints["left_shoulder"]] * 5 + [joints[name] for name in ROLES]

    people = [[points(who, k) for k in range(F)] for who in (0, 1)]
    array = people if axes == "people, frames" else [*zip(*people, strict=True)]
    path = write(tmp_path, wrap(array))

    assert [(body.name, body.n_frames) for body in list_bodies(path)] == [("0", F), ("1", F)]


def test_numbers_say_when_each_person_is_seen(tmp_path, two):
    path = write(tmp_path, {"anna": by_number(two, 0), "ben": by_number(two, 1, first=20)})

    anna, ben = list_bodies(path)

    assert (anna.first, anna.last, ben.first, ben.last) == (0, 29, 20, 49)


def test_frame_ids_say_when_each_person_is_seen(tmp_path, two):
    content = {
        str(who): {"joints3d": listed(two, who), "frame_ids": [*range(10 * who, 10 * who + F)]}
        for who in (0, 1)
    }

    first, second = list_bodies(write(tmp_path, content))

    assert (first.first, second.first, second.last) == (0, 10, 39)


def test_frames_left_out_of_a_list_are_missing(tmp_path, two):
    kept = [k for k in range(F) if k not in {4, 5}]
    path = write(tmp_path, rows(two, [(0, k) for k in kept]))

    missing = np.isnan(read_recording(path).tracks.positions).all(axis=(1, 2))

    assert np.flatnonzero(missing).tolist() == [4, 5]


def test_frames_that_all_state_one_number_stay_in_their_order(tmp_path, two):
    path = write(tmp_path, [{"frame": 0, "joints": two(0, k)} for k in range(F)])

    assert read_recording(path).tracks.n_frames == F


@pytest.mark.parametrize("content", [
    lambda two: {"anna": two(0, 0), "ben": two(1, 0)},
    lambda two: {"person_1": two(0, 0), "person_2": two(1, 0)},
    lambda two: {"people": [with_identity(two, 0), with_identity(two, 1)]},
    lambda two: {"people": {"0": two(0, 0), "1": two(1, 0)}},
    lambda two: {"frames": [{"people": [with_identity(two, 0), with_identity(two, 1)]}]},
])  # fmt: skip
def test_people_in_one_frame_are_no_take(tmp_path, two, content):
    """Two people by name are not one who jumps from place to place."""
    with pytest.raises(InvalidFileError, match="holds the joints of one frame"):
        read_recording(write(tmp_path, content(two)))


def test_pictures_by_name_are_frames(tmp_path, two):
    path = write(tmp_path, {f"img_{k:04}.jpg": two(0, k) for k in range(F)})

    assert read_recording(path).tracks.n_frames == F


@pytest.mark.parametrize(
    "key", ["cam{c}/{k:06}.jpg", "{c}_frame_{k:04}.png", "view {c} {k}.jpg"]
)
def test_pictures_of_several_cameras_are_takes_to_choose_from(tmp_path, two, key):
    """The frames of the last camera do not replace those of the others."""
    path = write(
        tmp_path, {key.format(c=c, k=k): two(c == "B", k) for c in "AB" for k in range(F)}
    )

    bodies = list_bodies(path)

    assert len(bodies) == 2 and all(each.n_frames == F for each in bodies)
    assert [("A" in each.name, "B" in each.name) for each in bodies] == [
        (True, False), (False, True),
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("key", "names"),
    [
        ("frame_{k}_cam_{c}", ("cam_0", "cam_1")),
        ("cam_{c}_frame_{k}", ("cam_0", "cam_1")),
        ("{k:06}/cam{c}.jpg", ("cam0", "cam1")),
    ],
)
def test_numbered_cameras_are_takes_to_choose_from(tmp_path, two, key, names):
    """No body alternates between the cameras, and no frame replaces another."""
    path = write(tmp_path, {key.format(c=c, k=k): two(c, k) for k in range(F) for c in (0, 1)})

    bodies = list_bodies(path)

    assert tuple((each.name, each.n_frames) for each in bodies) == tuple(
        (name, F) for name in names
    )


def test_dates_of_frames_are_no_cameras(tmp_path, two):
    key = "2024-01-01T00:{:02}:{:02}Z".format
    path = write(tmp_path, {key(k // 20, k % 20): two(0, k) for k in range(F)})

    assert list_bodies(path) == ()
    assert read_recording(path).tracks.n_frames == F


def write(folder, content):
    path = folder / "take.json"
    path.write_text(json.dumps(content))
    return path


@pytest.mark.parametrize("nest", [
    lambda anna, ben: {"anna": anna, "ben": ben},
    lambda anna, ben: [{"people": [{"id": 1, "joints": a}, {"id": 2, "joints": b}]}
                       for a, b in zip(anna, ben, strict=True)],
    lambda anna, ben: [{"anna": a, "ben": b} for a, b in zip(anna, ben, strict=True)],
])  # fmt: skip
def test_people_may_have_joints_of_other_names(tmp_path, two, nest):
    """With the names of both, each would be no body."""
    path = tmp_path / "two.json"
    ben = [
        {NAMES_OF_UNREAL[name]: place for name, place in two(1, k).items()} for k in range(F)
    ]
    path.write_text(json.dumps(nest(listed(two, 0), ben)))

    first, second = (read_recording(path, body=each.name) for each in list_bodies(path))

    assert "left_wrist" in first.names and "left_wrist" in second.names
    wrists = [
        each.tracks.positions[:, each.names.index("left_wrist")] for each in (first, second)
    ]
    feet = [
        each.tracks.positions[:, each.names.index("left_ankle")] for each in (first, second)
    ]
    assert np.allclose(wrists[0] - feet[0], wrists[1] - feet[1], atol=1e-9)


def test_actors_of_a_scene_are_called_by_their_names(tmp_path, two):
    frames = [{"timestamp": k / 50.0, "props": [], "actors": [
        {"name": name, "body": {joint: {"position": dict(zip("xyz", place, strict=True))}
                                for joint, place in two(who, k).items()}}
        for who, name in enumerate(("Anna", "Ben"))
    ]} for k in range(F)]  # fmt: skip
    path = tmp_path / "studio.json"
    path.write_text(json.dumps({"version": "3,0", "scene": {"frames": frames}}))

    assert [each.name for each in list_bodies(path)] == ["Anna", "Ben"]
    assert read_recording(path, body="Ben").frame_rate == 50.0
