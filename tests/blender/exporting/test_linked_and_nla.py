"""Export of a linked rig and its override, and of what lies on the NLA."""

import pytest
from armature_fixtures import BONES
from numpy.testing import assert_allclose

MILLIMETER = 1e-3
FRAMES = range(1, 61, 10)


@pytest.fixture
def rig_file(walk, blank, tmp_path):
    """The walking figure in a file of its own; the scene is empty afterwards."""
    path = tmp_path / "rig.blend"
    blank.data.libraries.write(str(path), {walk})
    blank.data.batch_remove([walk, walk.data, *blank.data.actions])
    return path


def linked(blank, path):
    with blank.data.libraries.load(str(path), link=True) as (_, found):
        found.objects = ["Actor"]
    (rig,) = found.objects
    blank.context.scene.collection.objects.link(rig)
    return rig


def chosen(blank, armature):
    blank.context.view_layer.objects.active = armature
    armature.select_set(True)
    blank.context.view_layer.update()
    return armature


@pytest.mark.parametrize(
    ("overridden", "ending"), [(False, "fbx"), (True, "bvh")], ids=["linked", "overridden"]
)
def test_a_linked_rig_is_exported(rig_file, blank, export, bring, heads, overridden, ending):
    rig = linked(blank, rig_file)
    if overridden:
        rig = rig.override_hierarchy_create(blank.context.scene, blank.context.view_layer)
    chosen(blank, rig)
    expected = heads(rig, FRAMES, BONES)
    before = {each.name_full for each in blank.data.objects}

    path = export(f"out.{ending}")

    assert {each.name_full for each in blank.data.objects} == before
    back = bring(path)

    assert_allclose(heads(back, FRAMES, BONES), expected, atol=MILLIMETER)


def test_strips_are_refused_with_advice(walk, blank, export):
    animation = walk.animation_data
    action, slot = animation.action, animation.action_slot
    animation.action = None
    strip = animation.nla_tracks.new().strips.new("walk", 1, action)
    strip.action_slot = slot
    chosen(blank, walk)

    with pytest.raises(RuntimeError, match="plays NLA strips, not an action"):
        export()

    strip.mute = True
    with pytest.raises(RuntimeError, match="has no action"):
        export()


def test_a_result_on_a_track_is_exported(walk, blank, export, bring, heads):
    chosen(blank, walk)
    assert blank.ops.mocap_assist.denoise(plant_feet=False, result_as="NLA_TRACK") == {
        "FINISHED"
    }
    expected = heads(walk, FRAMES, BONES)

    back = bring(export("out.fbx"))

    assert_allclose(heads(back, FRAMES, BONES), expected, atol=MILLIMETER)
