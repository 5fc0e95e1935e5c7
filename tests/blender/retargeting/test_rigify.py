"""A walk given to Rigify's control rig: what its deform bones do when Blender plays it."""

import numpy as np
import pytest

CENTIMETER = 0.01
ANKLE_ROLL_M = 0.04
"""Ankles go along where a foot of another length rolls over its planted ball."""
SOURCE = ("LeftUpLeg", "LeftLeg", "LeftFoot", "LeftArm", "LeftForeArm", "LeftHand")
DEFORM = ("thigh.L", "shin.L", "foot.L", "upper_arm.L", "forearm.L", "hand.L")
FRAMES = range(1, 61, 6)
LEGS, ARMS = slice(0, 3), slice(3, 6)


def heads(poses, armature, names, frames=FRAMES):
    matrices = poses(armature, frames)
    return np.stack([matrices[name][:, :3, 3] for name in names], axis=1)


def length(armature, names):
    """Of a limb at rest: Rigify's IK limbs may stretch."""
    points = [armature.matrix_world @ armature.data.bones[name].head_local for name in names]
    return np.linalg.norm(np.diff(points, axis=0), axis=1).sum()


def ends_off(poses, hero, walker):
    """How far foot and hand are from where the source's, grown with the limb, are: meters."""
    names = [f"DEF-{name}" for name in DEFORM]
    ours, theirs = heads(poses, hero, names), heads(poses, walker, SOURCE)
    legs, arms = (
        length(hero, names[limb]) / length(walker, SOURCE[limb]) for limb in (LEGS, ARMS)
    )
    feet = [points[:, 2] - points[0, 2] for points in (ours, theirs)]
    hands = [points[:, 5] - points[:, 3] for points in (ours, theirs)]
    return (
        np.linalg.norm(feet[0] - legs * feet[1], axis=1).max(),
        np.linalg.norm(hands[0] - arms * hands[1], axis=1).max(),
    )


@pytest.mark.parametrize("limbs", ["FK", "IK", "BOTH"])
def test_hands_and_feet_follow_the_source(limbs, hero, walker, give, poses):
    give(walker, hero, limbs=limbs)

    feet, hands = ends_off(poses, hero, walker)
    assert feet < ANKLE_ROLL_M and hands < CENTIMETER


@pytest.mark.parametrize("limbs", ["FK", "IK"])
def test_joints_do_not_flip(limbs, hero, walker, give, poses):
    frames = range(1, 61)

    give(walker, hero, limbs=limbs)

    def steps(armature, names):
        found = poses(armature, frames)
        rotations = np.stack([found[name][:, :3, :3] for name in names], axis=1)
        rotations /= np.linalg.norm(rotations, axis=-2, keepdims=True)
        cosine = (np.einsum("fjab,fjab->fj", rotations[1:], rotations[:-1]) - 1.0) / 2.0
        return np.degrees(np.arccos(cosine.clip(-1.0, 1.0))).max(axis=0)

    ours = steps(hero, [f"DEF-{name}" for name in DEFORM])
    assert (ours < steps(walker, SOURCE) + 5.0).all()


@pytest.mark.parametrize("limbs", ["FK", "IK"])
def test_rigify_rig_can_be_the_source(limbs, hero, walker, give, poses, make_rig):
    """Where its body is depends on constraints: the pose that Blender shows is read."""
    give(walker, hero, limbs=limbs)
    target = make_rig("Mixamo", prefix="mixamorig:")

    give(hero, target)

    bones = ("LeftUpLeg", "LeftFoot", "LeftArm", "LeftHand")
    ours = heads(poses, target, [f"mixamorig:{bone}" for bone in bones])
    theirs = heads(poses, walker, bones)
    for start, end in ((0, 1), (2, 3)):
        directions = [unit(points[:, end] - points[:, start]) for points in (ours, theirs)]
        angles = np.degrees(
            np.arccos((directions[0] * directions[1]).sum(axis=1).clip(-1.0, 1.0))
        )
        assert angles.max() < 6.0


def unit(vectors):
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def test_fk_and_ik_keys_give_the_same_pose(hero, walker, give, poses, blank):
    action = give(walker, hero, limbs="BOTH")
    by_fk = heads(poses, hero, [f"DEF-{name}" for name in DEFORM])

    for curve in action.layers[0].strips[0].channelbags[0].fcurves:
        if "IK_FK" in curve.data_path:
            assert [key.co.y for key in curve.keyframe_points] == [1.0]
            curve.keyframe_points[0].co.y = 0.0
            curve.update()
    by_ik = heads(poses, hero, [f"DEF-{name}" for name in DEFORM])

    distances = np.linalg.norm(by_fk - by_ik, axis=-1).max(axis=0)
    assert distances[[2, 5]].max() < 0.1 * CENTIMETER
    assert 0.0 < distances[[1, 4]].max() < 4 * CENTIMETER  # Rigify's IK limbs stretch a little


