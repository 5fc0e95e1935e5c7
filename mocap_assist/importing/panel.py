"""Panel: bring recordings in, and where the selected one came from."""

from pathlib import PurePath

import bpy

from ..blender.mixins import PanelMixin
from ..depth.depth_preview import NOT_ALLOWED, problem_of
from ..panels.drawing import draw_job, draw_sentence, exists
from ..scene.origin import noted_conventions, origin_of
from .import_menu import IMPORT

CHANGE = "mocap_assist.change_axes"
SHOW = "mocap_assist.show_depth"


class ImportPanel(PanelMixin):
    """The button Import, and the origin of what is selected."""

    bl_label = "Import"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return exists(IMPORT)

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        draw_job(layout, context, "import")
        layout.operator(IMPORT, text="Import Motion Capture", icon="IMPORT")
        active = context.view_layer.objects.active
        origin = origin_of(active) if active is not None else {}
        if origin:
            column = layout.column(align=True)
            name = PurePath(str(origin.get("file", ""))).name
            column.label(text=name, icon="FILE", translate=False)
            column.label(text=_figures(origin), icon="BLANK1", translate=False)
            if conventions := noted_conventions(origin):
                draw_sentence(column, context, f"{conventions.sentence()}.", icon="BLANK1")
            if conventions and exists(CHANGE):
                layout.operator(CHANGE, icon="ORIENTATION_GLOBAL")
            if problem := problem_of(active):
                draw_sentence(column, context, problem, icon="ERROR")
                if problem == NOT_ALLOWED:
                    column.operator(SHOW)


def _figures(origin: dict[str, object]) -> str:
    """Return length, rate and sensor of a recording as text."""
    parts = [f"{origin.get('n_frames', 0)} frames", f"{origin.get('frame_rate', 0):.4g} Hz"]
    if "sensor" in origin:
        parts.append(str(origin["sensor"]).replace("_", " "))
    return ", ".join(parts)
