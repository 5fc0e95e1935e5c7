"""Process many files, sequentially or in parallel, and resume after a stop."""

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
from ..progress import Progress, Remark, collect_remarks, unwatched
from ..version import version
from .report import FIGURES, PAGE, draw_task, picture_file, remove_picture
from .screen import Screen
from .verb import Outcome, Task, Verb

RECORD = "mocap_assist.json"
IRRELEVANT_OPTIONS = {"again", "files", "jobs", "json", "output_folder", "report", "work"}
"""Options that do not change the result."""


class FinishedTask(NamedTuple):
    """A finished task: its outcome or failure."""

    task: Task
    outcome: Outcome | None
    """None if the task failed."""
    failure: str = ""
    crashed: bool = False
    """Whether the process of the task crashed."""


def run_tasks(
    verb: Verb, tasks: Sequence[Task], prepared: Any, n_jobs: int, screen: Screen
) -> Iterator[FinishedTask]:
    """Yield each task when it finishes; a failure does not stop the others."""
    if n_jobs == 1 or len(tasks) <= 1:
        for number, task in enumerate(tasks, start=1):
            screen.title = f"[{number}/{len(tasks)}] {task.source.name}"
            yield _attempt(verb, task, prepared, screen.progress)
        return
    crashed: list[Task] = []
    for finished in _run_in_pool(verb, tasks, prepared, n_jobs):
        if finished.crashed:
            crashed.append(finished.task)
        else:
            yield finished
    suspects: list[Task] = []
    for finished in _run_in_pool(verb, crashed, prepared, n_jobs) if crashed else ():
        if finished.crashed:
            suspects.append(finished.task)
        else:
            yield finished
    for task in suspects:  # A crash ends all tasks of the pool; run alone, the cause is known.
        yield from _run_in_pool(verb, [task], prepared, 1)


def _run_in_pool(
    verb: Verb, tasks: Sequence[Task], prepared: Any, n_jobs: int
) -> Iterator[FinishedTask]:
    n_workers, n_threads = min(n_jobs, len(tasks)), threads_from(tasks[0].arguments)
    with worker_pool(n_workers, n_threads) as pool:
        pending = {_submit(pool, verb, task, prepared): task for task in tasks}
        try:
            for done in as_completed(pending):
                task = pending[done]
                try:
                    yield done.result()
                except BrokenProcessPool:
                    sentence = (
                        f"{task.subject}: its process crashed, perhaps for lack of memory."
                        " Process a part of the take, or use fewer --jobs."
                    )
                    yield FinishedTask(task, None, sentence, crashed=True)
        finally:
            pool.shutdown(cancel_futures=True)


def _submit(
    pool: ProcessPoolExecutor, verb: Verb, task: Task, prepared: Any
) -> "Future[FinishedTask]":
    try:
        return pool.submit(_attempt, verb, task, prepared, unwatched)
    except BrokenProcessPool as error:  # A process crashed while other tasks were submitted.
        failed: Future[FinishedTask] = Future()
        failed.set_exception(error)
        return failed


def _attempt(verb: Verb, task: Task, prepared: Any, progress: Progress) -> FinishedTask:
    outcome = attempt(task.subject, _perform, verb, task, prepared, progress)
    if isinstance(outcome, Failure):
        return FinishedTask(task, None, outcome.sentence)
    return FinishedTask(task, outcome)


def _perform(verb: Verb, task: Task, prepared: Any, progress: Progress) -> Outcome:
    """Perform a task; figures that cannot be written as JSON count as its failure."""
    remarks: list[Remark] = []
    outcome = verb.perform(task, prepared, collect_remarks(progress, remarks))
    added = [f"{remark.rstrip('.')}." for remark in remarks if remark not in outcome.text]
    outcome = replace(outcome, text="\n".join([outcome.text, *added]))
    json.dumps(outcome.figures, allow_nan=False)
    if getattr(task.arguments, "output_folder", None) is not None:
        remove_picture(task)
        if task.arguments.report and (fault := draw_task(task)):
            return replace(outcome, failures=(*outcome.failures, fault))
    return outcome


class OutputRecord:
    """The record of the outputs in a folder: their inputs, options and figures.

    The file `mocap_assist.json` stores for each output the verb, its options, the version of
    Mocap Assist, the size and date of the input files, and the figures.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.path = folder / RECORD
        self.notes: dict[str, Any] = {}
        try:
            notes = parse_json(self.path.read_bytes())
        except (OSError, ValueError):
            notes = None  # Missing or unreadable: every output is made again.
        if isinstance(notes, dict):
            self.notes = {name: note for name, note in notes.items() if isinstance(note, dict)}

    def clear_up(self, tasks: Sequence[Task]) -> None:
        """Remove temporary files that a killed batch left for these outputs."""
        targets = [task.target for task in tasks if task.target is not None]
        pictures = [picture_file(task) for task in tasks if task.target is not None]
        own = [self.path, self.folder / PAGE, self.folder / FIGURES]
        remove_leftovers([*own, *targets, *pictures])

    def has(self, task: Task) -> bool:
        """Return whether the output exists and is up to date."""
        if task.refusal or task.target is None or is_missing(task.target):
            return False
        note = dict(self.notes.get(self._name(task), {}))
        note.pop("figures", None)
        return note == task_fingerprint(task)

    def figures(self, task: Task) -> dict[str, Any]:
        """Return the figures of an existing output."""
        found = self.notes[self._name(task)].get("figures")
        return found if isinstance(found, dict) else {}

    def add(self, task: Task, figures: dict[str, Any]) -> None:
        """Record a new output."""
        if task.target is not None:
            self.notes[self._name(task)] = {**task_fingerprint(task), "figures": figures}
            with write_atomically(self.path) as part:
                part.write_text(json.dumps(self.notes, indent=1), encoding="utf-8")

    def _name(self, task: Task) -> str:
        return "" if task.target is None else task.target.relative_to(self.folder).as_posix()


def task_fingerprint(task: Task) -> dict[str, Any]:
    """Return everything that the result depends on, as JSON; files by size and date."""
    options = {
        name: _json_value(value)
        for name, value in sorted(vars(task.arguments).items())
        if name not in IRRELEVANT_OPTIONS
    }
    return {
        "version": version(),
        "source": _stamp(task.source),
        "skeletons": _nearby_skeletons(task.source),
        "options": options,
    }


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
    return [str(real_path(file)), found.st_size, found.st_mtime_ns]
