"""Put a walk on a Rigify rig in a Blender with a window, as an animator does; take pictures.

    make extension-plain
    BG_DEBS="python3-scipy python3-pil" bash ../shared/tools/blender-gui.sh run \
        dist/mocap_assist-0.1.0-plain.zip tests/gui/drive_retarget.py build/gui/retarget.png

Runs inside that Blender; `bgui` comes with the tool and moves a real pointer.
"""

import tempfile
from importlib import import_module
from pathlib import Path

import bgui
import bpy
from addon_utils import enable

PACKAGE = "bl_ext.user_default.mocap_assist"
RETARGET, FIND = "mocap_assist.retarget", "mocap_assist.find_bones"
FRAMES = (1, 60)


def settle():
    """Wait until everything is drawn."""
    for _ in range(3):
        bgui.redraw()
        yield 0.5


def import_walk():
    samples = import_module(f"{PACKAGE}.solvers.samples")
    walk = samples.walking_gait(samples.GaitSettings(duration=4.0, frame_rate=30.0))
    path = Path(tempfile.mkdtemp()) / "walk.bvh"
    import_module(f"{PACKAGE}.solvers.recordings").write_bvh(walk, path)
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.import_recording(
            directory=str(path.parent), files=[{"name": path.name}]
        )
    return bpy.context.view_layer.objects.active


def make_rigify():
    """Generate the human rig that comes with Blender, and hide its metarig."""
    enable("rigify", default_set=True)
    with bgui.override("WINDOW"):
        bpy.ops.object.armature_human_metarig_add()
        metarig = bpy.context.object
        bpy.ops.pose.rigify_generate()
    metarig.hide_set(True)
    rig = metarig.data.rigify_target_rig
    rig.location.x = 1.2
    return rig


def show_retarget_alone():
    """Take the other panels away, and unfold this one, before the tab is first drawn."""
    for name in ("import", "clean", "check", "compare", "feet", "markers"):
        bpy.utils.unregister_class(getattr(bpy.types, f"MOCAP_PT_{name}"))
    panel = bpy.types.MOCAP_PT_retarget
    bpy.utils.unregister_class(panel)
    panel.bl_options = set()
    bpy.utils.register_class(panel)


def look():
    view = bgui.area().spaces.active.region_3d
    view.view_location = (0.6, -1.0, 0.9)
    view.view_rotation = (0.76, 0.62, 0.13, 0.15)
    view.view_distance = 5.0
    view.view_perspective = "ORTHO"


def steps():
    # The panel before and after Find Bones, and the rig making the walk.
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    rig = make_rigify()
    walk = import_walk()
    bpy.context.scene.render.fps = 30
    with bgui.override("WINDOW"):
        bpy.ops.object.select_all(action="DESELECT")
    walk.select_set(True)
    bpy.context.view_layer.objects.active = walk
    show_retarget_alone()
    yield from bgui.open_sidebar("Mocap")
    look()
    yield from settle()
    bgui.shot("1-panel.png")
    shown = bpy.context.scene.mocap_assist.retarget
    shown.target = rig.name
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.find_bones()
    yield from settle()
    bgui.shot("2-bones.png")
    with bgui.override("WINDOW"):
        assert bpy.ops.mocap_assist.retarget(target=rig.name) == {"FINISHED"}
    bpy.context.scene.frame_set(FRAMES[1])
    yield from settle()
    bgui.shot("3-retargeted.png")
    assert rig.animation_data.action is not None


bgui.run(steps, timeout=300)
