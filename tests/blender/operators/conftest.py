"""A noisy take, and the button Clean."""

import gc
import warnings

import numpy as np
import pytest


@pytest.fixture
def noisy(make_armature, animate, blank, rng):
    """A figure of 13 bones in smooth motion with 2 degrees of noise, for two seconds."""
    armature = make_armature(mode="XYZ")
    action = animate(armature)
    blank.context.scene.render.fps = 30
    bag = action.layers[0].strips[0].channelbag(action.slots[0])
    for curve in bag.fcurves:
        scale = 0.01 if "location" in curve.data_path else np.radians(2.0)
        for key in curve.keyframe_points:
            key.co.y += rng.normal(scale=scale)
        curve.update()
    return armature


@pytest.fixture
def clean(blank):
    """Press Clean; without feet, so that the random dance of the figure is not nailed down."""

    def press(**settings):
        settings = {"plant_feet": False} | settings
        assert blank.ops.mocap_assist.denoise(**settings) == {"FINISHED"}
        return blank.context.object.animation_data.action

    return press


@pytest.fixture
def dancer(make_dancer):
    """A figure of 13 bones in smooth motion for ten seconds at 30 Hz."""
    return make_dancer(300)


@pytest.fixture
def bad_arm(dancer):
    """Two seconds of it without the left arm, from frame 101 on."""
    bag = dancer.animation_data.action.layers[0].strips[0].channelbags[0]
    for curve in bag.fcurves:
        if "LeftArm" in curve.data_path:
            for key in list(curve.keyframe_points)[100:160][::-1]:
                curve.keyframe_points.remove(key)
    return dancer


@pytest.fixture
def walker(load, blank, tmp_path):
    """A walk of three seconds that shakes, imported from BVH."""
    samples = load("solvers.samples")
    walk = samples.walking_gait(samples.GaitSettings(duration=3.0, frame_rate=30.0))
    shaking = samples.corrupt(walk, samples.CorruptionSettings(jitter=1.0, root_jitter=0.002))
    load("solvers.recordings").write_bvh(shaking, tmp_path / "walk.bvh")
    with warnings.catch_warnings(action="ignore"):  # Blender's importer leaves its file open
        blank.ops.import_anim.bvh(
            filepath=str(tmp_path / "walk.bvh"), global_scale=0.01, update_scene_fps=True
        )
        gc.collect()
    return blank.context.object
