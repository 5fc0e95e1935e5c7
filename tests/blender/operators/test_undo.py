"""Nothing else changes behind the animator: a press and its undo leave the scene as it was."""

import pytest

ELSEWHERE = {
    "mocap_assist.import_recording": "a file",
    "mocap_assist.fix_folder": "a folder",
    "mocap_assist.add_workspace": "a window",
    "mocap_assist.cancel_solve": "a running solve",
    "mocap_assist.show_raw": "a held key",
    "mocap_assist.listen": "a sender",
    "mocap_assist.record_live": "a sender",
    "mocap_assist.track_live": "a recorder",
    "mocap_assist.export_take": "a file to write",
    "mocap_assist.index_library": "clips",
    "mocap_assist.keep_current": "clips",
}
"""What these buttons need, which the sample has not."""
OPTIONS = {"mocap_assist.retarget": {"target": "Sample Walk.001"}}
MOVES = {"mocap_assist.jump_to_issue"}
"""Its purpose is to change the frame, the selection and the mode."""
PRESSED = {
    "accept_fix", "change_axes", "denoise", "fix_take", "jump_to_issue", "mark_issues",
    "measure_quality", "plant_feet", "reconstruct", "reduce_keys", "retarget", "revert_to_raw",
    "simulate", "vary",
}  # fmt: skip


@pytest.fixture
def sample(load, blank, monkeypatch):
    """Two seconds of the sample take, with a target to retarget to, cleaned once."""
    importing, walk = load("mocap_assist.importing.sample_take"), load("solvers.samples")
    monkeypatch.setattr(importing, "noisy_walk", lambda: walk.noisy_walk().slice(0, 60))
    for _ in range(2):
        blank.ops.mocap_assist.load_sample()
        blank.ops.object.mode_set(mode="OBJECT")
    target, source = blank.data.objects["Sample Walk.001"], blank.data.objects["Sample Walk"]
    target.select_set(False)
    source.select_set(True)
    blank.context.view_layer.objects.active = source
    blank.ops.mocap_assist.fix_take(plant_feet=False)
    blank.ops.mocap_assist.measure_quality()
    blank.context.scene.frame_set(17, subframe=0.5)
    return blank


def values_of(group):
    """Return all properties of a group of settings, those of its groups and lists, too."""
    values = {}
    for each in group.bl_rna.properties:
        name, value = each.identifier, getattr(group, each.identifier)
        if name == "rna_type":
            continue
        if each.type == "COLLECTION":
            values[name] = [values_of(row) for row in value]
        elif each.type == "POINTER":
            is_setting = value is not None and not hasattr(value, "session_uid")
            values[name] = values_of(value) if is_setting else getattr(value, "name", "")
        else:
            values[name] = tuple(value) if getattr(each, "is_array", False) else value
    return values


def notes_of(owner):
    """Return the custom properties, data-blocks by their names."""
    notes = dict(owner.items())
    for name, value in notes.items():
        plain = value.to_dict() if hasattr(value, "to_dict") else value
        notes[name] = getattr(value, "name", None) or str(plain)
    return notes


def keys_of(action):
    for layer in action.layers:
        for strip in layer.strips:
            for bag in strip.channelbags:
                for curve in bag.fcurves:
                    keys = [0.0] * (2 * len(curve.keyframe_points))
                    curve.keyframe_points.foreach_get("co", keys)
                    yield curve.data_path, curve.array_index, tuple(keys)


def state_of(bpy):
    """Return what an animator would notice."""
    scene, view_layer = bpy.context.scene, bpy.context.view_layer
    blocks = {
        each.identifier: sorted(getattr(bpy.data, each.identifier).keys())
        for each in bpy.data.bl_rna.properties
        if each.type == "COLLECTION"
    }
    objects = {
        each.name: {
            "matrix": [tuple(row) for row in each.matrix_basis],
            "selected": each.select_get(),
            "hidden": (each.hide_viewport, each.hide_get()),
            "mode": each.mode,
            "properties": notes_of(each),
            "action": each.animation_data and getattr(each.animation_data.action, "name", ""),
            "tracks": each.animation_data and each.animation_data.nla_tracks.keys(),
            "bones": [(bone.name, notes_of(bone)) for bone in each.pose.bones],
        }
        for each in scene.objects
    }
    names = ("frame_start", "frame_end", "frame_current_final", "use_preview_range",
             "frame_preview_start", "frame_preview_end")  # fmt: skip
    return {
        "blocks": blocks,
        "objects": objects,
        "actions": {each.name: list(keys_of(each)) for each in bpy.data.actions},
        "notes": {each.name: notes_of(each) for each in bpy.data.actions},
        "active": view_layer.objects.active.name,
        "scene": {name: str(getattr(scene, name)) for name in names},
        "markers": [(each.name, each.frame) for each in scene.timeline_markers],
        "rate": (scene.render.fps, scene.render.fps_base),
        "settings": values_of(scene.mocap_assist),
    }


def differences(before, after, path=""):
    """Return where two states differ."""
    if isinstance(before, dict) and isinstance(after, dict):
        for name in before.keys() | after.keys():
            yield from differences(before.get(name), after.get(name), f"{path}/{name}")
    elif before != after:
        yield f"{path}: {str(before)[:60]} -> {str(after)[:60]}"


def offered(bpy, draw):
    """Return the buttons of all panels."""
    panels = [each for each in dir(bpy.types) if each.startswith("MOCAP_PT_")]
    panels = [each for each in panels if not each.endswith("_presets")]
    shown = {name for panel in panels for name in draw(panel)}
    return sorted(name for name in shown if name.startswith("mocap_assist."))


def kept(state):
    """Return what no press may change at all: selection, modes, the frame and the rate."""
    noticed = ("selected", "hidden", "mode")
    objects = {
        name: [each[part] for part in noticed] for name, each in state["objects"].items()
    }
    return {"objects": objects, **{name: state[name] for name in ("active", "scene", "rate")}}


def test_a_press_and_its_undo_leave_the_scene_as_it_was(sample, draw, all_panels):
    window = sample.context.window_manager.windows[0]
    pressed, changed = set(), {}
    with sample.context.temp_override(window=window, screen=window.screen):
        sample.ops.ed.undo_push(message="before")
        before = state_of(sample)
        for idname in offered(sample, draw):
            button = getattr(sample.ops.mocap_assist, idname.partition(".")[2])
            if idname in ELSEWHERE or not button.poll():
                continue
            button("EXEC_DEFAULT", True, **OPTIONS.get(idname, {}))
            pressed.add(idname.partition(".")[2])
            after = state_of(sample)
            if idname not in MOVES:
                changed[idname, "pressed"] = list(differences(kept(before), kept(after)))
            if "UNDO" in button.bl_options:
                sample.ops.ed.undo()
            changed[idname, "undone"] = list(differences(before, state_of(sample)))

    assert not {name: found for name, found in changed.items() if found}
    assert pressed >= PRESSED
