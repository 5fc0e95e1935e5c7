"""Read the scene for the button Learn, and write its file."""

from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import NamedTuple

import bpy

from ...solvers.denoising import FilterBasesSettings
from ...solvers.errors import InvalidFileError
from ...solvers.settings import Settings, setting
from ..blender.path_properties import file_to_write
from ..blender.time_slices import Sliced, Steps
from .examples import read_examples
from .solve_learning import Patterns, learn

ENDING = ".npz"


@dataclass(frozen=True, kw_only=True)
class LearnChoices(Settings):
    """Settings of the button Learn, named as those of Clean."""

    examples: str = setting(
        "", "Clean actions of this file, or recordings on disk, separated by semicolons"
    )
    learned_file: str = setting("", "File to write; Clean can use it in any .blend file")


class LearnBundle(NamedTuple):
    """Settings of the button."""

    choices: LearnChoices
    bases: FilterBasesSettings


@Sliced
def read_learning(
    scene: bpy.types.Scene, armature: bpy.types.Object, settings: LearnBundle
) -> "Steps[partial[Patterns]]":
    """Read the examples; return the picklable solve."""
    target_of(settings)
    examples = yield from read_examples.steps(scene, armature, settings.choices.examples)
    return partial(learn, examples, settings.bases)


def write_learned(
    scene: bpy.types.Scene,
    armature: bpy.types.Object,
    settings: LearnBundle,
    learned: Patterns,
    solved_digest: str | None = None,
) -> str:
    """Save what was learned; return a sentence about it."""
    target = target_of(settings)
    bases = learned.bases
    bases.save(target)
    message = (
        f"Learned {len(bases.values)} patterns from {bases.n_clips} clips. Saved as {target}."
    )
    return f"{message} {learned.remark}".strip()


def target_of(settings: LearnBundle) -> Path:
    """Return the file to write, after a check that it can be written."""
    if not settings.choices.learned_file:
        raise InvalidFileError("Choose a file to write the motion model to.")
    target = file_to_write(settings.choices.learned_file, ENDING)
    if not target.is_absolute() or not target.parent.is_dir():
        raise InvalidFileError(
            f"The folder {target.parent} does not exist. Choose another one for {target.name}."
        )
    return target
