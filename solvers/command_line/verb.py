"""What a verb of the command line is, and what it hands back."""

import argparse
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import Enum
from pathlib import Path
from typing import Any, NamedTuple

from ..progress import Progress
from ..recordings import recordings_in


@dataclass(frozen=True)
class Outcome:
    """What there is to say about one file that was worked on."""

    text: str
    """For people."""
    figures: dict[str, Any] = field(default_factory=dict)
    """For programs: what `--json` prints."""
    failures: tuple[str, ...] = ()
    """A sentence for each part of it that failed."""


class Task(NamedTuple):
    """What is done in one go. It can be sent to another process."""

    sources: tuple[Path, ...]
    """One file; all of them for a verb that makes one file of all."""
    target: Path | None
    """Where to write; None for verbs that write nothing."""
    arguments: argparse.Namespace
    refusal: str = ""
    """Why it cannot be done, where that is known before."""

    @property
    def source(self) -> Path:
        """The file to read, where it is one."""
        return self.sources[0]

    @property
    def subject(self) -> Path:
        """What a failure is about."""
        return self.sources[0] if len(self.sources) == 1 else self.target or self.sources[0]


class Makes(Enum):
    """What a verb makes."""

    WORDS = "figures of each file"
    FILES = "a file of each file"
    ONE_FILE = "one file of all files"
    LIBRARY = "a library, which is named first, of all other files"
    MATCHES = "what there is like a file in a library, which is named last"
    MANY_FILES = "a folder of files of all files"


def nothing_to_prepare(arguments: argparse.Namespace, progress: Progress) -> None:
    """Prepare nothing: every file stands for itself."""


@dataclass(frozen=True)
class Verb:
    """A verb: its options, what it does once, and what it does in each task."""

    help: str
    add_options: Callable[[argparse.ArgumentParser], None]
    perform: Callable[[Task, Any, Progress], Outcome]
    """From a task and what was prepared."""
    makes: Makes = Makes.FILES
    writes_motions: bool = False
    """Whether it makes skeletons' motions, whatever it reads."""
    writes_joints: bool = False
    """Whether it can also write tracked joints."""
    look: Callable[[Path], list[Path]] = recordings_in
    """Returns the recordings that it reads, of a folder."""
    prepare: Callable[[argparse.Namespace, Progress], Any] = nothing_to_prepare
    """Its result serves all tasks, and must be fit to be sent to another process."""
