"""An operator that sets the range to work on by a drag on the strip."""

from typing import ClassVar, NamedTuple

import bpy

from ...actions.frames import FrameRange
from ...blender.act_operator import ActOperator
from ...blender.redrawing import redraw
from .drawing import EDITORS, MODES, fitting_strip, strip_height, visible_frames
from .switch import SWITCH

GROUPS = ("clean", "reconstruct")
"""Settings of the buttons that change the frames of a range only."""
MIN_DRAG_PX = 4
"""Distance in pixels at scale 1 from which a press is a drag. By definition of Blender's own
threshold for the mouse, 3, and one more."""


class WorkingRange(NamedTuple):
    """The preview range, and which frames the buttons work on."""

    first: int
    last: int
    is_used: bool
    choices: tuple[str, ...]
    """For each of the groups of settings."""


def working_range(scene: bpy.types.Scene) -> WorkingRange:
    """Return the range that a drag changes."""
    choices = tuple(getattr(scene.mocap_assist, group).frame_range for group in GROUPS)
    first, last = scene.frame_preview_start, scene.frame_preview_end
    return WorkingRange(first, last, scene.use_preview_range, choices)


def restore_range(scene: bpy.types.Scene, before: WorkingRange) -> None:
    """Undo a drag."""
    scene.frame_preview_start, scene.frame_preview_end = before.first, before.last
    scene.use_preview_range = before.is_used
    for group, choice in zip(GROUPS, before.choices, strict=True):
        getattr(scene.mocap_assist, group).frame_range = choice


def set_range(scene: bpy.types.Scene, first: int, last: int) -> str:
    """Set the preview range, and let the buttons work on it; return a message."""
    scene.use_preview_range = True
    scene.frame_preview_start, scene.frame_preview_end = first, last
    for group in GROUPS:
        getattr(scene.mocap_assist, group).frame_range = FrameRange.PREVIEW.name
    return f"Clean and Reconstruct work on frames {first} to {last}."


def clear_range(scene: bpy.types.Scene) -> str:
    """End the preview range, and let the buttons work on whole actions; return a message."""
    scene.use_preview_range = False
    for group in GROUPS:
        settings = getattr(scene.mocap_assist, group)
        if settings.frame_range == FrameRange.PREVIEW.name:
            settings.frame_range = FrameRange.ACTION.name
    return "Clean and Reconstruct work on all frames."


class RangeOperator(ActOperator):
    """Mixed in before bpy.types.Operator. A drag sets the range, a click clears it."""

    bl_options: ClassVar[set[str]] = {"UNDO"}
    start: int
    end: int
    _from_px = 0
    _is_dragged = False
    _before: WorkingRange

    def act(self, context: bpy.types.Context) -> str:
        """Set the range that a script names, or clear it if the end is before the start."""
        if self.end < self.start:
            return clear_range(context.scene)
        return set_range(context.scene, self.start, self.end)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Start a drag on the strip; leave presses elsewhere to Blender."""
        if not is_on_strip(context, event.mouse_region_y):
            return {"PASS_THROUGH"}
        self._before, self._is_dragged = working_range(context.scene), False
        self._from_px = event.mouse_region_x
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Follow the pointer until its button is released; Esc restores the range."""
        if event.type in {"ESC", "RIGHTMOUSE"}:
            self.cancel(context)
            return {"CANCELLED"}
        if event.type == "MOUSEMOVE":
            self._follow(context, event.mouse_region_x)
        is_released = event.type == "LEFTMOUSE" and event.value == "RELEASE"
        return self._end_drag(context) if is_released else {"RUNNING_MODAL"}

    def cancel(self, context: bpy.types.Context) -> None:
        """Restore the range; Blender calls this when the window closes, for example."""
        restore_range(context.scene, self._before)

    def _follow(self, context: bpy.types.Context, to_px: int) -> None:
        smallest = MIN_DRAG_PX * context.preferences.system.ui_scale
        self._is_dragged |= abs(to_px - self._from_px) >= smallest
        if self._is_dragged:
            self.start, self.end = frames_between(context.region, self._from_px, to_px)
            set_range(context.scene, self.start, self.end)
            for editor in EDITORS:
                redraw(context, editor)

    def _end_drag(self, context: bpy.types.Context) -> set[str]:
        if not self._is_dragged:
            if not self._before.is_used:
                return {"CANCELLED"}
            self.start, self.end = 1, 0
        return self.execute(context)


def is_on_strip(context: bpy.types.Context, height_px: int) -> bool:
    """Return whether a height in a region is on the strip that is drawn there."""
    space = context.space_data
    if space is None or space.type not in EDITORS or space.mode not in MODES:
        return False
    if not getattr(context.window_manager, SWITCH):
        return False
    strip = fitting_strip(context)
    if strip is None:
        return False
    bottom, row = strip_height(context, len(strip.rows))
    return bool(bottom <= height_px <= bottom + row * len(strip.rows))


def frames_between(region: bpy.types.Region, from_px: int, to_px: int) -> tuple[int, int]:
    """Return the first and last whole frame between two columns of a region."""
    left, right = visible_frames(region)
    ends = [left + column * (right - left) / region.width for column in (from_px, to_px)]
    return round(min(ends)), round(max(ends))
