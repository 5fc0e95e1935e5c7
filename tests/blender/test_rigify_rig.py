"""A generated Rigify rig is read as a humanoid, and retargeting reaches its bones."""

import contextlib
import io

import numpy as np
import pytest

LIMBS = ("Shoulder", "UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot", "Toes")
HUMAN = {"hips", "spine", "chest", "neck", "head"} | {
    side + part for side in ("left", "right") for part in LIMBS
}


DEFORM = {
    f"{side}{part}": f"DEF-{bone}.{side[0].upper()}"
    for side in ("left", "right")
    for part, bone in (
        ("UpperArm", "upper_arm"), ("LowerArm", "forearm"), ("Hand", "hand"),
        ("UpperLeg", "thigh"), ("LowerLeg", "shin"), ("Foot", "foot"), ("Toes", "toe"),
    )
}  # fmt: skip


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
def test_generated_rig_gets_its_roles(rig, load, kind, hips, thigh, idle):
    names = names_of(rig, kind)
    found = load("solvers.motion").roles_by_name(names)

    assert set(found) >= HUMAN
    assert found["hips"] == hips and found["leftUpperLeg"] == thigh
    assert idle <= set(names) and not idle & set(found.values())


def test_spine_controls_rotate_the_bones_of_their_roles(rig, load):
    """The lower ones of Rigify's spine controls rotate the pelvis: they have no role."""
    import bpy

    found = load("solvers.motion").roles_by_name(names_of(rig, "controls"))
    angles = {}
    for role in ("spine", "chest", "hips"):
        control = rig.pose.bones[found[role]]
        control.rotation_mode = "QUATERNION"
        bpy.context.view_layer.update()
        before = rig.pose.bones["DEF-spine"].matrix.copy()
        control.rotation_quaternion = (0.96, 0.28, 0.0, 0.0)
        bpy.context.view_layer.update()
        after = rig.pose.bones["DEF-spine"].matrix
        angles[role] = (after.to_3x3() @ before.to_3x3().inverted()).to_quaternion().angle
        control.rotation_quaternion = (1.0, 0.0, 0.0, 0.0)
    bpy.context.view_layer.update()

    assert angles["spine"] < 1e-4 and angles["chest"] < 1e-4
    assert angles["hips"] == pytest.approx(2 * np.arcsin(0.28), abs=0.01)


def test_controls_follow_a_retargeted_walk(rig, load):
    """On the tree of the torso: feet on the scaled path, and no flips."""
    motion, retargeting, samples = (
        load(f"solvers.{name}") for name in ("motion", "retargeting", "samples")
    )
    walk = samples.walking_gait(samples.GaitSettings(duration=3.0, frame_rate=60.0))
    target_map = motion.HumanoidMap(motion.roles_by_name(names_of(rig, "controls")))
    skeleton = skeleton_of(rig, list(target_map.joints.values()), motion)
    source_map = motion.find_humanoid_map(walk.skeleton)

    given = retargeting.retarget(walk, source_map, skeleton, target_map)

    growth = motion.leg_length(skeleton, target_map) / motion.leg_length(
        walk.skeleton, source_map
    )
    source, retargeted = (motion.forward_kinematics(each) for each in (walk, given))
    theirs, ours = source_map.indices(walk.skeleton), target_map.indices(skeleton)
    for side in ("left", "right"):
        path = source.positions[:, theirs[f"{side}Foot"]]
        found = retargeted.positions[:, ours[f"{side}Foot"]]
        error = (found - found[0]) - growth * (path - path[0])
        # The foot is longer: its ankle goes along where it rolls over its planted ball.
        assert np.linalg.norm(error, axis=1).max() < 0.04
    for role in set(theirs) & set(ours):
        angles = [
            np.abs(
                (poses.rotations[1:, joints[role]] * poses.rotations[:-1, joints[role]]).sum(-1)
            )
            for poses, joints in ((source, theirs), (retargeted, ours))
        ]
        more = 2 * (np.arccos(angles[1].clip(0, 1)) - np.arccos(angles[0].clip(0, 1)))
        assert np.degrees(more.max()) < 5.0, role


