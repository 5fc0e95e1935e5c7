"""The converters of docs/formats/skeletons/smpl.md make of made-up results what we read."""

import re
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from solvers.errors import MocapAssistError
from solvers.motion import Motion
from solvers.recordings import read_recording
from solvers.rotations import angle_between

PAGE = Path(__file__).parents[4] / "docs" / "formats" / "skeletons" / "smpl.md"
N_FRAMES = 8
POSES = 0.2 * np.random.default_rng(5).normal(size=(N_FRAMES, 72))
POSES[:, :3] = 0.0
TRANS = np.linspace((0.0, 0.9, 0.0), (0.5, 0.9, 1.0), N_FRAMES)
MATRICES = Rotation.from_rotvec(POSES.reshape(-1, 3)).as_matrix().reshape(N_FRAMES, 24, 3, 3)
FRAMES = np.arange(10, 10 + N_FRAMES)


class Tensor:
    """What the converters use of a tensor."""

    def __init__(self, values):
        self.values = np.asarray(values, dtype=np.float32)

    def detach(self):
        return self

    def cpu(self):
        return self.values


@pytest.fixture(scope="module")
def converters():
    """Return the functions of the page's first block."""
    block = re.search(r"```python\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    names = {}
    exec(compile(block[1], str(PAGE), "exec"), names)
    return names


def gvhmr(names):
    body = {"global_orient": POSES[:, :3], "body_pose": POSES[:, 3:66], "transl": TRANS}
    return names["gvhmr"]({"smpl_params_global": {key: Tensor(v) for key, v in body.items()}})


def wham(names):
    body = {"pose_world": POSES, "trans_world": TRANS, "frame_ids": FRAMES}
    return names["wham"]({0: body})


def tram(names):
    camera_rotation = Rotation.from_rotvec([0.0, 0.4, 0.0]).as_matrix()
    offset = np.array([1.0, 2.0, 3.0])
    rotations = MATRICES.copy()
    rotations[:, 0] = camera_rotation.T @ rotations[:, 0]
    trans = (TRANS - offset) @ camera_rotation
    data = {"pred_rotmat": Tensor(rotations), "pred_trans": Tensor(trans[:, None]),
            "frame": Tensor(FRAMES)}  # fmt: skip
    camera = {"world_cam_R": np.tile(camera_rotation, (30, 1, 1)),
              "world_cam_T": np.tile(offset, (30, 1))}  # fmt: skip
    return names["tram"](data, camera)


def prompthmr(names):
    poses = np.zeros((N_FRAMES, 165))
    poses[:, :66] = POSES[:, :66]
    person = {"frames": FRAMES, "smplx_world": {"pose": Tensor(poses), "trans": Tensor(TRANS)}}
    return names["prompthmr"]({"people": {1: person}}, 1)


def humans4d(names):
    data = {}
    for frame, matrices in enumerate(MATRICES):
        body = {"global_orient": matrices[:1], "body_pose": matrices[1:]}
        data[f"img/{frame:06d}.jpg"] = {"tid": [4, 1], "smpl": [None, body]}
    return names["humans4d"](data, 1)


def aist(names):
    data = {"smpl_poses": POSES, "smpl_trans": 90.0 * TRANS, "smpl_scaling": np.array([90.0])}
    return names["aist"](data)


@pytest.mark.parametrize("convert", [gvhmr, wham, tram, prompthmr, humans4d, aist])
def test_converted_results_are_read_as_the_same_motion(converters, convert, tmp_path):
    np.savez(tmp_path / "take.npz", fps=25.0, **convert(converters))

    motion = read_recording(tmp_path / "take.npz")

    assert isinstance(motion, Motion)
    assert motion.frame_rate == 25.0
    assert motion.n_frames == N_FRAMES
    knee = motion.skeleton.names.index("left_knee")
    angles = np.linalg.norm(POSES[:, 12:15], axis=1)
    unturned = np.array([1.0, 0.0, 0.0, 0.0])
    assert_allclose(angle_between(motion.rotations[:, knee], unturned), angles, atol=1e-5)
    if convert is not humans4d:
        travel = np.linalg.norm(motion.root_positions[-1] - motion.root_positions[0])
        assert travel == pytest.approx(np.linalg.norm(TRANS[-1] - TRANS[0]), rel=1e-4)


def test_frames_without_the_person_are_missing(converters, tmp_path):
    kept = np.array([0, 1, 2, 5, 6, 7])
    body = {"pose_world": POSES[kept], "trans_world": TRANS[kept], "frame_ids": FRAMES[kept]}
    np.savez(tmp_path / "take.npz", fps=25.0, **converters["wham"]({0: body}))

    motion = read_recording(tmp_path / "take.npz")

    assert motion.n_frames == N_FRAMES
    assert np.isnan(motion.rotations[3:5]).all()
    assert np.isfinite(motion.rotations[[2, 5]]).all()


IN_THE_WORLD = {"pose_world": POSES, "trans_world": TRANS, "pose": POSES + 0.1, "trans": -TRANS}


@pytest.mark.parametrize(
    ("arrays", "is_of_camera"),
    [
        (
            {"global_orient": MATRICES[:, :1], "body_pose": MATRICES[:, 1:], "transl": TRANS},
            False,
        ),
        (
            {"global_orient": MATRICES[:, 0], "body_pose": MATRICES[:, 1:], "transl": TRANS},
            False,
        ),
        ({"poses": MATRICES, "trans": TRANS}, False),
        ({"pred_rotmat": MATRICES, "pred_trans": TRANS[:, None]}, True),
        ({"pose": POSES, "trans": TRANS, "betas": np.zeros((N_FRAMES, 10))}, True),
        (IN_THE_WORLD, False),
        ({"smpl_pose": POSES, "smpl_trans": TRANS}, False),
    ],
)
def test_results_saved_as_they_are_give_the_same_motion(tmp_path, arrays, is_of_camera):
    np.savez(tmp_path / "expected.npz", poses=POSES, trans=TRANS)
    np.savez(tmp_path / "take.npz", **arrays)
    said = []

    motion = read_recording(
        tmp_path / "take.npz", progress=lambda _, text="": said.append(str(text))
    )

    expected = read_recording(tmp_path / "expected.npz")
    assert angle_between(motion.rotations, expected.rotations).max() < 1e-6
    assert_allclose(motion.root_positions, expected.root_positions, atol=1e-9)
    assert ("relative to the camera" in " ".join(said)) == is_of_camera


def test_joints_called_pose_are_not_taken_for_rotations(tmp_path):
    np.savez(tmp_path / "take.npz", pose=np.zeros((N_FRAMES, 4, 4)))

    with pytest.raises(MocapAssistError, match=r"^(?!.*SMPL)"):
        read_recording(tmp_path / "take.npz")


def test_matrices_of_fingers_and_of_frames_without_a_person(tmp_path):
    hand = np.tile(Rotation.from_rotvec([0.0, 0.0, 0.5]).as_matrix(), (N_FRAMES, 15, 1, 1))
    root, body = MATRICES[:, :1].copy(), MATRICES[:, 1:22].copy()
    root[3] = body[3] = 0.0
    np.savez(tmp_path / "take.npz", global_orient=root, body_pose=body, transl=TRANS,
             left_hand_pose=hand, right_hand_pose=hand)  # fmt: skip

    motion = read_recording(tmp_path / "take.npz")

    assert motion.skeleton.n_joints == 52
    assert np.flatnonzero(np.isnan(motion.rotations).any(axis=(1, 2))).tolist() == [3]
