"""What the drivers have in common. Runs in the Blender with a window, as they do."""

import tempfile
import time
from importlib import import_module
from pathlib import Path

import bgui
import bpy
import numpy as np

PACKAGE = "bl_ext.user_default.mocap_assist"
SECONDS = 8.0  # of the noisy walk
MISSING = ("RightArm", range(120, 180))

PANELS = "MOCAP_PT_"
UNTIL_DONE = 1800  # tenths of a second
WHEEL_UP, WHEEL_DOWN = 4, 5
N_BONES, N_FRAMES = 100, 10_000
"""Of a large action."""
GENERATED = 5
"""Blender's number for that type of key."""
HIGHER = 80  # pixels
TOP = (1152, 872)
"""Of the tab: scrolled from there, no list comes under the mouse, which it would scroll."""


def empty_scene():
    for each in list(bpy.data.objects):
        bpy.data.objects.remove(each)


def unfold_alone(name):
    """Hide all other panels, and unfold this one, before the tab is first drawn."""
    bpy.context.window_manager.mocap_assist_all_panels = True
    for each in [other for other in dir(bpy.types) if other.startswith(PANELS)]:
        panel = getattr(bpy.types, each)
        bpy.utils.unregister_class(panel)
        if each == f"{PANELS}{name}":
            panel.bl_options = set()
            if hasattr(panel, "bl_parent_id"):
                del panel.bl_parent_id
        else:
            panel.poll = classmethod(lambda cls, context: False)
        bpy.utils.register_class(panel)


def settle(times=3, pointer=None):
    """Wait until everything is drawn; move the pointer off the buttons before, if given."""
    if pointer:
        bgui.move(*pointer)
    for _ in range(times):
        bgui.redraw()
        yield 0.5


def scroll(wheel):
    """Show the end of the tab, or its beginning."""
    bgui.move(*TOP)
    for _ in range(40):
        bgui.x("click", wheel)
        yield 0.05
    yield from settle()


def until_done():
    """Wait until the running import or solve has ended."""
    job = bpy.context.window_manager.mocap_assist_job
    for _ in range(UNTIL_DONE):
        yield 0.1
        if not job.running:
            return
    raise AssertionError(f"{job.message} {job.fraction}")


def until_checked(action):
    """Wait until the result is checked again; that has a process of its own."""
    for _ in range(UNTIL_DONE):
        if bpy.context.scene.mocap_assist.checked_action.name == action:
            return
        yield 0.1
    raise AssertionError(f"{action} is not checked again")


def open_preferences():
    """Show those of the extension in a window of their own."""
    bpy.ops.screen.userpref_show("INVOKE_DEFAULT")
    yield 1.0
    window = bpy.context.window_manager.windows[-1]
    bpy.context.preferences.active_section = "ADDONS"
    bpy.context.window_manager.addon_search = "mocap"
    with bpy.context.temp_override(window=window):
        bpy.ops.preferences.addon_expand(module=PACKAGE)
    yield 1.5


def import_noisy_walk():
    """Make a walk with jitter, spikes, sliding feet and a missing arm, and import it."""
    samples = import_module(f"{PACKAGE}.solvers.samples")
    write_bvh = import_module(f"{PACKAGE}.solvers.recordings").write_bvh
    walk = samples.walking_gait(samples.GaitSettings(duration=SECONDS, frame_rate=30.0))
    wrong = samples.CorruptionSettings(
        jitter=3.0, spikes=0.004, root_jitter=0.004, root_sway=0.03
    )
    path = Path(tempfile.mkdtemp()) / "walk.bvh"
    write_bvh(samples.corrupt(walk, wrong), path)
    with bgui.override("WINDOW"):
        bpy.ops.import_anim.bvh(
            filepath=str(path),
            global_scale=0.01,
            rotate_mode="NATIVE",
            update_scene_fps=True,
            update_scene_duration=True,
        )
    return bpy.context.view_layer.objects.active


def lose_arm(armature):
    """Remove the keys of one arm for two seconds."""
    action, slot = armature.animation_data.action, armature.animation_data.action_slot
    bone = armature.pose.bones[MISSING[0]]
    names = [bone.name, *(each.name for each in bone.children_recursive)]
    for curve in action.layers[0].strips[0].channelbag(slot).fcurves:
        if any(f'bones["{name}"]' in curve.data_path for name in names):
            for key in reversed(curve.keyframe_points):
                if round(key.co.x) in MISSING[1]:
                    curve.keyframe_points.remove(key, fast=True)
            curve.update()


