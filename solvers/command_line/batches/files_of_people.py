"""The files of several people of one take: their names, and what they may replace."""

import re
from pathlib import Path

from ...errors import InvalidFileError
from ...files import is_missing
from ..arguments import Task, check_target
from ..sharing import Record, Records

PERSON = re.compile(r"(.+)_person([2-9]|[1-9]\d{1,8})", re.DOTALL | re.ASCII)
"""The name of a person but the first, as `path_of_person` writes it, without the extension."""


def path_of_person(target: Path, number: int) -> Path:
    """Return the file of a person, counted from 1, of a take that is written to `target`."""
    return target if number == 1 else target.with_stem(f"{target.stem}_person{number}")


def take_of_person(name: str) -> str | None:
    """Return the name of the take of which a name is a person; None for other names."""
    found = PERSON.fullmatch(name)
    return None if found is None else found[1]


def n_people_of(record: Record) -> int:
    """Return how many people were written for the output of a record, each to a file."""
    people = record.figures.get("people")
    return len(people) if isinstance(people, list) else 1


def check_is_no_person(task: Task) -> None:
    """Refuse a take that would replace a person of another one in a folder of results.

    Raises InvalidFileError.
    """
    folder: Path | None = getattr(task.arguments, "output_folder", None)
    target = task.target
    assert target is not None
    found = PERSON.fullmatch(target.stem)
    if folder is None or found is None:
        return
    record = _record(target.with_stem(found[1]), folder)
    if record is not None and int(found[2]) <= n_people_of(record):
        raise InvalidFileError(
            f"{target} is a person of {_source_of(record)}, and would be replaced. Rename"
            f" {task.source.name}, or write to another folder."
        )


def check_files_of_people(task: Task, n_people: int) -> None:
    """Refuse a take that would replace what is not its own, before it is tracked.

    The target may be replaced: it was named. The files of its other people may be if they
    belong to it: in a folder of results, if they are not the results of other takes;
    elsewhere, if the target exists, too.

    Parameters
    ----------
    task : Task
    n_people : int
        Number of people to track, or that were; 0 for all.

    Raises
    ------
    InvalidFileError
    """
    target = task.target
    assert target is not None
    others = [path_of_person(target, number) for number in range(2, n_people + 1)]
    existing = [path for path in _existing(target) if path in others or n_people == 0]
    for path in others or existing:
        check_target(path, {path.suffix.lower(): ""})
    folder: Path | None = task.arguments.output_folder
    for path in existing:
        if folder is not None:
            record = _record(path, folder)
            if record is not None:
                raise InvalidFileError(
                    f"{path} is the result of {_source_of(record)}, and would be replaced by a"
                    f" person of {task.source.name}. Rename one of the recordings."
                )
        elif is_missing(target):
            raise InvalidFileError(
                f"{path} exists, and would be replaced by a person of {task.source.name}. Move"
                " it, or name another file to write."
            )


def left_of_earlier_run(target: Path, n_people: int) -> list[Path]:
    """Return the files that are named as people whom this run has not found."""
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


def _record(path: Path, folder: Path) -> Record | None:
    return Records(folder).read(path.relative_to(folder).as_posix())


def _source_of(record: Record) -> str:
    return record.inputs[0] if record.inputs else record.output
