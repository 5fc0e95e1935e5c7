"""The milestone: a real walk, imported by Blender's own importer, is cleaned by the button."""

import contextlib
import io

import numpy as np
import pytest

# Blender's importer leaves its file open.
INCH = 0.0254 / 0.45  # CMU's unit, in meters


@pytest.fixture
def walk(blank, recordings):
    """A CMU walk of 2.6 s at 120 Hz; its first frame is a T-pose."""
    with contextlib.redirect_stdout(io.StringIO()):
        blank.ops.import_anim.bvh(
            filepath=str(recordings / "mocap" / "cmu_walk" / "07_01.bvh"),
            global_scale=INCH,
            update_scene_fps=True,
            update_scene_duration=True,
        )
    return blank.context.object


def test_cleaned_walk_is_nearer_to_the_truth(walk, blank, load, rng):
    reading = load("mocap_assist.actions.armature_read")
    writing = load("mocap_assist.actions.armature_write")
    representations = load("solvers.rotations.representations")
    scene = blank.context.scene
    truth = reading.read_take(walk, scene)
    motion = truth.parts[0].motion
    shaken = rng.normal(scale=np.radians(3.0), size=(motion.n_frames, motion.n_joints, 3))
    noise = representations.quaternion_from_rotation_vector(shaken)
    noisy = truth.with_recordings((
        motion.with_poses(representations.multiply(motion.rotations, noise)),
    ))
    bones = set(truth.rig.bones)
    raw, slot = writing.write_take(walk, reading.action_of(walk), noisy, bones, {})
    raw.name = "walk"
    writing.assign_result(walk, raw, slot, writing.Output.ACTION)

    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}

    def error(take):
        angles = representations.angle_between(take.parts[0].motion.rotations, motion.rotations)
        return float(angles[:, : len(bones)].mean())

    assert walk.animation_data.action.name == "walk.clean"
    assert error(reading.read_take(walk, scene)) < 0.5 * error(noisy)
