"""Everything that knows what a Blender scene is.

Blender is imported only on `register`: a solve in a process of its own passes through here.
"""


def register() -> None:
    """Make properties known to Blender."""
    import bpy

    from .solver_operator import MOCAP_PG_job

    bpy.utils.register_class(MOCAP_PG_job)
    bpy.types.WindowManager.mocap_assist_job = bpy.props.PointerProperty(type=MOCAP_PG_job)


def unregister() -> None:
    """Take them away again."""
    import bpy

    from .solver_operator import MOCAP_PG_job

    del bpy.types.WindowManager.mocap_assist_job
    bpy.utils.unregister_class(MOCAP_PG_job)
