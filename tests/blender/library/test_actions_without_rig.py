"""Actions in a .blend file without their rig; another file has the rig."""

import numpy as np
import pytest


@pytest.fixture
def alone(blank, blend_file):
    """A file with the actions walk_0 and wave_0, and no armature."""
    path = blend_file.parent / "actions" / "alone.blend"
    path.parent.mkdir()
    blank.ops.wm.open_mainfile(filepath=str(blend_file))
    for name in ("walk_0", "wave_0"):
        blank.data.actions[name].use_fake_user = True
    blank.data.actions.remove(blank.data.actions["squat_0"])
    blank.data.batch_remove([*blank.data.objects, *blank.data.armatures])
    blank.ops.wm.save_as_mainfile(filepath=str(path), copy=True)
    blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    return path


def test_index_refuses_actions_without_their_rig(index, entries, alone):
    done = index(alone)

    assert len(done.refused) == 2 and entries() == {}
    assert all("no armature in the file has the bones" in message for message in done.refused)
    assert all("choose a rig file" in message for message in done.refused)


def test_actions_become_clips_with_a_rig_file(
    index, entries, alone, blend_file, load, tmp_path
):
    index(blend_file)
    done = index(alone, rig=blend_file)

    assert done.refused == () and done.n_added == 2
    with load("solvers.retrieval").load_clip_library(tmp_path / "clips.library") as library:
        numbers = {entry.name: number for number, entry in library.numbered().items()}
        for name in ("walk_0", "wave_0"):
            found = library.postures(numbers[f"alone/{name}"]).positions
            expected = library.postures(numbers[f"shot/{name}"]).positions
            np.testing.assert_allclose(found, expected, atol=1e-6)


def test_index_reports_a_rig_with_other_bones(
    index, entries, alone, blank, make_armature, animate, tmp_path
):
    armature = make_armature(name="Plain")
    animate(armature)
    for bone in armature.data.bones:
        bone.name = f"other {bone.name}"
    other = tmp_path / "plain.blend"
    blank.ops.wm.save_as_mainfile(filepath=str(other), copy=True)

    done = index(alone, rig=other)

    assert entries() == {} and len(done.refused) == 2
    assert all(f"nor in {other}, has the bones" in message for message in done.refused)


def test_unreadable_rig_file_excludes_no_other_clips(
    index, entries, alone, blend_file, tmp_path
):
    broken = tmp_path / "broken.blend"
    broken.write_bytes(b"no blend file at all")

    done = index(blend_file, alone, rig=broken)

    assert len(entries()) == 3 and len(done.refused) == 3
    assert done.refused[0].startswith(f"{broken} cannot be read for its rig")


def test_match_is_appended_with_its_rig(alone, find, index, blend_file, newcomer, blank):
    index(alone, rig=blend_file)
    armature = newcomer("wave")
    library = blank.context.scene.mocap_assist.library
    find()
    listed = blank.context.window_manager.mocap_assist_matches
    listed.active = [row.name for row in listed.rows].index("alone/walk_0")

    with pytest.raises(RuntimeError, match="choose a rig file"):
        blank.ops.mocap_assist.load_match()
    library.rig_file = str(alone.parent / "gone.blend")
    with pytest.raises(RuntimeError, match=r"gone.blend, does not exist"):
        blank.ops.mocap_assist.load_match()

    library.rig_file = str(blend_file)
    assert blank.ops.mocap_assist.load_match() == {"FINISHED"}
    assert "walk_0" in armature.animation_data.action.name
