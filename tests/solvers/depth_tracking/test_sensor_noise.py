"""Noise of a structured-light sensor, each cause separately."""

from dataclasses import replace

import numpy as np

from solvers.depth_scene.camera import Camera
from solvers.depth_tracking.forest_training.render_mesh import NO_PART, RenderedMesh
from solvers.depth_tracking.forest_training.sensor_noise import (
    DISPARITY_STEPS_M,
    SensorNoiseSettings,
    add_sensor_noise,
)

NO_NOISE = SensorNoiseSettings(
    jitter=0.0, disparity=0.0, step=0.0, baseline=0.0, edge_holes=0.0, holes=0.0
)
CAMERA = Camera(280.0, 280.0, 79.5, 59.5, 160, 120)


def wall(distance=3.0):
    shape = (CAMERA.height, CAMERA.width)
    return RenderedMesh(np.full(shape, distance, np.float32), np.zeros(shape, np.uint8))


def test_sensor_without_noise_changes_nothing(rng):
    depth = rng.uniform(1.0, 4.0, (120, 160)).astype(np.float32)
    depth[:30] = 0.0
    labels = np.where(depth > 0, 3, NO_PART).astype(np.uint8)
    observed = add_sensor_noise(RenderedMesh(depth, labels), CAMERA, rng, NO_NOISE)
    np.testing.assert_array_equal(observed.depth, depth)
    np.testing.assert_array_equal(observed.labels, labels)


def test_steps_grow_with_the_square_of_distance(rng):
    ramp = wall()
    ramp.depth[:] = np.linspace(1.0, 4.0, ramp.depth.size).reshape(ramp.depth.shape)
    noisy = add_sensor_noise(ramp, CAMERA, rng, replace(NO_NOISE, step=1.0)).depth
    steps = DISPARITY_STEPS_M / noisy
    np.testing.assert_allclose(steps, np.rint(steps), atol=1e-3)
    levels = np.unique(noisy)
    for z in (1.5, 3.0, 3.9):
        step = np.diff(levels)[np.searchsorted(levels, z)]
        np.testing.assert_allclose(step, z**2 / DISPARITY_STEPS_M, rtol=0.03)


def test_disparity_noise_grows_with_the_square_of_distance(rng):
    for z in (1.0, 3.0):
        noisy = add_sensor_noise(wall(z), CAMERA, rng, replace(NO_NOISE, disparity=0.2)).depth
        np.testing.assert_allclose(noisy.std(), 0.2 * z**2 / DISPARITY_STEPS_M, rtol=0.05)


def test_shadow_of_a_bar_is_as_wide_as_the_disparity(rng):
    """The projector is on the right; from there, the bar occludes what is left of it."""
    scene = wall()
    scene.depth[:, 80:100] = 1.5
    observed = add_sensor_noise(scene, CAMERA, rng, replace(NO_NOISE, baseline=0.075))
    holes = np.flatnonzero(observed.depth[60] == 0)
    width = 280.0 * 0.075 * (1 / 1.5 - 1 / 3.0)
    assert holes.max() == 79
    assert abs(len(holes) - width) <= 1
    assert (observed.labels[60, holes] == NO_PART).all()


def test_holes_have_the_requested_fraction_and_more_at_edges(rng):
    scene = wall()
    scene.depth[:, 80:] = 1.5
    observed = add_sensor_noise(
        scene, CAMERA, rng, replace(NO_NOISE, holes=0.1, edge_holes=0.6)
    )
    hole = observed.depth == 0
    assert abs(hole[:, [79, 80]].mean() - 0.6) < 0.1
    assert abs(hole[:, :79].mean() - 0.1) < 0.01


def test_labels_move_with_their_depth(rng):
    scene = wall()
    scene.depth[:, 80:], scene.labels[:, 80:] = 1.5, 7
    observed = add_sensor_noise(scene, CAMERA, rng, replace(NO_NOISE, jitter=1.0))
    np.testing.assert_array_equal(observed.labels == 7, observed.depth == 1.5)
    assert (observed.depth[:, 80] == 3.0).any()
