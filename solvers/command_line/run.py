"""Parse the command line, and run its verb."""

import argparse
import os
import sys
from collections.abc import Mapping, Sequence
from functools import partial
from pathlib import Path

from ..errors import MocapAssistError
from ..files import reason_of
from ..processes import add_threads_option
from ..version import version
from .arguments import (
    OutputKind,
    SentenceParser,
    Verb,
    add_cluster_option,
    add_sharing_options,
    arguments_from,
)
from .batches import PAGE, Screen, escape_undecodable_names
from .farm import FlamencoSettings, add_flamenco_options

FILES = {
    OutputKind.WORDS: "Recordings to read, or folders of them",
    OutputKind.FILES: "The recording and the file to write; with --output-folder recordings, or"
    " folders of them",
    OutputKind.ONE_FILE: "Recordings to read, or folders of them",
    OutputKind.MANY_FILES: "Recordings to read, or folders of them",
    OutputKind.REPORT: "Output folders of batches",
    OutputKind.LIBRARY: "The library, and then recordings to add, or folders of them",
    OutputKind.MATCHES: "The recording to search with, and then libraries with one vocabulary,"
    " or folders of them",
}
FAILED_STATUS = 2
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
    arguments = _parser(verbs, words, prog).parse_args(words)
    from .run_verb import run_verb, submit_batch  # slow to import, and help does without them

    verb = verbs[arguments.verb]
    escape_undecodable_names(sys.stdout)
    screen = Screen()
    try:
        if getattr(arguments, "flamenco", None) is not None:
            add_common = partial(_add_common_options, makes=verb.makes)
            return submit_batch(verb, arguments, list(words[1:]), add_common)
        return run_verb(verb, arguments, screen)
    except MocapAssistError as error:
        screen.write_line(str(error))
        return FAILED_STATUS
    except BrokenPipeError:  # The reader of our output, such as `head`, has closed it.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return FAILED_STATUS
    except OSError as error:
        screen.write_line(f"{error.filename or 'The output'}: {reason_of(error)}.")
        return FAILED_STATUS
    except KeyboardInterrupt:
        screen.write_line("Interrupted. Finished files are kept.")
        return INTERRUPTED


def _parser(verbs: Mapping[str, Verb], words: Sequence[str], prog: str) -> SentenceParser:
    """Return a parser that lists all verbs, and has the options of the one in the words."""
    parser = SentenceParser(
        prog=prog,
        description="Clean, solve, track, search, vary and retarget captured motion.",
        epilog=f"For the options of a verb: {prog} VERB --help",
    )
    parser.add_argument("--version", action="version", version=f"Mocap Assist {version()}")
    choices = parser.add_subparsers(dest="verb", metavar="VERB", required=True)
    chosen = next((word for word in words if not word.startswith("-")), None)
    for name, verb in verbs.items():
        described = choices.add_parser(name, help=verb.help, description=verb.help)
        if name == chosen:
            _add_common_options(described, verb.makes)
            verb.work().add_options(described)
    return parser


def _add_common_options(parser: argparse.ArgumentParser, makes: OutputKind) -> None:
    has_manifest = makes is OutputKind.FILES
    parser.add_argument(
        "files", nargs="*" if has_manifest else "+", type=Path,
        metavar="DIR" if makes is OutputKind.REPORT else "FILE",
        help=FILES[makes],
    )  # fmt: skip
    if has_manifest:
        parser.add_argument(
            "--output-folder", type=Path, metavar="DIR",
            help="Folder for the results, named like the inputs. A second run resumes the"
            " first: it skips results made from the same file with the same options. Many"
            " machines may write to one folder at once",
        )  # fmt: skip
        parser.add_argument("--again", action="store_true", help="Redo existing results")
        parser.add_argument(
            "--report", action="store_true",
            help=f"Write DIR/{PAGE} and report.json about the whole batch, with pictures",
        )  # fmt: skip
        add_sharing_options(parser)
    if makes not in {
        OutputKind.ONE_FILE, OutputKind.MANY_FILES, OutputKind.MATCHES, OutputKind.REPORT,
    }:  # fmt: skip
        workers = parser.add_mutually_exclusive_group()
        workers.add_argument(
            "--jobs", type=int, default=1, metavar="N",
            help="Number of files to process in parallel [default 1]",
        )  # fmt: skip
        if has_manifest or makes is OutputKind.LIBRARY:
            add_cluster_option(workers)
    if has_manifest:
        add_flamenco_options(parser)
        arguments_from(parser, FlamencoSettings)
    add_threads_option(parser)
    parser.add_argument(
        "--json", action="store_true",
        help="Print figures for programs: one line of JSON for each file",
    )  # fmt: skip
