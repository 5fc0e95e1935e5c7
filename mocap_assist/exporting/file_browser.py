"""Mix-in of the operator Export: a file browser before the solve."""

import re
from pathlib import Path
from typing import TYPE_CHECKING

import bpy
from bpy.props import BoolProperty, StringProperty

from ...solvers.errors import InvalidMotionError
from ..blender.path_properties import HIDDEN, absolute, path_property
from ..runtime.selection import played_source, selected_armature
from ..runtime.solver_operator import SolverOperator, in_background
from .file_formats import FileFormat
from .target_file import ENDINGS, with_ending

FORBIDDEN = re.compile(r'[\\/:*?"<>|\x00-\x1f]')
"""Characters that file names cannot have on some system."""


class ExportOperator(SolverOperator):
    """Mix in before bpy.types.Operator: choose a file, then export without blocking."""

    filepath: path_property(options={"SKIP_SAVE"}, name="File", description="File to write")
    filter_glob: StringProperty(
        default=";".join(f"*{each}" for each in ENDINGS), options=HIDDEN
    )
    check_existing: BoolProperty(default=True, options=HIDDEN)
    is_chosen: BoolProperty(options=HIDDEN)
    if TYPE_CHECKING:
        file_format: str

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if self.is_chosen or in_background():
            return super().invoke(context, event)
        self.prepare(context)
        if not self.filepath:
            self.filepath = default_path(selected_armature(context))
        self.filepath = with_ending(self.filepath, FileFormat[self.file_format])
        self._browsing = True
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def check(self, context: bpy.types.Context) -> bool:
        """Let the name in the file browser follow the chosen format."""
        named = with_ending(self.filepath, FileFormat[self.file_format])
        changed = bool(named != self.filepath)
        self.filepath = named
        return changed

    def execute(self, context: bpy.types.Context) -> set[str]:
        if not getattr(self, "_browsing", False):
            return super().execute(context)
        # Blender frees an operator that the file browser has executed, so another one waits.
        given = {name: getattr(self, name) for name in type(self).setting_names}
        export = bpy.ops.mocap_assist.export_take
        export("INVOKE_DEFAULT", **given, is_chosen=True)
        return {"FINISHED"}

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        for name in type(self).setting_names:
            if name != "filepath":
                self.layout.prop(self, name)


def default_path(armature: bpy.types.Object) -> str:
    """Return a file named like the action, next to the .blend file."""
    try:
        name = played_source(armature)[0].name
    except InvalidMotionError:
        name = armature.name
    folder = Path(bpy.data.filepath).parent if bpy.data.filepath else Path.home()
    return str(absolute(str(folder / FORBIDDEN.sub("_", name))))
