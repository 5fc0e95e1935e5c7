"""Parameter files of video models and AMASS come in standing, with exact rotations."""

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion import find_humanoid_map, world_poses
from solvers.recordings import read_recording
from solvers.recordings.skeleton_files.smpl_bodies.joints import BODY
from solvers.rotations import rotate

F = 40
NAMES = [name for name, _, _ in BODY]
Z_UP = np.array([np.pi / 2, 0.0, 0.0])
"""The model's own axes have Y up; this root rotation stands it on Z."""


def poses(*, root=(0.0, 0.0, 0.0), n_joints=22) -> np.ndarray:
    """Return a body that walks on the spot and raises its left arm, axis times angle."""
    time = np.arange(F) / 30.0
    vectors = np.zeros((F, n_joints, 3))
    vectors[:, 0] = root
    for side, sign in (("left", 1.0), ("right", -1.0)):
        vectors[:, NAMES.index(f"{side}_hip"), 0] = -0.4 * sign * np.sin(4.0 * time)
        vectors[:, NAMES.index(f"{side}_knee"), 0] = 0.5 + 0.4 * np.sin(4.0 * time)
    vectors[:, NAMES.index("left_shoulder"), 2] = np.linspace(0.0, 1.2, F)
    return vectors


def save(path, **arrays):
    np.savez(path, **arrays)
    return path


def joint_positions(motion) -> dict[str, np.ndarray]:
    positions = world_poses(motion.skeleton, motion.rotations, motion.root_positions).positions
    return {name: positions[:, k] for k, name in enumerate(motion.skeleton.names)}


def check_standing(motion):
    positions = joint_positions(motion)
    assert (positions["head"] - positions["pelvis"])[:, 2].min() > 0.4
    assert np.percentile(
        np.minimum(*(positions[f"{s}_foot"][:, 2] for s in ("left", "right"))), 5
    ) == (pytest.approx(0.02, abs=0.01))
    assert find_humanoid_map(motion.skeleton).score == 1.0
    raised = positions["left_wrist"] - positions["left_shoulder"]
    assert raised[-1, 2] > raised[0, 2] + 0.3  # the left arm rises
    facing = positions["left_foot"] - positions["left_ankle"]
    across = positions["left_hip"] - positions["right_hip"]
    assert np.cross(across, facing)[0, 2] < 0.0  # the left is at the left


def test_old_amass_files_are_read(tmp_path):
    vectors = poses(root=Z_UP, n_joints=52)
    path = save(
        tmp_path / "amass.npz", trans=np.tile((0.2, 0.1, 0.9), (F, 1)), gender="female",
        mocap_framerate=120.00004, betas=np.zeros(16), dmpls=np.zeros((F, 8)),
        poses=vectors.reshape(F, -1),
    )  # fmt: skip

    motion = read_recording(path)

    assert motion.n_frames == F
    assert motion.frame_rate == 120.0
    assert motion.skeleton.n_joints == 22  # the fingers do not move
    check_standing(motion)


def test_new_amass_with_hands(tmp_path):
    vectors = poses(root=Z_UP)
    hands = np.zeros((F, 90))
    hands[:, 2] = np.linspace(0.0, -1.0, F)
    path = save(
        tmp_path / "x.npz", gender=np.array(b"neutral"), surface_model_type="smplx",
        mocap_frame_rate=60.0, root_orient=vectors[:, 0],
        pose_body=vectors[:, 1:].reshape(F, -1), pose_hand=hands,
        trans=np.zeros((F, 3)), betas=np.zeros(16),
    )  # fmt: skip

    motion = read_recording(path)

    assert motion.frame_rate == 60.0
    assert find_humanoid_map(motion.skeleton).has("leftIndexProximal", "rightThumbDistal")
    check_standing(motion)


