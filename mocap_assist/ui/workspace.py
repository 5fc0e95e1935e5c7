"""A workspace for motion capture: 3D View, Graph Editor, Dope Sheet and Asset Browser."""

from collections.abc import Iterator
from contextlib import suppress

import bpy

from ..panel_parts.sidebar_tab import tab_name

NAME = "Mocap"
SPLITS = (
    ("VIEW_3D", "FCURVES", "HORIZONTAL", 0.45),
    ("FCURVES", "DOPESHEET", "HORIZONTAL", 0.4),
    ("VIEW_3D", "ASSETS", "VERTICAL", 0.7),
)
"""Editor that is split, editor of its lower or right part, direction, and where it is split, as
a fraction of its height from below or of its width from the left."""
WAIT_S, MAX_WAITS = 0.1, 50
"""Seconds from one try or step to the next, and their maximum number. They bound the wait for
an editor to open."""
DONE = object()
NO_WINDOW = "A workspace needs a Blender with a window."


def why_no_workspace(context: bpy.types.Context) -> str:
    """Return why no workspace can be added, or an empty text."""
    return "" if context.window is not None and not bpy.app.background else NO_WINDOW


def add_workspace(context: bpy.types.Context) -> str:
    """Show the workspace, made from a copy of the current one if necessary; return a
    message."""
    window, known = context.window, bpy.data.workspaces.get(NAME)
    if known is not None:
        window.workspace = known
        return f"The workspace {NAME} is there already."
    before = set(bpy.data.workspaces)
    bpy.ops.workspace.duplicate()
    (made,) = set(bpy.data.workspaces) - before
    made.name = NAME
    bpy.app.timers.register(_Arranging(made.name), first_interval=WAIT_S)
    return f"Added the workspace {NAME}."


class _Arranging:
    """A timer that arranges a workspace once a window shows it.

    Blender moves areas after a step, so each step has a turn of its own.
    """

    def __init__(self, name: str) -> None:
        self._name = name
        self._n_waits = 0
        self._steps: Iterator[None] | None = None

    def __call__(self) -> float | None:
        """Return the seconds until the next step; None ends the timer."""
        self._n_waits += 1
        if self._steps is None:
            windows = bpy.context.window_manager.windows
            shown = [each for each in windows if each.workspace.name == self._name]
            self._steps = arranging(shown[0]) if shown else None
        is_done = self._steps is not None and next(self._steps, DONE) is DONE
        return None if is_done or self._n_waits >= MAX_WAITS else WAIT_S


def arranging(window: bpy.types.Window) -> Iterator[None]:
    """Replace the areas of a window by those of the workspace, step by step."""
    while len(areas := areas_of(window)) > 1 and _close_one(window, areas[1:]):
        yield
    area_by_editor = {"VIEW_3D": areas_of(window)[0]}
    for divided, part, direction, factor in SPLITS:
        area = area_by_editor[divided]
        with bpy.context.temp_override(window=window, screen=window.screen, area=area):
            bpy.ops.screen.area_split(direction=direction, factor=factor)
        yield
        known = set(area_by_editor.values())
        made = next((each for each in areas_of(window) if each not in known), None)
        if made is None:
            return
        lower, upper = sorted((area, made), key=lambda each: (each.y, each.x))
        is_lower = direction == "HORIZONTAL"
        area_by_editor[divided], area_by_editor[part] = (
            (upper, lower) if is_lower else (lower, upper)
        )
    for editor, area in area_by_editor.items():
        area.ui_type = editor
    area_by_editor["VIEW_3D"].spaces.active.show_region_ui = True
    while not _show_tab(area_by_editor["VIEW_3D"]):
        yield


def _show_tab(area: bpy.types.Area) -> bool:
    """Open our tab of a sidebar.

    Blender has the tabs once they were drawn; until then it knows no tab of this name, or lets
    none be chosen.
    """
    sidebar = next((each for each in area.regions if each.type == "UI"), None)
    if sidebar is None:
        return True
    with suppress(AttributeError, TypeError):
        sidebar.active_panel_category = tab_name()
        return True
    return False


def areas_of(window: bpy.types.Window) -> list[bpy.types.Area]:
    """Return the areas, the largest first; those that are being closed have no size."""
    areas = [each for each in window.screen.areas if each.width and each.height]
    return sorted(areas, key=lambda each: each.width * each.height, reverse=True)


def _close_one(window: bpy.types.Window, areas: list[bpy.types.Area]) -> bool:
    """Close the first of the areas that its neighbors can replace, if there is one."""
    for area in areas:
        with (
            bpy.context.temp_override(window=window, screen=window.screen, area=area),
            suppress(RuntimeError),
        ):
            if bpy.ops.screen.area_close() == {"FINISHED"}:
                return True
    return False
