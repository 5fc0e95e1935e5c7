"""EasyMocap rotates and moves the posed body as a whole, about the origin of its model."""

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion import forward_kinematics
from solvers.progress import unwatched
from solvers.recordings import read_recording
from solvers.recordings.skeleton_files.smpl import open_smpl

F = 40


def save(path, **arrays):
    np.savez(path, **arrays)
    return path


@pytest.mark.parametrize("n_numbers", [69, 72, 78, 87])
def test_the_global_turn_and_travel_of_easymocap_are_read(tmp_path, n_numbers):
    """Ignored, they leave the body in place without a turn."""
    vectors = np.zeros((F, n_numbers))
    angles = np.linspace(0.0, 1.5, F)
    travel = np.linspace([0.0, 0.9, 0.0], [2.0, 0.9, 1.0], F)

    path = save(
        tmp_path / "easymocap.npz", poses=vectors, Th=travel,
        Rh=angles[:, None] * [0.0, 1.0, 0.0], shapes=np.zeros((1, 10)),
    )  # fmt: skip
    motion = read_recording(path)

    moved = motion.root_positions - motion.root_positions[0]
    assert np.allclose(moved[:, :2], np.stack([travel[:, 0], -travel[:, 2]], axis=1), atol=0.05)
    positions, names = forward_kinematics(motion).positions, motion.skeleton.names
    across = positions[:, names.index("left_hip")] - positions[:, names.index("right_hip")]
    turned = np.arctan2(across[:, 1], across[:, 0])
    assert turned - turned[0] == pytest.approx(angles, abs=1e-6)


def test_the_body_of_easymocap_turns_about_the_origin_of_the_model(tmp_path):
    """Who lies is where the pelvis of the model is then, not where its origin is."""
    path = save(
        tmp_path / "easymocap.npz", poses=np.zeros((F, 72)), Th=np.zeros((F, 3)),
        Rh=np.linspace([0.0, 0.0, 0.0], [0.0, 0.0, np.pi / 2.0], F),
    )  # fmt: skip

    motion = open_smpl(path, on_floor=False).read(0, unwatched)

    moved = motion.root_positions[-1] - motion.root_positions[0]
    assert moved == pytest.approx((0.226, 0.0, 0.226), abs=1e-6)


def test_a_turn_without_one_for_each_pose_is_refused(tmp_path):
    path = save(tmp_path / "a.npz", poses=np.zeros((F, 72)), Rh=np.zeros((F - 1, 3)))

    with pytest.raises(InvalidFileError, match="has 40 poses but positions of shape"):
        read_recording(path)


def test_the_size_of_the_body_is_that_of_the_model_times_its_scale(tmp_path):
    """A child of EasyMocap does not come in as tall as an adult."""
    arrays = {"poses": np.zeros((F, 72)), "Th": np.zeros((F, 3))}
    adult = read_recording(save(tmp_path / "adult.npz", **arrays))
    child = read_recording(save(tmp_path / "child.npz", **arrays, scale=np.full((1, 1), 0.6)))

    assert child.skeleton.offsets == pytest.approx(0.6 * adult.skeleton.offsets)


def test_the_pelvis_about_which_a_scaled_body_turns_is_scaled(tmp_path):
    path = save(
        tmp_path / "easymocap.npz", poses=np.zeros((F, 87)), Th=np.zeros((F, 3)),
        Rh=np.linspace([0.0, 0.0, 0.0], [0.0, 0.0, np.pi / 2.0], F), scale=np.array([[0.5]]),
    )  # fmt: skip

    motion = open_smpl(path, on_floor=False).read(0, unwatched)

    moved = motion.root_positions[-1] - motion.root_positions[0]
    assert moved == pytest.approx((0.174, 0.0, 0.177), abs=1e-6)


def test_fingers_as_components_are_reported_and_left_out(tmp_path, collected_messages):
    messages, progress = collected_messages
    poses = np.zeros((F, 87))
    poses[:, 66:78] = 2.0
    path = save(tmp_path / "a.npz", poses=poses, Rh=np.zeros((F, 3)))

    motion = read_recording(path, progress=progress)

    assert motion.skeleton.n_joints == 22
    assert "The fingers are components of the licensed model and are left out" in messages


