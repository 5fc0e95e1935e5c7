"""Process and record one file of many, so that a batch resumes after a stop."""

import json
from collections.abc import Callable, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from time import monotonic
from typing import Any, NamedTuple

from ...errors import InvalidFileError
from ...faults import Failure, attempt
from ...files import is_missing, make_folder
from ...pictures import StickFigureSettings, draw_stick_figures
from ...progress import Progress, Remark, collect_remarks, unwatched
from ...recordings import is_depth_recording, read_motion_or_tracks
from ..arguments import Outcome, Task, Verb, read
from ..sharing import (
    Record,
    Records,
    claimed,
    fingerprint,
    hook_remark,
    is_of_another_build,
    run_hook,
)
from .files_of_people import n_people_of, path_of_person
from .report import Entry, output_of, picture_file, picture_of, remove_picture, write_report
from .screen import Screen

SKIPPED = "skipped"
"""Figure of a take that another process has."""


class FinishedTask(NamedTuple):
    """A finished task: its outcome or failure."""

    task: Task
    outcome: Outcome | None
    """None if the task failed."""
    failure: str = ""
    crashed: bool = False
    """Whether the process of the task crashed."""
    is_held: bool = False
    """Whether the claim of a lost worker of this batch keeps the task from being done yet."""

    @property
    def is_taken(self) -> bool:
        """Whether it was skipped because another process has it."""
        return self.outcome is not None and SKIPPED in self.outcome.figures


def attempt_task(verb: Verb, task: Task, progress: Progress, prepared: Any) -> FinishedTask:
    """Do the work on a task, in whichever process, and record it; see `share`."""
    return work_if_unclaimed(task, partial(_work, verb, task, prepared, progress))


def _work(verb: Verb, task: Task, prepared: Any, progress: Progress) -> FinishedTask:
    outcome = attempt(task.subject, _perform, verb, task, prepared, progress)
    if isinstance(outcome, Failure):
        return FinishedTask(task, None, outcome.sentence)
    return FinishedTask(task, outcome)


def _perform(verb: Verb, task: Task, prepared: Any, progress: Progress) -> Outcome:
    """Perform a task; figures that cannot be written as JSON count as its failure."""
    remarks: list[Remark] = []
    outcome = verb.work().perform(task, prepared, collect_remarks(progress, remarks))
    added = [f"{remark.rstrip('.')}." for remark in remarks if remark not in outcome.text]
    text = "\n".join([outcome.text, *added])
    outcome = replace(outcome, text=text, remarks=(*outcome.remarks, *added))
    json.dumps(outcome.figures, allow_nan=False)
    if getattr(task.arguments, "output_folder", None) is not None:
        remove_picture(task)
        if task.arguments.report and (fault := draw_task(task)):
            return replace(outcome, failures=(*outcome.failures, fault))
    return outcome


def draw_task(task: Task) -> str:
    """Draw input and result over each other, as stick figures.

    If drawing fails there is no picture: a report must not fail after the work is done.

    Returns
    -------
    str
        The message of a bug in Mocap Assist; empty if there was none.
    """
    outcome = attempt(task.subject, _draw, task)
    if not isinstance(outcome, Failure):
        return ""
    remove_picture(task)
    return outcome.sentence if outcome.is_fault else ""


def _draw(task: Task) -> None:
    assert task.target is not None
    picture = picture_file(task)
    result = read_motion_or_tracks(task.target)
    motions = {"result": result}
    if not is_depth_recording(task.source):
        given = read(task.source, task.arguments, unwatched)
        motions = {"given": given, **motions} if given.n_frames == result.n_frames else motions
    make_folder(picture.parent, task.arguments.output_folder)
    draw_stick_figures(motions, StickFigureSettings(n_figures=9, height=150)).save(picture)


def work_if_unclaimed(task: Task, work: Callable[[], FinishedTask]) -> FinishedTask:
    """Do the work on a task unless another process does or has done it; record the result.

    A task without an output folder is not shared.
    """
    if getattr(task.arguments, "output_folder", None) is None:
        return work()
    finished = attempt(task.subject, _share, task, work)
    if isinstance(finished, Failure):
        return FinishedTask(task, None, finished.sentence)
    return finished


def record_end(finished: FinishedTask) -> FinishedTask:
    """Record a task that failed before or after its work, such as a crashed one.

    While another process holds its claim there is no record, and the other's end is returned.
    """
    return work_if_unclaimed(finished.task, lambda: finished)


def _share(task: Task, work: Callable[[], FinishedTask]) -> FinishedTask:
    assert task.target is not None
    records, output = Records(task.arguments.output_folder), output_of(task)
    with claimed(records.claim(output), task.batch) as claim:
        if claim.is_own_batch:
            return FinishedTask(task, None, is_held=True)
        if claim.holder:
            text = f"another process on {claim.holder} is working on it"
            return FinishedTask(task, Outcome(f"Skipped: {text}.", {SKIPPED: text}))
        if claim.taken_over:
            records.clear_up(output, task.target, picture_file(task))
        record = made_record(task)
        if record is not None and record.identifier != task.replaced:
            finished = FinishedTask(task, already_made(record))
        else:
            began = monotonic()
            finished = work()
            record = _record(finished, monotonic() - began)
            records.write(record)
        return _call_hook(finished, record, records)


