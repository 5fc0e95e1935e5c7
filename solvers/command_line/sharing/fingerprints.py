"""Fingerprints of results: everything that they depend on."""

import argparse
from pathlib import Path
from typing import Any

from ...version import build

IRRELEVANT_OPTIONS = {
    "after", "again", "cluster", "files", "flamenco", "flamenco_command", "flamenco_priority",
    "flamenco_tasks", "jobs", "json", "manifest", "output_folder", "report", "shard", "stamps",
    "wait", "work",
}  # fmt: skip
"""Options that do not change the result."""
STAMP_LENGTH = 3


def stamp_options(arguments: argparse.Namespace) -> None:
    """Add to the arguments of a run the sizes and dates of the files and folders they name.

    Each folder is listed once, however many takes there are.
    """
    arguments.stamps = {
        name: _json_value(value)
        for name, value in vars(arguments).items()
        if name not in IRRELEVANT_OPTIONS and _has_paths(value)
    }


def fingerprint(source: Path, arguments: argparse.Namespace) -> dict[str, Any]:
    """Return everything that a result depends on, as JSON; files by name, size and date.

    It is the same on all machines, wherever they mount the folder of the files.

    Parameters
    ----------
    source : Path
    arguments : Namespace
        With what `stamp_options` adds.
    """
    stamps: dict[str, Any] = arguments.stamps
    options = {
        name: stamps[name] if name in stamps else _json_value(value)
        for name, value in sorted(vars(arguments).items())
        if name not in IRRELEVANT_OPTIONS
    }
    return {
        "version": build(),
        "source": _stamp(source),
        "skeletons": _nearby_skeletons(source),
        "options": options,
    }


def without_folders(value: Any) -> Any:
    """Return a fingerprint of an earlier version, which has paths, with names instead."""
    if isinstance(value, dict):
        return {name: without_folders(each) for name, each in value.items()}
    if not isinstance(value, list):
        return value
    if len(value) == STAMP_LENGTH and isinstance(value[0], str) and isinstance(value[1], int):
        return [Path(value[0]).name, *value[1:]]
    return [without_folders(each) for each in value]


def is_of_another_build(made: dict[str, Any], now: dict[str, Any]) -> bool:
    """Return whether two fingerprints differ, and only in the version of Mocap Assist."""
    return made != now and {**made, "version": now["version"]} == now


def _nearby_skeletons(source: Path) -> list[Any]:
    """Return the skeleton files that an Acclaim recording may use."""
    if source.suffix.lower() != ".amc":
        return []
    return [_stamp(path) for path in sorted(source.parent.glob("*.[aA][sS][fF]"))]


def _has_paths(value: Any) -> bool:
    return isinstance(value, Path) or (isinstance(value, list) and any(map(_has_paths, value)))


def _json_value(value: Any) -> Any:
    """Return an option as JSON; a file by size and date."""
    if isinstance(value, list):
        return [_json_value(each) for each in value]
    return _stamp(value) if isinstance(value, Path) else str(value)


def _stamp(file: Path) -> list[Any]:
    """Return name, size and date of a file, or of all files in a folder."""
    try:
        if file.is_dir():
            return [_stamp(each) for each in sorted(file.rglob("*")) if each.is_file()]
        found = file.stat()
    except OSError:  # The reader reports the error.
        return [str(file)]
    return [file.name, found.st_size, found.st_mtime_ns]