def test_the_position_in_the_camera_of_romp_is_read(tmp_path, collected_messages):
    messages, progress = collected_messages
    path = save(
        tmp_path / "romp.npz", global_orient=np.tile([np.pi, 0.0, 0.0], (F, 1)),
        body_pose=np.zeros((F, 69)), cam_trans=np.linspace([0, 0, 3.0], [1.0, 0, 3.0], F),
    )  # fmt: skip

    motion = read_recording(path, progress=progress)

    assert np.ptp(motion.root_positions, axis=0) == pytest.approx((1.0, 0.0, 0.0), abs=1e-6)
    assert any("relative to the camera" in message for message in messages)


@pytest.mark.parametrize(
    ("name", "depth", "moved"),
    [
        ("pred_cam_t", 5.0, (1.0, 4.0, 0.3)), ("pred_cam_t", 43.0, (0.0, 0.0, 0.0)),
        ("pred_cam_t_full", 90.0, (1.0, 0.0, 0.3)), ("cam_t", 43.0, (0.0, 0.0, 0.0)),
    ],
)  # fmt: skip
def test_the_camera_of_a_cropped_picture_is_no_path(
    tmp_path, collected_messages, name, depth, moved
):
    """Otherwise an actor whose size in the picture changes by a tenth runs 4 m."""
    messages, progress = collected_messages
    path = save(
        tmp_path / "hmr.npz", global_orient=np.tile([np.pi, 0.0, 0.0], (F, 1)),
        body_pose=np.zeros((F, 69)),
        **{name: np.linspace([0, 0, depth], [1.0, 0.3, depth + 4.0], F)},
    )  # fmt: skip

    motion = read_recording(path, progress=progress)

    assert np.ptp(motion.root_positions, axis=0) == pytest.approx(moved, abs=1e-6)
    is_left_out = any("Save the path in the world" in message for message in messages)
    assert is_left_out == (depth > 25.0)


def test_the_names_and_the_pose_of_meshcapade_are_read(tmp_path):
    """Its .smpl is not a NumPy archive without joints of a known name."""
    path = save(
        tmp_path / "take.smpl.npz", codecVersion=2, smplVersion=1, gender=0, frameCount=F,
        frameRate=25.0, shapeParameters=np.zeros(10), headPose=np.zeros((F, 3, 3)),
        bodyTranslation=np.linspace([0, 0.9, 0], [1.0, 0.9, 0], F),
        bodyPose=np.zeros((F, 22, 3)), leftHandPose=np.full((F, 15, 3), 0.1),
        rightHandPose=np.full((F, 15, 3), 0.1),
    )  # fmt: skip

    motion = read_recording(path)

    assert (motion.frame_rate, motion.skeleton.n_joints) == (25.0, 52)
    assert np.ptp(motion.root_positions, axis=0) == pytest.approx((1.0, 0.0, 0.0), abs=1e-6)


def test_a_scale_of_another_program_does_not_change_the_size(tmp_path):
    """The size of a box around the actor in the picture would make a giant of 400 m."""
    arrays = {"poses": np.zeros((F, 72)), "trans": np.zeros((F, 3))}

    plain = read_recording(save(tmp_path / "plain.npz", **arrays))
    boxed = read_recording(save(tmp_path / "boxed.npz", **arrays, scale=np.full(F, 250.0)))

    assert np.allclose(boxed.skeleton.offsets, plain.skeleton.offsets)


@pytest.mark.parametrize("scale", [np.nan, -1.0, 1e9])
def test_a_scale_of_no_body_is_refused(tmp_path, scale):
    """No body of 1.7 million kilometers is read."""
    arrays = {"poses": np.zeros((F, 72)), "Th": np.zeros((F, 3))}

    with pytest.raises(InvalidFileError, match="times the size of the model"):
        read_recording(save(tmp_path / "a.npz", **arrays, scale=scale))
