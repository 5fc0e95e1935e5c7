"""Track an actor in a Blender with a window, while a recorder writes depth images.

The panel, points of the actor while he is measured, the body at camera rate, the status bar,
Esc, undo, and Stop while no image comes.

    make test-gui DRIVERS=track_live

Runs inside that Blender; `bgui` comes with the tool. A recording of
`../shared/data/depth/truth` and `record_images.py` are copied next to this script.
"""

import importlib
import json
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path
from time import monotonic

import bgui
import bpy
from driver_scene import PACKAGE, empty_scene, settle, unfold_alone

FOLDER = Path(__file__).parent
WALK, RECORDER = FOLDER / "walk.npz", FOLDER / "record_images.py"
TAKES = Path(tempfile.mkdtemp())
SIDE = (0.70, 0.66, 0.18, 0.20)
UNTIL_DONE = 3000  # tenths of a second
N_SHOWN = 60
"""Poses that are shown before the first picture."""
STOP = (400, 12)
"""Of the button in the status bar, while it says that images are waited for."""
shown_at = []


def prepare():
    """An empty scene, the panel alone, and a note of each pose that is shown."""
    empty_scene()
    unfold_alone("tracklive")
    yield from bgui.open_sidebar("Mocap")
    view = bgui.area().spaces.active.region_3d
    view.view_location, view.view_rotation = (0.0, 3.0, 0.0), SIDE
    view.view_distance, view.view_perspective = 5.0, "PERSP"
    view_class = importlib.import_module(
        f"{PACKAGE}.mocap_assist.track.following_view"
    ).FollowingView
    solid_of = view_class.solid_of

    def noted(self, *arguments):
        shown_at.append(monotonic())
        return solid_of(self, *arguments)

    view_class.solid_of = noted
    live = bpy.context.scene.mocap_assist.track_live
    live.unit, live.focal_length = "MILLIMETRES", 285.63
    live.calibration = 1.0
    bpy.context.scene.mocap_assist.track.refine = False


def record(name):
    """Start the recorder; return its process and folder."""
    folder = TAKES / name
    process = subprocess.Popen([python(), RECORDER, WALK, folder])
    return process, folder


def python():
    return shutil.which("python3") or sys.executable


def press(folder):
    bpy.context.scene.mocap_assist.track_live.recording_file = str(folder)
    with bgui.override("WINDOW"):
        bpy.ops.ed.undo_push(message="Before")
        bpy.ops.mocap_assist.track_live("INVOKE_DEFAULT")
    assert job().running


def job():
    return bpy.context.window_manager.mocap_assist_job


def until(happened, what):
    for _ in range(UNTIL_DONE):
        yield 0.1
        if happened():
            return
    raise AssertionError(f"not {what}: {job().message} {job().fraction}")


def until_done():
    yield from until(lambda: not job().running, "done")
    yield from settle()


def armatures():
    return [each for each in bpy.data.objects if each.type == "ARMATURE"]


def follow_until_esc():
    """Points, the body, Esc, and a result that undo takes away."""
    bgui.shot("0-panel.png")
    recorder, folder = record("take")
    press(folder)
    yield from until(lambda: "measured" in job().message, "collecting")
    bgui.shot("1-collecting.png")
    yield from until(lambda: job().message.startswith("Tracking"), "tracking")
    assert not [*bpy.data.objects] and job().ending.startswith("Esc ends"), job().ending
    yield from until(lambda: len(shown_at) > N_SHOWN, "shown")
    bgui.shot("2-tracking.png")
    yield 3.0
    bgui.shot("3-tracking-later.png")
    recent = sum(at > shown_at[-1] - 2.0 for at in shown_at)
    print(f"bgui: {len(shown_at)} poses, {recent} in the last 2 s; {job().message}")
    yield from bgui.key("Escape")
    yield from until_done()
    recorder.terminate()


def check_result():
    """The points and the armature, which undo takes away."""
    (armature,) = armatures()
    assert bpy.context.object == armature, bpy.context.object
    action = armature.animation_data.action
    print(f"bgui: {bpy.context.scene.mocap_assist.report}")
    assert not json.loads(action["mocap_assist_captured"])["settings"]["refine"]
    last = round(action.frame_range[1])
    assert last > N_SHOWN and bpy.context.scene.frame_end == last
    bpy.context.scene.frame_set(last - 10)
    yield from settle()
    bgui.shot("4-armature.png")
    with bgui.override("WINDOW"):
        bpy.ops.ed.undo()
    yield from settle()
    assert not [*bpy.data.objects], [*bpy.data.objects]
    with bgui.override("WINDOW"):
        bpy.ops.ed.redo()
    yield from settle()
    assert len(armatures()) == 1


def stop_without_images():
    """Stop in the status bar, while no image comes, changes nothing."""
    before = [each.name for each in bpy.data.objects]
    press(TAKES / "nothing")
    yield from until(lambda: job().message.startswith("Waiting for"), "waiting")
    bgui.shot("5-waiting.png")
    yield from bgui.click(*STOP)
    yield from until_done()
    assert [each.name for each in bpy.data.objects] == before
    bgui.shot("6-stopped.png")


def steps():
    yield from prepare()
    yield from settle()
    yield from follow_until_esc()
    yield from check_result()
    yield from stop_without_images()


bgui.run(steps, timeout=1500)
