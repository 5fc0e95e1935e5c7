"""Track an actor and correct it in a Blender with a window.

Points of depth, the panel, the body over the points while it solves and afterwards, undo, a
frame posed by hand, Track from Here, and Esc that keeps what is tracked.

    make test-gui DRIVERS=track

Runs inside that Blender; `bgui` comes with the tool. The recording, such as the first 30 frames
of one of `../shared/data/depth/truth`, is copied next to this script.
"""

import importlib
from pathlib import Path
from time import perf_counter

import bgui
import bpy
from driver_scene import empty_scene, settle, unfold_alone
from mathutils import Quaternion

FOLDER = Path(__file__).parent
WALK = FOLDER / "walk.npz"
UNTIL_DONE = 6000  # tenths of a second
SIDE = (0.70, 0.66, 0.18, 0.20)
ARM, WRONG, CORRECTED = "rightUpperArm", range(8, 24), 15
AWAY = Quaternion((0.0, 1.0, 0.0), 1.1)
PREVIEWED = {"Trying": "1-looking.png", "Tracking": "1-tracking.png"}
MAX_REDRAW_S = 0.03
"""Seconds that a redraw may take."""


def prepare():
    """An empty scene with points of depth, and the panel Track alone."""
    empty_scene()
    bpy.context.scene.render.fps = 30
    unfold_alone("track")
    yield from bgui.open_sidebar("Mocap")
    assert bpy.ops.mocap_assist.import_recording(filepath=str(WALK)) == {"FINISHED"}
    view = bgui.area().spaces.active.region_3d
    view.view_location, view.view_rotation = (0.0, 3.0, 0.0), SIDE
    view.view_distance, view.view_perspective = 3.6, "PERSP"


def press(name, shots, stop=lambda job: False):
    """Press a button of the panel and wait until it has ended, or is to be stopped.

    Pictures are taken when a status text first appears, and late during tracking.
    """
    with bgui.override("WINDOW"):
        bpy.ops.ed.undo_push(message="Before")
        getattr(bpy.ops.mocap_assist, name)("INVOKE_DEFAULT")
    job = bpy.context.window_manager.mocap_assist_job
    assert job.running
    shots, frames = dict(shots), set()
    for _ in range(UNTIL_DONE):
        yield 0.1
        frames.add(bpy.context.scene.frame_current)
        word = job.message.partition(" ")[0]
        if word in shots and (word != "Tracking" or job.fraction > 0.5):
            yield 1.0
            bgui.shot(shots.pop(word))
        if not job.running or stop(job):
            break
    assert len(frames) > 3, f"the scene went along to {sorted(frames)} alone"
    assert not shots, f"these status texts did not appear: {list(shots)}"


def undo_and_redo(points):
    """One undo takes the body away."""
    with bgui.override("WINDOW"):
        bpy.ops.ed.undo()
    yield from settle()
    assert [each.name for each in bpy.data.objects] == [points]
    with bgui.override("WINDOW"):
        bpy.ops.ed.redo()
    yield from settle()


def key_wrongly(armature):
    """Rotate an arm away in some frames, as after a tracking failure."""
    bone = armature.pose.bones[ARM]
    for frame in WRONG:
        bpy.context.scene.frame_set(frame)
        bone.rotation_quaternion = AWAY @ bone.rotation_quaternion
        bone.keyframe_insert("rotation_quaternion", frame=frame)


def show_frames(number, name, frames):
    for frame in frames:
        bpy.context.scene.frame_set(frame)
        yield from settle()
        bgui.shot(f"{number}-{name}-{frame}.png")


def time_of_a_redraw(armature):
    """Return the time to build the body, without that of the graphics card."""
    package = "bl_ext.user_default.mocap_assist.mocap_assist"
    overlay = importlib.import_module(f"{package}.track.body_overlay")
    drawing = importlib.import_module(f"{package}.overlays.body_drawing")
    view = bgui.area().spaces.active.region_3d
    began = perf_counter()
    for _ in range(20):
        drawing.batch_of(overlay.body_at(armature, 15), view)
    return (perf_counter() - began) / 20


def correct(armature):
    """Pose the arm as it was, in one frame, and track from there."""
    scene, bone = bpy.context.scene, armature.pose.bones[ARM]
    with bgui.override("WINDOW"):
        bpy.ops.object.mode_set(mode="POSE")
    scene.frame_set(CORRECTED)
    bone.rotation_quaternion = AWAY.inverted() @ bone.rotation_quaternion
    yield from settle()
    bgui.shot("4-posed-by-hand.png")
    before = armature.animation_data.action
    yield from press("retrack", {"Tracking": "5-tracking-again.png"})
    assert scene.frame_current == CORRECTED
    after = armature.animation_data.action
    assert after is not before and after.name.endswith(".retracked"), after.name
    yield from show_frames(6, "mended", (11, 15, 19))
    with bgui.override("WINDOW"):
        bpy.ops.object.mode_set(mode="OBJECT")


def keep_on_esc(points):
    """Esc in the middle makes an armature of what was tracked until then."""
    manager = bpy.context.window_manager
    bpy.context.scene.mocap_assist.track.keep_on_esc = True
    bpy.context.view_layer.objects.active = points
    n_before = len(bpy.data.armatures)
    yield from settle()
    yield from press("track_depth", {}, lambda job: job.fraction > 0.6)
    bgui.shot("7-before-esc.png")
    yield from bgui.key("Escape")
    for _ in range(50):
        yield 0.2
        if not manager.mocap_assist_job.running:
            break
    assert len(bpy.data.armatures) == n_before + 1, "Esc kept nothing"
    yield from settle()
    bgui.shot("8-kept.png")


def steps():
    yield from prepare()
    points = bpy.context.object
    points.select_set(False)  # active alone, so that its points keep their color
    name = points.name
    yield from settle()
    bgui.shot("0-points.png")
    yield from press("track_depth", PREVIEWED)
    assert bpy.context.scene.frame_current == 1
    assert bpy.context.object.type == "ARMATURE", bpy.context.object
    yield from undo_and_redo(name)
    armature = next(each for each in bpy.data.objects if each.type == "ARMATURE")
    points = bpy.data.objects[name]
    bpy.context.window_manager.mocap_assist_body = True
    yield from show_frames(2, "body", (1, 15))
    cost = time_of_a_redraw(armature)
    print(f"bgui: the body costs {1000 * cost:.1f} ms per redraw")
    assert cost < MAX_REDRAW_S
    key_wrongly(armature)
    yield from show_frames(3, "wrong", (11, 15))
    yield from correct(armature)
    yield from keep_on_esc(points)


bgui.run(steps, timeout=1500)