def _record(finished: FinishedTask, duration_s: float) -> Record:
    task, outcome = finished.task, finished.outcome
    return Record(
        verb=verb_name(task),
        inputs=[str(source) for source in task.sources],
        output=output_of(task),
        fingerprint=fingerprint(task.source, task.arguments),
        figures=outcome.figures if outcome is not None else {},
        error=finished.failure,
        remarks=[*outcome.remarks] if outcome is not None else [],
        duration_s=round(duration_s, 3),
    )


def _call_hook(finished: FinishedTask, record: Record, records: Records) -> FinishedTask:
    """Run the command of `--after`, unless the take failed or the command has run."""
    task, outcome = finished.task, finished.outcome
    if outcome is None or task.target is None or has_called_hook(task, record):
        return finished
    files = {
        "input": task.source,
        "output": task.target,
        "record": records.file(record.output),
    }
    after = run_hook(task.arguments.after, files)
    former, sentence = hook_remark(record.after), hook_remark(after)
    remarks = [remark for remark in record.remarks if remark != former]
    records.write(replace(record, after=after, remarks=[*remarks, *filter(None, [sentence])]))
    if not sentence:
        return finished
    failure = f"{task.subject}: {sentence}"
    return FinishedTask(task, replace(outcome, failures=(*outcome.failures, failure)))


def has_called_hook(task: Task, record: Record) -> bool:
    """Return whether nothing is left to do by the command of `--after`."""
    command = task.arguments.after
    return command is None or (
        record.after.get("command") == command and record.after.get("status") == 0
    )


def already_made(record: Record) -> Outcome:
    """Return the outcome of a task whose output is up to date."""
    return Outcome("Already made.", {**record.figures, "already_made": True})


def made_record(task: Task) -> Record | None:
    """Return the record of an output that exists and is up to date."""
    if task.refusal or task.target is None or is_missing(task.target):
        return None
    record = current_record(task)
    if record is None or record.error or _lacks_person(task.target, record):
        return None
    return record


def _lacks_person(target: Path, record: Record) -> bool:
    """Return whether a file of another person of the take is missing."""
    numbers = range(2, n_people_of(record) + 1)
    return any(is_missing(path_of_person(target, number)) for number in numbers)


def current_record(task: Task) -> Record | None:
    """Return the record of a task with the same input and options, also of one that failed."""
    record = Records(task.arguments.output_folder).read(output_of(task))
    same = record is not None and record.fingerprint == fingerprint(task.source, task.arguments)
    return record if same else None


def note_other_builds(tasks: Sequence[Task], screen: Screen) -> None:
    """Say how many existing results are made again only as Mocap Assist has changed."""
    n_other = sum(_is_of_another_build(task) for task in tasks)
    if n_other:
        screen.write_line(
            f"Results of another version of Mocap Assist that are made again: {n_other}."
        )


def _is_of_another_build(task: Task) -> bool:
    folder = getattr(task.arguments, "output_folder", None)
    if folder is None or task.refusal or task.target is None or is_missing(task.target):
        return False
    record = Records(folder).read(output_of(task))
    now = fingerprint(task.source, task.arguments)
    return record is not None and is_of_another_build(record.fingerprint, now)


def verb_name(task: Task) -> str:
    """Return the verb as reports name it; of `each`, with its options."""
    return " ".join(getattr(task.arguments, "words", ())) or str(task.arguments.verb)


def task_entries(tasks: Sequence[Task]) -> list[Entry]:
    """Return the report's entries for the tasks of a run, from all machines."""
    return [_task_entry(task, current_record(task)) for task in tasks]


def _task_entry(task: Task, record: Record | None) -> Entry:
    entry = Entry(str(task.source), str(task.target), picture_of(output_of(task)))
    return entry if record is None else entry.with_record(record)


def report_folder(task: Task, prepared: None, progress: Progress) -> Outcome:
    """Write the reports on an output folder from the records of all machines.

    Raises
    ------
    InvalidFileError
        The folder has no records.
    """
    folder = task.source
    records = Records(folder).all()
    if not records:
        raise InvalidFileError(f"There are no records of a batch in the folder {folder}.")
    verb = ", ".join(dict.fromkeys(record.verb for record in records))
    faults = write_report(folder, verb, lambda: _folder_entries(folder))
    records = Records(folder).all()
    entries = [_folder_entry(folder, record) for record in records]
    hooks = tuple(
        f"{_input_of(record)}: {sentence}"
        for record in records
        if (sentence := hook_remark(record.after))
    )
    lines = [f"{'failed' if each.failure else 'done':7} {each.target}" for each in entries]
    n_failed = sum(bool(each.failure) for each in entries)
    text = "\n".join([*lines, f"{len(entries) - n_failed} done, {n_failed} failed"])
    failures = tuple(each.failure for each in entries if each.failure)
    figures = {"done": len(entries) - n_failed, "failed": n_failed}
    return Outcome(text, figures, (*failures, *hooks, *faults))


def _folder_entries(folder: Path) -> list[Entry]:
    return [_folder_entry(folder, record) for record in Records(folder).all()]


def _folder_entry(folder: Path, record: Record) -> Entry:
    target, picture = str(folder / record.output), picture_of(record.output)
    return Entry(_input_of(record), target, picture).with_record(record)


def _input_of(record: Record) -> str:
    """Return the input of an output; of an old record, which has none, the output."""
    return record.inputs[0] if record.inputs else record.output
