"""The clean motion that an animator picks to learn from: actions of this file, or files."""

from pathlib import Path

import bpy

from ..solvers.errors import InvalidMotionError
from ..solvers.motion import Motion
from ..solvers.recordings import recordings_in
from .clean_choices import CleanChoices, Prior
from .jobs.cleaning import Examples
from .scene import compat
from .scene.armature_read import read_take
from .scene.fitting import fits, plays

SEPARATOR = ";"


def read_prior(
    scene: bpy.types.Scene, armature: bpy.types.Object, choices: CleanChoices
) -> Examples:
    """Return what is to be learned from, if anything; see `read_examples`."""
    if choices.prior is Prior.TAKE:
        return Examples()
    if choices.prior is Prior.LEARNED:
        if not choices.learned_file:
            raise InvalidMotionError("Choose the file of learned patterns, or another prior.")
        return Examples(bases_file=bpy.path.abspath(choices.learned_file))
    return read_examples(scene, armature, choices.examples)


def read_examples(scene: bpy.types.Scene, armature: bpy.types.Object, listed: str) -> Examples:
    """Read the actions named in a list; leave files to be read where it is solved.

    Raises
    ------
    InvalidMotionError
        Nothing was picked, or what was picked does not exist or fits no armature.
    """
    names = [name.strip() for name in listed.split(SEPARATOR) if name.strip()]
    if not names:
        raise InvalidMotionError(
            "Pick clean actions or recordings to learn from, or let the take guide itself."
        )
    actions = [name for name in names if name in bpy.data.actions]
    files = [bpy.path.abspath(name) for name in names if name not in actions]
    missing = [path for path in files if not Path(path).exists()]
    if missing:
        raise InvalidMotionError(
            f"There is neither an action nor a file called {', '.join(missing)}."
        )
    files = [str(file) for path in files for file in _recordings_of(Path(path))]
    motions = [_read_action(scene, armature, bpy.data.actions[name]) for name in actions]
    return Examples(motions=tuple(motions), files=tuple(files))


def _recordings_of(path: Path) -> list[Path]:
    """Return a file, or all recordings in a folder and below."""
    if not path.is_dir():
        return [path]
    if not (found := list(recordings_in(path))):
        raise InvalidMotionError(f"There is no recording in the folder {path}.")
    return found


def _read_action(
    scene: bpy.types.Scene, armature: bpy.types.Object, action: bpy.types.Action
) -> Motion:
    """Read the body's motion from an action, on the armature that plays it or that it fits."""
    armatures = [each for each in scene.objects if each.type == "ARMATURE"]
    players = [each for each in armatures if plays(each, action)]
    asking = [armature] if armature.type == "ARMATURE" else []
    for other in [*players, *asking, *armatures]:
        for slot in action.slots:
            if slot.target_id_type in compat.TARGETS and fits(other, action, slot):
                return read_take(other, scene, source=(action, slot)).parts[0].motion
    raise InvalidMotionError(
        f"No armature of this scene has the bones of the action {action.name}. Add the rig that"
        " it was made for, or pick another example."
    )
