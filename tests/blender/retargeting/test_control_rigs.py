"""What carries controls: bones with constraints, switches of inheritance, and mixtures."""

import numpy as np
import pytest

ARM = ("LeftArm", "LeftForeArm", "LeftHand")


@pytest.fixture
def puppet(make_rig, blank):
    """A Mixamo rig whose left arm hangs on a helper that copies the chest's rotation."""
    rig = make_rig("Mixamo", "Puppet", lowered=0.6)
    blank.ops.object.mode_set(mode="EDIT")
    bones = rig.data.edit_bones
    helper = bones.new("helper")
    helper.head, helper.tail = (
        bones["LeftArm"].head,
        bones["LeftArm"].head + bones["Hips"].vector,
    )
    bones["LeftArm"].parent = helper
    helper.parent = bones["LeftShoulder"]
    blank.ops.object.mode_set(mode="OBJECT")
    return rig


def constrain(rig, kind, **settings):
    constraint = rig.pose.bones["helper"].constraints.new(kind)
    for name, value in ({"target": rig} | settings).items():
        setattr(constraint, name, value)
    return constraint


def arm_rotations(poses, rig, frames=range(1, 61, 7)):
    """Return the world rotation of each arm bone relative to its rest pose."""
    matrices = poses(rig, frames)
    return {
        name: matrices[name][:, :3, :3]
        @ np.linalg.inv(
            np.array((rig.matrix_world @ rig.data.bones[name].matrix_local).to_3x3())
        )
        for name in ARM
    }


@pytest.mark.parametrize("carrier", ["Spine2", "Head"])
def test_arm_rotations_do_not_depend_on_the_parent(carrier, puppet, walker, give, poses):
    give(walker, puppet, keep_hands=False)
    free = arm_rotations(poses, puppet)
    rest = (puppet.matrix_world @ puppet.data.bones[carrier].matrix_local).inverted()
    constrain(puppet, "CHILD_OF", subtarget=carrier, inverse_matrix=rest)
    puppet.data.bones["helper"].use_inherit_rotation = False
    give(walker, puppet, keep_hands=False)

    held = arm_rotations(poses, puppet)
    for name in ARM:
        np.testing.assert_allclose(held[name], free[name], atol=1e-3)


def test_bone_without_inherited_rotation_rotates_equally(puppet, walker, give, poses):
    give(walker, puppet, keep_hands=False)
    free = arm_rotations(poses, puppet)
    puppet.data.bones["LeftArm"].use_inherit_rotation = False

    give(walker, puppet, keep_hands=False)

    held = arm_rotations(poses, puppet)
    for name in ARM:
        np.testing.assert_allclose(held[name], free[name], atol=1e-3)


def test_partial_constraint_is_refused_by_name(puppet, walker, blank):
    constrain(puppet, "COPY_ROTATION", subtarget="Head", influence=0.5)
    blank.context.view_layer.objects.active = walker

    with pytest.raises(RuntimeError, match="Could not determine what drives LeftArm"):
        blank.ops.mocap_assist.retarget(target="Puppet")


def test_rig_in_rest_position_is_refused(puppet, walker, blank):
    puppet.data.pose_position = "REST"
    blank.context.view_layer.objects.active = walker

    with pytest.raises(RuntimeError, match="is in Rest Position, so nothing moves"):
        blank.ops.mocap_assist.retarget(target="Puppet")
