"""`report`: collect the records of a batch, from all machines, into one report."""

import argparse
import sys
from pathlib import Path

from ...solvers.command_line.arguments import Task
from ...solvers.command_line.batches import Screen, printable, report_folder
from ...solvers.errors import InvalidFileError

HELP = "Write the report on the output folder of each, from the records of all machines."


def add_report_options(parser: argparse.ArgumentParser) -> None:
    """Add the options of `report`."""
    parser.add_argument(
        "folder", type=Path, metavar="DIR", help="the output folder of the batch"
    )


def perform_report(arguments: argparse.Namespace, screen: Screen) -> None:
    """Write the report; raise InvalidFileError if a file failed, or its command of --after."""
    outcome = report_folder(Task((arguments.folder,), None, arguments), None, screen.progress)
    sys.stdout.write(f"{printable(outcome.text)}\n")
    sys.stdout.flush()
    for sentence in outcome.failures[:-1]:
        screen.write_line(sentence)
    if outcome.failures:
        raise InvalidFileError(outcome.failures[-1])
