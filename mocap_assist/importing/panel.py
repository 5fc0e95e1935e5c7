"""Panel: bring recordings in, the first steps, and where the selected take came from."""

from pathlib import PurePath

import bpy

from ..blender.mixins import PanelMixin
from ..depth.depth_preview import NOT_ALLOWED, problem_of
from ..languages import translated
from ..panel_parts.manual_page import start_page
from ..panel_parts.panel_layout import draw_job, draw_sentence, operator_exists
from ..panel_parts.solver_ready import note_drawing
from ..panel_parts.visibility import ALL_PANELS
from ..runtime.selection import selected_subject, why_not_active
from ..scene.origin import noted_conventions, origin_of
from .menu import IMPORT

CHANGE = "mocap_assist.change_axes"
SHOW = "mocap_assist.show_depth"
SAMPLE = "mocap_assist.load_sample"
WORKSPACE = "mocap_assist.add_workspace"
SENSOR_NAMES = {
    "kinect_v1": "Kinect v1",
    "kinect_v2": "Kinect v2",
    "azure_kinect": "Azure Kinect",
    "mediapipe": "MediaPipe",
    "zed": "ZED",
    "nuitrack": "Nuitrack",
}
"""As their makers write them, in every language; other sensors are not named."""


class ImportPanel(PanelMixin):
    """The button Import, the first steps, and the origin of what is selected."""

    bl_label = "Import"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return operator_exists(IMPORT)

    def draw_header_preset(self, context: bpy.types.Context) -> None:
        """Offer the panels that the selection does not need."""
        note_drawing()  # Headers are drawn of folded panels, too.
        self.layout.prop(
            context.window_manager, ALL_PANELS, text="", icon="COLLAPSEMENU", emboss=False
        )

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        draw_job(layout, context, "import")
        layout.operator(IMPORT, text="Import Motion Capture", icon="IMPORT")
        active = context.view_layer.objects.active
        origin = origin_of(active) if active is not None else {}
        if not origin and selected_subject(context) is None:
            if hint := why_not_active(context):
                draw_sentence(layout, context, hint, icon="INFO")
            else:
                _draw_first_steps(layout, context)
        if origin:
            column = layout.column(align=True)
            name = PurePath(str(origin.get("file", ""))).name
            column.label(text=name, icon="FILE", translate=False)
            column.label(text=_figures(origin), icon="BLANK1", translate=False)
            if conventions := noted_conventions(origin):
                draw_sentence(column, context, f"{conventions.sentence()}.", icon="BLANK1")
            if conventions and operator_exists(CHANGE):
                layout.operator(CHANGE, icon="ORIENTATION_GLOBAL")
            if problem := problem_of(active):
                draw_sentence(column, context, problem, icon="ERROR")
                if problem == NOT_ALLOWED:
                    column.operator(SHOW)


def _draw_first_steps(layout: bpy.types.UILayout, context: bpy.types.Context) -> None:
    """Draw the first steps for an animator without a take."""
    draw_sentence(layout, context, "Or drop files into the 3D View.")
    if operator_exists(SAMPLE):
        layout.operator(SAMPLE, icon="ARMATURE_DATA")
    layout.operator("wm.url_open", text="Open Manual", icon="HELP").url = start_page().as_uri()
    if operator_exists(WORKSPACE):
        layout.operator(WORKSPACE, icon="WORKSPACE")


def _figures(origin: dict[str, object]) -> str:
    """Return length, rate and sensor of a recording as text."""
    n_frames = origin.get("n_frames", 0)
    parts = [translated(f"{n_frames} frames"), f"{origin.get('frame_rate', 0):.4g} Hz"]
    if sensor := SENSOR_NAMES.get(str(origin.get("sensor"))):
        parts.append(sensor)
    return ", ".join(parts)