def test_deform_bones_follow_in_blender(rig, load):
    """Compare DEF- bones after Blender has evaluated the constraints of retargeted controls."""
    import bpy

    motion, retargeting, samples = (
        load(f"solvers.{name}") for name in ("motion", "retargeting", "samples")
    )
    walk = samples.walking_gait(samples.GaitSettings(duration=2.0, frame_rate=30.0))
    roles = motion.HumanoidMap(motion.roles_by_name(names_of(rig, "controls")))
    skeleton = skeleton_of(rig, list(roles.joints.values()), motion)
    given = retargeting.retarget(walk, motion.find_humanoid_map(walk.skeleton), skeleton, roles)
    poses, joints = motion.forward_kinematics(given), roles.indices(skeleton)
    follow_the_chest(rig)

    for frame in (0, 11, 37, 59):
        pose(rig, skeleton, given, frame, roles.joints.values())
        bpy.context.view_layer.update()
        for role, deform in DEFORM.items():
            head = rig.pose.bones[deform].matrix.translation
            error = np.linalg.norm(np.array(head) - poses.positions[frame, joints[role]])
            assert error < 0.002, (frame, role)


def test_blender_curves_equal_the_unbaked_ones(blank, load):
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
        for index, key in enumerate(fcurve.keyframe_points):
            key.interpolation = "BEZIER"
            key.handle_left_type = key.handle_right_type = "FREE"
            key.co = curve.frames[index], curve.values[index, channel]
            key.handle_left = frames[index, 0], values[index, 0, channel]
            key.handle_right = frames[index, 1], values[index, 1, channel]
        fcurve.update()
    holder.animation_data_create().action = action

    times = np.arange(0.0, walk.n_frames - 1, 0.25)
    found = np.array([[fcurve.evaluate(time) for time in times] for fcurve in drawn]).T

    np.testing.assert_allclose(found, curve.at(times), atol=2e-6)


def follow_the_chest(rig):
    """FK limbs, and neck and head that rotate with the chest: only parents matter."""
    for bone in rig.pose.bones:
        for name in ("IK_FK", "neck_follow", "head_follow"):
            if name in bone:
                bone[name] = 1.0
    rig.update_tag()


def pose(rig, skeleton, motion, frame, controls):
    """Set the controls of one frame; a bone's own axes are those of its rest matrix."""
    from mathutils import Quaternion, Vector

    for name in controls:
        bone, joint = rig.pose.bones[name], skeleton.names.index(name)
        rest = bone.bone.matrix_local.to_quaternion()
        bone.rotation_mode = "QUATERNION"
        rotation = Quaternion(motion.rotations[frame, joint])
        bone.rotation_quaternion = rest.inverted() @ rotation @ rest
        if joint == 0:
            shift = Vector(motion.root_positions[frame]) - bone.bone.head_local
            bone.location = rest.inverted() @ shift


def names_of(rig, kind):
    names = [bone.name for bone in rig.data.bones]
    if kind == "controls":
        return [name for name in names if not name.startswith(("DEF-", "ORG-", "MCH-"))]
    return [name for name in names if name.startswith(kind)]


def skeleton_of(rig, names, motion):
    """These bones as a skeleton, each below the one that really carries it."""
    above = {name: carrier(rig, name, set(names)) for name in names}

    def depth(name):
        return 0 if above[name] is None else 1 + depth(above[name])

    ordered = sorted(names, key=depth)
    index_of = {name: index for index, name in enumerate(ordered)}
    heads = np.array([rig.data.bones[name].head_local for name in ordered])
    parents = [-1, *(index_of[above[name]] for name in ordered[1:])]
    offsets = heads - np.concatenate([np.zeros((1, 3)), heads[parents[1:]]])
    return motion.Skeleton(tuple(ordered), tuple(parents), offsets)


def carrier(rig, name, names):
    """The nearest of the names above; a bone that copies another in the world hangs on that."""
    bone = rig.pose.bones[name].parent
    while bone is not None and bone.name not in names:
        copied = [
            one.subtarget
            for one in bone.constraints
            if one.type == "COPY_TRANSFORMS" and one.owner_space == one.target_space == "WORLD"
        ]
        bone = rig.pose.bones[copied[0]] if len(copied) == 1 else bone.parent
    return None if bone is None else bone.name
