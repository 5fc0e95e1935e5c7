"""While its key is held, the recorded action plays; afterwards the result, whatever happens."""

import importlib.util
from pathlib import Path
from types import SimpleNamespace

import bpy
import pytest

MAPS = ("Window", "Screen", "User Interface", "3D View", "3D View Generic", "Frames")
MODES = ("Pose", "Object Mode", "Object Non-modal")


def event(kind, value="NOTHING", **more):
    held = dict.fromkeys(("ctrl", "alt", "shift", "oskey", "is_repeat"), False)
    return SimpleNamespace(type=kind, value=value, **held | more)


@pytest.fixture
def cleaned(blank, actor):
    """An armature that plays a result, and the names of its actions, raw and clean."""
    assert blank.ops.mocap_assist.denoise() == {"FINISHED"}
    return actor


@pytest.fixture
def raw_view(load):
    found = load("mocap_assist.check.raw_view")
    yield found
    found.restore_played()


@pytest.fixture
def button(blank, load, raw_view):
    """The operator without Blender's part, in a window that does nothing."""
    held = load("mocap_assist.check.held_operator")
    made = type("Button", (held.HeldOperator,), {})()
    made.status = []
    made.context = SimpleNamespace(
        view_layer=blank.context.view_layer,
        scene=blank.context.scene,
        window_manager=SimpleNamespace(modal_handler_add=lambda _: None),
        workspace=SimpleNamespace(status_text_set=made.status.append),
    )
    return made


def hold(button, kind="Y", value="PRESS"):
    assert button.invoke(button.context, event(kind, value)) == {"RUNNING_MODAL"}


def playing(armature):
    animation = armature.animation_data
    return animation.action.name, animation.action_slot.identifier


ENDINGS = {
    "key released": event("Y", "RELEASE"),
    "Esc": event("ESC", "PRESS"),
    "click": event("LEFTMOUSE", "PRESS"),
    "undo": event("Z", "PRESS", ctrl=True),
    "key pressed again": event("Y", "PRESS"),
    "window loses the focus": event("WINDOW_DEACTIVATE"),
}


@pytest.mark.parametrize("ending", ENDINGS)
def test_result_plays_again_after_every_ending(cleaned, button, keys_of, ending):
    before = playing(cleaned)
    keys = keys_of(cleaned.animation_data.action)
    hold(button)
    assert playing(cleaned)[0] == "walk"
    assert "release Y" in button.status[-1]

    assert button.modal(button.context, ENDINGS[ending]) == {"CANCELLED"}

    assert playing(cleaned) == before
    assert keys_of(cleaned.animation_data.action) == keys
    assert button.status[-1] is None


IGNORED = {
    "key repeats": event("Y", "PRESS", is_repeat=True),
    "another key is released": event("LEFT_CTRL", "RELEASE"),
    "pointer with Ctrl": event("WHEELUPMOUSE", "PRESS", ctrl=True),
}


@pytest.mark.parametrize("what", IGNORED)
def test_other_events_reach_no_operator(cleaned, button, what):
    hold(button)

    assert button.modal(button.context, IGNORED[what]) == {"RUNNING_MODAL"}

    assert playing(cleaned)[0] == "walk"


@pytest.mark.parametrize("kind", ["TIMER", "TIMER0", "MOUSEMOVE", "WHEELUPMOUSE"])
def test_playback_and_zoom_go_on(cleaned, button, kind):
    hold(button)

    assert button.modal(button.context, event(kind, "PRESS")) == {"PASS_THROUGH"}

    assert playing(cleaned)[0] == "walk"


def test_from_a_menu_the_next_click_ends_it(cleaned, button):
    before = playing(cleaned)
    hold(button, "LEFTMOUSE", "RELEASE")
    assert "press any key" in button.status[-1]
    assert button.modal(button.context, event("RET", "RELEASE")) == {"RUNNING_MODAL"}

    assert button.modal(button.context, event("LEFTMOUSE", "PRESS")) == {"CANCELLED"}

    assert playing(cleaned) == before


def test_blender_ends_it(cleaned, button):
    before = playing(cleaned)
    hold(button)

    button.cancel(button.context)

    assert playing(cleaned) == before


def test_pose_and_custom_properties_return(blank, cleaned, button, poses):
    before = poses(cleaned, [17])
    hold(button)
    raw = poses(cleaned, [17])
    button.modal(button.context, event("Y", "RELEASE"))

    assert any((raw[name] != before[name]).any() for name in before)
    after = poses(cleaned, [17])
    assert all((after[name] == before[name]).all() for name in before)


def test_channel_that_only_the_recording_has_returns(blank, cleaned, button):
    raw = bpy.data.actions["walk"]
    curve = raw.layers[0].strips[0].channelbag(raw.slots[0]).fcurves.new(
        'pose.bones["Head"].scale', index=0
    )  # fmt: skip
    curve.keyframe_points.insert(1, 3.0)
    hold(button)
    blank.context.view_layer.update()
    assert cleaned.pose.bones["Head"].scale.x == 3.0

    button.modal(button.context, event("Y", "RELEASE"))

    blank.context.view_layer.update()
    assert cleaned.pose.bones["Head"].scale.x == 1.0


