"""Reconstruct gives the bones of a Kinect v2 armature the lengths of the corrected joints."""

import numpy as np
import pytest

STANDING = 5
"""Frame in which the actor stands."""
LEGS = {"LLowLeg": "LKNE", "RLowLeg": "RKNE", "LFoot": "LANK", "RFoot": "RANK"}
"""Bones and the markers where they begin."""


@pytest.fixture
def take(load, recordings):
    """Return the Kinect's recording and the optical markers of a take, and its file."""
    path = recordings / "kinect" / "ui_prmd" / "m01_s02_e01.npz"
    return *load("solvers.recordings.joint_files.ui_prmd").read_ui_prmd_pair(path), path


@pytest.fixture
def heads(blank):
    """Return where the bones of an armature begin in some frame, by Blender itself."""

    def read(armature, frame):
        blank.context.scene.frame_set(frame)
        return {bone.name: np.array(bone.head) for bone in armature.pose.bones}

    return read


def at(markers, name):
    return markers.positions[STANDING - 1, markers.names.index(name)]


def test_knees_reach_the_markers_and_the_recorded_action_stays(take, bring, reconstruct, heads):
    _, markers, path = take
    armature = bring(path)
    recorded = armature.animation_data.action
    raw = heads(armature, STANDING)

    reconstruct()

    clean = heads(armature, STANDING)
    near, far = (
        np.mean([np.linalg.norm(each[bone] - at(markers, name)) for bone, name in LEGS.items()])
        for each in (clean, raw)
    )
    assert near < 0.5 * far
    armature.animation_data.action = recorded
    armature.animation_data.action_slot = recorded.slots[0]
    for bone, head in heads(armature, STANDING).items():
        np.testing.assert_allclose(head, raw[bone], atol=1e-5)


def test_lengths_are_those_of_the_motion_that_is_read_again(
    take, bring, reconstruct, heads, load, blank
):
    armature = bring(take[-1])
    reconstruct()

    read = load("mocap_assist.actions.armature_read").read_take(armature, blank.context.scene)

    body = read.parts[0].motion
    positions = load("solvers.motion").forward_kinematics(body).positions[STANDING - 1]
    before = heads(armature, STANDING)
    for name, position in zip(body.skeleton.names, positions, strict=True):
        np.testing.assert_allclose(position, before[name], atol=1e-4)


def test_bones_keep_their_lengths_without_the_offset(take, bring, reconstruct):
    bring(take[-1])

    action = reconstruct(shift=False)

    curves = action.layers[0].strips[0].channelbags[0].fcurves
    lengths = [
        curve.keyframe_points[0].co.y
        for curve in curves
        if curve.data_path.endswith("location") and '"Waist"' not in curve.data_path
    ]
    np.testing.assert_allclose(lengths, 0.0, atol=1e-6)
