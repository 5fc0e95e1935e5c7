"""How the last press of a button ended, for the diagnostics; without names and paths."""

import re
import traceback
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..languages import template_of

CALL = re.compile(r'File "([^"\n]+)", line (\d+), in (\S+)')
"""A call in a traceback."""
ROOT = Path(__file__).parents[2]
"""The folder of the extension: paths of calls begin below it."""
MAX_CALLS = 6
"""Number of innermost calls that are kept. It bounds the text that an animator copies."""


@dataclass(frozen=True)
class Press:
    """How a press ended."""

    button: str
    ending: str = "done"
    sentence: str = ""
    """The message without the names in it."""
    calls: tuple[str, ...] = ()
    """Module, line and function of calls in the extension, the innermost one last."""
    settings: Mapping[str, Any] = field(default_factory=dict)
    """Settings that differ from their defaults."""


_last: list[Press] = []


def note_press(
    operator: Any, error: BaseException | None = None, *, sentence: str = ""
) -> None:
    """Remember how a press ended.

    Parameters
    ----------
    operator : bpy.types.Operator
    error : BaseException, optional
        What ended it.
    sentence : str
        The message of an error that is not raised.
    """
    ending = type(error).__name__ if error is not None else "an error" if sentence else "done"
    _last[:] = [
        Press(
            getattr(operator, "bl_idname", type(operator).__name__),
            ending,
            template_of(str(error) if error is not None else sentence),
            () if error is None else calls_of(error),
            changed_values(getattr(operator, "properties", None)),
        )
    ]


@contextmanager
def noted_errors(operator: Any) -> Iterator[None]:
    """Remember an error that ends a press of this operator, and raise it again."""
    try:
        yield
    except BaseException as error:
        note_press(operator, error)
        raise


def last_press() -> Press | None:
    """Return the last press of this session."""
    return _last[0] if _last else None


def calls_of(error: BaseException) -> tuple[str, ...]:
    """Return the calls in the extension that led to an error, also in another process."""
    text = "".join(traceback.format_exception(error))
    found = [
        f"{Path(path).relative_to(ROOT).as_posix()}:{line} {function}"
        for path, line, function in CALL.findall(text)
        if Path(path).is_relative_to(ROOT)
    ]
    return tuple(found[-MAX_CALLS:])


def changed_values(owner: Any) -> dict[str, Any]:
    """Return the numbers, switches and choices of a Blender type that are not the defaults.

    Texts are left out, as are choices that a script lists: they may be names or paths.
    """
    items = () if owner is None else owner.bl_rna.properties
    found = {}
    for item in items:
        if item.type not in {"BOOLEAN", "INT", "FLOAT", "ENUM"} or item.is_readonly:
            continue
        if getattr(item, "is_array", False) or not _has_fixed_choices(item):
            continue
        value = getattr(owner, item.identifier)
        if value != item.default:
            found[item.identifier] = float(f"{value:.6g}") if item.type == "FLOAT" else value
    return found


def _has_fixed_choices(item: Any) -> bool:
    """Return whether the choices stand in the code; those of a callback have no default."""
    return item.type != "ENUM" or (bool(item.enum_items_static) and not item.is_enum_flag)
