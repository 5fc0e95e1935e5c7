"""Convert any failure in the processing of one file to one sentence."""

import re
import traceback
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import ParamSpec, TypeVar

from .errors import FileAccessError, InvalidFileError, MocapAssistError, SolveCancelled
from .files import reason_of

OWN_FOLDERS = {Path(__file__).parent.name, "mocap_assist", "operators"}
"""Folders of this project, relative to the folder of the extension or of all packages."""

Arguments = ParamSpec("Arguments")
Result = TypeVar("Result")


@dataclass(frozen=True)
class Failure:
    """Why the work on one file failed."""

    sentence: str
    """Names the file; valid Unicode even where the file's name is not."""
    lasting: bool = False
    """Whether the content of the file is the reason: it fails again until the file changes."""
    details: str = ""
    """The traceback of a bug in Mocap Assist."""

    @property
    def is_fault(self) -> bool:
        """Whether a bug in Mocap Assist is the reason."""
        return bool(self.details)

    def as_error(self) -> InvalidFileError:
        """Return an error with this sentence, and with the details as its note."""
        error = InvalidFileError(self.sentence)
        if self.details:
            error.add_note(self.details)
        return error


def attempt(
    subject: Path | str,
    work: Callable[Arguments, Result],
    /,
    *args: Arguments.args,
    **kwargs: Arguments.kwargs,
) -> Result | Failure:
    """Return the result of `work`, or its failure, so that other files are still processed.

    Parameters
    ----------
    subject : Path or str
        The file, or the part of it, that the sentence of a failure names.
    work : callable
        Called with the remaining arguments.

    Raises
    ------
    SolveCancelled
        Raised by `work`.
    """
    try:
        return work(*args, **kwargs)
    except SolveCancelled:
        raise
    except Exception as error:
        return _failure(subject, error)


def escaped(text: str) -> str:
    r"""Return text with each character that UTF-8 cannot encode written as `\udcff`.

    Python keeps bytes of file names that are not valid UTF-8 as such characters. Control
    characters are escaped, too: otherwise a name could imitate a separate line, or another
    name by letters that run backward.
    """
    plain = text.encode("utf-8", "backslashreplace").decode("utf-8")
    return re.sub(r"[\x00-\x1f\x7f-\x9f\u2028-\u202e\u2066-\u2069]", _code, plain)


def _code(letter: re.Match[str]) -> str:
    return letter[0].encode("unicode_escape").decode("ascii")


def _failure(subject: Path | str, error: Exception) -> Failure:
    if isinstance(error, MocapAssistError):
        sentence = str(error)
        named = Path(subject).name in sentence
        lasting = not isinstance(error, FileAccessError)
        return Failure(escaped(sentence if named else f"{subject}: {sentence}"), lasting)
    if isinstance(error, OSError):
        return Failure(escaped(f"{error.filename or subject}: {reason_of(error)}."))
    if isinstance(error, MemoryError):
        sentence = f"{subject} needs more memory than is available; work on a part of the take."
        return Failure(escaped(sentence))
    sentence = (
        f"{subject}: this is a bug in Mocap Assist ({type(error).__name__} at"
        f" {_position(error)}); please report it."
    )
    return Failure(escaped(sentence), details="".join(traceback.format_exception(error)))


def _position(error: Exception) -> str:
    """Return file and line of the innermost call in this project, or of the innermost call."""
    root = Path(__file__).parents[1]
    calls = traceback.extract_tb(error.__traceback__)[1:]  # The first is `attempt`.
    for call in reversed(calls):
        path = Path(call.filename)
        if path.is_relative_to(root) and path.relative_to(root).parts[0] in OWN_FOLDERS:
            return f"{path.relative_to(root).as_posix()}:{call.lineno}"
    return f"{Path(calls[-1].filename).name}:{calls[-1].lineno}" if calls else "its call"
