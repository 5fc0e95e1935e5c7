"""Find Similar: which clips are similar to an action, and in which frames."""

import numpy as np
import pytest


@pytest.mark.parametrize("kind", ["walk", "wave", "squat"])
def test_clips_of_the_same_kind_rank_first(find, newcomer, kind):
    newcomer(kind)

    rows = find()

    assert len(rows) == 6
    assert {row.name for row in rows[:2]} == {f"{kind}_0", f"{kind}_1"}
    scores = [row.score for row in rows]
    assert scores == sorted(scores, reverse=True) and scores[2] < scores[1]
    assert all(1 <= row.start < row.stop <= 75 for row in rows)


def test_identical_motion_has_the_highest_score(find, bring, clip_files, tmp_path):
    copy = tmp_path / "copy.bvh"
    copy.write_bytes((clip_files / "walk_0.bvh").read_bytes())
    bring(copy)

    best = find()[0]

    assert best.name == "walk_0" and best.score > 0.9


def test_find_leaves_out_the_source_of_the_query(find, bring, clip_files):
    bring(clip_files / "wave_0.bvh")

    assert "wave_0" not in {row.name for row in find()}


def test_selected_bones_limit_the_search_to_their_parts(find, newcomer, blank, load):
    armature = newcomer("wave")
    parts = load("mocap_assist.find_similar.chosen_parts")
    compat = load("mocap_assist.blender.compat")
    for bone in armature.pose.bones:
        compat.select_bone(bone, bone.name in {"RightArm", "RightHand", "Spine"})
    settings = load("solvers.retrieval").FindSettings()
    reading = load("mocap_assist.actions.armature_read")
    skeleton = reading.read_take(armature, blank.context.scene).parts[0].motion.skeleton
    chosen = parts.parts_of_bones(skeleton, {"RightArm", "RightHand", "Spine"}, settings)

    assert (chosen.trunk, chosen.right_arm) == (True, True)
    assert not (chosen.left_arm or chosen.left_leg or chosen.right_leg)
    assert find(bones="SELECTED")
    with pytest.raises(load("solvers.errors").InvalidMotionError, match="selected bones"):
        parts.parts_of_bones(skeleton, {"Unknown"}, settings)


def test_preview_range_limits_the_query(find, newcomer, blank, bring, load, tmp_path):
    armature = newcomer("walk", seconds=8.0)
    scene = blank.context.scene
    scene.use_preview_range = True
    scene.frame_preview_start, scene.frame_preview_end = 61, 120

    find(frame_range="PREVIEW")

    search = load("mocap_assist.find_similar.searches").listed_search(blank.context)
    assert (search.start, search.step) == (61.0, 1.0)
    assert len(search.finding.stage.positions) == 60
    assert search.query == armature.animation_data.action.name


def test_alignment_covers_query_and_match(find, newcomer, blank, load):
    newcomer("squat")
    find()
    search = load("mocap_assist.find_similar.searches").listed_search(blank.context)

    for found in search.finding.found:
        pairs = found.pairs
        assert (np.diff(pairs, axis=0) >= 0).all()
        assert pairs[0, 0] == 0 and pairs[-1, 0] >= 72
        assert found.match.frames == range(pairs[0, 1], pairs[-1, 1] + 1)


def test_thumbnails_show_the_clip(find, newcomer, blank, load):
    newcomer("squat")
    find()
    search = load("mocap_assist.find_similar.searches").listed_search(blank.context)
    pictures = [found.picture for found in search.finding.found]

    assert {picture.shape for picture in pictures} == {(128, 128, 3)}
    inked = [(picture < 200).any(axis=-1).mean() for picture in pictures]
    assert min(inked) > 0.02 and max(inked) < 0.4
    assert (pictures[0] != pictures[-1]).any()


def test_camera_joints_can_be_a_query_as_armature_and_as_empties(
    find, blank, recordings, index
):
    take = recordings / "kinect" / "irds" / "215_18_5_8_1_stand.txt"
    for target in ("ARMATURE", "OBJECT"):
        blank.ops.mocap_assist.import_recording(filepath=str(take), target=target)
        assert len(find()) == 6


def test_find_reports_a_missing_library(blank, newcomer, tmp_path):
    newcomer("walk")
    blank.context.scene.mocap_assist.library.library_file = str(tmp_path / "none.library")

    with pytest.raises(RuntimeError, match=r"There is no clip library .*none\.library"):
        blank.ops.mocap_assist.find_similar()


def test_find_is_disabled_without_the_shared_library(blank, newcomer, load, monkeypatch):
    newcomer("walk")
    monkeypatch.setattr(load("mocap_assist.library.sources"), "SHARED", "never indexed.clips")

    with pytest.raises(RuntimeError, match="There is no library yet"):
        blank.ops.mocap_assist.find_similar()


def test_find_refuses_a_damaged_library(blank, newcomer, tmp_path):
    newcomer("walk")
    broken = tmp_path / "broken.library"
    broken.write_bytes(b"SQLite format 3\0" + bytes(200))
    blank.context.scene.mocap_assist.library.library_file = str(broken)

    with pytest.raises(RuntimeError, match=r"broken\.library"):
        blank.ops.mocap_assist.find_similar()


def test_find_refuses_an_armature_without_a_body(blank, find, make_armature, animate):
    armature = make_armature(bones={"Lid": (None, (0, 0, 0), (0, 0, 1), False)}, name="Box")
    animate(armature)

    with pytest.raises(RuntimeError, match="no joint for"):
        find()


def test_find_does_not_change_the_scene(find, newcomer, blank, keys_of):
    armature = newcomer("walk")
    action = armature.animation_data.action
    before = (keys_of(action), sorted(blank.data.actions.keys()))

    find()

    assert (
        keys_of(armature.animation_data.action),
        sorted(blank.data.actions.keys()),
    ) == before
