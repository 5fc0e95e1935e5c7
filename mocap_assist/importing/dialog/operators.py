"""Mix-ins of the two operators of Import, and the wait of the second one."""

from typing import Any

import bpy
from bpy.props import CollectionProperty, EnumProperty, StringProperty

from ....solvers.errors import MocapAssistError
from ...blender.last_press import note_press, noted_errors
from ...blender.mixins import SettingsMixin
from ...blender.path_properties import FILE, FOLDER, HIDDEN, path_property
from ...languages import translated
from ...panel_parts.panel_layout import draw_lines
from ...runtime.navigation import is_in_status_bar
from ...runtime.solver_operator import in_background
from ...runtime.watch import why_busy
from ..importing import chosen_paths, import_files, shown_paths
from ..show_actor import show_actor
from ..transaction import Imported
from .body_choice import bodies_to_choose, body_items, number_of, text_of
from .file_kinds import DEPTH, FOR_KINDS, MOVING, fitting, kinds_of
from .job import ImportJob

DIALOG_WIDTH_PX = 400  # pixels at scale 1
NOTE_WIDTH_PX = 300  # of Adjust Last Operation; Blender chooses its width


def propose_start(operator: bpy.types.Operator, context: bpy.types.Context) -> None:
    """Let the animation begin where the scene does, unless a start was chosen."""
    if not operator.properties.is_property_set("frame_start"):
        operator.frame_start = context.scene.frame_start


class FilesOperator(SettingsMixin):
    """Mix in before bpy.types.Operator: files to import, how, and the import itself."""

    directory: path_property(FOLDER, HIDDEN)
    files: CollectionProperty(type=bpy.types.OperatorFileListElement, options=HIDDEN)
    filepath: path_property(FILE, HIDDEN)
    note: StringProperty(options=HIDDEN)
    body_choice: EnumProperty(
        name="Body",
        description="Body of the file to import",
        items=lambda self, context: body_items(shown_paths(self)),
        get=lambda self: number_of(self.body, shown_paths(self)),
        set=lambda self, number: setattr(self, "body", text_of(number, shown_paths(self))),
        options=HIDDEN,
    )
    kinds: StringProperty(options=HIDDEN)
    note_width = NOTE_WIDTH_PX

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if reason := why_busy():
            cls.poll_message_set(translated(reason))
        return not reason

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Import while a script, or the redo panel, waits."""
        paths, choices = chosen_paths(self), self.settings().choices
        self.kinds = kinds_of(paths)
        with noted_errors(self):
            imported = import_files(context, paths, choices)
        return self.end(context, imported)

    def end(self, context: bpy.types.Context, imported: Imported) -> set[str]:
        """Report the result for each file."""
        self.note = imported.note
        note_press(self, sentence="".join(imported.failed[:1]))
        self.report({"ERROR"} if imported.failed else {"INFO"}, translated(imported.sentence))
        return {"FINISHED"} if imported.made else {"CANCELLED"}

    def given(self) -> dict[str, Any]:
        """Return files and settings, to hand them on to another operator."""
        files = [{"name": each.name} for each in self.files]
        settings = {name: getattr(self, name) for name in type(self).setting_names}
        return {
            "directory": self.directory,
            "files": files,
            "filepath": self.filepath,
            "kinds": self.kinds,
            **settings,
        }

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        if bodies_to_choose(shown_paths(self)):
            self.layout.column().prop(self, "body_choice", expand=True)
        if self.note:
            draw_lines(self.layout, self.note, self.note_width)
        kinds = self.kinds.split()
        for_depth = fitting(type(self).setting_names, [DEPTH])
        for name in fitting(type(self).setting_names, kinds or MOVING):
            if name != "body":
                self.layout.prop(self, name)
        if not kinds:  # in the file browser, where nothing is chosen yet
            header, body = self.layout.panel("mocap_assist_depth", default_closed=True)
            header.label(text="Depth Camera")
            for name in for_depth if body else ():
                if name in FOR_KINDS:
                    body.prop(self, name)


class WaitingImport(FilesOperator):
    """Mix in likewise: the window ignores all input but Esc until everything is imported."""

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        paths = chosen_paths(self)
        if not paths:
            return self.execute(context)
        try:
            self._job = ImportJob(context, paths, self.settings().choices)
        except MocapAssistError as error:
            note_press(self, error)
            self.report({"ERROR"}, translated(str(error)))
            return {"CANCELLED"}
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        job = self._job
        if not job.watch.is_on:
            return {"CANCELLED"}
        escaped = event.type in {"ESC", "RIGHTMOUSE"} and event.value == "PRESS"
        if escaped or job.watch.is_cancelled:
            job.cancel(context)
            self.report({"INFO"}, translated("Cancelled."))
            return {"CANCELLED"}
        if event.type != "TIMER":
            passes = is_in_status_bar(context, event)
            return {"PASS_THROUGH"} if passes else {"RUNNING_MODAL"}
        try:
            with noted_errors(self):
                ended = job.step(context)
        except BaseException:
            job.cancel(context)
            raise
        return self.end(context, job.transaction.end(context)) if ended else {"RUNNING_MODAL"}

    def end(self, context: bpy.types.Context, imported: Imported) -> set[str]:
        """Show the actor as well: an animator imported it, not a script."""
        if imported.made and not in_background():
            show_actor(context)
        return super().end(context, imported)

    def cancel(self, context: bpy.types.Context) -> None:
        """Blender ends the operator: another file is loaded, or the window closes."""
        if self._job.watch.is_on:
            self._job.cancel(context)