def test_body_rotates_as_solved(hero, walker, give, load, blank):
    """Every mapped part is where the solver wants it, which its own tests judge."""
    retargeting = load("mocap_assist.retarget.scene_retargeting")
    button_settings = load("mocap_assist.retarget.button_settings")
    solvers = load("solvers.retargeting")
    motion = load("solvers.motion")
    give(walker, hero)
    settings = button_settings.RetargetBundle(
        button_settings.RetargetChoices(target="Hero"), solvers.RetargetSettings()
    )
    solve = retargeting.read_retarget(blank.context.scene, walker, settings)
    problem = solve.args[0]
    target = problem.target
    wanted = motion.forward_kinematics(
        solvers.retarget(
            problem.clips[0].on_stage(), problem.roles, target.skeleton, target.humanoid
        )
    )
    for frame in FRAMES:
        blank.context.scene.frame_set(frame)
        for role, name in target.humanoid.joints.items():
            joint = target.skeleton.names.index(name)
            there = np.array(hero.matrix_world @ hero.pose.bones[name].head)
            assert np.linalg.norm(there - wanted.positions[frame - 1, joint]) < 0.001, role


def test_only_controls_are_keyed_and_the_rig_stays(hero, walker, give, keys_of):
    before = {
        bone.name: (np.array(bone.matrix_basis).tolist(), dict(numbers(bone)))
        for bone in hero.pose.bones
    }

    action = give(walker, hero)

    paths = {path for _, path, _ in keys_of(action)}
    keyed = {path.split('"')[1] for path in paths}
    assert not any(name.startswith(("DEF-", "ORG-", "MCH-")) for name in keyed)
    assert {"torso", "spine_fk", "upper_arm_fk.L", "foot_fk.R", "head"} <= keyed
    assert not any("f_index" in name for name in keyed)
    assert 'pose.bones["thigh_parent.L"]["IK_FK"]' in paths
    after = {
        bone.name: (np.array(bone.matrix_basis).tolist(), dict(numbers(bone)))
        for bone in hero.pose.bones
        if bone.name not in keyed
    }
    assert after == {name: before[name] for name in after}


def test_travel_is_keyed_on_the_root_bone(hero, walker, give, poses):
    give(walker, hero)
    names = [f"DEF-{name}" for name in DEFORM]
    before = heads(poses, hero, names)

    give(walker, hero, root_motion="ROOT_BONE")

    root = heads(poses, hero, ["root"])[:, 0]
    assert np.linalg.norm(heads(poses, hero, names) - before, axis=-1).max() < CENTIMETER
    assert np.abs(root[:, 2]).max() < 1e-5
    hips = heads(poses, hero, ["DEF-spine"])[:, 0]
    assert np.linalg.norm((hips - root)[:, :2], axis=1).max() < 0.3
    assert np.linalg.norm(root[-1] - root[0]) > 1.0


@pytest.mark.parametrize("how", ["overridden", "appended"])
def test_moved_and_rotated_rig_walks_from_there(how, bring, walker, give, poses):
    hero = bring(how)
    give(walker, hero)
    names = [f"DEF-{name}" for name in DEFORM]
    here = heads(poses, hero, names)

    hero.location, hero.rotation_euler = (3.0, 1.0, 0.5), (0.0, 0.0, 0.7)
    give(walker, hero)

    rotation = np.array([
        [np.cos(0.7), -np.sin(0.7), 0],
        [np.sin(0.7), np.cos(0.7), 0],
        [0, 0, 1],
    ])
    moved = here @ rotation.T + (3.0, 1.0, 0.5)
    assert np.linalg.norm(heads(poses, hero, names) - moved, axis=-1).max() < 0.001


def test_linked_rig_gets_actions_and_plays_none(bring, walker, blank, keys_of, give):
    hero = bring("linked")
    blank.context.view_layer.objects.active = walker

    assert blank.ops.mocap_assist.retarget(target=hero.name) == {"FINISHED"}

    made = blank.data.actions[f"{walker.animation_data.action.name}.Hero"]
    assert made.library is None and keys_of(made)
    assert hero.animation_data is None or hero.animation_data.action is None


def numbers(bone):
    return {name: value for name, value in bone.items() if isinstance(value, (int, float))}
