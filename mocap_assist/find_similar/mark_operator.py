"""Mix-in of the buttons that mark actions as assets: the dialog."""

import bpy

from ..blender.act_operator import ActOperator


class MarkOperator(ActOperator):
    """Mix in before an operator that marks assets in `act`."""

    tags: bpy.props.StringProperty(
        name="Tags", description="Separated by commas", options={"SKIP_SAVE"}
    )
    catalog: bpy.props.StringProperty(
        name="Catalog",
        description="Path of the catalog, such as Locomotion/Walks; empty for none",
        options={"SKIP_SAVE"},
    )

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Ask for tags and catalog."""
        asked: set[str] = context.window_manager.invoke_props_dialog(self)
        return asked
