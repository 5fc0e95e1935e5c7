"""Retarget a hop, a lying-down and a kick onto a skinned Mixamo body, and take pictures.

    make test-gui DRIVERS=contacts

Runs inside a Blender with a window; `bgui` comes with the tool. The pictures show the moments
at which feet and hands meet the floor.
"""

from pathlib import Path

import bgui
import bpy
from driver_scene import empty_scene, settle, until_done

FOLDER = Path(__file__).parent
TIMES = {
    "HDM_bd_hopBothLegs1hops_002_120": (0.3, 0.45, 0.6, 0.75),
    "HDM_bd_lieDownFloor_002_120": (0.3, 0.5, 0.65, 0.9),
    "HDM_bd_kickLFront1Reps_001_120": (0.3, 0.4, 0.5, 0.7),
}
"""Fractions of each take."""


def bring(name):
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.import_recording(filepath=str(FOLDER / name), keep_meshes=True)
    yield 0.5
    yield from until_done()
    yield from settle()


def retarget(source, body):
    with bgui.override("WINDOW"):
        if bpy.context.mode != "OBJECT":
            bpy.ops.object.mode_set(mode="OBJECT")
        for each in bpy.context.selected_objects:
            each.select_set(False)
        bpy.context.view_layer.objects.active = source
        source.select_set(True)
        bpy.context.scene.mocap_assist.retarget.target = body.name
        bpy.ops.mocap_assist.find_bones()
        bpy.ops.mocap_assist.retarget("INVOKE_DEFAULT")
    yield 0.5
    yield from until_done()
    yield from settle()


def steps():
    empty_scene()
    yield from bring("walking.glb")
    body = bpy.context.view_layer.objects.active
    body.location.x += 1.2
    bgui.area().spaces.active.shading.type = "SOLID"
    for name, times in TIMES.items():
        yield from bring(f"{name}.amc")
        source = bpy.context.view_layer.objects.active
        assert source is not body
        action = source.animation_data.action
        yield from retarget(source, body)
        assert body.animation_data.action is not action
        view = bgui.area().spaces.active.region_3d
        view.view_rotation, view.view_distance = (0.76, 0.6, 0.15, 0.2), 3.2
        first, last = action.frame_range
        for fraction in times:
            bpy.context.scene.frame_set(round(first + fraction * (last - first)))
            positions = [each.matrix_world @ each.pose.bones[0].head for each in (source, body)]
            view.view_location = 0.5 * (positions[0] + positions[1])
            view.view_location.z = 0.7
            yield from settle()
            bgui.shot(f"{name.split('_')[2]}-{round(100 * fraction)}.png")
        bpy.data.objects.remove(source)


bgui.run(steps, timeout=1500)
