"""Clean, Check and Revert work on marker empties, as they do on armatures."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

TOLERANCE_M = 1e-5  # meters; keys are 32-bit numbers
N_MARKERS = 12
GAP = slice(60, 90)


@pytest.fixture
def true_tracks(recordings, load):
    """Two seconds of twelve markers of a walk, complete, at 60 Hz."""
    tracks = load("solvers.recordings").read_recording(recordings / "mocap" / "05_13.c3d")
    motion = load("solvers.motion")
    complete = np.flatnonzero(tracks.visible.all(axis=0))[:N_MARKERS]
    names = tuple(tracks.names[point] for point in complete)
    few = motion.Tracks(names, tracks.positions[:, complete], tracks.frame_rate)
    return motion.resample(few, 60.0).slice(0, 150)


@pytest.fixture
def bad_tracks(true_tracks, rng):
    """The same with 3 mm of noise; the second marker is lost for half a second."""
    positions = true_tracks.positions + rng.normal(
        scale=0.003, size=true_tracks.positions.shape
    )
    positions[GAP, 1] = np.nan
    positions[:10, 2] = positions[11:, 2] = np.nan  # seen once
    return true_tracks.with_positions(positions)


@pytest.fixture
def file(bad_tracks, load, tmp_path):
    path = tmp_path / "walk.trc"
    load("solvers.recordings").write_trc(bad_tracks, path)
    return path


@pytest.fixture
def holder(file, bring):
    return bring(file)


@pytest.fixture
def read(load, blank):
    markers = load("mocap_assist.actions.markers.take")
    return lambda holder, **how: markers.read_markers(holder, blank.context.scene, **how)


def in_order(take, tracks):
    return [take.tracks.names.index(name) for name in tracks.names]


@pytest.mark.parametrize(("fps", "unit"), [(24, 1.0), (60, 0.01), (240, 1.0)])
def test_markers_read_back_as_they_were_recorded(
    fps, unit, file, bad_tracks, bring, read, blank, markers_of
):
    blank.context.scene.render.fps = fps
    blank.context.scene.unit_settings.scale_length = unit

    holder = bring(file)

    size = markers_of(holder)[0].matrix_world.translation.length * unit
    assert 0.1 < size < 10.0
    take = read(holder)

    found = take.tracks.positions[:, in_order(take, bad_tracks)]
    assert take.tracks.frame_rate == pytest.approx(60.0)
    assert_allclose(found, bad_tracks.positions, atol=TOLERANCE_M)


def test_markers_are_read_in_the_world(holder, bad_tracks, read):
    holder.location, holder.scale = (1.0, 2.0, 3.0), (2.0, 2.0, 2.0)

    take = read(holder)

    found = take.tracks.positions[:, in_order(take, bad_tracks)]
    assert_allclose(found, 2.0 * bad_tracks.positions + (1.0, 2.0, 3.0), atol=2 * TOLERANCE_M)


def test_clean_fills_and_smooths_markers_and_revert_restores_raw(
    holder, true_tracks, bad_tracks, read, keys_of, blank, markers_of
):
    raw = markers_of(holder)[0].animation_data.action
    recorded = keys_of(raw)

    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}

    played = {each.animation_data.action for each in markers_of(holder)}
    assert [action.name for action in played] == ["walk.clean"]
    take = read(holder)
    found = take.tracks.positions[:, in_order(take, true_tracks)]
    misses = np.linalg.norm(found - true_tracks.positions, axis=-1)
    noise = np.linalg.norm(bad_tracks.positions - true_tracks.positions, axis=-1)
    assert np.isfinite(found).all()
    assert np.delete(misses, 2, axis=1).mean() < 0.75 * np.nanmean(noise)
    assert misses[GAP, 1].mean() < 0.05
    assert keys_of(raw) == recorded

    assert blank.ops.mocap_assist.revert_to_raw() == {"FINISHED"}

    assert {each.animation_data.action for each in markers_of(holder)} == {raw}
    again = read(holder)
    assert_allclose(
        again.tracks.positions[:, in_order(again, bad_tracks)],
        bad_tracks.positions,
        atol=TOLERANCE_M,
    )


def test_only_the_selected_markers_change(holder, keys_of, blank, markers_of):
    chosen = markers_of(holder)[3]
    raw = keys_of(chosen.animation_data.action)
    for each in blank.context.view_layer.objects:
        each.select_set(each == chosen)
    blank.context.view_layer.objects.active = chosen

    assert blank.ops.mocap_assist.denoise(bones="SELECTED") == {"FINISHED"}

    cleaned = keys_of(chosen.animation_data.action)
    changed = {
        slot
        for slot, *_ in raw
        if any(cleaned[key] != raw[key] for key in raw if key[0] == slot)
    }
    assert changed == {chosen.animation_data.action_slot.identifier}


def test_cleaning_again_starts_from_what_was_recorded(holder, keys_of, blank, markers_of):
    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}
    first = keys_of(markers_of(holder)[0].animation_data.action)

    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}

    action = markers_of(holder)[0].animation_data.action
    assert action.name == "walk.clean.001"
    assert keys_of(action) == first


def test_check_lists_issues_and_jumps_to_the_marker(holder, blank):
    assert blank.ops.mocap_assist.measure_quality() == {"FINISHED"}

    issues = blank.context.scene.mocap_assist.issues
    gap = next(index for index, issue in enumerate(issues) if issue.kind == "gap")
    assert blank.ops.mocap_assist.jump_to_issue(index=gap) == {"FINISHED"}
    active = blank.context.view_layer.objects.active
    assert active["mocap_assist_point"] == issues[gap].name


def test_buttons_for_armatures_give_a_reason(holder, blank):
    with pytest.raises(RuntimeError, match="Select an animated armature"):
        blank.ops.mocap_assist.plant_feet()


def test_an_empty_without_markers_is_no_take(blank):
    lone = blank.data.objects.new("Lone", None)
    blank.context.scene.collection.objects.link(lone)
    blank.context.view_layer.objects.active = lone

    with pytest.raises(RuntimeError, match="marker set"):
        blank.ops.mocap_assist.denoise()


def test_markers_have_no_keys_of_bones_to_thin_out(holder, blank):
    assert blank.ops.mocap_assist.denoise.poll()
    with pytest.raises(RuntimeError, match="Select an animated armature"):
        blank.ops.mocap_assist.reduce_keys()


@pytest.mark.parametrize("button", ["denoise", "measure_quality"])
@pytest.mark.parametrize("only_one", [True, False])
def test_markers_of_nan_only_are_named(holder, blank, button, only_one, markers_of):
    for marker in markers_of(holder)[: 1 if only_one else None]:
        animation = marker.animation_data
        bag = animation.action.layers[0].strips[0].channelbag(animation.action_slot)
        for curve in bag.fcurves:
            for key in curve.keyframe_points:
                key.co.y = np.nan

    with pytest.raises(RuntimeError, match="nothing was captured") as refusal:
        getattr(blank.ops.mocap_assist, button)()
    assert f"All keys of {markers_of(holder)[0].name}" in str(refusal.value)
    assert (markers_of(holder)[1].name in str(refusal.value)) != only_one


def test_a_marker_that_stands_nowhere_now_is_named(holder, blank, markers_of):
    markers_of(holder)[0].scale.x = np.nan

    with pytest.raises(RuntimeError, match=r"scale of .* is not a number"):
        blank.ops.mocap_assist.denoise()
