"""Parameters of SMPL bodies in JSON are read like those in archives."""

import json

import numpy as np
import pytest
from exports.camera_bodies import mediapipe
from pytest import approx

from solvers.errors import InvalidFileError
from solvers.motion import Sensor
from solvers.recordings import list_bodies, read_recording

F = 12
TRAVEL = np.linspace([0.0, 0.9, 0.0], [1.1, 0.9, 0.0], F)


def person(frame: int, identity: int, n_numbers: int = 72) -> dict:
    """Return a body of EasyMocap in one frame."""
    return {
        "id": identity, "Rh": [[0.0, 0.0, 0.0]], "Th": [TRAVEL[frame].tolist()],
        "poses": np.zeros((1, n_numbers)).tolist(), "shapes": np.zeros((1, 10)).tolist(),
    }  # fmt: skip


def travel_of(motion):
    return motion.root_positions[-1, 0] - motion.root_positions[0, 0]


@pytest.mark.parametrize("n_numbers", [69, 72, 78, 87])
def test_a_file_for_each_frame_is_one_take(tmp_path, n_numbers):
    for frame in range(F):
        people = [person(frame, 7, n_numbers)] + [person(frame, 9, n_numbers)] * (frame > 3)
        (tmp_path / f"{frame:06}.json").write_text(json.dumps(people))

    motion = read_recording(tmp_path / "000002.json", body="9")

    assert [body.name for body in list_bodies(tmp_path / "000002.json")] == ["7", "9"]
    assert motion.n_frames == F
    assert np.isnan(motion.rotations[:4]).all()
    assert np.isfinite(motion.rotations[4:]).all()


@pytest.mark.parametrize(
    "content",
    [
        {"poses": np.zeros((F, 72)).tolist(), "trans": TRAVEL.tolist(), "fps": 25},
        {
            "incam": {"global_orient": np.ones((F, 3)).tolist(),
                      "body_pose": np.zeros((F, 63)).tolist()},
            "smpl_params_global": {"global_orient": np.zeros((F, 3)).tolist(), "fps": 25,
                                   "body_pose": np.zeros((F, 63)).tolist(),
                                   "transl": TRAVEL.tolist()},
        },
        {"fps": 25, "frames": [
            {"global_orient": [0, 0, 0], "body_pose": [[0, 0, 0]] * 23, "transl": each.tolist()}
            for each in TRAVEL
        ]},
    ],
)  # fmt: skip
def test_arrays_and_lists_of_frames_are_read(make_reader, content):
    motion = make_reader("take.json")(json.dumps(content))

    assert (motion.n_frames, motion.frame_rate) == (F, 25.0)
    assert travel_of(motion) == approx(1.1)


def test_people_in_each_frame_are_all_listed(tmp_path):
    frames = [{"people": [person(frame, 1), person(frame, 2)]} for frame in range(F)]
    path = tmp_path / "take.json"
    path.write_text(json.dumps({"frames": frames}))

    assert [body.name for body in list_bodies(path)] == ["1", "2"]


def test_one_frame_alone_is_refused(make_reader):
    with pytest.raises(InvalidFileError, match="Keep the files of all frames"):
        make_reader("000000.json")(json.dumps([person(0, 1)]))


def test_a_changing_number_of_parameters_is_refused(make_reader):
    frames = [[person(0, 1)], [person(1, 1, 69)]]
    with pytest.raises(InvalidFileError, match="number of parameters of body 1 changes"):
        make_reader("take.json")(json.dumps(frames))


def test_points_of_a_body_in_long_rows_are_no_rotations(make_reader):
    """99 numbers in a row are 33 landmarks, not the parameters of an SMPL body."""
    rows = mediapipe(F)[..., :3].reshape(F, 99).round(4)

    recording = make_reader("take.json")(json.dumps({"fps": 25, "poses": rows.tolist()}))

    assert recording.sensor is Sensor.MEDIAPIPE


@pytest.mark.parametrize("n_numbers", [72, 165])
def test_poses_alone_are_read_however_many_digits_they_have(make_reader, rng, n_numbers):
    poses = 0.1 * rng.normal(size=(F, n_numbers))

    motion = make_reader("take.json")(json.dumps({"poses": poses.tolist(), "fps": 25}))

    assert motion.n_frames == F


@pytest.mark.parametrize("absent", [{"trans": None}, {}, {"trans": 5.0}])
@pytest.mark.parametrize("frame", [0, 5])
def test_a_position_may_be_missing_in_a_frame(make_reader, absent, frame):
    """null ends in no traceback, and positions are not all those of the first frame."""
    frames = [
        {"poses": [0.0] * 72, "betas": [0.0] * 10}
        | (absent if number == frame else {"trans": each.tolist()})
        for number, each in enumerate(TRAVEL)
    ]

    motion = make_reader("take.json")(json.dumps({"fps": 25, "frames": frames}))

    step = TRAVEL[-1, 0] / (F - 1)
    assert motion.root_positions[-1, 0] - motion.root_positions[1, 0] == approx(10 * step)


def test_a_number_called_pose_is_none(make_reader):
    take = {"poses": np.zeros((F, 72)).tolist(), "trans": TRAVEL.tolist(), "pose": 5, "fps": 25}

    assert make_reader("take.json")(json.dumps(take)).n_frames == F


def test_frames_are_in_the_order_of_their_numbers(make_reader):
    """Frames in another order are sorted, and missing ones are gaps."""
    frames = [
        {"frame": number, "poses": [0.0] * 72, "betas": [0.0], "trans": each.tolist()}
        for number, each in enumerate(TRAVEL)
        if number != 4
    ]

    motion = make_reader("take.json")(json.dumps({"fps": 25, "frames": frames[::-1]}))

    assert motion.n_frames == F
    assert travel_of(motion) == approx(1.1)
    assert np.isnan(motion.rotations[4]).all()


@pytest.mark.parametrize("numbers", [range(0, 2 * F, 2), [10**30, *range(F - 1)], [7] * F])
def test_numbers_in_steps_or_without_sense_leave_no_gaps(make_reader, numbers):
    frames = [
        {"frame": number, "poses": [0.0] * 72, "betas": [0.0], "trans": each.tolist()}
        for number, each in zip(numbers, TRAVEL, strict=True)
    ]

    assert make_reader("take.json")(json.dumps({"frames": frames})).n_frames == F


@pytest.mark.parametrize(("step", "rate"), [(1, 25.0), (2, 12.5), (40, 25.0)])
def test_numbers_in_steps_are_of_the_video_or_milliseconds(make_reader, step, rate):
    """A take of which each second frame was saved plays at its speed."""
    frames = [
        {"frame": step * number, "poses": [0.0] * 72, "betas": [0.0], "trans": each.tolist()}
        for number, each in enumerate(TRAVEL)
        if number != 4
    ]

    motion = make_reader("take.json")(json.dumps({"fps": 25, "frames": frames}))

    assert motion.n_frames == F
    assert motion.frame_rate == rate
    assert np.isnan(motion.rotations[4]).all()
