"""Other uses of a match: a ghost, a link, an example to learn from, an asset."""

from types import SimpleNamespace

import numpy as np
import pytest


@pytest.fixture
def ghost(load, blank):
    """The lines of the ghost at a frame."""
    drawing = load("mocap_assist.find_similar.ghost_drawing")

    def lines(frame):
        blank.context.scene.frame_set(frame)
        return drawing.ghost_now(blank.context)

    return lines


def test_ghost_of_the_identical_motion_is_on_the_query(
    find, bring, clip_files, choose, ghost, poses, blank, load, tmp_path
):
    blank.context.scene.render.fps = 30
    copy = tmp_path / "copy.bvh"
    copy.write_bytes((clip_files / "walk_0.bvh").read_bytes())
    armature = bring(copy)
    armature.location = (5.0, 0.0, 0.0)
    armature.rotation_euler, armature.rotation_mode = (0.0, 0.0, 1.0), "XYZ"
    blank.context.view_layer.update()
    find()
    choose("walk_0")

    for frame in (5, 30, 60):
        lines = ghost(frame)
        found = poses(armature, [frame])
        joints = lines.reshape(-1, 3)
        for bone in ("Hips", "LeftFoot", "RightHand", "LeftLeg"):
            head = found[bone][0][:3, 3]
            assert np.linalg.norm(joints - head, axis=-1).min() < 0.08, (bone, frame)


def test_ghost_holds_its_ends_outside_the_match(find, newcomer, ghost, load, blank):
    newcomer("squat")
    find()

    np.testing.assert_allclose(ghost(-50), ghost(1), atol=1e-6)
    np.testing.assert_allclose(ghost(500), ghost(75), atol=1e-6)


def test_there_is_no_ghost_without_a_match(ghost, blank):
    blank.context.window_manager.mocap_assist_matches.search = 0

    assert ghost(1) is None


def test_ghost_frames_follow_the_alignment(load):
    ghost, finding = (
        load("mocap_assist.find_similar.ghost"),
        load("mocap_assist.find_similar.solve_finding"),
    )
    retrieval = load("solvers.retrieval")
    pairs = np.array([[0, 10], [1, 10], [2, 10], [3, 12], [3, 14], [4, 16]])
    match = retrieval.Match("x", range(10, 17), 1.0, pairs)
    entry = retrieval.ClipEntry("x", (), None, 40, 20.0)
    postures = np.zeros((7, 20, 3), np.float32)
    found = finding.Found(entry, match, postures, 20.0, None)

    assert [ghost.clip_frame(found, frame) for frame in (-1, 1, 3, 3.5, 9)] == [
        10.0, 10.0, 13.0, 14.5, 16.0,
    ]  # fmt: skip


@pytest.fixture
def actions_found(index, blend_file, newcomer, find, bring, clip_files):
    """The library has the actions of a .blend file too; a squatting armature was the query."""
    index(blend_file)
    armature = newcomer("squat")
    find()
    return armature


@pytest.mark.parametrize("link", [True, False])
def test_an_action_is_linked_or_appended_and_played(
    actions_found, choose, blank, blend_file, link
):
    choose("shot/wave_0")

    assert blank.ops.mocap_assist.link_match(link=link) == {"FINISHED"}

    action = actions_found.animation_data.action
    assert action.name == "wave_0" and (action.library is not None) == link
    if link:
        assert blank.path.abspath(action.library.filepath) == str(blend_file)
    assert actions_found.animation_data.action_slot is not None


def test_recordings_cannot_be_linked(actions_found, choose, blank):
    choose("wave_1")

    with pytest.raises(RuntimeError, match="a recording, not an action"):
        blank.ops.mocap_assist.link_match()


def test_use_reports_a_missing_blend_file(actions_found, choose, blank, blend_file):
    played = actions_found.animation_data.action
    choose("shot/wave_0")
    blend_file.unlink()

    with pytest.raises(RuntimeError, match="was moved or deleted"):
        blank.ops.mocap_assist.link_match()
    with pytest.raises(RuntimeError, match="was moved or deleted"):
        blank.ops.mocap_assist.load_match()

    assert actions_found.animation_data.action == played


