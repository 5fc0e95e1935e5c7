"""Define a verb of the command line, its tasks and outcomes."""

import argparse
from collections.abc import Callable
from dataclasses import dataclass, field
from enum import Enum
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

from ...progress import Progress

COMMAND_LINE = __name__.removesuffix(".arguments.verb_description")


@dataclass(frozen=True)
class Outcome:
    """The report on one processed file."""

    text: str
    """For people."""
    figures: dict[str, Any] = field(default_factory=dict)
    """For programs: what `--json` prints."""
    failures: tuple[str, ...] = ()
    """A sentence for each part that failed."""
    remarks: tuple[str, ...] = ()
    """Sentences of the text that the record keeps."""


class Task(NamedTuple):
    """One unit of work; picklable."""

    sources: tuple[Path, ...]
    """One file; all files for a verb that combines them."""
    target: Path | None
    """The output; None for verbs that write nothing."""
    arguments: argparse.Namespace
    refusal: str = ""
    """Why the task cannot run, if that is known in advance."""
    name: str = ""
    """Path of the input below the named folder; it decides the shard."""
    replaced: str = ""
    """Identifier of the record that `--again` replaces."""
    batch: str = ""
    """Identifier that all workers of a cluster know, see `Workers`."""

    @property
    def source(self) -> Path:
        """The input file of a task with one."""
        return self.sources[0]

    @property
    def key(self) -> tuple[Any, ...]:
        """Key that distinguishes it from other tasks."""
        return self.sources, self.target, getattr(self.arguments, "body", None)

    @property
    def subject(self) -> Path:
        """The file that a failure names."""
        return self.sources[0] if len(self.sources) == 1 else self.target or self.sources[0]


class OutputKind(Enum):
    """The output of a verb."""

    WORDS = "figures of each file"
    FILES = "a file of each file"
    ONE_FILE = "one file of all files"
    REPORT = "a report on folders"
    LIBRARY = "a library, which is named first, of all other files"
    MATCHES = "matches of a file in libraries, which are named last"
    MANY_FILES = "a folder of files of all files"


def prepare_nothing(arguments: argparse.Namespace, progress: Progress) -> None:
    """Prepare nothing: all files are independent."""


@dataclass(frozen=True)
class VerbWork:
    """What a verb does: its options, its preparation for a run, and its work on each task."""

    add_options: Callable[[argparse.ArgumentParser], None]
    perform: Callable[[Task, Any, Progress], Outcome]
    """Called with a task and the result of `prepare`."""
    list_recordings: Callable[[Path], list[Path]] | None = None
    """Returns the recordings in a folder that it can read; None for those of all formats."""
    prepare: Callable[[argparse.Namespace, Progress], Any] = prepare_nothing
    """Called once per run; its picklable result is passed to all tasks."""


@dataclass(frozen=True)
class Verb:
    """A verb of the command line; picklable."""

    help: str
    place: str
    """Module and name of its `VerbWork`; `.fix_verb:FIX` is in `solvers.command_line`."""
    makes: OutputKind = OutputKind.FILES
    writes_motions: bool = False
    """Whether it always writes motions of skeletons."""
    writes_joints: bool = False
    """Whether it can also write tracked joints."""

    def work(self) -> VerbWork:
        """Import and return what the verb does; a run imports no other verb."""
        module, name = self.place.split(":")
        found = getattr(import_module(module, COMMAND_LINE), name)
        assert isinstance(found, VerbWork)
        return found
