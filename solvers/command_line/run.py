"""Parse the command line, work on every file, say what came of it."""

import argparse
import json
import os
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path

from ..errors import InvalidSettingError, MocapAssistError
from .batch import Finished, Made, work_on
from .files import ending_for, refuse_target
from .options import SentenceParser
from .screen import Screen
from .verb import Outcome, Task, Verb

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
        screen.say(f"{error.filename}: {error.strerror}.")
        return FAILED
    except KeyboardInterrupt:
        screen.say("Interrupted. Files that were finished are kept.")
        return INTERRUPTED


def _parser(verbs: Mapping[str, Verb], prog: str) -> SentenceParser:
    parser = SentenceParser(prog=prog, description="Clean up and rebuild captured motion.")
    choices = parser.add_subparsers(dest="verb", metavar="VERB", required=True)
    for name, verb in verbs.items():
        described = choices.add_parser(name, help=verb.help, description=verb.help)
        outcome = "IN OUT, or many IN with --output-folder" if verb.writes else "IN"
        described.add_argument("files", nargs="+", type=Path, help=outcome)
        if verb.writes:
            described.add_argument(
                "--output-folder", type=Path, metavar="DIR",
                help="write there, under the names of the inputs. A second run goes on where"
                " the first stopped: it leaves alone what was made from the same file with the"
                " same options, as DIR/mocap_assist.json says",
            )  # fmt: skip
            described.add_argument(
                "--again", action="store_true", help="redo also what is there already"
            )
        described.add_argument(
            "--jobs", type=int, default=1, metavar="N",
            help="how many files to work on at a time [default 1]",
        )  # fmt: skip
        described.add_argument(
            "--json", action="store_true", help="print one line of JSON for each file"
        )
        verb.add_options(described)
    return parser


def _work(verb: Verb, arguments: argparse.Namespace, screen: Screen) -> int:
    """Work on all files and report each; return the exit status."""
    if arguments.jobs < 1:
        raise InvalidSettingError(f"jobs is {arguments.jobs}; it must be at least 1.")
    pairs = _pairs(arguments) if verb.writes else [(path, None) for path in arguments.files]
    tasks = [Task(source, target, arguments) for source, target in pairs]
    made = Made(arguments.output_folder) if _is_for_a_folder(verb, arguments) else None
    if made is not None and not arguments.again:
        there = [task for task in tasks if made.has(task)]
        for task in there:
            _report(Finished(task, Outcome("Already made.", {"already_made": True})), arguments)
        tasks = [task for task in tasks if task not in there]
    failures = 0
    prepared = verb.prepare(arguments, screen.progress) if tasks else None
    for finished in work_on(verb, tasks, prepared, arguments.jobs, screen):
        screen.clear()
        if finished.outcome is None:
            failures += 1
            screen.say(finished.failure)
        elif made is not None:
            made.add(finished.task)
        _report(finished, arguments)
    return FAILED if failures else 0


def _report(finished: Finished, arguments: argparse.Namespace) -> None:
    """Print what came of a file on stdout: a line of JSON, or text."""
    task, outcome = finished.task, finished.outcome
    if arguments.json:
        figures = {"error": finished.failure} if outcome is None else outcome.figures
        names = {"input": str(task.source)}
        if task.target is not None:
            names["output"] = str(task.target)
        sys.stdout.write(json.dumps({**names, **figures}, allow_nan=False) + "\n")
    elif outcome is not None:
        title = (
            f"{task.source}\n" if len(arguments.files) > 1 + (task.target is not None) else ""
        )
        sys.stdout.write(f"{title}{outcome.text}\n")
    sys.stdout.flush()


def _is_for_a_folder(verb: Verb, arguments: argparse.Namespace) -> bool:
    return verb.writes and arguments.output_folder is not None


def _pairs(arguments: argparse.Namespace) -> list[tuple[Path, Path]]:
    """Return which file is written from which."""
    files: list[Path] = arguments.files
    folder: Path | None = arguments.output_folder
    if folder is None:
        if len(files) != 2:
            raise InvalidSettingError(
                f"{len(files)} files are named: name one to read and one to write, or say"
                " where to put many with --output-folder DIR."
            )
        pairs = [(files[0], files[1])]
    else:
        pairs = [(path, folder / f"{path.stem}{ending_for(path)}") for path in files]
    targets = [target.resolve() for _, target in pairs]
    same = [source for source, target in pairs if source.resolve() in targets]
    if same:
        raise InvalidSettingError(
            f"{same[0]} would be written over. Recordings are never changed: choose another"
            " name or folder."
        )
    if len(set(targets)) < len(targets):
        twice = next(target for target in targets if targets.count(target) > 1)
        raise InvalidSettingError(f"Two inputs would both be written to {twice}. Rename one.")
    if folder is not None and folder.exists() and not folder.is_dir():
        raise InvalidSettingError(f"{folder} is a file; name a folder to write to.")
    if folder is not None:
        folder.mkdir(parents=True, exist_ok=True)
    for _, target in pairs:
        refuse_target(target)
    return pairs
