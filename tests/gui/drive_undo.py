"""Undo, redo and revert results in a Blender with a window; the list of Check stays true.

    make test-gui DRIVERS=undo

Runs inside that Blender; `bgui` comes with the tool and moves a real pointer.
"""

import bgui
import bpy
from driver_scene import empty_scene, load, settle, until_done
from mathutils import Quaternion

AWAY = (500, 500)
UNTIL_LISTED = 300  # tenths of a second
EDITED = ("RightArm", 40)
"""Bone and frame of a key that is edited by hand."""


def shown():
    return bpy.context.scene.mocap_assist


def played():
    return bpy.context.view_layer.objects.active.animation_data.action.name


def listed():
    return sorted((each.name, each.kind, round(each.start)) for each in shown().issues)


def call(operator, *arguments, **options):
    """Call an operator over the 3D View, as a shortcut does."""
    with bgui.override("WINDOW"):
        operator(*arguments, **options)


def quiet():
    """Whether no check is awaited any more."""
    return not load("mocap_assist.check.renewing")._awaited


def until_listed(name):
    """Wait until the list is of this action, and no check is awaited."""
    for _ in range(UNTIL_LISTED):
        yield 0.1
        checked = shown().checked_action
        if checked is not None and checked.name == name == played() and quiet():
            yield from settle(pointer=AWAY)
            return
    raise AssertionError((name, played(), shown().checked_action, len(listed())))


def press(idname, **options):
    call(getattr(bpy.ops.mocap_assist, idname), "INVOKE_DEFAULT", True, **options)
    yield 0.5
    yield from until_done()


def lists():
    """Return what Check lists of a raw and of a cleaned take, and of a key that was edited."""
    yield from press("measure_quality")
    raw = listed()
    assert raw
    yield from press("denoise")
    yield from until_listed("Sample Walk.clean")
    clean = listed()
    assert clean != raw
    return raw, clean


def undo_and_redo(raw, clean):
    bgui.shot("1-cleaned.png")
    call(bpy.ops.ed.undo)
    yield from until_listed("Sample Walk")
    assert listed() == raw, "after undo"
    bgui.shot("2-undone.png")
    call(bpy.ops.ed.redo)
    yield from until_listed("Sample Walk.clean")
    assert listed() == clean, "after redo"
    yield from press("revert_to_raw")
    yield from until_listed("Sample Walk")
    assert listed() == raw, "after a revert"
    bgui.shot("3-reverted.png")
    call(bpy.ops.ed.undo)
    yield from until_listed("Sample Walk.clean")
    assert listed() == clean, "after undo of a revert"
    call(bpy.ops.ed.undo)
    yield from until_listed("Sample Walk")
    assert listed() == raw, "after undo of both"


def undo_of_an_edited_key(raw):
    """The action stays, and its keys change."""
    armature = bpy.context.view_layer.objects.active
    bone, frame = EDITED
    bpy.context.scene.frame_set(frame)
    pose = armature.pose.bones[bone]
    pose.rotation_quaternion.rotate(Quaternion((0.0, 1.0, 0.0), 1.0))
    pose.keyframe_insert("rotation_quaternion")
    call(bpy.ops.ed.undo_push, message="Edit a key")
    yield from press("measure_quality")
    assert listed() != raw
    call(bpy.ops.ed.undo)
    yield from until_listed("Sample Walk")
    assert listed() == raw, "after undo of an edited key"


def card_and_list_agree(raw):
    """The card counts before and after what Check lists of the take and of the result."""
    yield from press("fix_take")
    yield from settle(pointer=AWAY)
    bgui.shot("4-card.png")
    card = load("mocap_assist.panel_parts.fix_card").shown_card(bpy.context)
    counts = [card[each]["issues"] for each in ("before", "after")]
    assert counts == [len(raw), len(listed())], (counts, len(raw), len(listed()))
    result = listed()
    yield from press("measure_quality")
    assert listed() == result, "Check of a fixed take"
    call(bpy.ops.ed.undo)
    yield from until_listed("Sample Walk")
    assert len(listed()) == counts[0]


def steps():
    empty_scene()
    yield from bgui.open_sidebar("Mocap")
    call(bpy.ops.mocap_assist.load_sample, "EXEC_DEFAULT", True)
    raw, clean = yield from lists()
    yield from undo_and_redo(raw, clean)
    yield from undo_of_an_edited_key(raw)
    yield from card_and_list_agree(raw)


bgui.run(steps, timeout=900)
