"""Timeline markers at the issues that Check listed."""

import bpy

from ..runtime.selection import shown_frames

PREFIX = "Issue: "
"""Start of the name of such a marker: one that the animator renames is the animator's."""


def has_issue_markers(scene: bpy.types.Scene) -> bool:
    """Whether a scene has such markers."""
    return any(each.name.startswith(PREFIX) for each in scene.timeline_markers)


def mark_issues(context: bpy.types.Context) -> str:
    """Replace the markers by one at the first frame of each issue; return a message."""
    scene = context.scene
    remove_issue_markers(scene)
    for issue in scene.mocap_assist.issues:
        name = f"{PREFIX}{issue.kind}, {issue.name}"
        first, _ = shown_frames(context, issue)
        scene.timeline_markers.new(name, frame=round(first)).select = False
    n_issues = len(scene.mocap_assist.issues)
    return "1 issue marked." if n_issues == 1 else f"{n_issues} issues marked."


def remove_issue_markers(scene: bpy.types.Scene) -> str:
    """Remove the markers; return a message."""
    found = [each for each in scene.timeline_markers if each.name.startswith(PREFIX)]
    for each in found:
        scene.timeline_markers.remove(each)
    return "1 marker removed." if len(found) == 1 else f"{len(found)} markers removed."


def why_not_mark(context: bpy.types.Context) -> str:
    """Return why no markers can be added or removed, or an empty text."""
    scene = context.scene
    if scene.mocap_assist.issues or has_issue_markers(scene):
        return ""
    return "No issues are listed. Press Check first."
