"""Process every file of a command and report the results, or submit the batch to a farm."""

import argparse
import json
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

from ..errors import InvalidSettingError
from ..faults import Failure, attempt, escaped
from ..files import is_missing
from .arguments import Task, Verb, settings_from_arguments
from .batches import (
    FinishedTask,
    Screen,
    already_made,
    check_output_folder,
    draw_task,
    has_called_hook,
    has_picture,
    made_record,
    note_other_builds,
    note_pipe,
    printable,
    record_end,
    run_tasks,
    shared_tasks,
    task_entries,
    tasks_of,
    until_released,
    verb_name,
    workers_for,
    write_report,
)
from .farm import FlamencoSettings, check_job, job_of_batch
from .run import FAILED_STATUS
from .sharing import stamp_options


def run_verb(verb: Verb, arguments: argparse.Namespace, screen: Screen) -> int:
    """Process all files and report each; return the exit status."""
    n_jobs = getattr(arguments, "jobs", 1)
    if n_jobs < 1:
        raise InvalidSettingError(f"jobs is {n_jobs}; it must be at least 1.")
    if getattr(arguments, "cluster", None) and hasattr(arguments, "threads"):
        raise InvalidSettingError(
            "The workers of a cluster choose their threads. Leave out --threads."
        )
    folder: Path | None = getattr(arguments, "output_folder", None)
    reporting = getattr(arguments, "report", False)
    if folder is None and reporting:
        raise InvalidSettingError("A report needs a folder: name it with --output-folder DIR.")
    stamp_options(arguments)
    note_pipe(arguments, screen)
    every = tasks_of(verb, arguments)
    tasks = every if folder is None else shared_tasks(every, arguments, screen)
    has_failures = False
    try:
        for finished in _run_tasks(verb, tasks, screen):
            has_failures |= _report(finished, len(tasks) > 1, screen)
            has_failures |= finished.outcome is None
            if folder is not None:
                check_output_folder(folder)
    finally:
        if folder is not None and reporting and not is_missing(folder):
            name = verb_name(every[0])
            for fault in write_report(folder, name, lambda: task_entries(every)):
                screen.write_line(fault)
                has_failures = True
    return FAILED_STATUS if has_failures else 0


def _run_tasks(verb: Verb, tasks: Sequence[Task], screen: Screen) -> Iterator[FinishedTask]:
    """Yield existing results, then each task when it finishes."""
    remaining = []
    for task in tasks:
        record = None if _folder(task) is None else made_record(task)
        if record is not None and task.arguments.again:
            remaining.append(task._replace(replaced=record.identifier))
        elif record is not None and has_called_hook(task, record):
            draw = task.arguments.report and not has_picture(task)
            failures = tuple(filter(None, [draw_task(task)])) if draw else ()
            outcome = already_made(record)
            yield FinishedTask(task, replace(outcome, failures=failures))
        elif task.refusal:
            screen.write_line(task.refusal)
            yield record_end(FinishedTask(task, None, task.refusal))
        else:
            remaining.append(task)
    if not remaining:
        return
    note_other_builds(remaining, screen)
    with workers_for(remaining) as workers:
        prepared = verb.work().prepare(tasks[0].arguments, screen.progress)
        run_all = partial(run_tasks, verb, prepared=prepared, workers=workers, screen=screen)
        for finished in until_released(remaining, run_all, screen):
            screen.clear()
            if finished.outcome is None and not is_missing(_folder(finished.task) or "."):
                screen.write_line(finished.failure)
            yield finished


def _folder(task: Task) -> Path | None:
    folder: Path | None = getattr(task.arguments, "output_folder", None)
    return folder


def _report(finished: FinishedTask, one_of_many: bool, screen: Screen) -> bool:
    """Print the result of a task on stdout: a line of JSON, or text.

    Returns
    -------
    bool
        Whether a part of it failed; stderr names it.
    """
    task, outcome = finished.task, finished.outcome
    arguments = task.arguments
    failures = outcome.failures if outcome is not None else ()
    if arguments.json:
        figures = {"error": finished.failure} if outcome is None else outcome.figures
        names: dict[str, Any] = {"input": str(task.source)}
        if len(task.sources) > 1:
            names = {"inputs": [str(source) for source in task.sources]}
        if getattr(arguments, "body", None):
            names["body"] = str(arguments.body)
        if task.target is not None:
            names["output"] = str(task.target)
        line = attempt(task.subject, json.dumps, {**names, **figures}, allow_nan=False)
        if isinstance(line, Failure):
            failures = (*failures, line.sentence)
            line = json.dumps({**names, "error": line.sentence})
        sys.stdout.write(f"{line}\n")
    elif outcome is not None:
        title = f"{escaped(str(task.source))}\n" if one_of_many else ""
        sys.stdout.write(f"{title}{printable(outcome.text)}\n")
    sys.stdout.flush()
    for sentence in failures:
        screen.write_line(sentence)
    return bool(failures)


def submit_batch(
    verb: Verb,
    arguments: argparse.Namespace,
    words: list[str],
    add_common: Callable[[argparse.ArgumentParser], None],
) -> int:
    """Submit the batch to a Flamenco Manager and print the address of its page."""
    settings = settings_from_arguments(arguments, FlamencoSettings)
    job = job_of_batch(arguments, settings, words, add_common, verb.work().add_options)
    submitted = check_job(job, arguments.flamenco).submit()
    text = f"Submitted {job.name} in {settings.flamenco_tasks} tasks: {submitted.page}"
    figures = {"job": submitted.identifier, "page": submitted.page}
    sys.stdout.write(f"{json.dumps(figures) if arguments.json else text}\n")
    return 0
