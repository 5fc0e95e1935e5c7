"""A match becomes an action of the armature, or a strip of its NLA."""

import json

import numpy as np
import pytest

PLAIN = {"at_query": False, "part": "WHOLE"}


@pytest.fixture
def load_match(blank):
    def press(**settings):
        assert blank.ops.mocap_assist.load_match(**settings) == {"FINISHED"}
        return blank.context.object.animation_data.action

    return press


def test_loaded_clip_equals_the_recording_on_the_same_body(
    find, newcomer, load_match, choose, poses, bring, clip_files, blank
):
    armature = newcomer("wave")
    find()
    choose("walk_0")
    # The file of a rig that is gone matters to actions without a rig alone.
    blank.context.scene.mocap_assist.library.rig_file = "//gone.blend"
    action = load_match(**PLAIN)
    found = poses(armature, [1, 20, 60])
    blank.context.view_layer.objects.active = bring(clip_files / "walk_0.bvh")
    expected = poses(blank.context.object, [1, 20, 60])

    assert action.name == f"walk_0.{armature.name}"
    for bone in ("Hips", "LeftFoot", "RightHand", "Head"):
        np.testing.assert_allclose(
            found[bone][:, :3, 3], expected[bone][:, :3, 3], atol=0.03, err_msg=bone
        )


def test_matching_frames_start_at_the_position_of_the_query(
    find, newcomer, load_match, blank, load, poses
):
    armature = newcomer("walk", seconds=6.0)
    blank.context.scene.frame_set(1)
    find()
    search, match = load("mocap_assist.find_similar.searches").chosen_match(blank.context)
    start = search.scene_frame(match.pairs[0, 0])
    before = poses(armature, [start])["Hips"][0]

    action = load_match()

    first, last = action.frame_range
    assert first == start
    assert abs((last - first + 1) - len(match.match.frames)) <= 1
    after = poses(armature, [start])["Hips"][0]
    np.testing.assert_allclose(after[:2, 3], before[:2, 3], atol=0.03)
    facing = after[:3, :3] @ np.linalg.inv(before[:3, :3])
    assert np.degrees(np.arctan2(facing[1, 0], facing[0, 0])) == pytest.approx(0.0, abs=12.0)


@pytest.mark.parametrize("heading", [0.0, 2.0])
def test_loaded_match_starts_at_the_query_for_any_armature_heading(
    find, newcomer, load_match, blank, poses, heading, load
):
    armature = newcomer("squat")
    armature.location, armature.rotation_euler = (3.0, -2.0, 0.0), (0.0, 0.0, heading)
    armature.rotation_mode = "XYZ"
    blank.context.view_layer.update()
    find()
    search, match = load("mocap_assist.find_similar.searches").chosen_match(blank.context)
    frame = search.scene_frame(match.pairs[0, 0])
    before = poses(armature, [frame])["Hips"][0]

    load_match()

    after = poses(armature, [frame])["Hips"][0]
    np.testing.assert_allclose(after[:2, 3], before[:2, 3], atol=0.02)
    assert np.dot(after[:3, 0], before[:3, 0]) > 0.97


def test_match_is_retargeted_to_another_rig(
    find, newcomer, load_match, choose, make_armature, blank, poses, bring, clip_files
):
    newcomer("wave")
    find()
    choose("wave_1")
    actor = make_armature(name="Hero")
    blank.context.view_layer.objects.active = actor

    action = load_match(**PLAIN)

    assert action.name == "wave_1.Hero"
    frames = np.arange(1, 70, 3)
    recorded = bring(clip_files / "wave_1.bvh")
    for bone in ("RightForeArm", "LeftForeArm"):
        found = poses(actor, frames)[bone][:, :3, 1]
        expected = poses(recorded, frames)[bone][:, :3, 1]
        assert (found * expected).sum(axis=-1).min() > 0.97, bone


def test_clip_of_a_blend_file_is_loaded(
    blank, blend_file, index, newcomer, find, load_match, choose
):
    index(blend_file)
    newcomer("squat")
    find()
    choose("shot/squat_0")

    action = load_match(**PLAIN)

    assert tuple(action.frame_range) == (1.0, 75.0)
    noted = json.loads(action["mocap_assist_clip"])
    assert (noted["file"], noted["item"]) == (str(blend_file), "squat_0")


def test_strip_starts_at_the_current_frame_with_the_query_timing(find, newcomer, blank, load):
    armature = newcomer("walk")
    played = armature.animation_data.action
    find()
    search, match = load("mocap_assist.find_similar.searches").chosen_match(blank.context)
    blank.context.scene.frame_set(40)

    assert blank.ops.mocap_assist.load_match(result_as="NLA_TRACK") == {"FINISHED"}

    assert armature.animation_data.action is None
    below, above = armature.animation_data.nla_tracks
    assert (below.strips[0].action, tuple(below.strips[0].action.frame_range)) == (
        played,
        (below.strips[0].frame_start, below.strips[0].frame_end),
    )
    (strip,) = above.strips
    n_query = (match.pairs[-1, 0] - match.pairs[0, 0]) * search.step
    assert strip.frame_start == 40.0
    assert strip.frame_end - strip.frame_start == pytest.approx(n_query, abs=1.5)
    assert strip.action_slot is not None


def test_loaded_clip_keeps_its_duration_at_the_scene_rate(
    find, newcomer, load_match, choose, blank
):
    newcomer("walk")
    find()
    choose("walk_0")
    blank.context.scene.render.fps = 60

    action = load_match(**PLAIN)

    assert np.ptp(action.frame_range) == pytest.approx(2 * 74, abs=1)


def test_load_reports_a_changed_or_deleted_file(find, newcomer, blank, clip_files):
    armature = newcomer("walk")
    played = armature.animation_data.action
    find()
    name = blank.context.window_manager.mocap_assist_matches.rows[0].name
    path = clip_files / f"{name}.bvh"
    lines = path.read_text().splitlines()
    cut = next(number for number, line in enumerate(lines) if line.startswith("Frames:"))
    lines[cut] = "Frames: 3"
    path.write_text("\n".join(lines[: cut + 5]) + "\n")

    with pytest.raises(RuntimeError, match=r"has changed\. Build the library again"):
        blank.ops.mocap_assist.load_match()
    path.unlink()
    with pytest.raises(RuntimeError, match="was moved or deleted"):
        blank.ops.mocap_assist.load_match()

    assert armature.animation_data.action == played


def test_load_reports_a_missing_search(newcomer, blank):
    newcomer("walk")
    listed = blank.context.window_manager.mocap_assist_matches
    listed.rows.clear()
    listed.search = 0

    with pytest.raises(RuntimeError, match="Press Find Similar"):
        blank.ops.mocap_assist.load_match()
