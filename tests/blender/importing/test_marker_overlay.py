"""The overlay's markers and trails stand where Blender puts the empties."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

TOLERANCE_M = 2e-6
N_MARKERS = 8
GAP = slice(40, 70)
FRAMES = (1, 20, 90)


@pytest.fixture
def overlay(load):
    found = load("mocap_assist.overlays.comparison.markers")
    found.forget()
    return found


@pytest.fixture
def holder(recordings, load, rng, tmp_path, bring, blank):
    """A hundred frames of eight markers with 3 mm of noise; one is lost for half a second."""
    module = load("solvers.recordings")
    take = module.read_recording(recordings / "mocap" / "05_13.c3d")
    tracks = load("solvers.motion").Tracks(
        take.names[:N_MARKERS], take.positions[:200:2, :N_MARKERS].copy(), 60.0
    )
    tracks.positions[...] += rng.normal(scale=0.003, size=tracks.positions.shape)
    tracks.positions[GAP, 1] = np.nan
    path = tmp_path / "take.trc"
    module.write_trc(tracks, path)
    blank.context.scene.render.fps = 60
    return bring(path)


def crosses(lines, n_markers=N_MARKERS):
    """Middles of the crosses, which come first, three lines each."""
    return lines[: 3 * n_markers].reshape(n_markers, 6, 3).mean(axis=1)


def world_positions(blank, markers, frame):
    blank.context.scene.frame_set(frame)
    return [each.matrix_world.translation for each in markers]


def test_crosses_stand_where_the_empties_do(blank, overlay, holder):
    holder.location, holder.rotation_euler = (1.0, 2.0, 3.0), (0.3, 0.2, 1.0)
    holder.scale = (2.0, 2.0, 2.0)
    blank.context.view_layer.update()
    raw, clean = overlay.raw_and_clean(holder)

    assert not clean.markers
    assert len(overlay.lines_at(clean, blank.context.scene)) == 0
    for frame in FRAMES:
        positions = world_positions(blank, raw.markers, frame)
        lines = overlay.lines_at(raw, blank.context.scene)
        assert_allclose(crosses(lines), positions, atol=10 * TOLERANCE_M)


def test_trails_go_through_the_positions_at_adjacent_frames(blank, overlay, holder):
    raw, _ = overlay.raw_and_clean(holder)
    blank.context.scene.frame_set(20)

    lines = overlay.lines_at(raw, blank.context.scene)

    trails = lines[3 * N_MARKERS :].reshape(-1, N_MARKERS, 2, 3)
    assert len(trails) == 24  # 0.2 s at 60 frames a second, to either side
    assert_allclose(trails[0, :, 0], world_positions(blank, raw.markers, 8), atol=TOLERANCE_M)
    assert_allclose(trails[-1, :, 1], world_positions(blank, raw.markers, 32), atol=TOLERANCE_M)
    assert_allclose(trails[:-1, :, 1], trails[1:, :, 0])


def test_a_gap_is_drawn_filled_where_it_was_cleaned_only(blank, overlay, holder):
    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}
    raw, clean = overlay.raw_and_clean(holder)
    blank.context.scene.frame_set(56)

    raw_lines = overlay.lines_at(raw, blank.context.scene)
    clean_lines = overlay.lines_at(clean, blank.context.scene)

    complete = N_MARKERS * (3 + 24)
    assert len(raw_lines) == complete - (3 + 24)
    assert len(clean_lines) == complete
    played = world_positions(blank, clean.markers, 56)
    assert_allclose(crosses(clean_lines), played, atol=TOLERANCE_M)


def test_raw_and_clean_of_each_marker_are_found_from_either(blank, overlay, holder):
    recorded, _ = overlay.raw_and_clean(holder)
    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}

    pair = overlay.raw_and_clean(holder)

    assert pair[0] == recorded
    assert all(action.name.endswith(".clean") for action, _ in pair[1].sources)
    for (_, raw_slot), (_, clean_slot) in zip(recorded.sources, pair[1].sources, strict=True):
        assert raw_slot.handle == clean_slot.handle
    assert blank.ops.mocap_assist.revert_to_raw() == {"FINISHED"}
    assert overlay.raw_and_clean(holder) == pair


def test_before_and_after_the_take_its_ends_are_shown(blank, overlay, holder):
    raw, _ = overlay.raw_and_clean(holder)
    blank.context.scene.frame_set(500)

    lines = overlay.lines_at(raw, blank.context.scene)

    assert_allclose(crosses(lines), world_positions(blank, raw.markers, 100), atol=TOLERANCE_M)


def test_keys_are_read_once_until_they_are_edited(blank, load, overlay, holder):
    raw, _ = overlay.raw_and_clean(holder)
    old = overlay.trails_at(raw, 1.0, 12)
    assert overlay.trails_at(raw, 1.0, 12) is old
    marker = raw.markers[0]
    marker.location = (9.0, 9.0, 9.0)
    marker.keyframe_insert("location", frame=20)
    blank.context.view_layer.update()
    refresh = load("mocap_assist.overlays.comparison.drawing").refresh
    assert blank.app.timers.is_registered(refresh)
    refresh()  # timers run only where there is a window

    new = overlay.trails_at(overlay.raw_and_clean(holder)[0], 1.0, 12)

    assert_allclose(new.positions[19, 0], 9.0)


def test_another_file_makes_it_forget(blank, overlay, holder):
    overlay.trails_at(overlay.raw_and_clean(holder)[0], 1.0, 12)

    blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)

    assert not overlay._cache


def test_cache_is_limited(overlay, holder, monkeypatch):
    monkeypatch.setattr(overlay, "MAX_CACHED", 3)
    raw, _ = overlay.raw_and_clean(holder)
    for count in range(1, N_MARKERS + 1):
        overlay.trails_at(
            overlay.ComparedMarkers(raw.markers[:count], raw.sources[:count]), 1.0, 12
        )

    assert len(overlay._cache) == overlay.MAX_CACHED


def test_distant_key_is_drawn_without_frames_between(blank, overlay, holder):
    raw, _ = overlay.raw_and_clean(holder)
    marker, (action, _) = raw.markers[0], raw.sources[0]
    curve = action.layers[0].strips[0].channelbags[0].fcurves[0]
    assert marker.animation_data.action == action
    curve.keyframe_points.insert(1_000_000, 0.0)
    blank.context.scene.frame_set(1)

    lines = overlay.lines_at(raw, blank.context.scene)

    assert len(lines) > 3 * N_MARKERS
    assert all(len(block.positions) < 2000 for block in overlay._cache.values())