def test_video_model_with_y_up(tmp_path):
    vectors = poses()
    path = save(
        tmp_path / "v.npz", global_orient=vectors[None, :, 0],
        body_pose=vectors[None, :, 1:].reshape(1, F, -1),
        transl=np.cumsum(np.full((1, F, 3), (0.0, 0.0, 0.04)), axis=1),
    )  # fmt: skip
    messages = []

    motion = read_recording(path, progress=lambda _, message="": messages.append(message))

    assert motion.frame_rate == 30.0
    assert any("no frame rate; 30 Hz" in message for message in messages)
    assert np.ptp(motion.root_positions[:, 1]) == pytest.approx(0.04 * (F - 1))
    check_standing(motion)


def test_rotations_are_exact(tmp_path):
    """A wrist's direction follows from the shoulder's rotation alone."""
    path = save(tmp_path / "p.npz", poses=poses().reshape(F, -1), trans=np.zeros((F, 3)))

    positions = joint_positions(read_recording(path))

    angle = np.linspace(0.0, 1.2, F)
    arm = positions["left_wrist"] - positions["left_shoulder"]
    assert np.allclose(np.arctan2(arm[:, 2], arm[:, 0]), angle, atol=1e-6)


def test_scaled_positions_of_aist(tmp_path):
    path = save(
        tmp_path / "a.npz", smpl_poses=poses().reshape(F, -1), smpl_scaling=np.array([90.0]),
        smpl_trans=np.linspace((0, 0, 0), (90.0, 0, 0), F),
    )  # fmt: skip

    motion = read_recording(path)

    assert np.ptp(motion.root_positions[:, 0]) == pytest.approx(1.0)


@pytest.mark.parametrize(
    "arrays",
    [
        {"trans": np.zeros((F, 3))},
        {"poses": np.zeros((F, 10)), "trans": np.zeros((F, 3))},
        {"poses": np.zeros((F, 66)), "trans": np.zeros((F - 1, 3))},
        {"poses": np.zeros((0, 66)), "trans": np.zeros((0, 3))},
        {"poses": np.zeros(67)},
        {"poses": np.tile(2.0 * np.eye(3), (F, 24, 1, 1)), "trans": np.zeros((F, 3))},
        {"poses": np.zeros((F, 144)), "trans": np.zeros((F, 3))},
        {"poses": np.zeros((2, F, 72)), "trans": np.zeros((3, F, 3))},
        {"global_orient": np.zeros((F, 1, 3, 3)), "body_pose": np.zeros((F, 23, 3, 3))},
        {"root_orient": np.array(1.0), "pose_body": np.zeros((F, 63))},
        {"posed_joints": np.array(1.0), "global_rot_mats": np.array(1.0)},
        {"trans": np.zeros((F, 3)), "poses": np.array([None], dtype=object)},
    ],
)
def test_what_is_no_body_is_refused(tmp_path, arrays):
    path = tmp_path / "bad.npz"
    np.savez(path, **arrays)

    with pytest.raises(InvalidFileError, match=r"bad\.npz"):
        read_recording(path)


def test_motion_x_is_a_body_with_hands(tmp_path):
    columns = np.zeros((F, 322))
    columns[:, :66] = poses().reshape(F, -1)
    columns[:, 311] = np.linspace(0.0, 2.0, F)
    np.save(tmp_path / "m.npy", columns)

    motion = read_recording(tmp_path / "m.npy")

    assert motion.skeleton.n_joints == 52
    assert np.ptp(motion.root_positions[:, 1]) == pytest.approx(2.0)
    check_standing(motion)


def test_joints_of_humanml3d_stand(tmp_path):
    path = save(tmp_path / "p.npz", poses=poses().reshape(F, -1), trans=np.zeros((F, 3)))
    positions = joint_positions(read_recording(path))
    ours = np.stack([positions[name] for name in NAMES], axis=1)
    np.save(tmp_path / "j.npy", np.stack([ours[..., 0], ours[..., 2], -ours[..., 1]], axis=-1))

    joints = read_recording(tmp_path / "j.npy")

    assert np.allclose(joints.tracks.positions, ours)
    assert joints.tracks.names == tuple(NAMES)
    assert joints.tracks.frame_rate == 20.0


