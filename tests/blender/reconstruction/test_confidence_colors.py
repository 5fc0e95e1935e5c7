"""Confidence colors: from the action, at each frame."""

import numpy as np
import pytest
from kinect_walks import OCCLUDED_FRAMES

INSIDE = OCCLUDED_FRAMES.start + 15


@pytest.fixture
def colors(load):
    return load("mocap_assist.overlays.confidence_colors")


def of_bone(armature, shown, name):
    """Colors of a bone's head and tail."""
    return shown.colors[[bone.name for bone in armature.pose.bones].index(name)]


def test_hidden_arm_is_red_and_the_other_blue(walk, reconstruct, colors):
    reconstruct()

    shown = colors.colored_bones_at(walk, INSIDE)
    before = colors.colored_bones_at(walk, 5)

    red, _, blue, _ = of_bone(walk, shown, "WristLeft")[0]
    assert red > 0.6 and blue < 0.4
    red, _, blue, _ = of_bone(walk, shown, "WristRight")[0]
    assert red < 0.8 and blue > 0.4
    assert of_bone(walk, before, "WristLeft")[0][2] > of_bone(walk, shown, "WristLeft")[0][2]


def test_bone_blends_into_the_color_of_the_next(walk, reconstruct, colors):
    reconstruct()

    shown = [
        colors.colored_bones_at(walk, frame)
        for frame in range(OCCLUDED_FRAMES.start - 10, INSIDE)
    ]

    arms = np.array([of_bone(walk, each, "ShoulderLeft") for each in shown])
    elbows = np.array([of_bone(walk, each, "ElbowLeft")[0] for each in shown])
    assert np.allclose(arms[:, 1], elbows)
    assert np.abs(arms[:, 0] - arms[:, 1]).max() > 0.2


def test_lines_follow_the_posed_bones(walk, reconstruct, colors, blank):
    reconstruct()
    blank.context.scene.frame_set(INSIDE)

    shown = colors.colored_bones_at(walk, INSIDE)

    for bone, (head, tail) in zip(walk.pose.bones, shown.ends, strict=True):
        assert np.allclose(head, bone.head, atol=1e-6)
        assert np.allclose(tail, bone.tail, atol=1e-6)


def test_recording_without_a_reconstruction_has_no_colors(walk, colors, blank):
    assert colors.colored_bones_at(walk, 5) is None

    blank.ops.mocap_assist.denoise(plant_feet=False)

    assert colors.colored_bones_at(walk, 5) is None


@pytest.mark.parametrize(("reliability", "channel"), [(0.0, 0), (1.0, 2)])
def test_shades_go_from_red_to_blue(colors, reliability, channel):
    assert np.argmax(colors.color_from_reliability(reliability)[:3]) == channel


def test_unknown_reliability_is_gray(colors):
    red, green, blue, _ = colors.color_from_reliability(np.nan)

    assert red == green == blue


def test_color_switch_does_not_change_the_scene(walk, reconstruct, blank):
    reconstruct()
    bones = [bone.color.palette for bone in walk.pose.bones]

    blank.context.window_manager.mocap_assist_confidence = True

    assert [bone.color.palette for bone in walk.pose.bones] == bones
    blank.context.window_manager.mocap_assist_confidence = False
