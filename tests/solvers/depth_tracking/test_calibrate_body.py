"""Measure bodies in one frame, by cylinders from random samples and by a fit of the complete
body.
"""

from dataclasses import replace

import numpy as np
import pytest

from solvers.depth_scene.camera import Camera
from solvers.depth_scene.recording import DepthRecording
from solvers.depth_tracking.body.coordinates import COORDINATES, N_COORDINATES
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.tables import CAPSULES
from solvers.depth_tracking.capturing.calibrate_body import (
    CalibrationSettings,
    body_from_cylinders,
    calibrate_body,
)
from solvers.depth_tracking.capturing.sample_cylinders import Cylinder, sample_cylinder
from solvers.depth_tracking.forest.pixel_forest import load_pixel_forest
from solvers.depth_tracking.terms.hypothesis import render_hypothesis
from solvers.errors import InvalidMotionError

CAMERA = Camera(285.63, 285.63, 159.5, 119.5, 320, 240)
LIMBS = ("UpperArm", "LowerArm", "UpperLeg", "LowerLeg")


@pytest.fixture(scope="module")
def forest():
    return load_pixel_forest()


def arms_away(body, arms=0.7):
    """A recording of one frame: the body faces the camera, arms lifted sideways."""
    pose = np.zeros(N_COORDINATES)
    pose[:3] = 0.0, -0.05, 2.6
    for name, angle in (
        ("leftHumerusZ", arms), ("rightHumerusZ", arms),
        ("leftFemurZ", 0.15), ("rightFemurZ", 0.15),
    ):  # fmt: skip
        pose[COORDINATES.index(name)] = angle
    depth = render_hypothesis(body, pose, CAMERA).image.depth_image().astype(np.float32)
    return DepthRecording(CAMERA, 1, 30.0, lambda frame: depth)


def bar(start, stop, radius):
    """Depth and silhouette of a capsule, by marching along every ray."""
    rays = CAMERA.rays()
    rays /= np.linalg.norm(rays, axis=-1, keepdims=True)
    depth = np.zeros(rays.shape[:2])
    axis = stop - start
    for distance in np.arange(1.5, 2.5, 0.002):
        points = rays * distance
        along = (points - start) @ axis / (axis @ axis)
        off = np.linalg.norm(points - start - along[..., None] * axis, axis=-1)
        hit = (off <= radius) & (along >= 0) & (along <= 1) & (depth == 0.0)
        depth[hit] = points[hit][:, 2]
    return depth


@pytest.mark.parametrize("radius", [0.04, 0.07])
def test_sample_cylinder_measures_a_cylinder(rng, radius):
    start, stop = np.array([-0.2, -0.1, 2.0]), np.array([0.15, 0.1, 2.05])
    depth = bar(start, stop, radius)
    found = sample_cylinder(depth, depth > 0, CAMERA, (0.02, 0.12), rng)
    assert found.quality > 0.9
    np.testing.assert_allclose(found.radius, radius, rtol=0.1)
    np.testing.assert_allclose(found.length, np.linalg.norm(stop - start), rtol=0.08)


def test_sample_cylinder_counts_other_parts_as_outliers(rng):
    """Half of the bar is labeled as another part, so the cylinder is half as long."""
    start, stop = np.array([-0.2, 0.0, 2.0]), np.array([0.2, 0.0, 2.0])
    depth = bar(start, stop, 0.05)
    own = depth > 0
    own[:, : CAMERA.width // 2] = False
    found = sample_cylinder(depth, own, CAMERA, (0.02, 0.12), rng)
    np.testing.assert_allclose(found.length, 0.2, rtol=0.12)
    assert found.ends[:, 0].min() > -0.02


def test_sample_cylinder_returns_none_for_three_pixels(rng):
    depth = np.zeros((240, 320))
    depth[10, 10:13] = 2.0
    assert sample_cylinder(depth, depth > 0, CAMERA, (0.02, 0.1), rng) is None


def test_joints_are_between_cylinders_and_sides_are_averaged():
    arm = {
        "leftUpperArm": Cylinder(np.array([[0, 0, 2], [0, 0.28, 2.0]]), 0.05, 1.0),
        "leftLowerArm": Cylinder(np.array([[0, 0.32, 2], [0, 0.56, 2.0]]), 0.04, 1.0),
        "rightUpperArm": Cylinder(np.array([[1, 0, 2], [1, 0.36, 2.0]]), 0.06, 1.0),
    }
    body = body_from_cylinders(arm, np.nan)
    np.testing.assert_allclose(body.length("leftUpperArm"), (0.30 + 0.36) / 2)
    np.testing.assert_allclose(body.length("leftLowerArm"), 0.26)
    np.testing.assert_allclose(body.length("rightLowerArm"), 0.26)
    for part, radius in (("leftUpperArm", 0.055), ("rightLowerArm", 0.04)):
        np.testing.assert_allclose(body.radii[CAPSULES.index(part)], radius)
    longer = body_from_cylinders(arm, 0.7)
    trunk = sum(longer.length(name) for name in ("hips", "spine", "chest"))
    np.testing.assert_allclose(trunk, 0.7)


@pytest.mark.parametrize("stature", [1.55, 1.9])
def test_calibrate_body_measures_bodies_of_capsules(forest, stature):
    true = default_body(stature)
    found = calibrate_body(arms_away(true), 0, forest)
    for limb in LIMBS:
        for side in ("left", "right"):
            name = f"{side}{limb}"
            np.testing.assert_allclose(found.length(name), true.length(name), rtol=0.08)
    assert found.length("leftUpperArm") == found.length("rightUpperArm")


def test_published_calibration_is_less_accurate(forest):
    true = default_body(1.75)
    plain = calibrate_body(
        arms_away(true), 0, forest, settings=CalibrationSettings(refine=False)
    )
    trunk = sum(plain.length(name) for name in ("hips", "spine", "chest"))
    assert 0.35 < trunk < 0.75
    assert 0.15 < plain.length("leftUpperArm") < 0.4


def test_calibrate_body_repeats_for_the_same_frame(forest):
    depth = arms_away(default_body())
    settings = CalibrationSettings(refine=False, n_samples=60)
    one, other = (calibrate_body(depth, 0, forest, settings=settings) for _ in range(2))
    np.testing.assert_array_equal(one.lengths, other.lengths)
    np.testing.assert_array_equal(one.radii, other.radii)


def test_calibrate_body_raises_for_frames_with_few_limbs(forest):
    complete = arms_away(default_body())
    with pytest.raises(InvalidMotionError, match="no frame 3"):
        calibrate_body(complete, 3, forest)
    empty = replace(complete, read_depth=lambda frame: np.zeros((240, 320), np.float32))
    with pytest.raises(InvalidMotionError, match="Frame 0 shows only 0 arms and legs"):
        calibrate_body(empty, 0, forest)
    head = complete.frame(0).copy()
    head[50:] = 0.0
    with pytest.raises(InvalidMotionError, match="arms and legs well enough"):
        calibrate_body(replace(complete, read_depth=lambda frame: head), 0, forest)
