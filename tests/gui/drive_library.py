"""Index clips and find similar ones in a Blender with a window, as an animator does.

    make test-gui DRIVERS=library

Runs inside that Blender; `bgui` comes with the tool. The folder `clips` holds recordings, and
is copied next to this script; clips similar to the last of them are searched. The first is also
written as a .blend file, so that another Blender has to read that.
"""

from importlib import import_module
from pathlib import Path

import bgui
import bpy
import numpy as np
from driver_scene import PACKAGE, empty_scene, settle, unfold_alone

FOLDER = Path(__file__).parent
CLIPS = FOLDER / "clips"
LIBRARY = FOLDER / "clips.library"
UNTIL_DONE = 900  # tenths of a second


def bring(path):
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.import_recording(
            directory=str(path.parent), files=[{"name": path.name}], frame_rate="UPDATE"
        )
    return bpy.context.view_layer.objects.active


def write_blend(path):
    """Keep what is in the scene as a .blend file, with one action as an asset."""
    action = bpy.context.view_layer.objects.active.animation_data.action
    action.asset_mark()
    action.asset_data.tags.new("asset of ours")
    bpy.ops.wm.save_as_mainfile(filepath=str(path), copy=True)
    action.asset_clear()


def press(text, column=0.5):
    yield from bgui.scan(columns=(column,))
    yield from bgui.click(*bgui.at(text))


def wait_for(until):
    for _ in range(UNTIL_DONE):
        if until():
            return
        yield 0.1
    raise AssertionError("It does not end.")


def state():
    return bpy.context.window_manager.mocap_assist_indexing


def matches():
    return bpy.context.window_manager.mocap_assist_matches


def look_at(armature):
    view = bgui.area().spaces.active.region_3d
    view.view_location = armature.matrix_world @ armature.pose.bones[0].head
    view.view_rotation = (0.76, 0.6, 0.15, 0.2)
    view.view_distance = 4.5


def index():
    bpy.context.scene.mocap_assist.library.library_file = str(LIBRARY)
    bpy.context.scene.mocap_assist.library.sources = str(CLIPS)
    yield from settle()
    bgui.shot("1-sources.png")
    yield from press("mocap_assist.index_library")
    yield 1.0
    assert state().running
    yield from settle(2)
    bgui.shot("2-indexing.png")
    yield from wait_for(lambda: not state().running)
    assert state().report.startswith("The library has "), state().report
    yield from settle()
    bgui.shot("3-indexed.png")


def keep_current():
    """What is added while the switch is on is read without anybody pressing Index."""
    yield from press("mocap_assist.keep_current", column=0.75)
    report = state().report
    first = sorted(CLIPS.glob("*.bvh"))[0]
    (CLIPS / "added.bvh").write_bytes(first.read_bytes())
    yield from wait_for(lambda: state().report != report)
    assert "1 read" in state().report, state().report
    yield from settle()
    bgui.shot("3-kept-current.png")


def find():
    yield from press("mocap_assist.find_similar")
    job = bpy.context.window_manager.mocap_assist_job
    yield 1.0
    yield from wait_for(lambda: not job.running)
    assert len(matches().rows) > 2
    bpy.context.window_manager.mocap_assist_ghost = True
    yield from settle()
    bgui.shot("4-found.png")
    yield from press("choose_match(index=1)", column=0.75)
    assert matches().active == 1
    matches().active = 0


def differs(*names):
    """Whether two pictures differ."""
    images = [bpy.data.images.load(str(Path(bgui.OUT) / name)) for name in names]
    pixels = [np.array(image.pixels[:]) for image in images]
    for image in images:
        bpy.data.images.remove(image)
    return np.abs(pixels[0] - pixels[1]).max() > 0.1


def browse():
    """The matches over the view: one plays under the pointer, a click selects it."""
    yield from press("mocap_assist.browse_matches")
    view = bgui.area()
    cells = import_module(f"{PACKAGE}.mocap_assist.find_similar.gallery_drawing")
    layout = import_module(f"{PACKAGE}.mocap_assist.find_similar.gallery")
    pixels = import_module(f"{PACKAGE}.mocap_assist.overlays.pixel_drawing")
    space = pixels.free_space(view)
    scale = bpy.context.preferences.system.ui_scale
    below = space._replace(height=space.height - cells.HEAD_PX * scale)
    cell = layout.cells_in(below, len(matches().rows), scale)[2]
    region = bgui.region("WINDOW")
    middle = region.x + cell.x + 0.5 * cell.width, region.y + cell.y + 0.5 * cell.height
    bgui.move(*middle)
    yield 1.0
    bgui.shot("4b-played.png")
    yield 0.5
    bgui.shot("4c-played-later.png")
    assert differs("4b-played.png", "4c-played-later.png"), "nothing plays"
    yield from bgui.click(*middle)
    yield 0.5
    assert matches().active == 2, matches().active
    matches().active = 0
    yield from press("mocap_assist.browse_matches")
    yield from bgui.key("Escape")
    yield 0.3
    assert matches().active == 0
    bgui.shot("4d-closed.png")


def use(armature):
    before = armature.animation_data.action
    bpy.context.scene.frame_set(int(before.frame_range[0]) + 60)
    look_at(armature)
    matches().active = 1
    yield from settle()
    bgui.shot("5-ghost.png")
    bpy.context.preferences.view.ui_scale = 0.7  # then all of the panel is visible
    yield from settle()
    bgui.shot("6-uses.png")
    job = bpy.context.window_manager.mocap_assist_job
    yield from press("load_match(result_as='ACTION')", column=0.2)
    yield 1.0
    yield from wait_for(lambda: not job.running)
    yield from wait_for(lambda: armature.animation_data.action != before)
    yield from settle()
    bgui.shot("7-appended.png")


def steps():
    empty_scene()
    unfold_alone("library")
    paths = sorted(CLIPS.glob("*.bvh"))
    other = bring(paths[0])
    write_blend(CLIPS / "shot.blend")
    bpy.data.objects.remove(other)
    armature = bring(paths[-1])
    look_at(armature)
    bgui.area().spaces.active.show_region_ui = True
    yield from bgui.open_sidebar("Mocap", 420)
    yield from index()
    yield from keep_current()
    yield from find()
    yield from browse()
    yield from use(armature)


bgui.run(steps, timeout=1500)
