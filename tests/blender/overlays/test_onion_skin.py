"""Ghosts are poses of other frames, trails follow hands and feet, a wipe has two halves."""

import numpy as np
import pytest
from numpy.testing import assert_allclose


@pytest.fixture
def onion_skin(load):
    load("mocap_assist.overlays.comparison.drawing").forget()
    return load("mocap_assist.overlays.comparison.onion_skin")


@pytest.fixture
def overlay(load):
    return load("mocap_assist.overlays.comparison.figures")


def source_of(armature):
    animation = armature.animation_data
    return animation.action, animation.action_slot


def test_ghosts_are_poses_of_nearby_frames_and_fade(onion_skin, overlay, actor):
    onion = onion_skin.Onion(n_ghosts=2, step=5)
    figures = overlay.figures_at(actor, source_of(actor), 30)

    found = onion_skin.onion_at(actor, source_of(actor), 30.2, onion)

    ghosts = np.concatenate([figures.segments(frame) for frame in (20, 25, 35, 40)])
    assert_allclose(found.lines[: len(ghosts)], ghosts)
    far, near, *_ = found.alphas[: len(ghosts), 0].reshape(4, -1)
    assert 0.0 < far.max() < near.min() < 1.0
    assert onion_skin.onion_at(actor, source_of(actor), 30.4, onion) is found


def test_trails_follow_the_feet_frame_by_frame(onion_skin, overlay, actor):
    onion = onion_skin.Onion(n_ghosts=1, step=4)
    figures = overlay.figures_at(actor, source_of(actor), 30)
    n_ghost_lines = 2 * len(figures.segments(30))

    found = onion_skin.onion_at(actor, source_of(actor), 30, onion)

    feet = [figures.bones.index(name) for name in ("LeftFoot", "RightFoot")]
    trails = found.lines[n_ghost_lines:].reshape(8, 2, 2, 3)  # frames, feet, ends, axes
    assert_allclose(trails[:, :, 0], figures.heads[25:33, feet])
    assert_allclose(trails[:, :, 1], figures.heads[26:34, feet])


def test_ghosts_end_with_the_action(onion_skin, overlay, actor):
    onion = onion_skin.Onion(n_ghosts=3, step=5)
    n_lines = len(overlay.figures_at(actor, source_of(actor), 1).segments(1))

    assert len(onion_skin.onion_at(actor, source_of(actor), 1, onion).lines) == (
        3 * n_lines + 2 * 15
    )
    assert not len(onion_skin.onion_at(actor, source_of(actor), 500, onion).lines)


def test_long_take_has_the_same_ghosts_across_blocks(onion_skin, overlay, actor, monkeypatch):
    onion = onion_skin.Onion(n_ghosts=3, step=5)
    complete = onion_skin.onion_at(actor, source_of(actor), 30, onion)
    overlay.forget()
    onion_skin.forget()
    monkeypatch.setattr(overlay, "BLOCK_POSES", 7 * len(actor.data.bones))

    in_blocks = onion_skin.onion_at(actor, source_of(actor), 30, onion)

    assert_allclose(in_blocks.lines, complete.lines, atol=1e-6)
    assert_allclose(in_blocks.alphas, complete.alphas)


def test_edited_action_is_read_again(load, onion_skin, actor):
    onion = onion_skin.Onion(n_ghosts=1, step=1)
    found = onion_skin.onion_at(actor, source_of(actor), 30, onion)

    load("mocap_assist.overlays.comparison.drawing").refresh()

    assert onion_skin.onion_at(actor, source_of(actor), 30, onion) is not found


@pytest.mark.parametrize("position", [0.0, 0.3, 1.0])
def test_halves_of_a_wipe_cover_the_view_once(load, position):
    half_of = load("mocap_assist.overlays.comparison.wipe").half_of

    left, right = (half_of((10, 20, 301, 200), position, left=each) for each in (True, False))

    assert left[0] == 10 and left[0] + left[2] == right[0]
    assert left[2] + right[2] == 301 and right[0] + right[2] == 311
    assert left[1::2] == right[1::2] == (20, 200)


@pytest.mark.usefixtures("all_panels")
def test_settings_and_colors_are_shown_while_a_switch_is_on(blank, draw, load, monkeypatch):
    manager = blank.context.window_manager
    monkeypatch.setattr(manager, "mocap_assist_raw_curves", False)
    shown = draw("MOCAP_PT_compare")
    assert {"mocap_assist_onion", "mocap_assist_wipe"} <= set(shown)
    assert not {"mocap_assist_onion_ghosts", "mocap_assist_wipe_position", "raw_color"} & set(
        shown
    )

    manager.mocap_assist_onion = manager.mocap_assist_wipe = True
    try:
        shown = draw("MOCAP_PT_compare")
        look = load("mocap_assist.overlays.comparison.switches").current_look(manager)
    finally:
        manager.mocap_assist_onion = manager.mocap_assist_wipe = False

    assert {"mocap_assist_onion_step", "mocap_assist_wipe_position", "raw_color"} <= set(shown)
    assert look.has_poses and look.wipe == 0.5 and look.onion == (3, 5)
