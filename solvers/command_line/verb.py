"""What a verb of the command line is, and what it hands back."""

import argparse
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, NamedTuple

from ..progress import Progress


@dataclass(frozen=True)
class Outcome:
    """What there is to say about one file that was worked on."""

    text: str
    """For people."""
    figures: dict[str, Any] = field(default_factory=dict)
    """For programs: what `--json` prints."""


class Task(NamedTuple):
    """One file to work on. It can be sent to another process."""

    source: Path
    target: Path | None
    """Where to write; None for verbs that write nothing."""
    arguments: argparse.Namespace


def nothing_to_prepare(arguments: argparse.Namespace, progress: Progress) -> None:
    """Prepare nothing: every file stands for itself."""


@dataclass(frozen=True)
class Verb:
    """A verb: its options, what it does once, and what it does to each file."""

    help: str
    add_options: Callable[[argparse.ArgumentParser], None]
    perform: Callable[[Task, Any, Progress], Outcome]
    """From a task and what was prepared."""
    writes: bool = True
    prepare: Callable[[argparse.Namespace, Progress], Any] = nothing_to_prepare
    """Its result serves all files, and must be fit to be sent to another process."""
