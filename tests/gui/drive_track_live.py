"""Track an actor in a Blender with a window, while a recorder writes depth images.

The panel, points of the actor while he is measured, the body at camera rate, the status bar,
Stop, undo, a folder without images, a recorder that stops by itself, and one that is removed.

    make test-gui DRIVERS=track_live

Runs inside that Blender; `bgui` comes with the tool. A recording of
`../shared/data/depth/truth` and `record_images.py` are copied next to this script.
"""

import importlib
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
MIN_POSES_PER_S = 10.0
"""Of a machine that draws without a graphics card and does other work too."""
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
    live.calibration, live.max_silence = 1.0, 3.0


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


def follow_until_stop():
    """Points, the body, Stop in the status bar, and undo."""
    bgui.shot("0-panel.png")
    recorder, folder = record("take")
    press(folder)
    yield from until(lambda: "measured" in job().message, "collecting")
    yield 1.0
    bgui.shot("1-collecting.png")
    yield from until(lambda: job().message.startswith("Tracking"), "tracking")
    assert not armatures()
    yield from until(lambda: len(shown_at) > 60, "shown")
    bgui.shot("2-tracking.png")
    yield 2.0
    bgui.shot("3-tracking-later.png")
    recent = [at for at in shown_at if at > shown_at[-1] - 2.0]
    rate = (len(recent) - 1) / (recent[-1] - recent[0])
    print(f"bgui: {len(shown_at)} poses, {rate:.1f} in a second; {job().message}")
    assert rate > MIN_POSES_PER_S
    assert job().ending.startswith("Esc ends"), job().ending
    yield from bgui.key("Escape")
    yield from until(lambda: "discards" in job().ending or not job().running, "ending")
    bgui.shot("4-finishing.png")
    yield from until_done()
    recorder.terminate()
    (armature,) = armatures()
    assert bpy.context.object == armature, bpy.context.object
    action = armature.animation_data.action
    first, last = action.frame_range
    print(f"bgui: {bpy.context.scene.mocap_assist.report}")
    assert last - first > 60 and bpy.context.scene.frame_end == round(last)
    bpy.context.scene.frame_set(round(last) - 20)
    yield from settle()
    bgui.shot("5-armature.png")
    with bgui.override("WINDOW"):
        bpy.ops.ed.undo()
    yield from settle()
    assert not [*bpy.data.objects], [*bpy.data.objects]
    with bgui.override("WINDOW"):
        bpy.ops.ed.redo()
    yield from settle()
    assert len(armatures()) == 1


def steps():
    yield from prepare()
    yield from settle()
    yield from follow_until_stop()


bgui.run(steps, timeout=1500)
