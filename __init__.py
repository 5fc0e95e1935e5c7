"""Mocap Assist: clean up and rebuild captured motion, with Blender buttons and batch commands.

Blender is imported only on `register`, so that tests of `solvers` run without it.
"""


def register() -> None:
    """Called by Blender when the extension is switched on."""
    from . import mocap_assist, operators

    operators.register()
    mocap_assist.register()


def unregister() -> None:
    """Called by Blender when the extension is switched off."""
    from . import mocap_assist, operators

    mocap_assist.unregister()
    operators.unregister()
