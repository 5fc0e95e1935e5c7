"""Detect poses in single depth images with the shipped forest."""

import numpy as np
import pytest

from solvers.depth_scene.camera import Camera
from solvers.depth_tracking.body.coordinates import COORDINATES, N_COORDINATES
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.segment_kinematics import joint_positions, segment_frames
from solvers.depth_tracking.body.tables import JOINTS
from solvers.depth_tracking.detection.detect_pose import DetectorSettings, detect_pose
from solvers.depth_tracking.forest import PARTS
from solvers.depth_tracking.forest.pixel_forest import classify_pixels, load_pixel_forest
from solvers.depth_tracking.terms.hypothesis import render_hypothesis
from solvers.errors import InvalidMotionError

CAMERA = Camera(142.8, 142.8, 79.5, 59.5, 160, 120)
BODY = default_body()
CMU = {
    "head": "Head", "leftHand": "LeftHand", "rightHand": "RightHand",
    "leftLowerLeg": "LeftLeg", "rightLowerLeg": "RightLeg", "leftFoot": "LeftFoot",
    "rightFoot": "RightFoot", "leftLowerArm": "LeftForeArm", "rightLowerArm": "RightForeArm",
}  # fmt: skip


@pytest.fixture(scope="module")
def forest():
    return load_pixel_forest()


def capsule_person(**angles):
    pose = np.zeros(N_COORDINATES)
    pose[:3] = 0.05, -0.1, 2.6
    for name, angle in angles.items():
        pose[COORDINATES.index(name)] = angle
    return pose, render_hypothesis(BODY, pose, CAMERA).image.depth_image().astype(np.float32)


@pytest.mark.parametrize(
    "angles",
    [
        {"leftHumerusZ": 1.4, "rightHumerusZ": 1.4},
        {"leftHumerusX": 1.0, "rightHumerusZ": 0.5, "yaw": 0.4},
    ],
)
def test_detect_pose_finds_a_body_of_capsules(forest, angles):
    true, depth = capsule_person(**angles)
    found = detect_pose(depth, CAMERA, BODY, forest)
    exact = joint_positions(BODY, segment_frames(BODY, true))
    distances = np.linalg.norm(found.joints - exact, axis=1)
    assert distances.mean() < 0.05
    assert found.overlap > 0.85
    assert 0.0 < found.score <= 1.0
    np.testing.assert_allclose(
        found.joints, joint_positions(BODY, segment_frames(BODY, found.pose))
    )


def test_detect_pose_repeats_for_the_same_image(forest):
    _, depth = capsule_person(leftHumerusZ=1.0)
    one, other = (detect_pose(depth, CAMERA, BODY, forest) for _ in range(2))
    np.testing.assert_array_equal(one.pose, other.pose)


def test_detect_pose_subsamples_a_finer_camera(forest):
    _, depth = capsule_person(leftHumerusZ=1.0, rightHumerusZ=1.0)
    fine = np.repeat(np.repeat(depth, 4, axis=0), 4, axis=1)
    camera = Camera(4 * 142.8, 4 * 142.8, 4 * 79.5, 4 * 59.5, 640, 480)
    settings = DetectorSettings(max_pixels=int(np.count_nonzero(depth)))
    small = detect_pose(depth, CAMERA, BODY, forest, settings)
    large = detect_pose(fine, camera, BODY, forest, settings)
    assert large.step == 4 * small.step
    np.testing.assert_allclose(small.joints, large.joints, atol=1e-6)


def test_detect_pose_reports_parts_outside_of_the_image(forest):
    _, depth = capsule_person(leftHumerusZ=1.2, rightHumerusZ=1.2)
    depth[62:] = 0.0
    found = detect_pose(depth, CAMERA, BODY, forest)
    assert {"leftFoot", "rightFoot"} <= missing_parts(found)
    assert "head" not in missing_parts(found)
    assert np.isfinite(found.pose).all()


