"""Track from Here reads the displayed pose, or says what prevents it."""

import numpy as np
import pytest
from mathutils import Quaternion

ARM = "rightUpperArm"
ROTATION = Quaternion((0.0, 1.0, 0.0), 0.5)


@pytest.fixture
def read(made, load, blank):
    """Read the scene as the button does; return the frame and the pose to constrain."""
    retracking = load("mocap_assist.track.retracking")
    settings = retracking.RetrackBundle(load("solvers.depth_tracking").RetrackSettings())

    def read():
        blank.context.view_layer.update()
        problem = retracking.read_retracking(blank.context.scene, made.armature, settings)
        return problem.args[1]

    return read


@pytest.fixture
def edit(made, blank):
    """Call something with the bones in Edit Mode."""

    def edit(change):
        blank.ops.object.mode_set(mode="EDIT")
        change(made.armature.data.edit_bones)
        blank.ops.object.mode_set(mode="OBJECT")

    return edit


@pytest.fixture
def refused(read, load):
    """Expect a sentence."""

    def refused(sentence):
        with pytest.raises(load("solvers.errors").InvalidMotionError, match=sentence):
            read()

    return refused


def test_rotated_bones_and_moved_hips_are_read_as_displayed(made, read, load, blank):
    from mathutils import Matrix

    made.armature.matrix_world = Matrix.Scale(2.0, 4) @ made.armature.matrix_world
    bones = made.armature.pose.bones
    bones["hips"].location.x += 0.3
    bones[ARM].rotation_quaternion = ROTATION @ bones[ARM].rotation_quaternion
    correction = read()
    assert correction.frame == 4
    space = load("mocap_assist.track.tracked_armature.body")
    moved = load("solvers.depth_tracking.body.motion")
    frames = moved.motion_frames(made.body, correction.pose)[0]
    to_armature = space.armature_from_motion(made.armature, made.body)
    expected = to_armature @ moved.scene_from_camera(None) @ frames
    shown = space.posed_frames(made.armature, made.body)
    np.testing.assert_allclose(shown, expected, atol=1e-4)


def test_constrained_bone_is_named(made, refused, blank):
    target = blank.data.objects.new("target", None)
    blank.context.collection.objects.link(target)
    target.location = (0.6, 2.4, 1.4)
    pulled = made.armature.pose.bones["rightLowerArm"].constraints.new("IK")
    pulled.target, pulled.chain_count = target, 2
    refused(f"{ARM} of wall tracked .* its rotations place it")


@pytest.mark.parametrize("bone", ["rightShoulder", "leftUpperLeg"])
def test_moved_joint_is_named(bone, made, refused):
    made.armature.pose.bones[bone].location = (0.0, 0.2, 0.0)
    refused(f"{bone} of wall tracked .* its rotations place it")


def test_scaled_bone_is_refused(made, refused):
    made.armature.pose.bones["chest"].scale = (1.3, 1.3, 1.3)
    refused("chest of wall tracked .* its rotations place it")


def test_rotated_extra_bone_is_refused(made, edit, refused, read):
    def put_between(bones):
        new = bones.new("twist")
        new.head, new.tail = bones["rightShoulder"].head, bones["rightShoulder"].tail
        new.parent, bones[ARM].parent = bones["rightShoulder"], new

    edit(put_between)
    read()
    made.armature.pose.bones["twist"].rotation_quaternion = (0.9, 0.43, 0.0, 0.0)
    refused(f"{ARM} of wall tracked .* its rotations place it")


def test_bones_without_inherited_rotation_are_refused(made, refused):
    bones = made.armature.pose.bones
    bones["rightShoulder"].rotation_quaternion = ROTATION
    made.armature.data.bones[ARM].use_inherit_rotation = False
    refused(f"{ARM} of wall tracked .* its rotations place it")


def test_copy_of_a_bone_does_not_replace_it(made, edit, read, read_take, blank):
    before = read().pose.rotations

    def double(bones):
        blank.ops.armature.select_all(action="SELECT")
        blank.ops.armature.duplicate()
        assert f"{ARM}.001" in bones

    edit(double)
    np.testing.assert_allclose(read().pose.rotations, before, atol=1e-6)
    assert read_take(made).bones["hips"] == "hips"


def test_armature_in_rest_position_is_named(made, refused):
    made.armature.data.pose_position = "REST"
    refused("wall tracked shows its rest pose")