def test_features_are_no_points(recordings):
    with pytest.raises(InvalidFileError, match="263 features of HumanML3D"):
        read_recording(recordings / "corpus/smpl/humanml3d_263/000612.npy")


@pytest.mark.parametrize("name", ["01_single_text_prompt", "05_root_path"])
def test_kimodo_stands_with_joints_at_the_stored_positions(recordings, name):
    path = recordings / "corpus/smpl/kimodo_soma_npz" / f"{name}.npz"

    motion = read_recording(path)

    theirs = np.load(path)["posed_joints"]
    ours = world_poses(motion.skeleton, motion.rotations, motion.root_positions).positions
    rotated = np.stack([theirs[..., 0], -theirs[..., 2], theirs[..., 1]], axis=-1)
    assert np.abs(ours - rotated).max() < 0.02
    assert find_humanoid_map(motion.skeleton).score == 1.0


@pytest.mark.parametrize(
    "content", [b"\x80\x04\x95", b"PK\x03\x04" + bytes(26) + b"archive/data.pkl"]
)
def test_pickles_are_never_opened(tmp_path, content):
    (tmp_path / "p.pkl").write_bytes(content)

    with pytest.raises(InvalidFileError, match="pickle, which is never opened"):
        read_recording(tmp_path / "p.pkl")


def test_unknown_rest_axes_are_kept_with_the_rotations(tmp_path):
    """With Z up in the motion, the rest pose still stands."""
    vectors = poses(root=Z_UP)
    path = save(tmp_path / "z.npz", poses=vectors.reshape(F, -1), trans=np.zeros((F, 3)))

    motion = read_recording(path)

    rest = motion.skeleton.rest_positions
    assert rest[NAMES.index("head"), 2] > rest[0, 2] + 0.4
    down = rotate(motion.rotations[:, 0], np.array([0.0, 0.0, -1.0]))
    assert (down[:, 2] < -0.9).all()


def test_one_damaged_frame_does_not_cost_the_hands(tmp_path):
    vectors = poses(n_joints=52)
    vectors[:, 30, 2] = 0.3
    vectors[3] = np.nan
    path = save(tmp_path / "h.npz", poses=vectors.reshape(F, -1), trans=np.zeros((F, 3)))

    motion = read_recording(path)

    assert motion.skeleton.n_joints == 52
    assert np.isnan(motion.rotations[3]).any()


def test_kimodo_is_known_whatever_comes_first(recordings, tmp_path):
    with np.load(recordings / "corpus/smpl/kimodo_soma_npz/05_root_path.npz") as archive:
        path = save(tmp_path / "k.npz", fps=25.0, **archive)

    assert read_recording(path).frame_rate == 25.0


@pytest.mark.parametrize(
    ("root", "lies"), [((0.0, 0.0, 0.0), True), ((0.0, np.pi, 0.0), False)]
)
def test_a_lying_actor_of_amass_never_passes_in_silence(tmp_path, root, lies):
    """On the back, or face down with the feet below the floor, which looks like standing."""
    path = save(
        tmp_path / "lie.npz", poses=poses(root=root).reshape(F, -1), mocap_framerate=60.0,
        trans=np.tile((0.0, 0.0, 0.1), (F, 1)),
    )  # fmt: skip
    messages = []

    motion = read_recording(path, progress=lambda _, message="": messages.append(message))

    positions = joint_positions(motion)
    rises = np.abs((positions["head"] - positions["pelvis"])[:, 2]).max()
    assert (rises < 0.3) == lies
    assert any("is interpreted as up" in message for message in messages)


def test_poses_are_found_in_archives_with_arrays_of_any_order_and_size(tmp_path):
    about = {
        "seq_name": np.array("walk"), "vertices": np.random.default_rng(1).random((F, 900)),
        "poses": poses(root=Z_UP).reshape(F, -1), "trans": np.tile((0.2, 0.1, 0.9), (F, 1)),
        "mocap_framerate": np.array(60.0),
    }  # fmt: skip

    motion = read_recording(save(tmp_path / "a.npz", **about))

    assert motion.frame_rate == 60.0
    check_standing(motion)
