"""Check: read the scene, list issues, and jump to them."""

from collections.abc import Sequence
from functools import partial

import bpy

from ...solvers.arrays import Array
from ...solvers.denoising import Issue, Quality
from ...solvers.errors import InvalidMotionError
from ..actions.armature_read import read_take
from ..actions.contact_keys import FOOT_PROPERTIES, read_contacts
from ..actions.limits import read_limits
from ..actions.markers.holders import markers_of, point_names
from ..actions.markers.take import MarkerTake, read_markers
from ..actions.take import ArmatureTake
from ..blender.compat import is_hidden
from ..blender.time_slices import Sliced, Steps
from ..runtime.selection import (
    played_source,
    select_only_bone,
    selected_subject,
    shown_frames,
    timeline_frames,
)
from ..runtime.subject import Subject, check_unchanged
from ..scene.scene_objects import select_only
from .button_settings import CheckBundle
from .solve_checking import Checked, check


@Sliced
def read_checking(
    scene: bpy.types.Scene, subject: bpy.types.Object, settings: CheckBundle
) -> "Steps[partial[Checked]]":
    """Read the action that a subject plays; return the picklable solve."""
    here = Subject.of(scene, subject)
    take = yield from read_played.steps(scene, subject)
    scene, subject = here.find()
    contacts, limits = None, None
    if isinstance(take, ArmatureTake):
        keyed = read_contacts(*played_source(subject), take.frames)
        contacts = None if keyed is None else keyed[:, : len(FOOT_PROPERTIES)]
        limits = read_limits(subject, take, take.rig.bones)
    return partial(
        check,
        take.recordings[0],
        settings.quality,
        settings.issues,
        contacts=contacts,
        limits=limits,
    )


@Sliced
def show_checked(
    scene: bpy.types.Scene,
    subject: bpy.types.Object,
    settings: CheckBundle,
    checked: Checked,
    solved_digest: str | None = None,
) -> Steps[str]:
    """List the issues in the scene; return a sentence about them."""
    here = Subject.of(scene, subject)
    take = yield from read_played.steps(scene, subject)
    scene, subject = here.find()
    yield from check_unchanged.steps(subject, solved_digest, take.recordings[0])
    scene, subject = here.find()
    list_issues(scene, subject, take.frames, checked.issues, checked.quality)
    return " ".join(filter(None, [_summary(checked), checked.low_confidence]))


def list_issues(
    scene: bpy.types.Scene,
    subject: bpy.types.Object,
    frames: Array,
    issues: Sequence[Issue],
    quality: Quality,
) -> None:
    """List the issues of a subject's action in the scene; `frames` are those of its take."""
    shown = scene.mocap_assist
    shown.issues.clear()
    shown.active_issue = 0
    shown.checked_action = played_source(subject)[0]
    shown.report = quality.report(timeline_frames(subject, frames))
    for issue in issues:
        item = shown.issues.add()
        item.name = issue.joint.removesuffix("_end")
        item.start, item.stop = frames[issue.start_frame], frames[issue.stop_frame - 1]
        item.kind, item.severity, item.sentence = issue.kind, issue.severity, issue.sentence


def _summary(checked: Checked) -> str:
    if not checked.issues:
        return "No issues found."
    n_issues = len(checked.issues)
    found = "1 issue" if n_issues == 1 else f"{n_issues} issues"
    return f"{found} found. Worst: {checked.issues[0].sentence}"


def is_stale(checked: bpy.types.Action | None, subject: bpy.types.Object | None) -> bool:
    """Whether the subject plays another action than the one that was checked.

    A checked action that was deleted is None.
    """
    if subject is None:
        return True
    try:
        return bool(played_source(subject)[0] != checked)
    except InvalidMotionError:
        return True


def why_not_visible(context: bpy.types.Context, issue: bpy.types.PropertyGroup) -> str:
    """Return why the views do not show the bone of an issue, or an empty text."""
    subject = selected_subject(context)
    if subject is None or subject.type != "ARMATURE" or issue.name not in subject.pose.bones:
        return ""
    if not subject.visible_get():
        return f"{subject.name} is hidden. Show it in the Outliner."
    if is_hidden(subject.pose.bones[issue.name]):
        return f"{issue.name} is hidden. Show its bone collection, or press Alt H in Pose Mode."
    return ""


def jump_to(context: bpy.types.Context, issue: bpy.types.PropertyGroup) -> None:
    """Set the current frame to the start of an issue and select only its bone or its marker.

    An armature in Object Mode enters Pose Mode, where the selected bone is visible.
    """
    frame, subframe = divmod(shown_frames(context, issue)[0], 1.0)
    context.scene.frame_set(int(frame), subframe=subframe)
    subject = selected_subject(context)
    if subject is None:
        return
    if subject.type == "ARMATURE":
        _select_bone(subject, issue.name)
        return
    markers = markers_of(subject)
    for name, marker in zip(point_names(markers), markers, strict=True):
        if name == issue.name:
            select_only(context, [marker], marker)


def _select_bone(armature: bpy.types.Object, name: str) -> None:
    if name not in armature.pose.bones:
        return
    select_only_bone(armature, name)
    if armature.mode == "OBJECT" and armature.library is None and armature.visible_get():
        bpy.ops.object.mode_set(mode="POSE")


@Sliced
def read_played(
    scene: bpy.types.Scene, subject: bpy.types.Object
) -> Steps[ArmatureTake | MarkerTake]:
    """Read what an armature, or the markers below an object, play now."""
    if subject.type != "ARMATURE":
        return (yield from read_markers.steps(subject, scene))
    return (yield from read_take.steps(subject, scene, source=played_source(subject)))
