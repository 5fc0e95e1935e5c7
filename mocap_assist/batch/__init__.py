"""`blender FILE --command mocap_assist VERB ...`: the buttons without a window."""

from collections.abc import Sequence

import bpy

_commands: list[object] = []


def _run(words: Sequence[str]) -> int:
    """Run a command; return its exit status."""
    from .command import run  # slow to import, and Blender seldom starts for a command

    return run(words)


def register() -> None:
    """Let `blender --command mocap_assist` find the command."""
    _commands.append(bpy.utils.register_cli_command("mocap_assist", _run))


def unregister() -> None:
    """Remove the command."""
    while _commands:
        bpy.utils.unregister_cli_command(_commands.pop())
