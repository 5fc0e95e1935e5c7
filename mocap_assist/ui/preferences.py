"""The extension's preferences."""

from pathlib import Path
from typing import ClassVar

import bpy

from ...solvers.command_line.farm import COMMAND
from ...solvers.errors import MocapAssistError
from ...solvers.recordings.streams import PORT
from ..actions.armature_write import Output
from ..check.key_map import draw_keys
from ..languages import translated
from ..library.auto_update_list import auto_updated_libraries, stop_keeping
from ..overlays.comparison import drawing
from ..panel_parts.manual_page import start_page
from ..panel_parts.panel_layout import draw_sentence
from ..panel_parts.preference_values import EXTENSION, preference_value, preferences
from .diagnostics import COPY

NETWORK_WARNING = (
    "Any program at an allowed address can move your rig. Use it in a network that you know."
)
STOP = "mocap_assist.stop_keeping"


def _move_panels(self: bpy.types.AddonPreferences, context: bpy.types.Context) -> None:
    from .sidebar import move_to_tab

    move_to_tab()


def _redraw(self: bpy.types.AddonPreferences, context: bpy.types.Context) -> None:
    drawing.refresh()


class MOCAP_AP_preferences(bpy.types.AddonPreferences):
    """Preferences for all files."""

    bl_idname = EXTENSION

    tab: bpy.props.StringProperty(
        name="Sidebar Tab",
        description="Tab of the sidebar that shows the panels",
        default="Mocap",
        update=_move_panels,
    )
    result_as: bpy.props.EnumProperty(
        name="Default Output",
        description="Output of results in new scenes",
        items=[
            (Output.ACTION.name, Output.ACTION.label, Output.ACTION.help),
            (Output.NLA_TRACK.name, Output.NLA_TRACK.label, Output.NLA_TRACK.help),
        ],
        default=Output.ACTION.name,
    )
    show_research: bpy.props.BoolProperty(
        name="Show Research Settings",
        description="Show methods of papers and parameters of experiments in the panels, too",
        default=False,
        update=_redraw,
    )
    keep_solver_ready: bpy.props.BoolProperty(
        name="Keep Solver Ready",
        description="Start the next solver ahead, so that a press answers faster (0.13 GB)",
        default=True,
    )
    live_port: bpy.props.IntProperty(
        name="Live Stream Port",
        description="UDP port for live joint streams",
        default=PORT,
        min=1024,
        max=65535,
    )
    live_network: bpy.props.BoolProperty(
        name="Receive from Other Machines",
        description="Receive live streams from the allowed addresses too",
        default=False,
    )
    live_addresses: bpy.props.StringProperty(
        name="Allowed Addresses",
        description="IPv4 addresses or networks of your trackers, with commas between",
        default="",
    )
    flamenco_manager: bpy.props.StringProperty(
        name="Flamenco Manager",
        description="Address that Submit Folder sends jobs to, such as http://farm:8080",
        default="",
    )
    flamenco_command: bpy.props.StringProperty(
        name="Command of Workers",
        description="Command of Mocap Assist on the workers of the farm",
        default=COMMAND,
    )
    raw_color: bpy.props.FloatVectorProperty(
        name="Raw Color",
        description="Color of the recorded action in the overlay",
        subtype="COLOR_GAMMA",
        size=4,
        min=0.0,
        max=1.0,
        default=(1.0, 0.45, 0.1, 0.8),
        update=_redraw,
    )
    clean_color: bpy.props.FloatVectorProperty(
        name="Clean Color",
        description="Color of the cleaned action in the overlay",
        subtype="COLOR_GAMMA",
        size=4,
        min=0.0,
        max=1.0,
        default=(0.2, 0.65, 1.0, 1.0),
        update=_redraw,
    )
    line_width: bpy.props.FloatProperty(
        name="Line Width",
        description="Width of the overlay lines",
        subtype="PIXEL",
        min=1.0,
        max=10.0,
        default=3.0,
        update=_redraw,
    )

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split = True
        layout.use_property_decorate = False
        for name in ("tab", "result_as", "show_research", "keep_solver_ready", "live_port"):
            layout.prop(self, name)
        _draw_network(layout, context, self)
        layout.prop(self, "flamenco_manager")
        if self.flamenco_manager:
            layout.prop(self, "flamenco_command")
        overlay = layout.column(heading="Overlay")
        for name in ("raw_color", "clean_color", "line_width"):
            overlay.prop(self, name)
        draw_keys(layout, context)
        folder = bpy.utils.extension_path_user(EXTENSION)
        if Path(folder).is_dir():
            row = layout.row()
            row.label(text=folder, icon="FILE_FOLDER", translate=False)
            row.operator("wm.path_open", text="", icon="FILEBROWSER").filepath = folder
        row = layout.row()
        row.operator("wm.url_open", text="Open Manual", icon="HELP").url = start_page().as_uri()
        row.operator("mocap_assist.reset_preferences", icon="LOOP_BACK")
        row.operator(COPY, icon="COPYDOWN")
        _draw_kept(layout)


