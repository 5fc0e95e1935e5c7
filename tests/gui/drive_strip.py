"""See the strip below the keys, and the raw take while its key is held; take pictures.

    make test-gui DRIVERS=strip

Runs inside a Blender with a window; `bgui` comes with the tool. It also prints how long one
drawing of the strip takes, for an action of 100 bones and 10,000 frames.
"""

import tempfile
import time
from importlib import import_module
from pathlib import Path

import bgui
import bpy
import numpy as np
from driver_scene import (
    N_BONES,
    N_FRAMES,
    empty_scene,
    large_action,
    lose_arm,
    made_up_confidence,
    make_the_timeline_higher,
    open_preferences,
    ours,
    settle,
    time_uploads,
    unfold_alone,
    until_checked,
    until_done,
)

PACKAGE = "bl_ext.user_default.mocap_assist"
N_TIMES = 20
LOOKED_AT = 151
WORKSPACE = ["ASSETS", "DOPESHEET", "FCURVES", "VIEW_3D"]
UNTIL_ARRANGED = 60  # seconds


def import_walk():
    """Import a walk with spikes and sliding feet, without its right arm for two seconds."""
    samples = import_module(f"{PACKAGE}.solvers.samples")
    write_bvh = import_module(f"{PACKAGE}.solvers.recordings").write_bvh
    walk = samples.walking_gait(samples.GaitSettings(duration=8.0, frame_rate=30.0))
    wrong = samples.CorruptionSettings(jitter=3.0, spikes=0.004, root_sway=0.03)
    path = Path(tempfile.mkdtemp()) / "walk.bvh"
    write_bvh(samples.corrupt(walk, wrong), path)
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.import_recording(filepath=str(path))
    yield 0.5
    yield from until_done()
    armature = bpy.context.view_layer.objects.active
    lose_arm(armature)


def press(button):
    with bgui.override("WINDOW"):
        getattr(bpy.ops.mocap_assist, button)("INVOKE_DEFAULT")
    yield 0.5
    yield from until_done()
    yield from settle()


def open_editors():
    """Show the Timeline below, and the Graph Editor in the lower half of the 3D View."""
    with bgui.override("WINDOW"):
        bpy.ops.screen.area_split(direction="HORIZONTAL", factor=0.5)
    yield 0.5
    views = [each for each in bgui.window().screen.areas if each.type == "VIEW_3D"]
    lower = min(views, key=lambda each: each.y)
    lower.ui_type = "FCURVES"
    yield 0.5
    for kind, operator in (
        ("GRAPH_EDITOR", bpy.ops.graph),
        ("DOPESHEET_EDITOR", bpy.ops.action),
    ):
        with bgui.override("WINDOW", kind):
            operator.view_all()
    yield from settle()


def look_at(armature):
    view = bgui.area().spaces.active.region_3d
    bpy.context.scene.frame_set(LOOKED_AT)
    view.view_location = armature.matrix_world @ armature.pose.bones[0].head
    view.view_rotation, view.view_distance = (0.76, 0.6, 0.15, 0.2), 4.0


