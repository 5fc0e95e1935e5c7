"""What the buttons that make assets of actions ask for, and what they do with the answer."""

from collections.abc import Callable

import bpy

from ...solvers.errors import MocapAssistError
from ..blender.mixins import OperatorMixin


class MarkOperator(OperatorMixin):
    """Mix in before an operator that defines `mark`."""

    tags: bpy.props.StringProperty(
        name="Tags", description="Separated by commas", options={"SKIP_SAVE"}
    )
    catalog: bpy.props.StringProperty(
        name="Catalog",
        description="Path of the catalog, such as Locomotion/Walks; empty for none",
        options={"SKIP_SAVE"},
    )

    mark: Callable[[bpy.types.Context], str]
    """Mark assets, and return a message: a method of the operator."""

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for tags and catalog."""
        asked: set[str] = context.window_manager.invoke_props_dialog(self)
        return asked

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Mark assets, and report the result or the error."""
        try:
            self.report({"INFO"}, self.mark(context))
        except MocapAssistError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}