def test_pose_without_keys_returns_unless_the_frame_changed(blank, cleaned, button):
    bone, posed = cleaned.pose.bones["LeftArm"], (0.0, 1.0, 0.0, 0.0)
    bone.rotation_quaternion = posed
    hold(button)
    blank.context.view_layer.update()
    assert tuple(bone.rotation_quaternion) != posed

    button.modal(button.context, event("Y", "RELEASE"))
    blank.context.view_layer.update()
    assert tuple(bone.rotation_quaternion) == posed

    hold(button)
    blank.context.scene.frame_set(17)
    button.modal(button.context, event("Y", "RELEASE"))
    blank.context.view_layer.update()
    released = tuple(bone.rotation_quaternion)
    blank.context.scene.frame_set(17)
    assert tuple(bone.rotation_quaternion) == pytest.approx(released)
    assert released != posed


def test_saved_file_has_the_result(blank, cleaned, button, tmp_path):
    before = playing(cleaned)
    hold(button)

    blank.ops.wm.save_as_mainfile(filepath=str(tmp_path / "take.blend"), copy=True)

    assert playing(cleaned) == before
    assert button.modal(button.context, event("TIMER")) == {"CANCELLED"}
    blank.ops.wm.open_mainfile(filepath=str(tmp_path / "take.blend"))
    assert playing(blank.data.objects["Actor"]) == before


def test_loading_another_file_ends_it(blank, cleaned, button):
    hold(button)

    blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)

    assert button.modal(button.context, event("TIMER")) == {"CANCELLED"}


def test_disabling_the_extension_ends_it(cleaned, button, extension):
    before = playing(cleaned)
    hold(button)

    extension.unregister()
    try:
        assert playing(cleaned) == before
    finally:
        extension.register()


def test_undo_steps_hold_the_result(blank, cleaned, button):
    window = blank.context.window_manager.windows[0]
    before, name = playing(cleaned), cleaned.name
    with blank.context.temp_override(window=window, screen=window.screen):
        blank.ops.ed.undo_push(message="cleaned")
        cleaned.location.x = 1.0
        blank.ops.ed.undo_push(message="moved")
        hold(button)
        blank.ops.ed.undo()

    armature = blank.data.objects[name]
    assert playing(armature) == before
    assert armature.location.x == 0.0


def test_operator_adds_no_undo_step():
    assert "UNDO" not in bpy.types.MOCAP_ASSIST_OT_show_raw.bl_options


def test_deleted_armature_does_not_matter(blank, cleaned, button):
    hold(button)
    blank.data.objects.remove(cleaned)

    assert button.modal(button.context, event("Y", "RELEASE")) == {"CANCELLED"}


def test_action_that_was_assigned_meanwhile_stays(blank, cleaned, button, animate):
    hold(button)
    other = animate(cleaned)

    button.modal(button.context, event("Y", "RELEASE"))

    assert cleaned.animation_data.action == other


def test_result_on_an_nla_track_plays_again(blank, actor, button):
    assert blank.ops.mocap_assist.denoise(result_as="NLA_TRACK") == {"FINISHED"}
    before = actor.animation_data.action
    hold(button)
    assert actor.animation_data.action.name == "walk"

    button.modal(button.context, event("Y", "RELEASE"))

    assert actor.animation_data.action == before
    assert len(actor.animation_data.nla_tracks) == 1


def test_button_is_gray_without_a_result(blank, actor):
    assert not blank.ops.mocap_assist.show_raw.poll()


def default_items(name):
    """Key map, operator and event of all items of a key map that comes with Blender."""
    folder = Path(bpy.utils.preset_paths("keyconfig")[0]) / "keymap_data"
    spec = importlib.util.spec_from_file_location(name, folder / f"{name}.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    for keymap, _, content in module.generate_keymaps(module.Params()):
        for operator, pressed, _ in content["items"]:
            yield keymap, operator, pressed


@pytest.mark.parametrize("name", ["blender_default", "industry_compatible_data"])
def test_key_is_free_in_the_key_maps_of_blender(load, name):
    key = load("mocap_assist.check.key_map").KEY
    items = list(default_items(name))
    assert {"Pose", "Object Mode"} <= {keymap for keymap, *_ in items}

    clashes = [
        (keymap, operator)
        for keymap, operator, pressed in items
        if keymap in MAPS + MODES
        and key in {pressed["type"], pressed.get("key_modifier")}
        and not any(pressed.get(each) for each in ("shift", "ctrl", "alt", "oskey"))
    ]

    assert clashes == []


def our_items():
    keyconfig = bpy.context.window_manager.keyconfigs.addon
    return [
        (keymap.name, item.type, item.value)
        for keymap in keyconfig.keymaps
        for item in keymap.keymap_items
        if item.idname == "mocap_assist.show_raw"
    ]


def test_key_is_added_and_removed_with_the_extension(extension):
    assert sorted(our_items()) == [("Object Mode", "Y", "PRESS"), ("Pose", "Y", "PRESS")]
    extension.unregister()
    assert our_items() == []
    extension.register()
    assert len(our_items()) == 2
