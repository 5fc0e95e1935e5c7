"""Frames of SMPL bodies are found however a program keys, spells or flattens them."""

import io
import json

import numpy as np
import pytest
from pytest import approx
from scipy.spatial.transform import Rotation

from solvers.errors import InvalidFileError
from solvers.recordings import list_bodies, read_recording
from solvers.recordings.skeleton_files.smpl_bodies import rows_of_frames

F = 40
TRAVEL = np.linspace([0.0, 0.9, 0.0], [1.1, 0.9, 0.0], F)
SWING = 0.8 * np.sin(np.arange(F) / 6.0)


def poses(n_numbers: int) -> np.ndarray:
    """Return poses of a body that swings its left arm."""
    vectors = np.zeros((F, n_numbers))
    vectors[:, 48] = SWING
    return vectors


def frame(number: int) -> dict:
    vectors = poses(72)[number]
    return {
        "global_orient": vectors[:3].tolist(),
        "body_pose": vectors[3:].tolist(),
        "transl": TRAVEL[number].tolist(),
    }


def check(motion):
    assert motion.n_frames == F
    assert np.ptp(motion.root_positions[:, 0]) == approx(1.1)
    elbow = motion.rotations[:, motion.skeleton.names.index("left_shoulder")]
    assert np.abs(2.0 * np.arcsin(elbow[:, 1])) == approx(np.abs(SWING), abs=1e-6)


@pytest.mark.parametrize("key", ["{}", "{:06d}", "frame_{}"])
@pytest.mark.parametrize("outer", [None, "frames"])
def test_frames_may_be_keyed_by_their_numbers(read_any, key, outer):
    """They are not the pose of one frame."""
    keyed = {key.format(number): frame(number) for number in range(F)}

    check(read_any(json.dumps({outer: keyed} if outer else keyed)))


def test_keyed_frames_may_hold_people_and_leave_frames_out(make_writer):
    frames = {str(n): {"0": frame(n), "1": frame(0)} for n in range(F) if n != 7}
    path = make_writer("take.json")(json.dumps(frames))

    assert [body.name for body in list_bodies(path)] == ["0", "1"]
    assert [body.n_frames for body in list_bodies(path)] == [F - 1, F - 1]


@pytest.mark.parametrize("n_numbers", [66, 72, 156, 165])
@pytest.mark.parametrize("stated", [True, False])
def test_all_frames_may_be_in_one_row(read_any, n_numbers, stated):
    positions = TRAVEL.ravel() if stated else TRAVEL
    content = {"poses": poses(n_numbers).ravel().tolist(), "trans": positions.tolist()}

    check(read_any(json.dumps(content)))


def test_rows_without_positions_are_split_where_poses_change_least(rng):
    walk = np.cumsum(0.01 * rng.normal(size=(66, 72)), axis=0)

    assert rows_of_frames({"poses": walk.ravel()})["poses"] == approx(walk)


@pytest.mark.parametrize("n_frames", [1, F])
@pytest.mark.parametrize("stated", [True, False])
def test_a_row_may_hold_matrices(n_frames, stated):
    """The matrices of one frame are not the vectors of three."""
    vectors = poses(72)[:n_frames]
    matrices = Rotation.from_rotvec(vectors.reshape(-1, 3)).as_matrix()
    arrays = {"poses": matrices.reshape(-1)}
    positions = {"transl": TRAVEL[:n_frames]} if stated else {}

    rows = rows_of_frames(arrays | positions)

    assert rows["poses"] == approx(vectors, abs=1e-9)


def test_a_row_of_one_frame_stays_one():
    arrays = {"poses": np.zeros(72), "trans": np.zeros(3), "fps": np.array(30.0)}

    rows = rows_of_frames(arrays)

    assert [rows[name].shape for name in arrays] == [(1, 72), (1, 3), ()]


@pytest.mark.parametrize(
    "names",
    [("Poses", "Trans", "Fps"), ("POSES", "TRANS", "FPS"), ("SmplPoses", "Transl", "fps")],
)
@pytest.mark.parametrize("is_archive", [True, False])
def test_names_may_have_capitals(read_any, names, is_archive):
    arrays = dict(zip(names, (poses(72), TRAVEL, np.array(25.0)), strict=True))
    file = io.BytesIO()
    np.savez(file, **arrays)
    text = json.dumps({name: array.tolist() for name, array in arrays.items()})

    motion = read_any(file.getvalue() if is_archive else text)

    check(motion)
    assert motion.frame_rate == 25.0


def test_names_of_joints_in_archives_may_have_capitals(read_any):
    file = io.BytesIO()
    np.savez(file, Keypoints3D=np.zeros((F, 17, 2)))

    with pytest.raises(InvalidFileError, match="2D points of images"):
        read_any(file.getvalue())


@pytest.mark.parametrize("name", ["{:05d}_0.npz", "frame{}.npz"])
def test_an_archive_for_each_frame_is_one_take(tmp_path, name):
    """SMPLer-X writes them; before, the chosen one came in as a take of one frame."""
    for number in range(F):
        if number != 7:
            arrays = {key: np.array([each]) for key, each in frame(number).items()}
            np.savez(tmp_path / name.format(number), betas=np.zeros((1, 10)), **arrays)

    motion = read_recording(tmp_path / name.format(3))

    assert motion.n_frames == F
    assert np.flatnonzero(np.isnan(motion.rotations).any(axis=(1, 2))).tolist() == [7]
    assert np.nanmax(motion.root_positions[:, 0]) == approx(1.1)


def test_an_archive_of_one_frame_alone_is_a_pose(tmp_path):
    np.savez(tmp_path / "pose.npz", **{key: np.array(each) for key, each in frame(9).items()})

    assert read_recording(tmp_path / "pose.npz").n_frames == 1


def test_frames_may_be_keyed_by_their_images(read_any):
    """4D-Humans does so, with matrices of one person in each list."""
    frames = {}
    for number in range(F):
        vectors = poses(72)[number].reshape(24, 3)
        matrices = Rotation.from_rotvec(vectors).as_matrix().tolist()
        body = {"global_orient": matrices[:1], "body_pose": matrices[1:],
                "pred_cam_t": TRAVEL[number].tolist()}  # fmt: skip
        frames[f"out/img/{number + 1:06d}.jpg"] = {"time": number, "smpl": [body]}

    check(read_any(json.dumps(frames)))
