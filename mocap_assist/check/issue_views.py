"""What a jump to an issue also shows: its bone in the views, and the frames around it."""

from typing import NamedTuple

import bpy
from mathutils import Vector

from ..actions.frames import FrameRange
from ..actions.markers.holders import markers_of, point_names
from ..overlays.strip.drag import working_range
from ..overlays.view_control import show_point
from ..runtime.selection import selected_subject, shown_frames

VIEW, RANGE = "mocap_assist_issue_view", "mocap_assist_issue_range"
FRAMES_AROUND = 4
"""Frames of the preview range before and after an issue, by definition of *Preview Range*."""
PreviewRange = tuple[int, int, bool]
"""Start, end and use of a preview range."""


class _Ranges(NamedTuple):
    """Preview ranges of a scene since issues are shown in it."""

    own: PreviewRange
    """The animator's."""
    shown: frozenset[PreviewRange]
    """Those of issues; undo may bring any of them back."""


_ranges: dict[int, _Ranges] = {}
"""By the session's number of the scene."""


def draw_view_switches(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the switches, in a row with the buttons that jump."""
    layout.prop(context.window_manager, VIEW, text="", icon="VIEW3D", toggle=True)
    row = layout.row(align=True)
    row.active = not works_on_own(context.scene)
    row.prop(context.window_manager, RANGE, text="", icon="PREVIEW_RANGE", toggle=True)


def show_issue(context: bpy.types.Context, issue: bpy.types.PropertyGroup) -> None:
    """Show an issue as the switches choose; the current frame is its first one already."""
    manager = context.window_manager
    if getattr(manager, VIEW):
        point = _point_of(context, issue.name)
        if point is not None:
            show_point(manager, point)
    if getattr(manager, RANGE):
        preview_issue(context, issue)


def preview_issue(context: bpy.types.Context, issue: bpy.types.PropertyGroup) -> None:
    """Set the preview range to an issue and the frames around it; keep the animator's own.

    A range of the animator's that a button works on stays: it would work on the issue alone.
    """
    scene = context.scene
    if works_on_own(scene):
        return
    first, last = shown_frames(context, issue)
    current = _preview_range(scene)
    own, shown = _ranges.get(scene.session_uid, (current, frozenset()))
    scene.use_preview_range = True
    scene.frame_preview_start = round(first) - FRAMES_AROUND
    scene.frame_preview_end = round(last) + FRAMES_AROUND
    _ranges[scene.session_uid] = _Ranges(
        own if current in shown else current, shown | {_preview_range(scene)}
    )


def works_on_own(scene: bpy.types.Scene) -> bool:
    """Whether a button works on a preview range that the animator has set."""
    current = working_range(scene)
    is_worked_on = current.is_used and FrameRange.PREVIEW.name in current.choices
    return is_worked_on and not _is_of_issue(scene)


def _is_of_issue(scene: bpy.types.Scene) -> bool:
    ranges = _ranges.get(scene.session_uid)
    return ranges is not None and _preview_range(scene) in ranges.shown


def _preview_range(scene: bpy.types.Scene) -> PreviewRange:
    return scene.frame_preview_start, scene.frame_preview_end, scene.use_preview_range


def _point_of(context: bpy.types.Context, name: str) -> Vector | None:
    """Return where the bone or marker of that name is in the scene, if it is there."""
    subject = selected_subject(context)
    if subject is None:
        return None
    if subject.type == "ARMATURE":
        bone = subject.pose.bones.get(name)
        return bone and subject.matrix_world @ bone.head
    markers = markers_of(subject)
    named = dict(zip(point_names(markers), markers, strict=True))
    return named[name].matrix_world.translation if name in named else None


def _range_switched(self: bpy.types.WindowManager, context: bpy.types.Context) -> None:
    """Set the preview range to the selected issue, or restore the animator's own."""
    shown = context.scene.mocap_assist
    if not getattr(self, RANGE):
        for scene in bpy.data.scenes:
            if _is_of_issue(scene):
                start, end, is_used = _ranges[scene.session_uid].own
                scene.frame_preview_start, scene.frame_preview_end = start, end
                scene.use_preview_range = is_used
        _ranges.clear()  # scenes of files that are closed
    elif 0 <= shown.active_issue < len(shown.issues):
        preview_issue(context, shown.issues[shown.active_issue])


def register() -> None:
    """Add the switches; the view follows at first, the preview range does not."""
    manager = bpy.types.WindowManager
    manager.mocap_assist_issue_view = bpy.props.BoolProperty(
        name="Follow in View",
        description="Center 3D views on the bone of an issue that is outside of them",
        default=True,
    )
    manager.mocap_assist_issue_range = bpy.props.BoolProperty(
        name="Preview Range",
        description=(
            "Play only an issue and 4 frames around it, unless Clean works on your own range"
        ),
        update=_range_switched,
    )


def unregister() -> None:
    """Remove the switches."""
    delattr(bpy.types.WindowManager, RANGE)
    delattr(bpy.types.WindowManager, VIEW)
