"""Mix-in of the operator Submit Folder: a file browser before the job is submitted."""

from typing import Any, ClassVar

import bpy
from bpy.props import BoolProperty

from ...solvers.errors import SolveCancelled
from ..blender.path_properties import FOLDER, HIDDEN, absolute, path_property
from ..jobs.job import Job
from ..runtime.solver_operator import SolverOperator, in_background

MAYBE_SUBMITTED = (
    "Cancelled while the job was sent. Look at the Manager's list of jobs before you submit it"
    " again."
)


class FarmOperator(SolverOperator):
    """Mix in before bpy.types.Operator: choose a folder, then submit without blocking.

    Nothing of the scene is read or written, so no object needs to be selected.
    """

    bl_options: ClassVar = set[str]()  # a redo would submit again
    directory: path_property(FOLDER, HIDDEN)
    output_folder: path_property(
        FOLDER,
        {"SKIP_SAVE"},
        name="Output Folder",
        description="Shared folder for the results; empty: next to the folder of the takes",
    )
    is_chosen: BoolProperty(options=HIDDEN)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        if self.is_chosen or in_background():
            return super().invoke(context, event)
        self.prepare(context)
        self._browsing = True
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        if not getattr(self, "_browsing", False):
            return super().execute(context)
        # Blender frees an operator that the file browser has executed, so another one waits.
        names = ("directory", "output_folder", *type(self).setting_names)
        given = {name: getattr(self, name) for name in names}
        try:
            bpy.ops.mocap_assist.submit_folder("INVOKE_DEFAULT", **given, is_chosen=True)
        except RuntimeError as error:  # its own sentence
            self.report({"ERROR"}, str(error).removeprefix("Error: ").strip())
            return {"CANCELLED"}
        return {"FINISHED"}

    def remember(self, context: bpy.types.Context) -> None:
        """Remember nothing: there is no subject."""

    def result_from_job(self, job: Job[Any]) -> Any:
        """Return what the Manager accepted; after Esc, say if it may have the job."""
        was_sent = job.cancelled and bool(job.all_previews())
        try:
            return super().result_from_job(job)
        except SolveCancelled:
            raise SolveCancelled(MAYBE_SUBMITTED if was_sent else "Cancelled.") from None

    def draw(self, context: bpy.types.Context) -> None:
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        for name in ("output_folder", *type(self).setting_names):
            self.layout.prop(self, name)

    def _read_arguments(self) -> tuple[Any, ...]:
        output_folder = absolute(self.output_folder) if self.output_folder else None
        return absolute(self.directory), output_folder, self.settings()