def _draw_network(
    layout: bpy.types.UILayout, context: bpy.types.Context, ours: MOCAP_AP_preferences
) -> None:
    """Draw who may send live streams, with a warning."""
    layout.prop(ours, "live_network")
    if ours.live_network:
        layout.prop(ours, "live_addresses")
        draw_sentence(layout, context, NETWORK_WARNING, icon="ERROR")


def _draw_kept(layout: bpy.types.UILayout) -> None:
    """Draw the libraries that are kept current, each with a button that stops this."""
    kept = auto_updated_libraries()
    if kept:
        layout.label(text="Auto-Updated Libraries")
    for problem in kept:
        row = layout.row()
        row.label(text=problem.library, icon="ASSET_MANAGER", translate=False)
        row.operator(STOP, text="", icon="X", emboss=False).library = problem.library


class MOCAP_OT_stop_keeping(bpy.types.Operator):
    bl_idname = STOP
    bl_label = "Stop Auto-Update"
    bl_description = "Update this library only when Build Library is pressed"
    bl_options: ClassVar = {"INTERNAL"}  # preferences have no undo

    library: bpy.props.StringProperty(name="Library", options={"SKIP_SAVE"})

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            stop_keeping(self.library)
        except MocapAssistError as error:
            self.report({"ERROR"}, translated(str(error)))
            return {"CANCELLED"}
        return {"FINISHED"}


class MOCAP_OT_reset_preferences(bpy.types.Operator):
    bl_idname = "mocap_assist.reset_preferences"
    bl_label = "Reset"
    bl_description = "Restore default preferences"
    bl_options: ClassVar = {"INTERNAL"}  # preferences have no undo

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if preferences() is None:
            cls.poll_message_set(translated("Switch the extension on in the preferences first"))
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        ours = preferences()
        if ours is None:
            return {"CANCELLED"}
        for name in MOCAP_AP_preferences.__annotations__:
            ours.property_unset(name)
        _move_panels(ours, context)
        _redraw(ours, context)
        return {"FINISHED"}


@bpy.app.handlers.persistent
def _give_default(*_: object) -> None:
    """Set the output of scenes without a choice of their own to that of the preferences."""
    for scene in bpy.data.scenes:
        _give_scene_default(scene)


@bpy.app.handlers.persistent
def _give_scene_default(scene: bpy.types.Scene, *_: object) -> None:
    """Set the output of one scene, such as one that was just added."""
    wanted, clean = preference_value("result_as"), scene.mocap_assist.clean
    if wanted != Output.ACTION.name and not clean.is_property_set("result_as"):
        clean.result_as = wanted


CLASSES = (MOCAP_AP_preferences, MOCAP_OT_reset_preferences, MOCAP_OT_stop_keeping)


def register() -> None:
    """Add the preferences."""
    for each in CLASSES:
        bpy.utils.register_class(each)
    bpy.app.handlers.load_post.append(_give_default)
    bpy.app.handlers.depsgraph_update_post.append(_give_scene_default)
    # Blender hides the scenes from add-ons while it switches them on.
    bpy.app.timers.register(_give_default, first_interval=0.0)


def unregister() -> None:
    """Remove the preferences; Blender keeps the values while it runs."""
    if bpy.app.timers.is_registered(_give_default):
        bpy.app.timers.unregister(_give_default)
    bpy.app.handlers.depsgraph_update_post.remove(_give_scene_default)
    bpy.app.handlers.load_post.remove(_give_default)
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
