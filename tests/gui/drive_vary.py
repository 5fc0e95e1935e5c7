"""Press Vary in a Blender with a window, as an animator does; take pictures.

    make test-gui DRIVERS=vary

Runs inside that Blender; `bgui` comes with the tool. The folder `kicks` holds recordings of one
behavior of one actor, and is copied next to this script. At last 200 variants are made, and the
longest time for which the window did not respond is printed.
"""

from pathlib import Path
from time import monotonic

import bgui
import bpy
from driver_scene import WHEEL_DOWN, WHEEL_UP, empty_scene, scroll, settle, unfold_alone

FOLDER = Path(__file__).parent
KICKS = FOLDER / "kicks"
UNTIL_DONE = 2400  # looks
LOOKS_AFTER = 10
N_CROWD, N_MANY = 8, 200


def bring():
    """Import the kicks, and keep the armature of the first alone."""
    paths = sorted(path for path in KICKS.iterdir() if path.suffix in {".amc", ".bvh"})
    for path in paths:
        with bgui.override("WINDOW"):
            bpy.ops.mocap_assist.import_recording(
                directory=str(path.parent), files=[{"name": path.name}], frame_rate="SCALE"
            )
    first, *others = sorted(bpy.data.objects, key=lambda each: each.name)
    for each in others:
        bpy.data.objects.remove(each)
    first.select_set(True)
    bpy.context.view_layer.objects.active = first
    return first


def look_at(armature, distance):
    view = bgui.area().spaces.active.region_3d
    view.view_location = armature.location + armature.pose.bones[0].head
    view.view_rotation = (0.76, 0.6, 0.15, 0.2)
    view.view_distance = distance


def press(text):
    bgui.move(500, 500)  # else a slow scan begins with the button that was pressed last
    yield 0.5
    yield from bgui.scan()
    yield from bgui.click(*bgui.at(text))


def job():
    return bpy.context.window_manager.mocap_assist_job


def longest_wait():
    """Wait until no solve runs; return the longest time for which nothing could be done."""
    yield 0.5
    waits, before, n_after = [], monotonic(), 0
    for _ in range(UNTIL_DONE):
        doing = f"{job().message} {job().fraction:.2f}" if job().running else "after the end"
        n_after += not job().running
        if n_after > LOOKS_AFTER:
            waits.sort(reverse=True)
            print("Longest waits:", *(f"{wait:.2f} s at {what};" for wait, what in waits[:8]))
            return waits[0][0]
        yield 0.05
        now = monotonic()
        waits.append((now - before - 0.05, doing))
        before = now
    raise AssertionError("It does not end.")


def n_variants():
    return sum(".variant" in each.name for each in bpy.data.actions)


def make(armature):
    shown = bpy.context.scene.mocap_assist.vary
    yield from settle()
    bgui.shot("1-nothing.png")
    shown.actions = "; ".join(action.name for action in bpy.data.actions)
    yield from press("mocap_assist.vary()")
    yield 2.0
    bgui.shot("2-running.png")
    yield from longest_wait()
    assert n_variants() == 20, n_variants()
    bpy.context.scene.frame_set(25)
    yield from settle()
    bgui.shot("3-made.png")


def pick(armature):
    variants = bpy.context.scene.mocap_assist.variants
    variants.active = 3
    for index in range(1, 6):
        variants.rows[index].picked = True
    assert armature.animation_data.action == variants.rows[3].action
    yield from scroll(WHEEL_DOWN)
    yield from settle()
    bgui.shot("4-picked.png")


def crowd(armature):
    members = [armature]
    for index in range(1, N_CROWD):
        member = armature.copy()
        member.animation_data_clear()
        member.location = (1.5 * (index % 4), 1.8 * (index // 4), 0.0)
        bpy.context.scene.collection.objects.link(member)
        members.append(member)
    for member in members:
        member.select_set(True)
    with bgui.override("WINDOW"):
        done = bpy.ops.mocap_assist.assign_variants(delay=0.5, spread=0.4, turn=0.4)
    assert done == {"FINISHED"}
    bpy.context.scene.frame_set(45)
    look_at(members[2], 9.0)
    yield from settle()
    bgui.shot("5-crowd.png")
    for member in members[1:]:
        bpy.data.objects.remove(member)


def undo_and_redo():
    """One step takes all back; another brings them again, with their pictures."""
    yield from press("mocap_assist.vary()")
    yield from longest_wait()
    assert n_variants() == 40
    with bgui.override("WINDOW"):
        bpy.ops.ed.undo()
    assert n_variants() == 20, n_variants()
    with bgui.override("WINDOW"):
        bpy.ops.ed.redo()
    assert n_variants() == 40
    rows = bpy.context.scene.mocap_assist.variants.rows
    assert all(row.action.preview is not None for row in rows)
    yield from settle()
    bgui.shot("6-redone.png")


def many():
    bpy.context.scene.mocap_assist.vary.n_variants = N_MANY
    yield from settle()
    yield from press("mocap_assist.vary()")
    longest = yield from longest_wait()
    print(f"The window was held for {longest:.2f} s at most.")
    assert len(bpy.context.scene.mocap_assist.variants.rows) == N_MANY
    before = monotonic()
    for _ in range(10):
        bgui.redraw()
    print(f"A redraw takes {(monotonic() - before) / 10:.3f} s with {N_MANY} variants.")
    yield from settle()
    bgui.shot("7-many.png")


def steps():
    empty_scene()
    unfold_alone("vary")
    armature = bring()
    look_at(armature, 4.5)
    bgui.area().spaces.active.show_region_ui = True
    yield from bgui.open_sidebar("Mocap", 420)
    yield from make(armature)
    yield from pick(armature)
    yield from crowd(armature)
    yield from scroll(WHEEL_UP)
    yield from undo_and_redo()
    yield from many()


bgui.run(steps, timeout=1500)
