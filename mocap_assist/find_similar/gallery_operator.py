"""An operator that shows the matches over the 3D View until one is chosen."""

from typing import ClassVar

import bpy

from ..blender.last_press import note_press
from ..blender.mixins import OperatorMixin
from ..languages import translated
from ..overlays.pixel_drawing import window_region
from ..runtime.watch import why_busy
from . import searches
from .gallery_drawing import Gallery

NO_VIEW = "This window has no 3D View."
PASSED_EVENTS = {"MIDDLEMOUSE", "WHEELUPMOUSE", "WHEELDOWNMOUSE"}


def why_not_browse(context: bpy.types.Context) -> str:
    """Return why no matches can be shown, or an empty text."""
    search = searches.listed_search(context)
    if search is None or not search.finding.found:
        return "No matches are listed. Press Find Similar first."
    return why_busy()


class BrowseOperator(OperatorMixin):
    """Mixed in before bpy.types.Operator. The scene is not changed."""

    bl_options: ClassVar[set[str]] = set()
    _gallery: Gallery | None = None
    _area: bpy.types.Area | None = None

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if reason := why_not_browse(context):
            cls.poll_message_set(translated(reason))
        return not reason

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Show the matches in the largest 3D View of the window."""
        search = searches.listed_search(context)
        views = [area for area in context.window.screen.areas if area.type == "VIEW_3D"]
        if not views or search is None:
            self.report({"ERROR"}, translated(NO_VIEW))
            note_press(self, sentence=NO_VIEW)
            return {"CANCELLED"}
        self._area = max(views, key=lambda area: area.width * area.height)
        self._gallery = Gallery(context, search, self._area)
        context.window_manager.modal_handler_add(self)
        self._area.tag_redraw()
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Play what is under the pointer; a click selects it, Esc ends."""
        area = self._shown_area(context)
        if area is None or self._gallery is None:
            return self._close_gallery(context, {"CANCELLED"})
        area.tag_redraw()
        is_pressed = event.value == "PRESS"
        if event.type in {"ESC", "RIGHTMOUSE"} and is_pressed:
            return self._close_gallery(context, {"CANCELLED"})
        scale = context.preferences.system.ui_scale
        pointed = self._gallery.point_at(area, event.mouse_x, event.mouse_y, scale)
        if event.type == "LEFTMOUSE" and is_pressed:
            return self._select_match(context, area, event, pointed)
        is_timer = event.type.startswith("TIMER")
        return (
            {"PASS_THROUGH"} if is_timer or event.type in PASSED_EVENTS else {"RUNNING_MODAL"}
        )

    def cancel(self, context: bpy.types.Context) -> None:
        """Remove the drawing; Blender calls this when the window closes, for example."""
        self._close_gallery(context, set())

    def _shown_area(self, context: bpy.types.Context) -> bpy.types.Area | None:
        """Return the area, if it is still a 3D View of the window with the search listed."""
        shown = self._gallery
        if (
            shown is None
            or not shown.is_open
            or searches.listed_search(context) is not shown.search
        ):
            return None
        is_there = any(area == self._area for area in context.window.screen.areas)
        return self._area if is_there and self._area and self._area.type == "VIEW_3D" else None

    def _select_match(
        self,
        context: bpy.types.Context,
        area: bpy.types.Area,
        event: bpy.types.Event,
        pointed: int,
    ) -> set[str]:
        if pointed >= 0:
            context.window_manager.mocap_assist_matches.active = pointed
            note_press(self)
            return self._close_gallery(context, {"FINISHED"})
        region = window_region(area)
        inside_x = region.x <= event.mouse_x < region.x + region.width
        inside_y = region.y <= event.mouse_y < region.y + region.height
        if inside_x and inside_y:
            return {"RUNNING_MODAL"}
        self._close_gallery(context, set())
        return {"CANCELLED", "PASS_THROUGH"}

    def _close_gallery(self, context: bpy.types.Context, status: set[str]) -> set[str]:
        if self._gallery is not None:
            self._gallery.close(context)
            self._gallery = None
        return status
