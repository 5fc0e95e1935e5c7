"""Work on many files: one after the other or several at a time, and go on after a stop."""

import json
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

from ..faults import Failure, attempt
from ..files import is_missing, real_path, remove_leftovers, write_atomically
from ..json_text import parse_json
from ..processes import threads_from, worker_pool
from ..progress import Progress, unwatched
from ..version import version
from .report import FIGURES, PAGE, draw_task, forget_picture, picture_file
from .screen import Screen
from .verb import Outcome, Task, Verb

RECORD = "mocap_assist.json"
NOT_OF_THE_RESULT = {"again", "files", "jobs", "json", "output_folder", "report", "work"}
"""Options that do not change what comes out."""


class Finished(NamedTuple):
    """A file that was worked on."""

    task: Task
    outcome: Outcome | None
    """None where it failed."""
    failure: str = ""
    died: bool = False
    """Its process did not live to tell."""


def work_on(
    verb: Verb, tasks: Sequence[Task], prepared: Any, n_jobs: int, screen: Screen
) -> Iterator[Finished]:
    """Yield every task as it is finished; a failure does not stop the others."""
    if n_jobs == 1 or len(tasks) <= 1:
        for number, task in enumerate(tasks, start=1):
            screen.title = f"[{number}/{len(tasks)}] {task.source.name}"
            yield _attempt(verb, task, prepared, screen.progress)
        return
    lost: list[Task] = []
    for finished in _work_together(verb, tasks, prepared, n_jobs):
        if finished.died:
            lost.append(finished.task)
        else:
            yield finished
    suspects: list[Task] = []
    for finished in _work_together(verb, lost, prepared, n_jobs) if lost else ():
        if finished.died:
            suspects.append(finished.task)
        else:
            yield finished
    for task in suspects:  # One that dies takes the others along; alone it is known which.
        yield from _work_together(verb, [task], prepared, 1)


def _work_together(
    verb: Verb, tasks: Sequence[Task], prepared: Any, n_jobs: int
) -> Iterator[Finished]:
    n_workers, n_threads = min(n_jobs, len(tasks)), threads_from(tasks[0].arguments)
    with worker_pool(n_workers, n_threads) as pool:
        waiting = {_submitted(pool, verb, task, prepared): task for task in tasks}
        try:
            for done in as_completed(waiting):
                task = waiting[done]
                try:
                    yield done.result()
                except BrokenProcessPool:
                    sentence = (
                        f"{task.subject}: the process that worked on it has died, perhaps for"
                        " want of memory. Work on a part of the take, or with fewer --jobs."
                    )
                    yield Finished(task, None, sentence, died=True)
        finally:
            pool.shutdown(cancel_futures=True)


def _submitted(
    pool: ProcessPoolExecutor, verb: Verb, task: Task, prepared: Any
) -> "Future[Finished]":
    try:
        return pool.submit(_attempt, verb, task, prepared, unwatched)
    except BrokenProcessPool as error:  # A process has died while others were submitted.
        failed: Future[Finished] = Future()
        failed.set_exception(error)
        return failed


def _attempt(verb: Verb, task: Task, prepared: Any, progress: Progress) -> Finished:
    outcome = attempt(task.subject, _perform, verb, task, prepared, progress)
    if isinstance(outcome, Failure):
        return Finished(task, None, outcome.sentence)
    return Finished(task, outcome)


def _perform(verb: Verb, task: Task, prepared: Any, progress: Progress) -> Outcome:
    """Do the work; figures that cannot be written as JSON are a fault of this task."""
    outcome = verb.perform(task, prepared, progress)
    json.dumps(outcome.figures, allow_nan=False)
    if getattr(task.arguments, "output_folder", None) is not None:
        forget_picture(task)
        if task.arguments.report and (fault := draw_task(task)):
            return replace(outcome, failures=(*outcome.failures, fault))
    return outcome


class Made:
    """What is in an output folder already, from what it was made, and what came of it.

    The file `mocap_assist.json` notes, for each output, the verb, its options, the version of
    Mocap Assist, size and date of the files it was made from, and the figures.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.path = folder / RECORD
        self.notes: dict[str, Any] = {}
        try:
            notes = parse_json(self.path.read_bytes())
        except (OSError, ValueError):
            notes = None  # None yet, or unreadable: everything is made anew.
        if isinstance(notes, dict):
            self.notes = {name: note for name, note in notes.items() if isinstance(note, dict)}

    def clear_up(self, tasks: Sequence[Task]) -> None:
        """Remove half-written files that a killed batch has left among these outputs."""
        targets = [task.target for task in tasks if task.target is not None]
        pictures = [picture_file(task) for task in tasks if task.target is not None]
        own = [self.path, self.folder / PAGE, self.folder / FIGURES]
        remove_leftovers([*own, *targets, *pictures])

    def has(self, task: Task) -> bool:
        """Whether the output is there and would come out the same again."""
        if task.refusal or task.target is None or is_missing(task.target):
            return False
        note = dict(self.notes.get(self._name(task), {}))
        note.pop("figures", None)
        return note == note_of(task)

    def figures(self, task: Task) -> dict[str, Any]:
        """Return the figures of an output that is there."""
        found = self.notes[self._name(task)].get("figures")
        return found if isinstance(found, dict) else {}

    def add(self, task: Task, figures: dict[str, Any]) -> None:
        """Note that the output was made."""
        if task.target is not None:
            self.notes[self._name(task)] = {**note_of(task), "figures": figures}
            with write_atomically(self.path) as part:
                part.write_text(json.dumps(self.notes, indent=1), encoding="utf-8")

    def _name(self, task: Task) -> str:
        return "" if task.target is None else task.target.relative_to(self.folder).as_posix()


def note_of(task: Task) -> dict[str, Any]:
    """Return what the result depends on, as JSON has it: files by what is in them now."""
    options = {
        name: _noted(value)
        for name, value in sorted(vars(task.arguments).items())
        if name not in NOT_OF_THE_RESULT
    }
    return {
        "version": version(),
        "source": _stamp(task.source),
        "skeletons": _skeletons_beside(task.source),
        "options": options,
    }


def _skeletons_beside(source: Path) -> list[Any]:
    """Return what an Acclaim recording may be read with."""
    if source.suffix.lower() != ".amc":
        return []
    return [_stamp(path) for path in sorted(source.parent.glob("*.[aA][sS][fF]"))]


def _noted(value: Any) -> Any:
    """Return an option as JSON has it; a file by what is in it now."""
    if isinstance(value, list):
        return [_noted(each) for each in value]
    return _stamp(value) if isinstance(value, Path) else str(value)


def _stamp(file: Path) -> list[Any]:
    """Return name, size and date of a file, or of all files in a folder."""
    try:
        if file.is_dir():
            return [_stamp(each) for each in sorted(file.rglob("*")) if each.is_file()]
        found = file.stat()
    except OSError:  # Whoever reads it will say so.
        return [str(file)]
    return [str(real_path(file)), found.st_size, found.st_mtime_ns]
