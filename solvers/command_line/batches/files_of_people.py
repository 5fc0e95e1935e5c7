"""The files of several people of one take: their names, and what they may replace."""

import re
from pathlib import Path

from ...errors import InvalidFileError
from ...files import is_missing
from ..arguments import Task, check_target
from ..sharing import Records

PERSON = re.compile(r"(.+)_person\d+", re.DOTALL)
"""The name of a person but the first, without the extension."""


def path_of_person(target: Path, number: int) -> Path:
    """Return the file of a person, counted from 1, of a take that is written to `target`."""
    return target if number == 1 else target.with_stem(f"{target.stem}_person{number}")


def take_of_person(name: str) -> str | None:
    """Return the name of the take of which a name is a person; None for other names."""
    found = PERSON.fullmatch(name)
    return None if found is None else found[1]


def check_files_of_people(task: Task, n_people: int) -> None:
    """Refuse a take that would replace what is not its own, before it is tracked.

    The target may be replaced: it was named. The files of its other people may be if they
    belong to it: in a folder of results, if they are not the results of other takes;
    elsewhere, if the target exists, too.

    Parameters
    ----------
    task : Task
    n_people : int
        Number of people to track; 0 for all.

    Raises
    ------
    InvalidFileError
    """
    target = task.target
    assert target is not None
    others = [path_of_person(target, number) for number in range(2, n_people + 1)]
    for path in others or _existing(target):
        check_target(path, {path.suffix.lower(): ""})
    folder: Path | None = task.arguments.output_folder
    for path in _existing(target):
        if folder is not None:
            record = Records(folder).read(path.relative_to(folder).as_posix())
            if record is not None:
                raise InvalidFileError(
                    f"{path} is the result of {record.inputs[0]}, and would be replaced by a"
                    f" person of {task.source.name}. Rename one of the recordings."
                )
        elif is_missing(target):
            raise InvalidFileError(
                f"{path} exists, and would be replaced by a person of {task.source.name}. Move"
                " it, or name another file to write."
            )


def left_of_earlier_run(target: Path, n_people: int) -> list[Path]:
    """Return the files of people whom this run has not found."""
    written = {path_of_person(target, number) for number in range(1, n_people + 1)}
    return [path for path in _existing(target) if path not in written]


def _existing(target: Path) -> list[Path]:
    """Return the files in the folder of a target that are named as its other people."""
    if is_missing(target.parent):
        return []
    return sorted(
        path
        for path in target.parent.iterdir()
        if path.suffix == target.suffix and take_of_person(path.stem) == target.stem
    )
