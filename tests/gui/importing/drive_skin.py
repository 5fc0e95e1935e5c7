"""Drop a skinned Mixamo take as FBX, clean it, retarget it onto Rigify, and take pictures.

    make test-gui DRIVERS=skin

Runs inside a Blender with a window; `bgui` comes with the tool. The take is a GLB of the
corpus, which Blender's own exporter turns into an FBX here.
"""

from pathlib import Path

import addon_utils
import bgui
import bpy
import numpy as np
from driver_scene import empty_scene, settle, until_done

FOLDER = Path(__file__).parent
TAKE = FOLDER / "skinned.fbx"
FRAMES = (1, 12, 22)


def make_skinned_fbx():
    with bgui.override("WINDOW"):
        bpy.ops.import_scene.gltf(filepath=str(FOLDER / "walking.glb"))
        bpy.ops.export_scene.fbx(filepath=str(TAKE), add_leaf_bones=False)
    empty_scene()
    bpy.ops.outliner.orphans_purge(do_recursive=True)


def box(meshes):
    """Return the lowest and highest corner of what is drawn of the meshes."""
    graph = bpy.context.evaluated_depsgraph_get()
    corners = []
    for each in meshes:
        drawn = each.evaluated_get(graph)
        corners += [each.matrix_world @ vertex.co for vertex in drawn.data.vertices]
    return np.min(corners, axis=0), np.max(corners, axis=0)


def check_stands(meshes):
    """The skin stands on the floor, as tall as a person, whatever the frame."""
    for frame in FRAMES:
        bpy.context.scene.frame_set(frame)
        low, high = box(meshes)
        assert abs(low[2]) < 0.05, low
        assert 1.6 < high[2] < 1.8, high


def bring():
    bgui.move(500, 500)
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.import_recording(
            "INVOKE_DEFAULT",
            directory=str(FOLDER),
            files=[{"name": TAKE.name}],
            keep_meshes=True,
        )
    yield 2.0
    bgui.shot("1-dialog.png")
    yield from bgui.key("Return")
    yield 0.5
    yield from until_done()
    yield 1.0
    yield from settle()


def press(call):
    with bgui.override("WINDOW"):
        call("INVOKE_DEFAULT")
    yield 0.5
    yield from until_done()
    yield from settle()


def make_rigify():
    addon_utils.enable("rigify", default_set=True)
    with bgui.override("WINDOW"):
        if bpy.context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        bpy.ops.object.armature_human_metarig_add()
        meta = bpy.context.object
        bpy.ops.pose.rigify_generate()
    rig = bpy.context.object
    assert rig is not meta, "Rigify made no rig."
    bpy.data.objects.remove(meta)
    rig.location.x = 1.2
    return rig


def steps():
    empty_scene()
    make_skinned_fbx()
    yield from bgui.open_sidebar("Mocap")
    yield from bring()
    source = bpy.context.object
    meshes = [each for each in bpy.data.objects if each.type == "MESH"]
    check_stands(meshes)
    bgui.shot("2-imported.png")
    yield from press(bpy.ops.mocap_assist.denoise)
    assert source.animation_data.action.name.endswith(".clean")
    check_stands(meshes)
    yield from settle()
    bgui.shot("3-cleaned.png")
    rig = make_rigify()
    yield 1.0
    with bgui.override("WINDOW"):
        bpy.context.view_layer.objects.active = source
        for each in bpy.context.selected_objects:
            each.select_set(False)
        source.select_set(True)
    bpy.context.scene.mocap_assist.retarget.target = rig.name
    yield from press(bpy.ops.mocap_assist.find_bones)
    yield from press(bpy.ops.mocap_assist.retarget)
    assert rig.animation_data.action.name.endswith(".clean.rig")
    view = bgui.area().spaces.active.region_3d
    view.view_location, view.view_distance = (0.6, 0.0, 0.9), 5.0
    for frame in FRAMES:
        bpy.context.scene.frame_set(frame)
        yield from settle()
        bgui.shot(f"4-rigify-{frame}.png")


bgui.run(steps, timeout=1500)
