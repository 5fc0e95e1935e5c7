"""What the button Check reads from the scene and shows there, and the way to what it found."""

from functools import partial

import bpy

from ..actions.armature_read import read_take
from ..actions.contacts import read_contacts
from ..actions.limits import read_limits
from ..actions.marker_take import MarkerTake, read_markers
from ..actions.markers import markers_of, point_names
from ..actions.take import ArmatureTake
from ..blender import compat
from ..blender.time_slices import Sliced, Steps
from ..runtime.selection import played_source, selected_subject
from ..runtime.subject import Subject, check_unchanged
from ..scene.scene_objects import choose
from .choices import CheckSettings
from .solve_checking import Checked, check


@Sliced
def read_checking(
    scene: bpy.types.Scene, subject: bpy.types.Object, settings: CheckSettings
) -> "Steps[partial[Checked]]":
    """Read what a subject plays; return what is to be solved, which may be pickled."""
    here = Subject.of(scene, subject)
    take = yield from _read.steps(scene, subject)
    scene, subject = here.find()
    contacts, limits = None, None
    if isinstance(take, ArmatureTake):
        contacts = read_contacts(*played_source(subject), take.frames)
        limits = read_limits(subject, take, take.rig.bones)
    return partial(
        check,
        take.recordings[0],
        settings.quality,
        settings.spots,
        contacts=contacts,
        limits=limits,
    )


@Sliced
def show_checked(
    scene: bpy.types.Scene,
    subject: bpy.types.Object,
    settings: CheckSettings,
    checked: Checked,
    asked: str | None = None,
) -> Steps[str]:
    """List the spots in the scene; return a sentence about them."""
    here = Subject.of(scene, subject)
    take = yield from _read.steps(scene, subject)
    scene, subject = here.find()
    shown = scene.mocap_assist
    check_unchanged(subject, asked, take.recordings[0])
    frames = take.frames
    shown.spots.clear()
    shown.active_spot = 0
    shown.checked = played_source(subject)[0].name
    shown.report = checked.quality.report()
    for spot in checked.spots:
        item = shown.spots.add()
        item.name = spot.joint.removesuffix("_end")
        item.start, item.stop = frames[spot.start_frame], frames[spot.stop_frame - 1]
        item.kind, item.severity, item.sentence = spot.kind, spot.severity, spot.sentence
    if not checked.spots:
        return "No issues found."
    n_issues = len(checked.spots)
    found = "1 issue" if n_issues == 1 else f"{n_issues} issues"
    return f"{found} found. Worst: {checked.spots[0].sentence}"


def jump_to(context: bpy.types.Context, spot: bpy.types.PropertyGroup) -> None:
    """Move the playhead to the start of a spot and select its bone, or its marker, alone."""
    whole, part = divmod(spot.start, 1.0)
    context.scene.frame_set(int(whole), subframe=part)
    subject = selected_subject(context)
    if subject is None:
        return
    if subject.type == "ARMATURE":
        _select_bone(subject, spot.name)
        return
    markers = markers_of(subject)
    for name, marker in zip(point_names(markers), markers, strict=True):
        if name == spot.name:
            choose(context, [marker], marker)


def _select_bone(armature: bpy.types.Object, name: str) -> None:
    if name not in armature.pose.bones:
        return
    for bone in armature.pose.bones:
        compat.select_bone(bone, bone.name == name)
    armature.data.bones.active = armature.data.bones[name]


@Sliced
def _read(
    scene: bpy.types.Scene, subject: bpy.types.Object
) -> Steps[ArmatureTake | MarkerTake]:
    if subject.type != "ARMATURE":
        return (yield from read_markers.steps(subject, scene))
    return (yield from read_take.steps(subject, scene, source=played_source(subject)))
