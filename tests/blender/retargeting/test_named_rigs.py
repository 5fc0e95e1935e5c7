"""A walk given to Mixamo- and Unreal-named rigs, as Blender evaluates it."""

import numpy as np
import pytest

CENTIMETER = 0.01
ANKLE_ROLL_M = 0.04
"""Ankles go along where a foot of another length rolls over its planted ball."""
SOURCE = ("LeftUpLeg", "LeftLeg", "LeftFoot", "LeftArm", "LeftForeArm", "LeftHand")
ENDS = {
    "Mixamo": tuple(f"mixamorig:{name}" for name in SOURCE),
    "Unreal": ("thigh_l", "calf_l", "foot_l", "upperarm_l", "lowerarm_l", "hand_l"),
}
RIGS = {
    "T-pose": ("Mixamo", {"prefix": "mixamorig:", "scale": 0.01}),
    "A-pose, large": ("Mixamo", {"prefix": "mixamorig:", "lowered": 0.7, "size": 1.3}),
    "A-pose with a root and twist bones": ("Unreal", {"lowered": 0.85}),
    "T-pose, small": ("Unreal", {"size": 0.6, "scale": 0.01}),
}


@pytest.fixture(params=RIGS)
def case(request, make_rig):
    family, settings = RIGS[request.param]
    return make_rig(family, **settings), ENDS[family]


def heads(poses, armature, frames, names):
    matrices = poses(armature, frames)
    return np.stack([matrices[name][:, :3, 3] for name in names], axis=1)


def length(points):
    return np.linalg.norm(np.diff(points[0], axis=0), axis=1).sum()


def test_hands_and_feet_follow_the_source(case, walker, give, poses):
    target, names = case
    frames = range(1, 61, 3)

    give(walker, target)

    ours, theirs = (
        heads(poses, *each) for each in ((target, frames, names), (walker, frames, SOURCE))
    )
    growth = length(ours[:, :3]) / length(theirs[:, :3])
    paths = [points[:, 2] - points[0, 2] for points in (ours, theirs)]
    assert np.linalg.norm(paths[0] - growth * paths[1], axis=1).max() < ANKLE_ROLL_M
    grown = length(ours[:, 3:]) / length(theirs[:, 3:])
    reach = [points[:, 5] - points[:, 3] for points in (ours, theirs)]
    assert np.linalg.norm(reach[0] - grown * reach[1], axis=1).max() < CENTIMETER


def test_joints_do_not_flip(case, walker, give, poses):
    target, names = case
    frames = range(1, 61)

    give(walker, target)

    steps = [
        np.abs(np.diff(poses(armature, frames)[name][:, :3, 1], axis=0)).max()
        / np.abs(poses(armature, frames)[name][0, :3, 1]).max()
        for armature, names in ((target, names), (walker, SOURCE))
        for name in names
    ]
    assert max(steps[:6]) < 2.0 * max(steps[6:])


def test_only_mapped_bones_are_keyed_and_the_source_stays(case, walker, give, keys_of):
    target, _ = case
    raw = walker.animation_data.action
    before = keys_of(raw)
    rest = [np.array(bone.matrix_local) for bone in target.data.bones]

    action = give(walker, target)

    assert action.name == f"{raw.name}.{target.name}"
    assert keys_of(raw) == before and walker.animation_data.action == raw
    assert all(
        (np.array(bone.matrix_local) == old).all()
        for bone, old in zip(target.data.bones, rest, strict=True)
    )
    keyed = {path.split('"')[1] for _, path, _ in keys_of(action)}
    moved = {path.split('"')[1] for _, path, _ in keys_of(action) if "location" in path}
    assert not any("twist" in name or name == "root" for name in keyed)
    assert len(moved) == 1 and moved <= {"mixamorig:Hips", "pelvis"}
    assert np.isfinite([key[:2] for keys in keys_of(action).values() for key in keys]).all()


def test_travel_is_keyed_on_the_bone_above_the_hips(make_rig, walker, give, poses):
    target, names = make_rig("Unreal", lowered=0.8), ("root", "pelvis", "hand_l", "ball_r")
    frames = range(1, 61, 5)
    give(walker, target)
    stationary = heads(poses, target, frames, names)

    give(walker, target, root_motion="ROOT_BONE")

    moved = heads(poses, target, frames, names)
    assert np.linalg.norm((moved - stationary)[:, 1:], axis=-1).max() < 1e-4
    assert np.abs(stationary[:, 0]).max() < 1e-6 and np.abs(moved[:, 0, 2]).max() < 1e-5
    distance = np.linalg.norm((moved[:, 1] - moved[:, 0])[:, :2], axis=-1)
    assert distance.max() < 0.1 and np.linalg.norm(moved[-1, 0] - moved[0, 0]) > 1.0


def test_in_place_removes_the_travel(make_rig, walker, give, poses):
    target = make_rig("Mixamo")

    give(walker, target, root_motion="IN_PLACE")

    hips = heads(poses, target, range(1, 61), ("Hips",))[:, 0]
    assert np.linalg.norm((hips - hips[0])[:, :2], axis=-1).max() < 0.15


def test_recorded_walk_is_retargeted_to_a_mixamo_rig(
    make_rig, import_bvh, recordings, give, poses
):
    source = import_bvh(recordings / "mocap" / "cmu_walk" / "07_01.bvh", 0.0254 / 0.45)
    target = make_rig("Mixamo", prefix="mixamorig:", lowered=0.7, scale=0.01)
    frames = range(1, 301, 20)

    action = give(source, target)

    assert action.frame_range[:] == source.animation_data.action.frame_range[:]
    ours, theirs = (
        heads(poses, *each)
        for each in ((target, frames, ENDS["Mixamo"]), (source, frames, SOURCE))
    )
    growth = length(ours[:, :3]) / length(theirs[:, :3])
    paths = [points[:, 2] - points[0, 2] for points in (ours, theirs)]
    assert np.linalg.norm(paths[0] - growth * paths[1], axis=1).max() < ANKLE_ROLL_M
