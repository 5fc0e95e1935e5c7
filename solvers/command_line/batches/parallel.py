"""Run the tasks of a batch one after another, in several processes, or on a cluster."""

import argparse
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import BrokenExecutor, Executor, Future, as_completed
from contextlib import AbstractContextManager, nullcontext
from functools import partial
from pathlib import Path
from time import sleep
from typing import Any

from ...processes import LocalWorkers, Workers, threads_from
from ...progress import unwatched
from ..arguments import Task, Verb
from ..farm import cluster_workers
from ..sharing import RENEWAL_INTERVAL_S
from .batch import FinishedTask, attempt_task, record_end
from .screen import Screen
from .tasks import check_output_folder


def workers_for(tasks: Sequence[Task]) -> AbstractContextManager[Workers | None]:
    """Return the workers that the command line requests; None for this process.

    A verb without an output folder, such as `index`, sends its parts to workers itself.

    Raises
    ------
    InvalidSettingError
        The workers of a cluster cannot be used.
    """
    arguments = tasks[0].arguments
    cluster: str | None = getattr(arguments, "cluster", None)
    folder: Path | None = getattr(arguments, "output_folder", None)
    if cluster is not None and folder is not None:
        named = [folder, getattr(arguments, "library", None)]
        return cluster_workers(cluster, [path.absolute() for path in named if path is not None])
    n_jobs: int = getattr(arguments, "jobs", 1)
    if n_jobs == 1 or len(tasks) == 1:
        return nullcontext()
    return nullcontext(LocalWorkers(n_jobs, threads_from(arguments)))


def run_tasks(
    verb: Verb, tasks: Sequence[Task], prepared: Any, workers: Workers | None, screen: Screen
) -> Iterator[FinishedTask]:
    """Yield each task when it finishes; a failure does not stop the others."""
    if workers is None:
        for number, task in enumerate(tasks, start=1):
            screen.title = f"[{number}/{len(tasks)}] {task.source.name}"
            yield attempt_task(verb, task, screen.progress, prepared)
    else:
        ended = _run_on_workers(verb, tasks, workers.share(prepared), workers, screen)
        yield from screen.counted(ended, len(tasks))


def _run_on_workers(
    verb: Verb, tasks: Sequence[Task], shared: Any, workers: Workers, screen: Screen
) -> Iterator[FinishedTask]:
    crashes: Counter[tuple[Any, ...]] = Counter()
    remaining, given_up = [*tasks], list[FinishedTask]()
    while remaining or given_up:
        again: list[Task] = []
        n_held = 0
        for group in _groups(remaining, crashes, workers.max_crashes):
            for finished in _run_group(verb, group, shared, workers):
                key = finished.task.key
                crashes[key] += finished.crashed
                n_held += finished.is_held
                if finished.crashed and crashes[key] == workers.max_crashes:
                    given_up.append(finished)
                elif finished.crashed or finished.is_held:
                    again.append(finished.task)
                else:
                    yield finished
        recorded = [_record_crash(finished, workers.batch) for finished in given_up]
        yield from (finished for finished in recorded if not finished.is_held)
        given_up = [each for each, end in zip(given_up, recorded, strict=True) if end.is_held]
        if n_held + len(given_up):
            screen.note(
                f"Waiting for takes that lost workers have claimed: {n_held + len(given_up)}."
            )
            sleep(RENEWAL_INTERVAL_S)
        remaining = again


def until_released(
    tasks: Sequence[Task],
    run_all: Callable[[Sequence[Task]], Iterator[FinishedTask]],
    screen: Screen,
) -> Iterator[FinishedTask]:
    """Run tasks; with `--wait`, again and again those that other processes have.

    A take ends in the claim's holder, or is made here as soon as its claim is abandoned.
    """
    remaining, n_reported = [*tasks], 0
    while remaining:
        taken: list[Task] = []
        for finished in run_all(remaining):
            if finished.is_taken and finished.task.arguments.wait:
                taken.append(finished.task)
            else:
                yield finished
        if taken:
            if len(taken) != n_reported:  # Also in the log of a farm, which looks stuck else.
                n_reported = len(taken)
                screen.write_line(
                    f"Waiting for takes on which other processes work: {n_reported}."
                )
            check_output_folder(taken[0].arguments.output_folder)
            sleep(RENEWAL_INTERVAL_S)
        remaining = taken


def _record_crash(crashed: FinishedTask, batch: str) -> FinishedTask:
    """Record a crash; the claim of a lost worker is that of this batch, and may hold still.

    A process that was killed holds its claim until the system has removed it, and one that the
    cluster only believes dead until it ends.
    """
    task = crashed.task
    return record_end(crashed._replace(task=task._replace(batch=batch)))._replace(task=task)


def _groups(
    tasks: Sequence[Task], crashes: Counter[tuple[Any, ...]], max_crashes: int
) -> list[list[Task]]:
    """Return the tasks that run together, and those that run alone for the last time."""
    alone = [task for task in tasks if crashes[task.key] == max_crashes - 1]
    together = [task for task in tasks if task not in alone]
    return [*([together] if together else []), *([task] for task in alone)]


def _run_group(
    verb: Verb, tasks: Sequence[Task], shared: Any, workers: Workers
) -> Iterator[FinishedTask]:
    with workers.open(len(tasks)) as executor:
        pending = {}
        for task in tasks:
            sent = _for_other_machines(task, workers.batch) if workers.batch else task
            pending[_submit(executor, verb, sent, shared)] = task
        try:
            for done in as_completed(pending):
                task = pending[done]
                try:
                    yield done.result()._replace(task=task)
                except BrokenExecutor:
                    sentence = (
                        f"{task.subject}: its process crashed, perhaps for lack of memory."
                        f" {workers.advice}"
                    )
                    yield FinishedTask(task, None, sentence, crashed=True)
        finally:
            executor.shutdown(cancel_futures=True)


def _submit(executor: Executor, verb: Verb, task: Task, shared: Any) -> "Future[FinishedTask]":
    try:
        return executor.submit(partial(attempt_task, verb, task, unwatched), shared)
    except BrokenExecutor as error:  # A process crashed while other tasks were submitted.
        failed: Future[FinishedTask] = Future()
        failed.set_exception(error)
        return failed


def _for_other_machines(task: Task, batch: str) -> Task:
    """Return a task with absolute paths: workers have other working folders."""
    arguments = {name: _absolute_paths(value) for name, value in vars(task.arguments).items()}
    return task._replace(
        sources=tuple(map(_absolute_paths, task.sources)),
        target=_absolute_paths(task.target),
        arguments=argparse.Namespace(**arguments),
        batch=batch,
    )


def _absolute_paths(value: Any) -> Any:
    """Return a path, or a list of them, as absolute; anything else as it is."""
    if isinstance(value, list):
        return [_absolute_paths(each) for each in value]
    return value.absolute() if isinstance(value, Path) else value