def look_at_figure():
    """Rotate the view to the figure at the current frame."""
    view = bgui.area().spaces.active.region_3d
    hips = bpy.context.object.pose.bones[0]
    view.view_location = bpy.context.object.matrix_world @ hips.head
    view.view_rotation = (0.76, 0.6, 0.15, 0.2)
    view.view_distance = 4.0
    view.view_perspective = "ORTHO"


def make_the_timeline_higher():
    """In that of a new file the strip reaches into the frame numbers, where drags scrub."""
    timeline = bgui.area("DOPESHEET_EDITOR")
    column, border = timeline.x + timeline.width // 2, timeline.y + timeline.height
    height = timeline.height
    bgui.move(column, border)
    yield 0.3
    bgui.x("mousedown", 1)
    for step in range(0, HIGHER + 1, 20):
        bgui.move(column, border + step)
        yield 0.1
    bgui.x("mouseup", 1)
    yield from settle()
    assert timeline.height > height + HIGHER // 2, (height, timeline.height)


def large_action():
    """Make an armature with an action of 100 bones and 10,000 frames, and 5 % generated."""
    with bgui.override("WINDOW"):
        bpy.ops.object.mode_set(mode="OBJECT")
        armature = bpy.data.objects.new("large", bpy.data.armatures.new("large"))
        bpy.context.scene.collection.objects.link(armature)
        bpy.context.view_layer.objects.active = armature
        bpy.ops.object.mode_set(mode="EDIT")
        for index in range(N_BONES):
            bone = armature.data.edit_bones.new(f"bone{index}")
            bone.head, bone.tail = (index, 0, 0), (index, 0, 1)
        bpy.ops.object.mode_set(mode="OBJECT")

    random = np.random.default_rng(1)
    frames = np.arange(1.0, N_FRAMES + 1.0)
    keys = np.stack([frames, np.ones(N_FRAMES)], axis=1).astype(np.float32).ravel()
    compat = ours("blender.compat")
    action, slot = compat.new_action("large", armature)
    bag = compat.ensure_channelbag(action, slot)
    for bone in armature.pose.bones:
        for index in range(4):
            path = f'pose.bones["{bone.name}"].rotation_quaternion'
            curve = compat.new_curve(bag, path, index, bone.name)
            curve.keyframe_points.add(N_FRAMES)
            curve.keyframe_points.foreach_set("co", keys)
            types = np.where(random.random(N_FRAMES) < 0.0005, GENERATED, 0).astype(np.uint8)
            curve.keyframe_points.foreach_set("type", types)
    compat.assign(armature, action, slot)
    sure = {bone.name: random.random(N_FRAMES // 20).repeat(20) for bone in armature.pose.bones}
    ours("actions.reliability_curves").write_reliability(armature, action, slot, frames, sure)
    contacts = random.random((N_FRAMES // 10, 2)).repeat(10, axis=0) > 0.5
    ours("actions.contact_keys").write_contacts(armature, action, slot, frames, contacts)
    return armature


def load(name):
    """Return a module of the extension."""
    return import_module(f"{PACKAGE}.{name}")


def ours(name):
    """Return a module of its folder mocap_assist."""
    return load(f"mocap_assist.{name}")


def made_up_confidence(armature):
    """Key a confidence that falls twice, as *Reconstruct* would."""
    source = armature.animation_data.action, armature.animation_data.action_slot
    frames = np.arange(*source[0].frame_range) + 0.0
    low = 1.0 - 0.8 * np.exp(-(((frames - 60.0) / 12.0) ** 2))
    medium = 1.0 - 0.4 * np.exp(-(((frames - 200.0) / 15.0) ** 2))
    ours("actions.reliability_curves").write_reliability(
        armature, *source, frames, {"LeftArm": low, "RightLeg": medium}
    )


def time_uploads():
    """Return a list that gets the milliseconds of each upload to the GPU from now on."""
    uploads = []

    def timed(make):
        def upload(*given):
            started = time.perf_counter()
            made = make(*given)
            uploads.append(1000.0 * (time.perf_counter() - started))
            return made

        return upload

    for module, name in (
        (ours("overlays.strip.drawing"), "_make_batch"),
        (ours("overlays.strip.labels"), "_make_image"),
    ):
        setattr(module, name, timed(getattr(module, name)))
    return uploads
