"""Parse the command line, work on every file, say what came of it."""

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
from .batch import RECORD, Finished, Made, work_on
from .options import SentenceParser
from .report import PAGE, Entry, draw_task, has_picture, write_report
from .screen import Screen, escape_odd_names, printable
from .tasks import tasks_of
from .verb import Makes, Outcome, Task, Verb

FILES = {
    Makes.WORDS: "Recordings to read, or folders of them",
    Makes.FILES: "The recording and the file to write; with --output-folder any recordings, and"
    " folders of them",
    Makes.ONE_FILE: "Recordings to read, or folders of them",
    Makes.MANY_FILES: "Recordings to read, or folders of them",
    Makes.LIBRARY: "The library, and then recordings to put into it, or folders of them",
    Makes.MATCHES: "The recording to which there may be something like, and then the library",
}
FAILED = 2
INTERRUPTED = 130


def run(verbs: Mapping[str, Verb], words: Sequence[str], prog: str) -> int:
    """Do what the command line says.

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
        sentence on stderr; a slip in the command line itself raises SystemExit with status 2.
    """
    arguments = _parser(verbs, prog).parse_args(words)
    escape_odd_names(sys.stdout)
    screen = Screen()
    try:
        return _work(verbs[arguments.verb], arguments, screen)
    except MocapAssistError as error:
        screen.say(str(error))
        return FAILED
    except BrokenPipeError:  # Whoever read our output, such as `head`, has seen enough.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED
    except OSError as error:
        screen.say(f"{error.filename or 'The output'}: {reason_of(error)}.")
        return FAILED
    except KeyboardInterrupt:
        screen.say("Interrupted. Files that were finished are kept.")
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


def _add_common_options(parser: argparse.ArgumentParser, makes: Makes) -> None:
    parser.add_argument("files", nargs="+", type=Path, metavar="FILE", help=FILES[makes])
    if makes is Makes.FILES:
        parser.add_argument(
            "--output-folder", type=Path, metavar="DIR",
            help="Write there, under the names of the inputs. A second run goes on where the"
            " first stopped: it leaves alone what was made from the same file with the same"
            f" options, as DIR/{RECORD} says",
        )  # fmt: skip
        parser.add_argument(
            "--again", action="store_true", help="Redo also what is there already"
        )
        parser.add_argument(
            "--report", action="store_true",
            help=f"Write DIR/{PAGE} and report.json about the whole batch, with pictures",
        )  # fmt: skip
    if makes not in {Makes.ONE_FILE, Makes.MANY_FILES, Makes.MATCHES}:
        parser.add_argument(
            "--jobs", type=int, default=1, metavar="N",
            help="How many files to work on at a time [default 1]",
        )  # fmt: skip
    add_threads_option(parser)
    parser.add_argument(
        "--json", action="store_true",
        help="Print figures for programs: one line of JSON for each file",
    )  # fmt: skip


def _work(verb: Verb, arguments: argparse.Namespace, screen: Screen) -> int:
    """Work on all files and report each; return the exit status."""
    n_jobs = getattr(arguments, "jobs", 1)
    if n_jobs < 1:
        raise InvalidSettingError(f"jobs is {n_jobs}; it must be at least 1.")
    folder: Path | None = getattr(arguments, "output_folder", None)
    reporting = getattr(arguments, "report", False)
    if folder is None and reporting:
        raise InvalidSettingError(
            "A report needs a folder: say which with --output-folder DIR."
        )
    tasks = tasks_of(verb, arguments)
    made = None if folder is None else Made(folder)
    entries = {task.sources: Entry(task, None) for task in tasks}
    partly = False
    try:
        for finished in _worked(verb, tasks, made, n_jobs, screen):
            figures = finished.outcome.figures if finished.outcome else None
            entry = Entry(finished.task, figures, finished.failure)
            entries[finished.task.sources] = entry
            partly |= _report(finished, len(tasks) > 1, screen)
    finally:
        if folder is not None and reporting:
            for fault in write_report(folder, arguments.verb, list(entries.values())):
                screen.say(fault)
                partly = True
    return FAILED if partly or any(entry.failure for entry in entries.values()) else 0


def _worked(
    verb: Verb, tasks: Sequence[Task], made: Made | None, n_jobs: int, screen: Screen
) -> Iterator[Finished]:
    """Yield what is there already, then each task as it is finished, and note it."""
    arguments = tasks[0].arguments
    if made is not None:
        made.clear_up(tasks)
    there = [] if made is None or arguments.again else [t for t in tasks if made.has(t)]
    for task in there:
        draw = arguments.report and not has_picture(task)
        failures = tuple(filter(None, [draw_task(task)])) if draw else ()
        figures = {} if made is None else made.figures(task)
        figures = {**figures, "already_made": True}
        yield Finished(task, Outcome("Already made.", figures, failures))
    refused = [task for task in tasks if task.refusal]
    for task in refused:
        screen.say(task.refusal)
        yield Finished(task, None, task.refusal)
    tasks = [task for task in tasks if task not in [*there, *refused]]
    prepared = verb.prepare(arguments, screen.progress) if tasks else None
    for finished in work_on(verb, tasks, prepared, n_jobs, screen):
        screen.clear()
        if finished.outcome is None:
            screen.say(finished.failure)
        elif made is not None:
            made.add(finished.task, finished.outcome.figures)
        yield finished


def _report(finished: Finished, one_of_many: bool, screen: Screen) -> bool:
    """Print what came of a task on stdout: a line of JSON, or text.

    Returns
    -------
    bool
        Whether a part of it failed, which is told on stderr.
    """
    task, outcome = finished.task, finished.outcome
    arguments = task.arguments
    failures = outcome.failures if outcome is not None else ()
    if arguments.json:
        figures = {"error": finished.failure} if outcome is None else outcome.figures
        names: dict[str, Any] = {"input": str(task.source)}
        if len(task.sources) > 1:
            names = {"inputs": [str(source) for source in task.sources]}
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
        screen.say(sentence)
    return bool(failures)
