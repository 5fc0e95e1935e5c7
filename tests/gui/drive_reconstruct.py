"""Reconstruct a Kinect take in a Blender with a window, as an animator does; take pictures.

    make extension-plain
    BG_DEBS="python3-scipy python3-pil" BG_FILES=kinect.txt \
        bash ../shared/tools/blender-gui.sh run dist/mocap_assist-0.1.0-plain.zip \
        tests/gui/drive_reconstruct.py build/gui/reconstruct.png

Runs inside that Blender; `bgui` comes with the tool. The take, of any depth camera, is copied
beside this script as kinect.txt.
"""

from pathlib import Path

import bgui
import bpy

FOLDER = Path(__file__).parent
TAKE = next(iter(sorted(FOLDER.glob("kinect*"))))


def settle():
    """Wait until everything is drawn."""
    for _ in range(3):
        bgui.redraw()
        yield 0.5


def unfold_reconstruct_alone():
    """Take the other panels away, and unfold this one, before the tab is first drawn."""
    for name in ("import", "clean", "check", "compare", "feet", "physics", "retarget"):
        bpy.utils.unregister_class(getattr(bpy.types, f"MOCAP_PT_{name}"))
    panel = bpy.types.MOCAP_PT_reconstruct
    bpy.utils.unregister_class(panel)
    panel.bl_options = set()
    bpy.utils.register_class(panel)


def most_mixed(armature):
    """Return the frame at which joints are trusted most differently."""
    action = armature.animation_data.action
    curves = [
        curve for curve in action.layers[0].strips[0].channelbags[0].fcurves
        if curve.data_path.endswith('["mocap_reliability"]')
    ]  # fmt: skip

    def spread(frame):
        trust = sorted(curve.evaluate(frame) for curve in curves)
        return trust[len(trust) // 2] - trust[1]

    return max(range(*map(int, action.frame_range)), key=spread)


def look_at(armature):
    """Turn the view, a little from the side, to where an armature is."""
    view = bgui.area().spaces.active
    view.overlay.show_relationship_lines = False
    view.region_3d.view_location = armature.pose.bones[0].head
    view.region_3d.view_distance = 2.6
    view.region_3d.view_rotation = (0.79, 0.57, 0.13, 0.18)


def choices(armature):
    """Show the signs of trust, and where postures may come from."""
    manager, settings = bpy.context.window_manager, bpy.context.scene.mocap_assist.reconstruct
    manager.mocap_assist_heat_term = "TRACKING"
    yield from settle()
    bgui.shot("2b-sensor.png")
    manager.mocap_assist_heat_term = "COMBINED"
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
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.import_recording(
            directory=str(FOLDER), files=[{"name": TAKE.name}], frame_rate="UPDATE"
        )
    unfold_reconstruct_alone()
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
    bpy.context.window_manager.mocap_assist_heat = True
    bpy.context.scene.frame_set(most_mixed(armature))
    yield from settle()
    bgui.shot("2-trust.png")
    yield from choices(armature)


bgui.run(steps, timeout=300)
