"""What the options of Import do, and what the button does with files that it cannot read."""

import pytest
from numpy.testing import assert_allclose

TOLERANCE_M = 1e-5  # meters; bones and keys are 32-bit numbers
WALK = "07_01.bvh"  # 317 frames at 120 Hz
N_FRAMES, RATE = 317, 120.0


@pytest.fixture
def walk(recordings):
    return recordings / "mocap" / "cmu_walk" / WALK


@pytest.mark.parametrize(
    ("choice", "first", "last", "n_keys", "fps"),
    [
        ("SCALE", 1.0, 1.0 + (N_FRAMES - 1) * 24 / RATE, N_FRAMES, 24.0),
        ("RESAMPLE", 1.0, 64.0, 64, 24.0),
        ("UPDATE", 1.0, N_FRAMES, N_FRAMES, RATE),
        ("ONE", 1.0, N_FRAMES, N_FRAMES, 24.0),
    ],
)
def test_scene_keeps_its_rate_unless_the_setting_changes_it(
    choice, first, last, n_keys, fps, walk, bring, key_times, blank
):
    render = blank.context.scene.render
    render.fps = 24

    times = key_times(bring(walk, frame_rate=choice))

    assert (times[0], len(times)) == (first, n_keys)
    assert times[-1] == pytest.approx(last)
    assert render.fps / render.fps_base == pytest.approx(fps)


def test_the_scene_is_extended_on_demand_and_never_shortened(walk, bring, blank):
    scene = blank.context.scene
    scene.render.fps, scene.frame_end = 24, 40

    bring(walk, frame_rate="SCALE", update_scene_duration=True, frame_start=11)
    assert scene.frame_end == 11 + 64

    bring(walk, frame_rate="SCALE", update_scene_duration=True)
    assert scene.frame_end == 11 + 64


def test_a_resampled_walk_shows_the_same_seconds(walk, bring, poses, blank):
    blank.context.scene.render.fps = 24
    every = poses(bring(walk, frame_rate="SCALE"), range(5, 60, 7))
    some = poses(bring(walk, frame_rate="RESAMPLE"), range(5, 60, 7))

    for name, matrices in every.items():
        assert_allclose(some[name][:, :3, 3], matrices[:, :3, 3], atol=0.03)


@pytest.mark.parametrize("length", [1.0, 0.01])
def test_a_body_is_as_tall_as_it_was_whatever_the_scenes_unit(length, walk, bring, blank):
    blank.context.scene.unit_settings.scale_length = length

    armature = bring(walk, global_scale=2.0)

    tall = max(bone.head_local.z for bone in armature.data.bones) * length
    low = min(bone.head_local.z for bone in armature.data.bones) * length
    assert 2.0 * 1.2 < tall - low < 2.0 * 2.1


@pytest.mark.parametrize("mode", ["QUATERNION", "XYZ", "ZYX"])
def test_every_rotation_mode_shows_the_same_walk(mode, walk, bring, poses):
    expected = poses(bring(walk), [3, 40])

    armature = bring(walk, rotate_mode=mode)

    assert {bone.rotation_mode for bone in armature.pose.bones} == {mode}
    for name, matrices in poses(armature, [3, 40]).items():
        assert_allclose(matrices[:, :3, 3], expected[name][:, :3, 3], atol=TOLERANCE_M)


def test_many_files_come_at_once_and_stand_for_themselves(walk, recordings, bring, blank):
    others = sorted(walk.parent.glob("*.bvh"))[:4]

    bring(*others)

    chosen = blank.context.view_layer.objects.selected
    assert sorted(each.name for each in chosen) == sorted(path.stem for path in others)
    assert len({each.animation_data.action for each in chosen}) == len(others)


