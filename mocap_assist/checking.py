"""What the button Check reads from the scene and shows there, and the way to what it found."""

from functools import partial

import bpy

from .check_choices import CheckSettings
from .jobs.checking import Checked, check
from .scene import compat
from .scene.armature_read import read_take
from .scene.contacts import read_contacts
from .scene.limits import read_limits
from .scene.take import ArmatureTake
from .selection import played_source, selected_armature
from .subject import check_unchanged


def read_checking(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: CheckSettings
) -> "partial[Checked]":
    """Read what an armature plays; return what is to be solved, which may be pickled."""
    take = _read(scene, armature)
    return partial(
        check,
        take.parts[0].motion,
        settings.quality,
        settings.spots,
        contacts=read_contacts(*played_source(armature), take.frames),
        limits=read_limits(armature, take, take.rig.bones),
    )


def show_checked(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    settings: CheckSettings,
    checked: Checked,
    asked: str | None = None,
) -> str:
    """List the spots in the scene; return a sentence about them."""
    take, shown = _read(scene, armature), scene.mocap_assist
    check_unchanged(armature, asked, take.parts[0].motion)
    frames = take.frames
    shown.spots.clear()
    shown.active_spot = 0
    shown.checked = played_source(armature)[0].name
    shown.report = checked.quality.report()
    for spot in checked.spots:
        item = shown.spots.add()
        item.name = spot.joint.removesuffix("_end")
        item.start, item.stop = frames[spot.start_frame], frames[spot.stop_frame - 1]
        item.kind, item.severity, item.sentence = spot.kind, spot.severity, spot.sentence
    if not checked.spots:
        return "Nothing stands out."
    return f"{len(checked.spots)} spots need an eye. The worst: {checked.spots[0].sentence}"


def jump_to(context: bpy.types.Context, spot: bpy.types.PropertyGroup) -> None:
    """Move the playhead to the start of a spot and select its bone alone."""
    whole, part = divmod(spot.start, 1.0)
    context.scene.frame_set(int(whole), subframe=part)
    armature = selected_armature(context)
    if armature is None or spot.name not in armature.pose.bones:
        return
    for bone in armature.pose.bones:
        compat.select_bone(bone, bone.name == spot.name)
    armature.data.bones.active = armature.data.bones[spot.name]


def _read(scene: bpy.types.Scene, armature: bpy.types.Object) -> ArmatureTake:
    return read_take(armature, scene, source=played_source(armature))
