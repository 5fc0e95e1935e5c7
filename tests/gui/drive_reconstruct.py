"""Reconstruct a Kinect take in a Blender with a window, as an animator does; take pictures.

    make test-gui DRIVERS=reconstruct

Runs inside that Blender; `bgui` comes with the tool. The take, of any depth camera, is copied
next to this script as kinect.txt.
"""

from pathlib import Path

import bgui
import bpy
from driver_scene import empty_scene, settle, unfold_alone

FOLDER = Path(__file__).parent
TAKE = next(iter(sorted(FOLDER.glob("kinect*"))))


def most_mixed(armature):
    """Return the frame with the largest differences of reliability."""
    action = armature.animation_data.action
    curves = [
        curve for curve in action.layers[0].strips[0].channelbags[0].fcurves
        if curve.data_path.endswith('["mocap_reliability"]')
    ]  # fmt: skip

    def spread(frame):
        reliability = sorted(curve.evaluate(frame) for curve in curves)
        return reliability[len(reliability) // 2] - reliability[1]

    return max(range(*map(int, action.frame_range)), key=spread)


def look_at(armature):
    """Rotate the view to an armature, a little from the side."""
    view = bgui.area().spaces.active
    view.overlay.show_relationship_lines = False
    view.region_3d.view_location = armature.pose.bones[0].head
    view.region_3d.view_distance = 2.6
    view.region_3d.view_rotation = (0.79, 0.57, 0.13, 0.18)


def choices(armature):
    """Show the reliability terms, and the sources of postures."""
    manager, settings = bpy.context.window_manager, bpy.context.scene.mocap_assist.reconstruct
    manager.mocap_assist_confidence_term = "TRACKING"
    yield from settle()
    bgui.shot("2b-sensor.png")
    manager.mocap_assist_confidence_term = "COMBINED"
    settings.postures, settings.examples = "EXAMPLES", "walk.clean; /captures/clean"
    yield from settle()
    bgui.shot("3-examples.png")
    settings.postures = "LEARNED"
    raw = armature.animation_data.action["mocap_assist_source"]
    raw["mocap_assist_recording"] = "{}"  # as if the file were gone
    with bgui.override("WINDOW"):
        assert bpy.ops.mocap_assist.reconstruct() == {"FINISHED"}
    yield from settle()
    bgui.shot("4-own-postures-without-the-file.png")


def steps():
    empty_scene()
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.import_recording(
            directory=str(FOLDER), files=[{"name": TAKE.name}], frame_rate="UPDATE"
        )
    unfold_alone("reconstruct")
    yield from bgui.open_sidebar("Mocap")
    armature = bpy.context.object
    look_at(armature)
    yield from settle()
    bgui.shot("1-recorded.png")
    with bgui.override("WINDOW"):
        assert bpy.ops.mocap_assist.reconstruct("INVOKE_DEFAULT") == {"RUNNING_MODAL"}
    for _ in range(200):
        yield 0.5
        if armature.animation_data.action.name.endswith(".reconstructed"):
            break
    assert armature.animation_data.action.name.endswith(".reconstructed")
    bpy.context.window_manager.mocap_assist_confidence = True
    bpy.context.scene.frame_set(most_mixed(armature))
    yield from settle()
    bgui.shot("2-reliability.png")
    yield from choices(armature)


bgui.run(steps, timeout=1500)
