"""Retarget as an animator does, in a Blender with a window, and take pictures.

    make test-gui DRIVERS=retarget

As in drive_clean.py.
"""

import tempfile
from importlib import import_module
from pathlib import Path

import bgui
import bpy
from driver_scene import empty_scene, settle, unfold_alone

PACKAGE = "bl_ext.user_default.mocap_assist"
AWAY = (300, 500)
SECONDS = 240.0  # of the walk: more than is solved at once


def set_the_stage():
    """A walk, and a larger figure next to it; only the panel Retarget is shown."""
    empty_scene()
    samples = import_module(f"{PACKAGE}.solvers.samples")
    write_bvh = import_module(f"{PACKAGE}.solvers.recordings").write_bvh
    path = Path(tempfile.mkdtemp()) / "walk.bvh"
    write_bvh(
        samples.walking_gait(samples.GaitSettings(duration=SECONDS, frame_rate=60.0)), path
    )
    with bgui.override("WINDOW"):
        bpy.ops.import_anim.bvh(filepath=str(path), global_scale=0.01, update_scene_fps=True)
    source = bpy.context.view_layer.objects.active
    hero = bpy.data.objects.new("Hero", source.data.copy())
    bpy.context.scene.collection.objects.link(hero)
    hero.location, hero.scale = (1.5, 0.0, 0.0), (1.3, 1.3, 1.3)
    bpy.context.view_layer.update()
    unfold_alone("retarget")
    return source, hero


def press(button):
    yield from bgui.scan()
    yield from bgui.click(*bgui.at(button))


def running():
    return bpy.context.window_manager.mocap_assist_job.running


def look_at(*armatures):
    view = bgui.area().spaces.active.region_3d
    positions = [each.matrix_world @ each.pose.bones[0].head for each in armatures]
    view.view_location = sum(positions[1:], positions[0]) / len(positions)
    view.view_rotation = (0.76, 0.6, 0.15, 0.2)
    view.view_distance = 6.0


def find_the_bones(hero):
    bgui.shot("1-no-target.png")
    bpy.context.scene.mocap_assist.retarget.target = hero.name
    yield from press("mocap_assist.find_bones")
    yield from settle(pointer=AWAY)
    assert len(bpy.context.scene.mocap_assist.bone_map.rows) > 20
    bgui.shot("2-bones.png")
    listed = bpy.context.scene.mocap_assist.bone_map
    next(row for row in listed.rows if row.name == "leftFoot").target = "LeftHand"
    sidebar = bgui.region()
    yield from bgui.click(sidebar.x + 60, 492)  # the last row of the list
    yield from settle(pointer=AWAY)
    assert listed.active_row == 7, listed.active_row
    assert bpy.context.window_manager.mocap_assist_highlight
    bgui.shot("2b-row-clicked.png")
    yield from rest_poses(hero)
    bpy.context.window_manager.mocap_assist_highlight = False
    yield from press("mocap_assist.find_bones")


def rest_poses(hero):
    """Both rigs in their rest poses; nothing of the scene changes for it."""
    source = bpy.context.view_layer.objects.active
    before = [[bone.matrix.copy() for bone in each.pose.bones] for each in (source, hero)]
    positions = [each.data.pose_position for each in (source, hero)]
    yield from press("mocap_assist_rest_poses")
    yield from settle(pointer=AWAY)
    assert bpy.context.window_manager.mocap_assist_rest_poses
    bgui.shot("2c-rest-poses.png")
    yield from press("mocap_assist_rest_poses")
    assert not bpy.context.window_manager.mocap_assist_rest_poses
    assert positions == [each.data.pose_position for each in (source, hero)]
    assert before == [[bone.matrix for bone in each.pose.bones] for each in (source, hero)]


def escape_leaves_all_as_it_was(hero):
    yield from press("ops.mocap_assist.retarget()")
    for _ in range(100):
        if running():
            break
        yield 0.05
    assert running()
    yield from bgui.key("Escape")
    yield 0.5
    assert not running() and hero.animation_data is None


def retarget(source, hero):
    raw = source.animation_data.action
    yield from press("ops.mocap_assist.retarget()")
    yield 1.0
    for _ in range(240):
        yield 0.5
        if not running():
            break
    assert hero.animation_data.action.name == f"{raw.name}.Hero"
    assert source.animation_data.action == raw
    bpy.context.scene.frame_set(30)
    look_at(source, hero)
    yield from settle(pointer=AWAY)
    bgui.shot("3-retargeted.png")


def take_it_back(name):
    with bgui.override("WINDOW"):
        bpy.ops.ed.undo()
    yield 1.0
    assert bpy.data.objects["Hero"].animation_data is None
    assert name not in bpy.data.actions
    yield from settle(pointer=AWAY)
    bgui.shot("4-undone.png")


def steps():
    source, hero = set_the_stage()
    name = f"{source.animation_data.action.name}.Hero"
    look_at(source, hero)
    yield 0.5
    bgui.area().spaces.active.show_region_ui = True
    yield from bgui.open_sidebar("Mocap", 420)
    yield from settle(pointer=AWAY)
    yield from find_the_bones(hero)
    yield from escape_leaves_all_as_it_was(hero)
    yield from retarget(source, hero)
    yield from take_it_back(name)


bgui.run(steps, timeout=1500)
