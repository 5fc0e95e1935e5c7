"""Fix My Take on takes that lack something and on depth images, and physics at the end."""

import numpy as np
import pytest
from drawn_bodies import recorded, waving
from marked_bodies import markers_on
from numpy.testing import assert_allclose

from solvers.denoising import denoise, plant_feet
from solvers.motion import Motion, Skeleton, Tracks
from solvers.physics import simulate
from solvers.samples import CorruptionSettings, GaitSettings, corrupt, walking_gait
from solvers.workflows import FixSettings, TakeOrigin, fix_take


@pytest.fixture(scope="module")
def walk() -> Motion:
    return walking_gait(GaitSettings(duration=4.0, frame_rate=30.0))


@pytest.fixture(scope="module")
def noisy(walk) -> Motion:
    return corrupt(walk, CorruptionSettings(jitter=3.0, root_jitter=0.004))


def test_actor_in_depth_images_is_tracked_and_cleaned():
    result = fix_take(recorded(waving(6)))

    tracked = result.chain.captured.motion
    assert result.origin is TakeOrigin.DEPTH and result.chain.denoised is not None
    cleaned = denoise(tracked).recording
    assert_allclose(result.recording.rotations, plant_feet(cleaned).motion.rotations, atol=1e-9)
    assert result.headline == "No floor is visible, so the camera is assumed to be level."


def test_physics_comes_last_on_request(noisy):
    settings = FixSettings(physics=True, plant_feet=False)
    short = noisy.slice(0, 40)

    result = fix_take(short, settings=settings)

    expected = simulate(fix_take(short, settings=FixSettings(plant_feet=False)).recording)
    assert_allclose(result.recording.rotations, expected.motion.rotations, atol=1e-9)
    assert any(step.startswith("Physics was applied. ") for step in result.steps)


def test_physics_of_points_is_skipped(rng):
    points = Tracks(("a", "b"), rng.normal(size=(30, 2, 3)), 30.0)

    steps = fix_take(points, settings=FixSettings(physics=True)).steps

    assert any(step.startswith("Physics was skipped") for step in steps)


def test_markers_that_are_never_seen_are_left_out(walk):
    markers = markers_on(walk)
    positions = markers.positions.copy()
    positions[:, [markers.names.index(name) for name in ("LFIN", "RFIN")]] = np.nan

    result = fix_take(markers.with_positions(positions))

    assert result.origin is TakeOrigin.MARKERS and result.recording.observed.all()
    assert "LFIN, RFIN were never observed and are left out." in result.steps


def test_take_without_an_essential_marker_is_cleaned_as_points(walk):
    markers = markers_on(walk.slice(0, 40))
    positions = markers.positions.copy()
    positions[:, markers.names.index("LKNE")] = np.nan

    result = fix_take(markers.with_positions(positions))

    assert result.origin is TakeOrigin.POINTS
    assert "LKNE" not in result.recording.names and len(result.recording.names) == 40
    assert result.headline.endswith("missing are LKNE.")


def test_frames_without_data_are_filled_and_reported(noisy):
    rotations, positions = noisy.rotations.copy(), noisy.root_positions.copy()
    for values in (rotations, positions):
        values[30:36] = values[100:103] = np.nan

    result = fix_take(noisy.with_poses(rotations, positions))

    assert result.recording.observed.all()
    sentence = "9 frames have no data at all, up to 0.2 s in a row; they are filled"
    assert result.headline.startswith(sentence) and result.headline in result.steps


def test_odd_size_of_the_actor_comes_first(noisy):
    skeleton = noisy.skeleton
    giant = Skeleton(skeleton.names, skeleton.parents, 8.0 * skeleton.offsets)
    moved = Motion(giant, noisy.rotations, 8.0 * noisy.root_positions, noisy.frame_rate)

    headline = fix_take(moved).headline

    assert headline.startswith("The actor is ") and "set Unit or Scale" in headline
