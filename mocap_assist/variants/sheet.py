"""Contact sheet of all variants."""

from functools import partial
from pathlib import Path

import bpy

from ...solvers.errors import InvalidFileError
from ..jobs.job import run
from . import listing
from .reading import read_body
from .solve_varying import draw_sheet

MAX_DRAWN_VARIANTS = 50
"""Number of rows in a picture; it bounds the height of the file."""


def write_sheet(scene: bpy.types.Scene, path: Path) -> str:
    """Draw the picked variants, or all, to a PNG file; return a sentence.

    Raises
    ------
    InvalidFileError
        There is no such folder.
    """
    if not path.resolve().parent.is_dir():
        raise InvalidFileError(f"There is no folder {path.resolve().parent} to write to.")
    armature, actions = listing.armature_of(scene), listing.chosen_variants(scene)
    motions = [
        (
            action.name,
            read_body(scene, armature, listing.source_for(armature, action)).parts[0].motion,
        )
        for action in actions[:MAX_DRAWN_VARIANTS]
    ]
    n_drawn = run(partial(draw_sheet, motions, str(path)))
    if len(actions) > MAX_DRAWN_VARIANTS:
        return f"{n_drawn} of {len(actions)} variants in {path.name}."
    return f"{n_drawn} variants in {path.name}."
