"""Parse the command line, process every file and report the results."""

import argparse
import json
import os
import sys
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from ..errors import InvalidSettingError, MocapAssistError
from ..faults import Failure, attempt, escaped
from ..files import reason_of
from ..processes import add_threads_option
from .batch import RECORD, FinishedTask, OutputRecord, run_tasks
from .options import SentenceParser
from .report import PAGE, Entry, draw_task, has_picture, write_report
from .screen import Screen, escape_undecodable_names, printable
from .tasks import tasks_of
from .verb import Outcome, OutputKind, Task, Verb

FILES = {
    OutputKind.WORDS: "Recordings to read, or folders of them",
    OutputKind.FILES: "The recording and the file to write; with --output-folder recordings, or"
    " folders of them",
    OutputKind.ONE_FILE: "Recordings to read, or folders of them",
    OutputKind.MANY_FILES: "Recordings to read, or folders of them",
    OutputKind.LIBRARY: "The library, and then recordings to add, or folders of them",
    OutputKind.MATCHES: "The recording to search with, and then the library",
}
FAILED = 2
INTERRUPTED = 130


def run(verbs: Mapping[str, Verb], words: Sequence[str], prog: str) -> int:
    """Run a command line.

    Parameters
    ----------
    verbs : mapping of str to Verb
    words : sequence of str
        The command line without the program's name.
    prog : str
        The program's name, for the help.

    Returns
    -------
    int
        Exit status: 0, or 2 if anything failed, or 130 if interrupted. Each failure is one
        sentence on stderr; a usage error raises SystemExit with status 2.
    """
    arguments = _parser(verbs, prog).parse_args(words)
    escape_undecodable_names(sys.stdout)
    screen = Screen()
    try:
        return _run_verb(verbs[arguments.verb], arguments, screen)
    except MocapAssistError as error:
        screen.write_line(str(error))
        return FAILED
    except BrokenPipeError:  # The reader of our output, such as `head`, has closed it.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED
    except OSError as error:
        screen.write_line(f"{error.filename or 'The output'}: {reason_of(error)}.")
        return FAILED
    except KeyboardInterrupt:
        screen.write_line("Interrupted. Finished files are kept.")
        return INTERRUPTED


def _parser(verbs: Mapping[str, Verb], prog: str) -> SentenceParser:
    parser = SentenceParser(
        prog=prog,
        description="Clean up captured motion: BVH, Acclaim (AMC with ASF), C3D and TRC files.",
        epilog=f"For the options of a verb: {prog} VERB --help",
    )
    choices = parser.add_subparsers(dest="verb", metavar="VERB", required=True)
    for name, verb in verbs.items():
        described = choices.add_parser(name, help=verb.help, description=verb.help)
        _add_common_options(described, verb.makes)
        verb.add_options(described)
    return parser


def _add_common_options(parser: argparse.ArgumentParser, makes: OutputKind) -> None:
    parser.add_argument("files", nargs="+", type=Path, metavar="FILE", help=FILES[makes])
    if makes is OutputKind.FILES:
        parser.add_argument(
            "--output-folder", type=Path, metavar="DIR",
            help="Folder for the results, named like the inputs. A second run resumes the"
            " first: it skips results made from the same file with the same options, as"
            f" recorded in DIR/{RECORD}",
        )  # fmt: skip
        parser.add_argument("--again", action="store_true", help="Redo existing results")
        parser.add_argument(
            "--report", action="store_true",
            help=f"Write DIR/{PAGE} and report.json about the whole batch, with pictures",
        )  # fmt: skip
    if makes not in {OutputKind.ONE_FILE, OutputKind.MANY_FILES, OutputKind.MATCHES}:
        parser.add_argument(
            "--jobs", type=int, default=1, metavar="N",
            help="Number of files to process in parallel [default 1]",
        )  # fmt: skip
    add_threads_option(parser)
    parser.add_argument(
        "--json", action="store_true",
        help="Print figures for programs: one line of JSON for each file",
    )  # fmt: skip


def _run_verb(verb: Verb, arguments: argparse.Namespace, screen: Screen) -> int:
    """Process all files and report each; return the exit status."""
    n_jobs = getattr(arguments, "jobs", 1)
    if n_jobs < 1:
        raise InvalidSettingError(f"jobs is {n_jobs}; it must be at least 1.")
    folder: Path | None = getattr(arguments, "output_folder", None)
    reporting = getattr(arguments, "report", False)
    if folder is None and reporting:
        raise InvalidSettingError("A report needs a folder: name it with --output-folder DIR.")
    tasks = tasks_of(verb, arguments)
    record = None if folder is None else OutputRecord(folder)
    entries = {task.key: Entry(task, None) for task in tasks}
    has_failures = False
    try:
        for finished in _run_tasks(verb, tasks, record, n_jobs, screen):
            figures = finished.outcome.figures if finished.outcome else None
            entry = Entry(finished.task, figures, finished.failure)
            entries[finished.task.key] = entry
            has_failures |= _report(finished, len(tasks) > 1, screen)
    finally:
        if folder is not None and reporting:
            for fault in write_report(folder, arguments.verb, list(entries.values())):
                screen.write_line(fault)
                has_failures = True
    return FAILED if has_failures or any(entry.failure for entry in entries.values()) else 0


def _run_tasks(
    verb: Verb, tasks: Sequence[Task], record: OutputRecord | None, n_jobs: int, screen: Screen
) -> Iterator[FinishedTask]:
    """Yield existing results, then each task when it finishes, and record it."""
    arguments = tasks[0].arguments
    if record is not None:
        record.clear_up(tasks)
    existing = [] if record is None or arguments.again else [t for t in tasks if record.has(t)]
    for task in existing:
        draw = arguments.report and not has_picture(task)
        failures = tuple(filter(None, [draw_task(task)])) if draw else ()
        figures = {} if record is None else record.figures(task)
        figures = {**figures, "already_made": True}
        yield FinishedTask(task, Outcome("Already made.", figures, failures))
    refused = [task for task in tasks if task.refusal]
    for task in refused:
        screen.write_line(task.refusal)
        yield FinishedTask(task, None, task.refusal)
    tasks = [task for task in tasks if task not in [*existing, *refused]]
    prepared = verb.prepare(arguments, screen.progress) if tasks else None
    for finished in run_tasks(verb, tasks, prepared, n_jobs, screen):
        screen.clear()
        if finished.outcome is None:
            screen.write_line(finished.failure)
        elif record is not None:
            record.add(finished.task, finished.outcome.figures)
        yield finished


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
            names["body"] = arguments.body
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
