"""Track an actor in a Blender with a window: bring in depth, press Track, look at the result.

    make extension-plain
    BG_DEBS="python3-scipy python3-pil" BG_FILES="walk.npz" \
        bash ../shared/tools/blender-gui.sh run dist/mocap_assist-0.1.0-plain.zip \
        tests/gui/drive_track.py build/gui/track/track.png

Runs inside that Blender; `bgui` comes with the tool. The recording, such as the first 30 frames
of one of `../shared/data/depth/truth`, is copied beside this script.
"""

from pathlib import Path

import bgui
import bpy

FOLDER = Path(__file__).parent
WALK = FOLDER / "walk.npz"
UNTIL_DONE = 6000  # tenths of a second
SIDE = (0.70, 0.66, 0.18, 0.20)


def settle():
    """Wait until everything is drawn."""
    for _ in range(3):
        bgui.redraw()
        yield 0.5


def look_at(center, distance, rotation):
    view = bgui.area().spaces.active.region_3d
    view.view_location = center
    view.view_rotation = rotation
    view.view_distance = distance
    view.view_perspective = "PERSP"


def unfold_track_alone():
    """Take the other panels away, and unfold this one, before the tab is first drawn."""
    for name in ("reconstruct", "clean", "compare", "feet", "physics", "retarget"):
        bpy.utils.unregister_class(getattr(bpy.types, f"MOCAP_PT_{name}"))
    panel = bpy.types.MOCAP_PT_track
    bpy.utils.unregister_class(panel)
    panel.bl_options = set()
    bpy.utils.register_class(panel)


def watch_it(job):
    """See the body over the points while it is looked for, tracked, and at last."""
    shots = {"Trying": "2-looking.png", "Tracking": "3-tracking.png", "Judging": "4-last.png"}
    frames = set()
    for _ in range(UNTIL_DONE):
        yield 0.1
        frames.add(bpy.context.scene.frame_current)
        word = job.message.partition(" ")[0]
        if word in shots and (word != "Tracking" or job.fraction > 0.6):
            yield 1.0
            bgui.shot(shots.pop(word))
        if not job.running:
            break
    assert len(frames) > 8, f"the scene went along to {sorted(frames)} alone"
    assert bpy.context.scene.frame_current == 1


def steps():
    # Points of depth, the panel, progress while it solves, and the body over the points.
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)
    bpy.context.scene.render.fps = 30
    unfold_track_alone()
    yield from bgui.open_sidebar("Mocap")
    assert bpy.ops.mocap_assist.import_recording(filepath=str(WALK)) == {"FINISHED"}
    name = bpy.context.object.name
    look_at((0.0, 3.0, 0.0), 4.5, SIDE)
    yield from settle()
    bgui.shot("1-points.png")
    with bgui.override("WINDOW"):
        bpy.ops.ed.undo_push(message="Imported")
        bpy.ops.mocap_assist.track_depth("INVOKE_DEFAULT")
    job = bpy.context.window_manager.mocap_assist_job
    assert job.running and job.owner == "track"
    yield from watch_it(job)
    armature = bpy.context.object
    assert armature is not None and armature.type == "ARMATURE", armature
    for number, frame in enumerate((1, 15, 30), start=5):
        bpy.context.scene.frame_set(frame)
        yield from settle()
        bgui.shot(f"{number}-frame-{frame}.png")
    with bgui.override("WINDOW"):
        bpy.ops.ed.undo()
    yield from settle()
    assert [each.name for each in bpy.data.objects] == [name]


bgui.run(steps, timeout=900)