def test_the_first_file_sets_the_rate_and_others_are_resampled(
    walk, recordings, bring, key_times, blank, tmp_path
):
    other = recordings / "formats" / "bvh" / "test_mocapbank.bvh"  # 455 frames at 30 Hz
    for path in (other, walk):
        (tmp_path / path.name).write_bytes(path.read_bytes())

    bring(tmp_path / other.name, tmp_path / walk.name, frame_rate="UPDATE")

    first, second = (blank.data.objects[name] for name in ("test_mocapbank", "07_01"))
    assert blank.context.scene.render.fps == 30
    assert key_times(first)[-1] == 455.0
    n_keys = 1 + int((N_FRAMES - 1) * 30.0 / RATE)
    assert list(key_times(second)) == list(range(1, n_keys + 1))


def test_one_bad_file_does_not_keep_the_others_out(walk, tmp_path, blank):
    good = tmp_path / "good.bvh"
    good.write_bytes(walk.read_bytes())
    (tmp_path / "bad.bvh").write_bytes(walk.read_bytes()[:9000])
    (tmp_path / "odd.txt").write_text("hello")
    files = [{"name": name} for name in ("bad.bvh", "good.bvh", "odd.txt")]

    with pytest.raises(RuntimeError, match=r"(?s)2 of 3 files failed.*bad\.bvh.*odd\.txt"):
        blank.ops.mocap_assist.import_recording(directory=str(tmp_path), files=files)

    assert [each.name for each in blank.data.objects] == ["good"]
    assert [each.name for each in blank.data.actions] == ["good"]
    assert len(blank.data.armatures) == 1


def test_failed_import_leaves_nothing(walk, blank, load, monkeypatch):
    objects, errors = load("mocap_assist.importing.recording_objects"), load("solvers.errors")
    before = blank.context.scene.render.fps

    def fail(*_, **__):
        raise errors.InvalidMotionError("Half way.")

    monkeypatch.setattr(objects, "write_motion", fail)
    with pytest.raises(RuntimeError, match=r"07_01\.bvh: Half way"):
        blank.ops.mocap_assist.import_recording(filepath=str(walk), frame_rate="UPDATE")

    assert not (blank.data.objects or blank.data.armatures or blank.data.actions)
    assert blank.context.scene.render.fps == before


def test_import_reports_that_no_file_was_chosen(blank):
    with pytest.raises(RuntimeError, match="No file was chosen"):
        blank.ops.mocap_assist.import_recording()


def test_pose_mode_and_hidden_collections_are_no_obstacle(walk, bring, blank):
    first = bring(walk)
    hidden = blank.data.collections.new("Hidden")
    blank.context.scene.collection.children.link(hidden)
    layer = blank.context.view_layer.layer_collection.children["Hidden"]
    blank.context.view_layer.active_layer_collection = layer
    layer.hide_viewport = True
    blank.ops.object.mode_set(mode="POSE")

    second = bring(walk)

    assert second != first
    assert second.visible_get()
    assert first.mode == "OBJECT"


def test_an_acclaim_skeleton_may_be_dropped_along_with_its_recording(recordings, bring, blank):
    folder = recordings / "mocap"

    bring(folder / "05.asf", folder / "05_13.amc")

    assert [each.name for each in blank.data.objects] == ["05_13"]


def test_undo_is_one_step(walk, blank):
    window = blank.context.window
    with blank.context.temp_override(window=window, screen=window.screen):
        blank.ops.ed.undo_push(message="before")
        blank.ops.mocap_assist.import_recording(filepath=str(walk))
        blank.ops.ed.undo_push(message="import")
        assert blank.data.objects
        blank.ops.ed.undo()

    assert not blank.data.objects
    assert not blank.data.actions


def test_small_files_are_read_together_and_large_ones_alone(load):
    batches_by_size = load("mocap_assist.jobs.batches").batches_by_size

    parted = list(batches_by_size([40, 60, 1, 300, 0, 99, 0], int, 100))

    assert parted == [[40, 60], [1], [300], [0, 99, 0]]
    assert list(batches_by_size([], int, 100)) == []
