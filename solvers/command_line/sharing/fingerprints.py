"""Fingerprints of results: everything that they depend on."""

import argparse
from pathlib import Path
from typing import Any

from ...version import version

IRRELEVANT_OPTIONS = {
    "after", "again", "cluster", "files", "flamenco", "flamenco_command", "flamenco_priority",
    "flamenco_tasks", "jobs", "json", "manifest", "output_folder", "report", "shard", "wait",
    "work",
}  # fmt: skip
"""Options that do not change the result."""
STAMP_LENGTH = 3


def fingerprint(source: Path, arguments: argparse.Namespace) -> dict[str, Any]:
    """Return everything that a result depends on, as JSON; files by name, size and date.

    It is the same on all machines, wherever they mount the folder of the files.
    """
    options = {
        name: _json_value(value)
        for name, value in sorted(vars(arguments).items())
        if name not in IRRELEVANT_OPTIONS
    }
    return {
        "version": version(),
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


def _nearby_skeletons(source: Path) -> list[Any]:
    """Return the skeleton files that an Acclaim recording may use."""
    if source.suffix.lower() != ".amc":
        return []
    return [_stamp(path) for path in sorted(source.parent.glob("*.[aA][sS][fF]"))]


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