def test_clean_and_reconstruct_learn_from_the_best_matches(actions_found, blank, clip_files):
    settings = blank.context.scene.mocap_assist

    assert blank.ops.mocap_assist.learn_from_matches(n_best=3) == {"FINISHED"}
    examples = settings.clean.examples.split("; ")
    assert settings.clean.prior == "EXAMPLES" and len(examples) == 3
    assert "squat_0" in examples  # of the .blend file
    assert {str(clip_files / f"squat_{seed}.bvh") for seed in (0, 1)} <= set(examples)
    assert blank.ops.mocap_assist.denoise(plant_feet=False) == {"FINISHED"}

    blank.ops.mocap_assist.learn_from_matches(n_best=2, group="reconstruct")
    assert settings.reconstruct.postures == "EXAMPLES"
    assert len(settings.reconstruct.examples.split("; ")) == 2


def test_clips_with_missing_files_are_no_examples(actions_found, blank, clip_files, blend_file):
    for path in (*clip_files.iterdir(), blend_file):
        path.unlink()

    blank.ops.mocap_assist.learn_from_matches()

    assert blank.context.scene.mocap_assist.clean.examples == ""


def test_action_becomes_an_asset_with_catalog_tags_and_preview(
    actions_found, blank, tmp_path, choose, index, load
):
    choose("shot/wave_0")
    blank.ops.mocap_assist.load_match(part="WHOLE")
    action = actions_found.animation_data.action
    (tmp_path / "assets").mkdir()
    blank.ops.wm.save_as_mainfile(filepath=str(tmp_path / "assets" / "mine.blend"))

    done = blank.ops.mocap_assist.mark_asset(tags="best, of all", catalog="Ours/Hands")

    assert done == {"FINISHED"}
    data = action.asset_data
    assert [tag.name for tag in data.tags] == ["greeting", "Gestures/Hello", "best", "of all"]
    catalogs = load("mocap_assist.library.catalogs")
    stored = catalogs.read_catalogs(tmp_path / "assets" / "blender_assets.cats.txt")
    assert stored == {data.catalog_id: "Ours/Hands"}
    assert tuple(action.preview.image_size) == (128, 128)
    pixels = np.empty(128 * 128 * 4, np.float32)
    action.preview.image_pixels_float.foreach_get(pixels)
    colors, opacity = pixels.reshape(-1, 4)[:, :3], pixels[3::4]
    assert 0.02 < (opacity > 0.2).mean() < 0.4 and opacity.max() == 1.0
    assert opacity[:128].max() == 0.0  # a transparent margin
    assert (colors <= opacity[:, None]).all()  # else Blender draws the card as a light square


def test_asset_is_the_result_on_a_strip_and_the_dialog_names_it(newcomer, blank):
    """An action fixed by hand above it, of one bone, is no take."""
    armature = newcomer("walk")
    assert blank.ops.mocap_assist.denoise(plant_feet=False, result_as="NLA_TRACK")
    by_hand = blank.data.actions.new("fixed by hand")
    armature.animation_data.action = by_hand
    result = armature.animation_data.nla_tracks[0].strips[0].action

    named: list[str] = []
    layout = SimpleNamespace(label=lambda text, **_: named.append(text), prop=lambda *_: None)
    button = blank.types.MOCAP_ASSIST_OT_mark_asset
    button.draw(SimpleNamespace(layout=layout), blank.context)
    assert named == [result.name]
    assert blank.ops.mocap_assist.mark_asset() == {"FINISHED"}

    assert result.asset_data is not None and by_hand.asset_data is None


def test_catalogs_need_a_saved_file(newcomer, blank):
    armature = newcomer("walk")

    with pytest.raises(RuntimeError, match="Save the file first"):
        blank.ops.mocap_assist.mark_asset(catalog="Ours")

    assert armature.animation_data.action.asset_data is None
    assert blank.ops.mocap_assist.mark_asset(tags="x") == {"FINISHED"}


def test_catalog_is_added_once_and_others_stay(load, tmp_path):
    catalogs = load("mocap_assist.library.catalogs")
    file = tmp_path / catalogs.FILE
    file.write_text("# note\nVERSION 1\n\n11111111-0000-0000-0000-000000000000:A/B:A-B")

    first = catalogs.ensure_catalog(file, "C")
    again = catalogs.ensure_catalog(file, " C/ ")

    assert first == again
    assert catalogs.read_catalogs(file) == {
        "11111111-0000-0000-0000-000000000000": "A/B",
        first: "C",
    }
    assert file.read_text().startswith("# note\nVERSION 1\n")
    assert catalogs.ensure_catalog(file, "A/B") == "11111111-0000-0000-0000-000000000000"
