"""The clean motion that an animator picks to learn from: actions, .blend files, recordings."""

from collections.abc import Sequence
from pathlib import Path

import bpy

from ...solvers.errors import InvalidFileError, InvalidMotionError
from ...solvers.motion import Motion
from ...solvers.recordings import is_scene_file, may_contain_motion
from ...solvers.recordings.containers import files_below
from ..actions.armature_read import read_take
from ..actions.fitting import fits_armature, plays_action
from ..blender import compat
from ..blender.name_lists import split_names
from ..blender.time_slices import Sliced, Steps, should_yield
from ..library.sources import background_blender
from ..runtime.subject import Subject
from ..scene.linked_clips import Linked, is_blend, linked_clips
from .button_settings import CleanChoices, Prior
from .example_source import ExampleSource

LINKED_AT_ONCE = 8
"""Actions that are linked from another file at once. It bounds the time in which Blender does
not answer."""


@Sliced
def read_prior(
    scene: bpy.types.Scene, armature: bpy.types.Object, choices: CleanChoices
) -> Steps[ExampleSource]:
    """Return the examples to learn from, or None; see `read_examples`."""
    if choices.prior is Prior.TAKE:
        return ExampleSource()
    if choices.prior is Prior.LEARNED:
        if not choices.learned_file:
            raise InvalidMotionError("Choose the motion model file, or another motion model.")
        return ExampleSource(bases_file=bpy.path.abspath(choices.learned_file))
    return (yield from read_examples.steps(scene, armature, choices.examples))


@Sliced
def read_examples(
    scene: bpy.types.Scene, armature: bpy.types.Object, examples: str
) -> Steps[ExampleSource]:
    """Read the actions named in a list; leave recordings to be read where it is solved.

    Of a .blend file in the list all actions are read that fit an armature there.

    Raises
    ------
    InvalidMotionError
        No example was picked, or one does not exist or fits no armature.
    """
    names = split_names(examples)
    if not names:
        raise InvalidMotionError(
            "Pick clean actions or recordings to learn from, or set Motion Model to From This"
            " Take."
        )
    actions = [name for name in names if name in bpy.data.actions]
    files = [bpy.path.abspath(name) for name in names if name not in actions]
    missing = [path for path in files if not Path(path).exists()]
    if missing:
        raise InvalidMotionError(f"No action or file is named {', '.join(missing)}.")
    here, motions = Subject.of(scene, armature), list[Motion]()
    for name in actions:
        motion = yield from _read_named(*here.find(), name)
        motions.append(motion)
    for path in filter(is_blend, map(Path, files)):
        played = yield from _read_blend(here, path)
        motions += played
    recordings, found = list[str](), list[str]()
    for path in files:
        if Path(path).is_dir():
            inside = yield from _recordings_in(Path(path))
            found += map(str, inside)
        elif not is_blend(Path(path)):
            recordings.append(path)
    return ExampleSource(
        motions=tuple(motions),
        files=tuple(recordings),
        found=tuple(found),
        blender=background_blender(""),
    )


def _recordings_in(folder: Path) -> Steps[list[Path]]:
    """Return all recordings in a folder and below."""
    found = []
    for each in files_below(folder):
        if should_yield():
            yield 0.0
        found += [each] if may_contain_motion(each) or is_scene_file(each) else []
    if not found:
        raise InvalidMotionError(f"The folder {folder} has no recordings.")
    return found


def _who_may_fit(scene: bpy.types.Scene, asking: bpy.types.Object) -> list[bpy.types.Object]:
    """Return the armatures of a scene, first the one that needs the examples."""
    armatures = [each for each in scene.objects if each.type == "ARMATURE"]
    return [*[each for each in (asking,) if each.type == "ARMATURE"], *armatures]


def _read_named(scene: bpy.types.Scene, asking: bpy.types.Object, name: str) -> Steps[Motion]:
    """Read the body's motion from an action of this file."""
    action = bpy.data.actions.get(name)
    found = action and _player(_who_may_fit(scene, asking), action)
    if not found:
        raise InvalidMotionError(
            f"No armature of this scene has the bones of the action {name}. Add the rig it"
            " was made for, or pick another example."
        )
    armature, slot = found
    take = yield from read_take.steps(armature, scene, source=(action, slot))
    return take.parts[0].motion


def _read_blend(here: Subject, path: Path) -> Steps[list[Motion]]:
    """Read the motions of all actions in another .blend file that fit an armature there.

    The file's data-blocks are in this one only while Blender waits: after each turn those that
    are needed are linked again.
    """
    if should_yield():
        yield 0.0
    with linked_clips(path) as clips:
        waiting = [each.name for each in clips.actions]
        rigs = [each.name for each in clips.armatures]
        motions = _read_linked(here, clips, waiting)
    while waiting:
        yield 0.0
        some = waiting[:LINKED_AT_ONCE]
        with linked_clips(path, some, rigs) as clips:
            motions += _read_linked(here, clips, waiting)
        if not clips.actions:
            raise InvalidFileError(
                f"{path} was changed while it was read. Press the button again."
            )
    if not motions:
        raise InvalidMotionError(
            f"{path} has no armature with an action for it."
            " Choose a file that has the rig, too."
        )
    return motions


def _read_linked(here: Subject, clips: Linked, waiting: list[str]) -> list[Motion]:
    """Read at least one action of `waiting`, and more until the time slice ends."""
    scene, _ = here.find()
    motions = []
    for action in clips.actions:
        waiting.remove(action.name)
        if found := _player(clips.armatures, action):
            armature, slot = found
            take = read_take(armature, scene, source=(action, slot))
            motions.append(take.parts[0].motion)
        if should_yield():
            break
    return motions


def _player(
    armatures: Sequence[bpy.types.Object], action: bpy.types.Action
) -> tuple[bpy.types.Object, bpy.types.ActionSlot] | None:
    """Return the armature that plays an action, or the first that fits, and the slot for it."""
    players = [each for each in armatures if plays_action(each, action)]
    for armature in [*players, *armatures]:
        for slot in action.slots:
            if slot.target_id_type in compat.TARGETS and fits_armature(armature, action, slot):
                return armature, slot
    return None
