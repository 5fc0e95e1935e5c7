"""The choice of a body in the import dialog, for files that hold several."""

from pathlib import Path

from ....solvers.recordings import ALL_BODIES, Body
from ..recent_files import bodies_of

Item = tuple[str, str, str, str, int]
BEST = "Most Frames", "Import the person who is in most frames"
EVERY = "All", "Import every body as its own armature"
ONLY_THIS = "Import only this one"
BEST_NUMBER, EVERY_NUMBER, FIRST_BODY_NUMBER = range(3)
"""Numbers of the first items; those of the other bodies follow."""
_items: dict[tuple[Body, ...], list[Item]] = {}
"""Blender does not keep the texts of items, so they must live here."""


def bodies_to_choose(paths: list[Path]) -> tuple[Body, ...]:
    """Return the bodies of the first file with several.

    Files that were read recently are known: the dialog reads small ones.
    """
    return next(filter(None, map(bodies_of, paths)), ())


def body_items(paths: list[Path]) -> list[Item]:
    """Return the items of the choice; of several files no single bodies."""
    offered = bodies_to_choose(paths) if len(paths) == 1 else ()
    if offered not in _items:
        _items[offered] = [
            ("best", *BEST, "NONE", BEST_NUMBER),
            ("all", *EVERY, "NONE", EVERY_NUMBER),
            *(
                (f"body{number}", body.summary, ONLY_THIS, "NONE", number)
                for number, body in enumerate(offered, start=FIRST_BODY_NUMBER)
            ),
        ]
    return _items[offered]


def number_of(text: str, paths: list[Path]) -> int:
    """Return the number of the item that means this text; that of the best for others."""
    if text.strip().lower() == ALL_BODIES:
        return EVERY_NUMBER
    names = [body.name for body in bodies_to_choose(paths)] if len(paths) == 1 else []
    return FIRST_BODY_NUMBER + names.index(text) if text in names else BEST_NUMBER


def text_of(number: int, paths: list[Path]) -> str:
    """Return the text that an item means."""
    bodies = bodies_to_choose(paths)
    if number == EVERY_NUMBER:
        return ALL_BODIES
    index = number - FIRST_BODY_NUMBER
    return bodies[index].name if 0 <= index < len(bodies) else ""
