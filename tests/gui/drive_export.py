"""Export a take and look at the list of bones, in a Blender with a window, with pictures.

    make test-gui DRIVERS=export

As in drive_clean.py.
"""

import tempfile
from importlib import import_module
from pathlib import Path

import bgui
import bpy
from driver_scene import empty_scene, settle

PACKAGE = "bl_ext.user_default.mocap_assist"
FOLDER = Path(tempfile.mkdtemp())
SHOWN = ("MOCAP_PT_compare", "MOCAP_PT_retarget")


def set_the_stage():
    """A cleaned walk, and a figure of the same bones next to it."""
    empty_scene()
    samples = import_module(f"{PACKAGE}.solvers.samples")
    write_bvh = import_module(f"{PACKAGE}.solvers.recordings").write_bvh
    walk = samples.walking_gait(samples.GaitSettings(duration=3.0, frame_rate=30.0))
    write_bvh(walk, FOLDER / "walk.bvh")
    with bgui.override("WINDOW"):
        bpy.ops.import_anim.bvh(
            filepath=str(FOLDER / "walk.bvh"), global_scale=0.01, update_scene_fps=True
        )
        source = bpy.context.view_layer.objects.active
        bpy.ops.mocap_assist.denoise()
        bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / "shot.blend"))
    hero = bpy.data.objects.new("Hero", source.data.copy())
    bpy.context.scene.collection.objects.link(hero)
    hero.location = (1.5, 0.0, 0.0)
    bpy.context.view_layer.update()
    return source, hero


def unfold(wanted):
    """Show these panels only, unfolded, each by itself."""
    bpy.context.window_manager.mocap_assist_all_panels = True
    for each in [other for other in dir(bpy.types) if other.startswith("MOCAP_PT_")]:
        panel = getattr(bpy.types, each)
        bpy.utils.unregister_class(panel)
        panel.bl_options = set()
        if each in wanted and hasattr(panel, "bl_parent_id"):
            del panel.bl_parent_id
        if each not in wanted:
            panel.poll = classmethod(lambda cls, context: False)
        bpy.utils.register_class(panel)


def press(button):
    yield from bgui.scan()
    yield from bgui.click(*bgui.at(button))


def running():
    return bpy.context.window_manager.mocap_assist_job.running


def export(source):
    played = source.animation_data.action.name
    yield from press("ops.mocap_assist.export_take()")
    yield 2.0
    bgui.shot("2-file-browser.png")
    window = bpy.context.window_manager.windows[-1]
    area = next(each for each in window.screen.areas if each.type == "FILE_BROWSER")
    chosen = area.spaces.active.params
    assert chosen.filename == f"{played}.fbx"
    region = next(each for each in area.regions if each.type == "WINDOW")
    with bpy.context.temp_override(window=window, area=area, region=region):
        bpy.ops.file.execute()
    for _ in range(120):
        yield 0.5
        if not running() and list(FOLDER.glob("*.fbx")):
            break
    assert [path.name for path in FOLDER.glob("*.fbx")] == [f"{played}.fbx"]
    assert source.animation_data.action.name == played
    yield from settle()
    bgui.shot("3-exported.png")


def look_at_the_bones(hero):
    found = bpy.context.scene.mocap_assist
    found.retarget.target = hero.name
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.find_bones()
    rows = {row.name: row for row in found.bone_map.rows}
    rows["leftLowerLeg"].source = "LeftHand"
    found.bone_map.active_row = list(rows).index("leftLowerLeg")
    assert rows["leftLowerLeg"].source_confidence < 0.5
    yield from settle()
    bgui.shot("4-bones.png")


def steps():
    source, hero = set_the_stage()
    unfold(SHOWN)
    yield 0.5
    bgui.area().spaces.active.show_region_ui = True
    yield from bgui.open_sidebar("Mocap", 420)
    yield from settle()
    bgui.shot("1-compare.png")
    yield from export(source)
    yield from look_at_the_bones(hero)


bgui.run(steps, timeout=1500)
