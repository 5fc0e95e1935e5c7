"""A generated Rigify rig is read as a humanoid, and retargeting reaches its bones."""

import contextlib
import io

import numpy as np
import pytest

LIMBS = ("Shoulder", "UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot", "Toes")
HUMAN = {"hips", "spine", "chest", "neck", "head"} | {
    side + part for side in ("left", "right") for part in LIMBS
}


@pytest.fixture(scope="module")
def rig():
    """The armature that Rigify makes of its human metarig."""
    import addon_utils
    import bpy

    bpy.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    addon_utils.enable("rigify", default_set=True)
    with contextlib.redirect_stdout(io.StringIO()):
        bpy.ops.object.armature_human_metarig_add()
        bpy.ops.pose.rigify_generate()
    yield bpy.context.object
    addon_utils.disable("rigify", default_set=True)


@pytest.mark.parametrize(
    ("kind", "hips", "thigh", "idle"),
    [
        (
            "controls",
            "torso",
            "thigh_fk.L",
            {"root", "hips", "chest", "spine_fk.001", "hand_ik.L"},
        ),
        (
            "DEF-",
            "DEF-spine",
            "DEF-thigh.L",
            {"DEF-thigh.L.001", "DEF-pelvis.L", "DEF-breast.L"},
        ),
        ("ORG-", "ORG-spine", "ORG-thigh.L", {"ORG-pelvis.L", "ORG-heel.02.L"}),
    ],
)
def test_roles_of_a_generated_rig(rig, load, kind, hips, thigh, idle):
    names = names_of(rig, kind)
    found = load("solvers.motion").roles_by_name(names)

    assert set(found) >= HUMAN
    assert found["hips"] == hips and found["leftUpperLeg"] == thigh
    assert idle <= set(names) and not idle & set(found.values())


def test_spine_controls_turn_what_their_roles_say(rig, load):
    """The lower ones of Rigify's spine controls turn the pelvis: they have no role."""
    import bpy

    found = load("solvers.motion").roles_by_name(names_of(rig, "controls"))
    turned = {}
    for role in ("spine", "chest", "hips"):
        control = rig.pose.bones[found[role]]
        control.rotation_mode = "QUATERNION"
        bpy.context.view_layer.update()
        before = rig.pose.bones["DEF-spine"].matrix.copy()
        control.rotation_quaternion = (0.96, 0.28, 0.0, 0.0)
        bpy.context.view_layer.update()
        after = rig.pose.bones["DEF-spine"].matrix
        turned[role] = (after.to_3x3() @ before.to_3x3().inverted()).to_quaternion().angle
        control.rotation_quaternion = (1.0, 0.0, 0.0, 0.0)
    bpy.context.view_layer.update()

    assert turned["spine"] < 1e-4 and turned["chest"] < 1e-4
    assert turned["hips"] == pytest.approx(2 * np.arcsin(0.28), abs=0.01)


def test_a_walk_reaches_the_controls(rig, load):
    """On the tree of the torso: feet on the scaled path, and no flips."""
    motion, retargeting, samples = (
        load(f"solvers.{name}") for name in ("motion", "retargeting", "samples")
    )
    walk = samples.walking_gait(samples.GaitSettings(duration=3.0, frame_rate=60.0))
    skeleton = skeleton_below(rig.data.bones["torso"], motion)
    source_map = motion.find_humanoid_map(walk.skeleton)
    target_map = motion.HumanoidMap(motion.roles_by_name(names_of(rig, "controls")))

    given = retargeting.retarget(walk, source_map, skeleton, target_map)

    growth = motion.leg_length(skeleton, target_map) / motion.leg_length(
        walk.skeleton, source_map
    )
    seen, got = (motion.forward_kinematics(each) for each in (walk, given))
    theirs, ours = source_map.indices(walk.skeleton), target_map.indices(skeleton)
    for side in ("left", "right"):
        path = seen.positions[:, theirs[f"{side}Foot"]]
        found = got.positions[:, ours[f"{side}Foot"]]
        error = (found - found[0]) - growth * (path - path[0])
        assert np.linalg.norm(error, axis=1).max() < 0.01
    for role in set(theirs) & set(ours):
        turns = [
            np.abs(
                (poses.rotations[1:, joints[role]] * poses.rotations[:-1, joints[role]]).sum(-1)
            )
            for poses, joints in ((seen, theirs), (got, ours))
        ]
        more = 2 * (np.arccos(turns[1].clip(0, 1)) - np.arccos(turns[0].clip(0, 1)))
        assert np.degrees(more.max()) < 5.0, role
    keyed = np.abs(given.rotations[..., 0]).min(axis=0) < 1.0 - 1e-9
    names = {skeleton.names[joint] for joint in np.flatnonzero(keyed)}
    assert names <= set(target_map.joints.values())


def test_blender_draws_the_curves_that_unbaking_promises(blank, load):
    """Keys and handles written as they are; F-Curves evaluated by Blender itself."""
    retargeting, samples = load("solvers.retargeting"), load("solvers.samples")
    walk = samples.walking_gait(samples.GaitSettings(duration=2.0, frame_rate=30.0))
    sparse = retargeting.reduce_keys(walk, 0.01)
    curve = max(sparse.rotations, key=lambda each: len(each.frames))
    holder = blank.data.objects.new("holder", None)
    action = blank.data.actions.new("unbaked")
    slot = action.slots.new(id_type="OBJECT", name="holder")
    strip = action.layers.new("layer").strips.new(type="KEYFRAME")
    drawn = strip.channelbag(slot, ensure=True).fcurves
    frames, values = curve.handles()
    for channel in range(4):
        fcurve = drawn.new(data_path="rotation_quaternion", index=channel)
        fcurve.keyframe_points.add(len(curve.frames))
        for place, key in enumerate(fcurve.keyframe_points):
            key.interpolation = "BEZIER"
            key.handle_left_type = key.handle_right_type = "FREE"
            key.co = curve.frames[place], curve.values[place, channel]
            key.handle_left = frames[place, 0], values[place, 0, channel]
            key.handle_right = frames[place, 1], values[place, 1, channel]
        fcurve.update()
    holder.animation_data_create().action = action

    times = np.arange(0.0, walk.n_frames - 1, 0.25)
    found = np.array([[fcurve.evaluate(time) for time in times] for fcurve in drawn]).T

    np.testing.assert_allclose(found, curve.at(times), atol=2e-6)


def names_of(rig, kind):
    names = [bone.name for bone in rig.data.bones]
    if kind == "controls":
        return [name for name in names if not name.startswith(("DEF-", "ORG-", "MCH-"))]
    return [name for name in names if name.startswith(kind)]


def skeleton_below(top, motion):
    """The bones from `top` on as a skeleton."""
    bones = [top, *top.children_recursive]
    bones.sort(key=lambda bone: len(bone.parent_recursive))
    place = {bone.name: index for index, bone in enumerate(bones)}
    parents = [-1, *(place[bone.parent.name] for bone in bones[1:])]
    heads = np.array([bone.head_local for bone in bones])
    offsets = heads - np.concatenate([np.zeros((1, 3)), heads[parents[1:]]])
    return motion.Skeleton(tuple(place), tuple(parents), offsets)
