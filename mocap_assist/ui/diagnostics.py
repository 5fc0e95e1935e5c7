"""Button: copy what a developer asks first when something fails, without names and paths."""

import locale
import os
import platform
import sys
from importlib.metadata import PackageNotFoundError
from importlib.metadata import version as installed_version

import bpy

from ...solvers.version import version
from ..blender.last_press import changed_values, last_press
from ..blender.mixins import OperatorMixin
from ..languages import translated
from ..panel_parts.preference_values import EXTENSION, preferences

COPY = "mocap_assist.copy_diagnostics"
LIBRARIES = ("numpy", "scipy", "pillow", "mujoco")
LEFT_OUT = "Left out: names of files, folders, takes and bones"


def diagnostics(context: bpy.types.Context) -> str:
    """Return versions, system, settings that were changed, the selection and the last press."""
    lines = [
        f"Mocap Assist {version()}, from the repository {_repository()}",
        f"Blender {bpy.app.version_string} ({_text(bpy.app.build_hash)}), {_window()}",
        f"Python {platform.python_version()}: {', '.join(map(_library, LIBRARIES))}",
        f"System: {platform.platform()}, {os.cpu_count()} processors",
        f"Language {bpy.app.translations.locale or 'en_US'}, encoding of text"
        f" {locale.getpreferredencoding(do_setlocale=False)}, of names"
        f" {sys.getfilesystemencoding()}",
        f"Preferences: {_values(changed_values(preferences()))}",
        f"Selected: {_selection(context)}",
        *_last_press(),
        LEFT_OUT,
    ]
    return "\n".join(lines) + "\n"


def _repository() -> str:
    """Return the kind of repository that the extension is in; the name may be a studio's."""
    module = EXTENSION.split(".")[1] if EXTENSION.startswith("bl_ext.") else ""
    return module if module in {"blender_org", "user_default", "system"} else "of another name"


def _text(value: bytes | str) -> str:
    return value.decode("ascii", "replace") if isinstance(value, bytes) else value


def _window() -> str:
    return "without a window" if bpy.app.background else "with a window"


def _library(name: str) -> str:
    try:
        return f"{name} {installed_version(name)}"
    except PackageNotFoundError:
        return f"{name} missing"


def _values(values: dict[str, object]) -> str:
    return ", ".join(f"{name} {value}" for name, value in values.items()) or "defaults"


def _selection(context: bpy.types.Context) -> str:
    """Return the kind and size of the active object and its action."""
    active = context.view_layer.objects.active
    if active is None:
        return "nothing"
    parts = [active.type.lower()]
    if active.type == "ARMATURE":
        parts.append(f"{len(active.data.bones)} bones")
    if active.library is not None or active.override_library is not None:
        parts.append("linked or overridden")
    action = active.animation_data and active.animation_data.action
    if action is not None:
        first, last = action.frame_range
        parts.append(f"action of {last - first + 1:.0f} frames")
    render = context.scene.render
    return ", ".join([*parts, f"scene at {render.fps / render.fps_base:g} frames per second"])


def _last_press() -> list[str]:
    """Return lines about the last press."""
    press = last_press()
    if press is None:
        return ["Last press: none in this session"]
    lines = [f"Last press: {press.button}, ended with {press.ending}"]
    if press.sentence:
        lines.append(f"  {press.sentence}")
    lines += [f"  {call}" for call in press.calls]
    return [*lines, f"  settings: {_values(dict(press.settings))}"]


class MOCAP_OT_copy_diagnostics(OperatorMixin, bpy.types.Operator):
    bl_idname = COPY
    bl_label = "Copy Diagnostics"
    bl_description = "Copy versions, settings and the last error for a bug report"

    def execute(self, context: bpy.types.Context) -> set[str]:
        context.window_manager.clipboard = diagnostics(context)
        self.report(
            {"INFO"}, translated("Copied versions, settings and the last error, without names.")
        )
        return {"FINISHED"}


def register() -> None:
    """Add the button."""
    bpy.utils.register_class(MOCAP_OT_copy_diagnostics)


def unregister() -> None:
    """Remove the button."""
    bpy.utils.unregister_class(MOCAP_OT_copy_diagnostics)
