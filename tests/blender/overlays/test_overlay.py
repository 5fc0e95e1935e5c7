"""The overlay's stick figures stand where Blender puts the bones."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

FRAMES = (1, 17, 60)


@pytest.fixture
def overlay(load):
    found = load("mocap_assist.overlays.comparison.figures")
    found.forget()
    return found


def source_of(armature):
    animation = armature.animation_data
    return animation.action, animation.action_slot


@pytest.mark.parametrize("mode", ["QUATERNION", "XYZ", "ZYX", "AXIS_ANGLE"])
def test_heads_and_tails_equal_blenders_pose(blank, overlay, make_armature, animate, mode):
    armature = make_armature(mode=mode)
    animate(armature, locations=True)

    figures = overlay.read_figures(armature, source_of(armature), range(1, 61))

    assert set(figures.bones) == set(armature.pose.bones.keys())
    for frame in FRAMES:
        blank.context.scene.frame_set(frame)
        for index, name in enumerate(figures.bones):
            bone = armature.pose.bones[name]
            assert_allclose(figures.heads[frame - 1, index], bone.head, atol=2e-6)
            assert_allclose(figures.tails[frame - 1, index], bone.tail, atol=2e-6)


def test_lines_are_bones_and_links_of_unconnected_bones(overlay, actor):
    figures = overlay.figures_at(actor, source_of(actor), 17)

    lines = figures.segments(17)

    free = [each for each in actor.data.bones if each.parent and not each.use_connect]
    assert lines.shape == (len(actor.data.bones) + len(free), 2, 3)
    assert_allclose(lines[0], [figures.heads[16, 0], figures.tails[16, 0]])


def test_overlay_holds_the_ends_of_the_action(overlay, actor):
    figures = overlay.figures_at(actor, source_of(actor), 1000)

    assert_allclose(figures.segments(-5), figures.segments(1))
    assert_allclose(figures.segments(1000), figures.segments(60))


def test_missing_bone_and_its_descendants_are_not_drawn(overlay, actor):
    action, slot = source_of(actor)
    for curve in action.layers[0].strips[0].channelbag(slot).fcurves:
        if '"LeftArm"' in curve.data_path:
            for key in reversed(curve.keyframe_points):
                if 20 <= key.co.x < 40:
                    curve.keyframe_points.remove(key)
            curve.update()

    figures = overlay.figures_at(actor, (action, slot), 30)

    complete, gapped = figures.segments(10), figures.segments(30)
    # Missing: the tail of the arm and the forearm. Present: the head of the arm and its link.
    assert len(complete) - len(gapped) == 2


def test_a_long_action_is_read_in_blocks(overlay, actor, monkeypatch):
    monkeypatch.setattr(overlay, "BLOCK_POSES", 25 * len(actor.data.bones))

    blocks = [overlay.figures_at(actor, source_of(actor), frame) for frame in (25, 26, 60)]

    assert [block.start for block in blocks] == [1, 26, 51]
    assert [len(block.heads) for block in blocks] == [25, 25, 10]


def test_keys_are_read_once_for_any_number_of_blocks(overlay, actor, monkeypatch):
    complete = overlay.read_figures(actor, source_of(actor), range(1, 61))
    read, read_keys = [], overlay.read_keys
    monkeypatch.setattr(overlay, "BLOCK_POSES", 10 * len(actor.data.bones))
    monkeypatch.setattr(
        overlay, "read_keys", lambda source: read.append(source) or read_keys(source)
    )

    for frame in (5, 15, 25, 60, 5):
        block = overlay.figures_at(actor, source_of(actor), frame)
        assert_allclose(block.segments(frame), complete.segments(frame), atol=1e-6)

    assert read == [source_of(actor)]


@pytest.mark.parametrize("length", [1, 7, 25])
def test_gap_stays_a_gap_for_any_block_length(overlay, actor, monkeypatch, length):
    action, slot = source_of(actor)
    for curve in action.layers[0].strips[0].channelbag(slot).fcurves:
        if '"LeftArm"' in curve.data_path:
            for key in reversed(curve.keyframe_points):
                if 10 <= key.co.x < 50:
                    curve.keyframe_points.remove(key)
            curve.update()
    complete = overlay.read_figures(actor, (action, slot), range(1, 61))
    monkeypatch.setattr(overlay, "BLOCK_POSES", length * len(actor.data.bones))

    for frame in (1, 9, 10, 30, 49, 50, 60):
        block = overlay.figures_at(actor, (action, slot), frame)
        assert_allclose(block.segments(frame), complete.segments(frame), atol=1e-6)
    assert len(complete.segments(30)) < len(complete.segments(9))


def test_raw_and_clean_are_found_from_each_other(blank, load, overlay, actor):
    raw = actor.animation_data.action
    assert overlay.raw_and_clean(actor) == ((raw, raw.slots[0]), None)
    assert blank.ops.mocap_assist.denoise(plant_feet=False) == {"FINISHED"}
    clean = actor.animation_data.action
    pair = ((raw, raw.slots[0]), (clean, clean.slots[0]))

    assert overlay.raw_and_clean(actor) == pair
    assert blank.ops.mocap_assist.revert_to_raw() == {"FINISHED"}
    assert overlay.raw_and_clean(actor) == pair


def test_cache_has_no_blender_data(overlay, actor):
    overlay.figures_at(actor, source_of(actor), 17)

    ((key, figures),) = overlay._cache.items()

    (keys,) = overlay._keys.values()
    assert all(type(part) in {int, range} for part in key)
    assert all(type(each) is np.ndarray for each in keys.values())
    assert all(type(name) is str for name in figures.bones)


def test_loading_another_file_clears_the_cache(blank, overlay, actor):
    overlay.figures_at(actor, source_of(actor), 17)

    blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)

    assert not overlay._cache


def test_edited_keys_are_read_again_after_a_pause(blank, load, overlay, actor):
    refresh = load("mocap_assist.overlays.comparison.drawing").refresh
    old = overlay.figures_at(actor, source_of(actor), 17)
    bone = actor.pose.bones["LeftArm"]
    bone.rotation_quaternion = (0.0, 1.0, 0.0, 0.0)
    bone.keyframe_insert("rotation_quaternion", frame=17)
    blank.context.view_layer.update()
    assert overlay.figures_at(actor, source_of(actor), 17) is old
    assert blank.app.timers.is_registered(refresh)
    refresh()  # timers run only where there is a window

    new = overlay.figures_at(actor, source_of(actor), 17)
    assert np.abs(new.tails[16] - old.tails[16]).max() > 0.01


def test_playback_does_not_read_again(blank, overlay, actor):
    overlay.figures_at(actor, source_of(actor), 1)

    for frame in FRAMES:
        blank.context.scene.frame_set(frame)

    assert len(overlay._cache) == 1


def test_cache_size_is_limited(overlay, actor, animate, monkeypatch):
    monkeypatch.setattr(overlay, "MAX_CACHED", 5)
    for _ in range(overlay.MAX_CACHED + 3):
        animate(actor)
        overlay.figures_at(actor, source_of(actor), 1)

    assert len(overlay._cache) == overlay.MAX_CACHED
    assert len(overlay._keys) == overlay.MAX_CACHED_ACTIONS
