"""The built-in sample take, which comes into the scene as an imported recording does."""

from pathlib import Path

import bpy

from ...solvers.errors import MocapAssistError
from ...solvers.samples import noisy_walk
from ..runtime.solver_operator import in_background
from ..runtime.watch import why_busy
from .button_settings import ImportChoices
from .recording_objects import conversion_from_choices
from .show_actor import show_actor
from .solve_reading import ReadRecording, convert_recording
from .transaction import ImportTransaction

NAME = Path("Sample Walk")
"""Name that replaces the path of a file: the sample take has no file."""


def why_not_load(context: bpy.types.Context) -> str:
    """Return why nothing can be loaded now, or an empty text."""
    return why_busy()


def load_sample_take(context: bpy.types.Context) -> str:
    """Add the sample as an armature, show it, and return a sentence about it."""
    transaction = ImportTransaction(context, ImportChoices())
    content = ReadRecording(noisy_walk())
    conversion = conversion_from_choices(context, transaction.choices)
    moving = convert_recording(content.recording, conversion)
    transaction.add(context, NAME, content, moving=moving)
    imported = transaction.end(context)
    if imported.failed:
        raise MocapAssistError(imported.sentence)
    if not in_background():
        show_actor(context)
    return imported.sentence