def hold_the_key(armature):
    """The raw take plays from the press to the release, in an X window as in any other."""
    clean = armature.animation_data.action
    view = bgui.area()
    bgui.move(view.x + view.width // 3, view.y + view.height // 2)
    yield 0.3
    n_steps = len(bpy.context.window_manager.operators)
    bgui.x("keydown", "y")
    yield 1.0
    assert armature.animation_data.action.name == "walk", armature.animation_data.action
    yield from settle(2)
    bgui.shot("5-raw-held.png")
    bgui.x("keyup", "y")
    yield 0.5
    assert armature.animation_data.action == clean
    assert len(bpy.context.window_manager.operators) == n_steps
    yield from settle(2)
    bgui.shot("6-released.png")
    bgui.x("keydown", "y")
    yield 0.5
    assert armature.animation_data.action != clean
    yield from bgui.key("Escape")
    yield 0.3
    assert armature.animation_data.action == clean
    bgui.x("keyup", "y")
    yield 0.3
    assert armature.animation_data.action == clean


def see_issues():
    """List them, mark them, and look at one with the frames around it."""
    yield from press("measure_quality")
    bgui.shot("1b-raw-checked.png")
    yield from press("mark_issues")
    bgui.shot("1c-markers.png")
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.mark_issues(remove=True)
    assert not bpy.context.scene.timeline_markers
    bpy.context.window_manager.mocap_assist_issue_range = True
    with bgui.override("WINDOW"):
        bpy.ops.mocap_assist.jump_to_issue(index=3)
    yield from settle(2)
    bgui.shot("1d-issue-range.png")
    bpy.context.window_manager.mocap_assist_issue_range = False


def see_ghosts_and_wipe():
    """Ghosts and trails of both takes, then each take on its side of a line."""
    manager = bpy.context.window_manager
    manager.mocap_assist_onion = True
    yield from settle(2)
    bgui.shot("6b-onion.png")
    manager.mocap_assist_onion, manager.mocap_assist_wipe = False, True
    yield from settle(2)
    bgui.shot("6c-wipe.png")
    manager.mocap_assist_wipe = False


def drag_on_the_strip():
    """A drag sets the range in the Graph Editor and in the Timeline; a click clears it."""
    scene, drag = bpy.context.scene, ours("overlays.strip.drag")
    for kind, picture in (("GRAPH_EDITOR", "3b-dragged.png"), ("DOPESHEET_EDITOR", None)):
        region = bgui.region("WINDOW", kind)
        with bgui.override("WINDOW", kind):
            found = ours("overlays.strip.drawing").fitting_strip(bpy.context)
            bottom, row = ours("overlays.strip.drawing").strip_height(
                bpy.context, len(found.rows)
            )
        columns = [region.x + int(part * region.width) for part in (0.4, 0.5, 0.6)]
        line = region.y + int(bottom + 0.5 * row)
        bgui.move(columns[0], line)
        yield 0.3
        bgui.x("mousedown", 1)
        for column in columns:
            bgui.move(column, line)
            yield 0.3
        bgui.x("mouseup", 1)
        yield 0.5
        assert scene.use_preview_range, kind
        ends = scene.frame_preview_start, scene.frame_preview_end
        expected = drag.frames_between(region, *(each - region.x for each in columns[::2]))
        assert np.abs(np.subtract(ends, expected)).max() <= 1, (ends, expected)
        assert scene.mocap_assist.clean.frame_range == "PREVIEW"
        yield from settle(2)
        if picture:
            bgui.shot(picture)
        yield from bgui.click(columns[0], line)
        yield 0.3
        assert not scene.use_preview_range, kind
        assert scene.mocap_assist.clean.frame_range == "ACTION"


def see_raw_curves(armature):
    """The recorded curves of one bone, behind those of the result."""
    compat = ours("blender.compat")
    for bone in armature.pose.bones:
        compat.select_bone(bone, bone.name == "LeftLeg")
    armature.data.bones.active = armature.data.bones["LeftLeg"]
    with bgui.override("WINDOW", "GRAPH_EDITOR"):
        pairs = ours("overlays.comparison.raw_curves").shown_pairs(bpy.context)
        bpy.ops.graph.view_all()
    assert pairs and all("LeftLeg" in each.recorded.data_path for each in pairs), pairs
    yield from settle(2)
    bgui.shot("3c-raw-curves.png")
    space = bgui.area("GRAPH_EDITOR").spaces.active
    space.use_normalization = True
    with bgui.override("WINDOW", "GRAPH_EDITOR"):
        bpy.ops.graph.view_all()
    yield from settle(2)
    bgui.shot("3d-raw-curves-normalized.png")
    space.use_normalization = False
    for bone in armature.pose.bones:
        compat.select_bone(bone, True)


def measure():
    """Print the time of the first drawing, which reads the action, and of the others."""
    large_action()
    as_long = bpy.data.objects.new("as long", None)
    bpy.context.scene.collection.objects.link(as_long)
    for frame in (1, N_FRAMES):
        as_long.keyframe_insert("location", frame=frame)
    for each in bpy.context.view_layer.objects:
        each.select_set(each == as_long)  # Blender need not draw millions of keys
    bpy.context.scene.frame_end = N_FRAMES
    switch, times, cpu_times = ours("overlays.strip.switch"), [], []
    draw_strip = switch.draw_strip
    uploads = time_uploads()

    def timed(context):
        started, cpu_started = time.perf_counter(), time.thread_time()
        draw_strip(context)
        times.append(1000.0 * (time.perf_counter() - started))
        cpu_times.append(1000.0 * (time.thread_time() - cpu_started))

    switch.draw_strip = timed
    graph = bgui.area("GRAPH_EDITOR")
    graph.ui_type = "DOPESHEET"
    yield 0.5
    graph.spaces.active.dopesheet.show_only_selected = True
    with bgui.override("WINDOW", "DOPESHEET_EDITOR"):
        bpy.ops.action.view_all()
    for _ in range(N_TIMES):
        bgui.redraw()
        yield 0.2
    bgui.shot("7-large.png")
    switch.draw_strip = draw_strip
    assert len(times) > N_TIMES
    print(
        f"bgui: the strip of {N_BONES} bones and {N_FRAMES} frames: first {times[0]:.1f} ms,"
        f" then median {np.median(times[1:]):.3f} ms, of the processor"
        f" {np.median(cpu_times[1:]):.3f} ms, best {min(times):.3f} ms, of {len(times)};"
        f" uploads to the GPU, once: {', '.join(f'{each:.1f}' for each in uploads)} ms",
        flush=True,
    )


def add_the_workspace():
    """One press adds it, and a second one shows it again."""
    for _ in range(2):
        with bgui.override("WINDOW"):
            assert bpy.ops.mocap_assist.add_workspace() == {"FINISHED"}
        for _ in range(UNTIL_ARRANGED):  # each step has a turn, and redraws are slow here
            yield 1.0
            kinds = sorted(each.ui_type for each in bgui.window().screen.areas)
            if kinds == WORKSPACE:
                break
        assert bgui.window().workspace.name == "Mocap"
        assert kinds == WORKSPACE, kinds
    assert [each.name for each in bpy.data.workspaces].count("Mocap") == 1
    assert bgui.region().active_panel_category == "Mocap"
    yield from settle(2)
    bgui.shot("7b-workspace.png")


def steps():
    empty_scene()
    unfold_alone("check")
    yield from import_walk()
    armature = bpy.context.view_layer.objects.active
    with bgui.override("WINDOW"):
        bpy.ops.object.mode_set(mode="POSE")
    look_at(armature)
    yield from open_editors()
    yield from bgui.open_sidebar("Mocap")
    yield from settle(pointer=(500, 700))
    bgui.shot("1-raw.png")
    yield from see_issues()
    yield from press("denoise")
    bgui.shot("2-cleaned.png")
    yield from until_done()
    yield from until_checked("walk.clean")
    yield from settle(2)
    bgui.shot("3-checked.png")
    yield from make_the_timeline_higher()
    yield from drag_on_the_strip()
    yield from see_raw_curves(armature)
    made_up_confidence(armature)
    yield from settle(5)
    bgui.shot("4-confidence.png")
    yield from hold_the_key(armature)
    yield from see_ghosts_and_wipe()
    yield from measure()
    yield from add_the_workspace()
    yield from open_preferences()
    bgui.shot("8-preferences.png")  # the key can be changed there


bgui.run(steps, timeout=1500)
