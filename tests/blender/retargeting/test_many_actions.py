"""Many actions at once, linked ones, gaps, and what cannot be done."""

import json

import numpy as np
import pytest


@pytest.fixture
def target(make_rig, walker, blank):
    rig = make_rig("Mixamo")
    blank.context.view_layer.objects.active = walker
    return rig


def made_of(bpy, operation="retarget"):
    found = []
    for action in bpy.data.actions:
        entries = json.loads(action.get("mocap_assist_history", "[]"))
        if entries and entries[-1]["operation"] == operation:
            found.append(action)
    return found


def test_all_matching_actions_are_retargeted_in_one_step(target, walker, give, blank, keys_of):
    raw = walker.animation_data.action
    for name in ("run", "jump"):
        raw.copy().name = name
    blank.data.actions.new("lamp")

    give(walker, target, takes="ALL")

    made = made_of(blank)
    names = {f"{name}.Mixamo" for name in (raw.name, "run", "jump")}
    assert {action.name for action in made} == names
    assert all(action.use_fake_user for action in made)
    assert len({json.dumps(sorted(keys_of(action).items(), key=str)) for action in made}) == 1


def test_actions_of_the_target_are_no_sources(target, walker, give, blank):
    """Both have bones of the same names."""
    for _ in range(2):
        give(walker, target, takes="ALL")

    assert not any("Mixamo.Mixamo" in action.name for action in blank.data.actions)
    assert len(made_of(blank)) == 2


def test_only_listed_actions_are_retargeted(target, walker, give, blank):
    raw = walker.animation_data.action
    for name in ("run", "jump"):
        raw.copy().name = name

    give(walker, target, takes="LISTED", actions=f"jump; {raw.name}")

    assert {action.name for action in made_of(blank)} == {"jump.Mixamo", f"{raw.name}.Mixamo"}


def test_linked_action_is_retargeted_and_remembered(target, walker, give, blank, tmp_path):
    raw = walker.animation_data.action
    raw.name = "linked walk"
    blank.data.libraries.write(str(tmp_path / "clips.blend"), {raw})
    blank.data.actions.remove(raw)
    with blank.data.libraries.load(str(tmp_path / "clips.blend"), link=True) as (_, found):
        found.actions = ["linked walk"]
    linked = blank.data.actions["linked walk"]
    assert linked.library is not None

    action = give(walker, target, takes="LISTED", actions="linked walk")

    assert action.name == "linked walk.Mixamo" and action.library is None
    assert action["mocap_assist_given_by"] == linked


def test_result_stores_its_settings_and_source(target, walker, give):
    action = give(walker, target, root_motion="IN_PLACE")

    entry = json.loads(action["mocap_assist_history"])[-1]
    assert entry["settings"]["root_motion"] == "in place"
    assert entry["source_armature"] == walker.name
    assert entry["bones"]["target"]["leftFoot"] == "LeftFoot"


def test_gaps_of_the_source_get_no_keys(target, walker, give, keys_of):
    bag = walker.animation_data.action.layers[0].strips[0].channelbags[0]
    for curve in bag.fcurves:
        if "LeftForeArm" in curve.data_path:
            for key in list(curve.keyframe_points)[20:50][::-1]:
                curve.keyframe_points.remove(key)

    keys = keys_of(give(walker, target))

    counts = {path.split('"')[1]: len(each) for (_, path, _), each in keys.items()}
    assert counts["LeftForeArm"] == 30 and counts["RightForeArm"] == 60
    assert np.isfinite([key[:2] for each in keys.values() for key in each]).all()


@pytest.mark.parametrize(
    ("settings", "sentence"),
    [
        ({"takes": "LISTED"}, "No action is listed"),
        ({"takes": "LISTED", "actions": "nothing"}, "There is no action nothing"),
        ({"root_motion": "ROOT_BONE"}, "no bone above the hips"),
    ],
)
def test_retarget_reports_impossible_requests(target, blank, settings, sentence):
    with pytest.raises(RuntimeError, match=sentence):
        blank.ops.mocap_assist.retarget(target=target.name, **settings)
    assert not made_of(blank) and target.animation_data is None


def test_armature_without_hips_is_refused(walker, make_armature, blank):
    prop = make_armature({"Lid": (None, (0, 0, 0), (0, 0, 1), False)}, name="Box")
    blank.context.view_layer.objects.active = walker

    with pytest.raises(RuntimeError, match="No bone of Box has the role hips"):
        blank.ops.mocap_assist.retarget(target=prop.name)


def test_retarget_adds_only_actions(target, walker, give, blank):
    collections = ("objects", "armatures", "meshes", "collections", "scenes")
    before = {name: len(getattr(blank.data, name)) for name in collections}

    give(walker, target)

    assert {name: len(getattr(blank.data, name)) for name in collections} == before


def test_retarget_is_one_undo_step(target, walker, give, blank):
    window = blank.context.window
    with blank.context.temp_override(window=window, screen=window.screen):
        blank.ops.ed.undo_push(message="before")
        give(walker, target)
        blank.ops.ed.undo_push(message="Retarget")
        blank.ops.ed.undo()

    assert not made_of(blank)
    assert blank.data.objects["Mixamo"].animation_data is None


def test_retargeted_action_can_be_cleaned_and_reverted(target, walker, give, blank):
    given = give(walker, target)
    blank.context.view_layer.objects.active = target

    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}
    clean = target.animation_data.action
    assert clean.name == f"{given.name}.clean"
    assert blank.ops.mocap_assist.revert_to_raw() == {"FINISHED"}

    assert target.animation_data.action == given
    operations = [each["operation"] for each in json.loads(clean["mocap_assist_history"])]
    assert operations == ["retarget", "denoise"]


def test_other_slots_and_bones_are_ignored(target, walker, give, blank):
    """The slot that keys the source's bones is taken, wherever it stands."""
    raw = walker.animation_data.action
    other = blank.data.actions.new("two")
    for name in ("Lamp", "Actor"):
        slot = other.slots.new("OBJECT", name)
        strip = (
            other.layers[0].strips[0]
            if other.layers
            else other.layers.new("Layer").strips.new(type="KEYFRAME")
        )
        bag = strip.channelbag(slot, ensure=True)
        if name == "Lamp":
            bag.fcurves.new("location", index=0).keyframe_points.insert(1, 0)
            continue
        for curve in raw.layers[0].strips[0].channelbags[0].fcurves:
            copy = bag.fcurves.new(curve.data_path, index=curve.array_index)
            for key in curve.keyframe_points:
                copy.keyframe_points.insert(*key.co, options={"FAST"})

    action = give(walker, target, takes="LISTED", actions="two")

    assert action.name == "two.Mixamo"
    assert json.loads(action["mocap_assist_history"])[-1]["slot"] == "OBActor"