@pytest.mark.parametrize("n_pixels", [0, 1, 30])
def test_detect_pose_raises_for_few_pixels(forest, n_pixels):
    depth = np.zeros((120, 160), dtype=np.float32)
    depth.reshape(-1)[5000 : 5000 + n_pixels] = 2.0
    with pytest.raises(InvalidMotionError, match=r"No person is detected: \d+ pixels"):
        detect_pose(depth, CAMERA, BODY, forest)


def test_detect_pose_raises_for_scattered_pixels(forest, rng):
    depth = np.zeros((120, 160), dtype=np.float32)
    depth[::14, ::14] = rng.uniform(1.0, 9.0, depth[::14, ::14].shape)
    with pytest.raises(InvalidMotionError, match="show no body part"):
        detect_pose(depth, CAMERA, BODY, forest)


def test_detect_pose_rejects_noise(forest, rng):
    depth = rng.uniform(1.0, 4.0, (120, 160)).astype(np.float32)
    depth[rng.random(depth.shape) < 0.7] = 0.0
    with pytest.raises(InvalidMotionError, match="No person is detected"):
        detect_pose(depth, CAMERA, BODY, forest)


def test_detect_pose_scores_a_wall_low(forest):
    """The forest finds parts on a flat wall, but no pose explains them."""
    wall = np.full((120, 160), 2.5, dtype=np.float32)
    assert detect_pose(wall, CAMERA, BODY, forest).overlap < 0.4


@pytest.mark.parametrize(("take", "maximum"), [("walk_front", 0.05), ("jump", 0.06)])
def test_detect_pose_is_accurate_on_frames_with_known_joints(recordings, forest, take, maximum):
    """A skinned human and a noisy sensor; the body model is a default adult."""
    with np.load(recordings / "depth" / "truth" / f"{take}.npz") as truth:
        depth, joints = truth["depth"], truth["joints"]
        names = truth["joint_names"].tolist()
        focal = [float(truth[name]) for name in ("fx", "fy", "cx", "cy")]
    camera = Camera(*focal, 320, 240)
    for frame in (5, 35, 65):
        found = detect_pose((depth[frame] / 1000.0).astype(np.float32), camera, BODY, forest)
        result = found.joints[[JOINTS.index(joint) for joint in CMU]]
        distances = result - joints[frame][[names.index(joint) for joint in CMU.values()]]
        assert np.linalg.norm(distances, axis=1).mean() < maximum


def test_detect_pose_reports_missing_legs_of_an_upper_body(recordings, forest):
    """Raw Kinect depth of skeltrack: a person close to the camera, cropped by the image."""
    path = sorted((recordings / "depth" / "skeltrack").iterdir())[0]
    depth = np.fromfile(path, dtype="<u2").reshape(480, 640) / 1000.0
    near = np.where((depth > 0.5) & (depth < 1.6), depth, 0.0).astype(np.float32)
    camera = Camera(571.3, 571.3, 319.5, 239.5, 640, 480)
    found = detect_pose(near, camera, BODY, forest)
    assert {"head", "chest"}.isdisjoint(missing_parts(found))
    assert {"leftFoot", "rightFoot"} <= missing_parts(found)


def test_heads_of_standing_people_are_on_top(recordings, forest):
    """UTD-MHAD: the forest finds the head of each subject in front of a real Kinect."""
    from scipy.io import loadmat

    camera = Camera(285.63, 285.63, 160.0, 120.0, 320, 240).every(2)
    for subject in (1, 3, 5, 7):
        path = recordings / "depth" / "utd_mhad" / f"a1_s{subject}_t1_depth.mat"
        depth = loadmat(path)["d_depth"][::2, ::2, 2] / 1000.0
        pixels = classify_pixels(depth.astype(np.float32), camera, forest)
        heads = pixels.rows[pixels.labels == 4]
        assert len(heads) > 20
        top, bottom = pixels.rows.min(), pixels.rows.max()
        assert heads.mean() < top + 0.2 * (bottom - top)


def missing_parts(found):
    """The parts without pixels, whose pose is a guess."""
    return {
        part for part, weight in zip(PARTS, found.parts.weights, strict=True) if weight == 0
    }
