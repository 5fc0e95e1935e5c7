"""Load Sample Take adds a take to the scene in the way that Import does."""

import json

import numpy as np


def test_sample_comes_in_as_an_import_does(blank):
    assert blank.ops.mocap_assist.load_sample() == {"FINISHED"}

    armature, scene = blank.context.object, blank.context.scene
    origin = json.loads(armature["mocap_assist_recording"])
    assert armature.type == "ARMATURE" and armature.animation_data.action
    assert (origin["kind"], origin["n_frames"]) == ("Motion", 240)
    assert (scene.render.fps, scene.frame_start, scene.frame_end) == (30, 1, 240)
    assert armature.data.display_type == "STICK" and armature.show_in_front


def test_sample_has_the_faults_that_it_is_there_for(blank):
    blank.ops.mocap_assist.load_sample()

    blank.ops.mocap_assist.measure_quality()

    kinds = {issue.kind for issue in blank.context.scene.mocap_assist.issues}
    assert kinds >= {"spike", "gap", "foot slide"}


def test_sample_is_resampled_to_the_rate_of_an_animated_scene(blank, make_armature, animate):
    animate(make_armature())
    blank.context.scene.render.fps = 60

    blank.ops.mocap_assist.load_sample()

    action = blank.context.object.animation_data.action
    bag = action.layers[0].strips[0].channelbags[0]
    times = np.array([key.co.x for key in bag.fcurves[0].keyframe_points])
    assert blank.context.scene.render.fps == 60
    assert np.allclose(np.diff(times), 1.0)


def test_two_samples_stand_next_to_each_other_by_name(blank):
    for _ in range(2):
        blank.ops.mocap_assist.load_sample()

    armatures = [each.name for each in blank.data.objects if each.type == "ARMATURE"]
    assert sorted(armatures) == ["Sample Walk", "Sample Walk.001"]


def test_sample_take_is_the_noisy_walk_of_the_solvers(blank, load):
    blank.ops.mocap_assist.load_sample()
    read_take = load("mocap_assist.actions.armature_read").read_take

    motion = read_take(blank.context.object, blank.context.scene).parts[0].motion

    walk = load("solvers.samples").noisy_walk()
    joint, expected = motion.skeleton.index("LeftLeg"), walk.skeleton.index("LeftLeg")
    assert np.allclose(
        np.abs(motion.rotations[:, joint]), np.abs(walk.rotations[:, expected]), atol=1e-4
    )
    missing = ~motion.observed[:, motion.skeleton.index("RightForeArm")]
    assert list(np.flatnonzero(missing)) == list(range(120, 180))
