"""Build jobs for a Flamenco Manager from command lines."""

import argparse
from collections.abc import Callable, Mapping
from typing import Any

from ...errors import InvalidSettingError
from ..sharing import read_manifest
from .flamenco_jobs import COMMAND, FlamencoJob, FlamencoSettings
from .job_types import JOB_TYPE, job_type_of, options_of, texts_of, words_of

PASSED_ON = ("again", "after", "jobs", "threads")
"""Options of every batch that each task has, too."""
NOT_PASSED_ON = {
    "shard": "Flamenco gives each task its part of the takes. Leave out --shard.",
    "cluster": "The workers of Flamenco process the takes. Leave out --cluster.",
}
AddOptions = Callable[[argparse.ArgumentParser], None]


def add_flamenco_options(parser: argparse._ActionsContainer) -> None:
    """Add the options to submit a batch, but for those of `FlamencoSettings`."""
    parser.add_argument(
        "--flamenco", metavar="ADDRESS",
        help="Submit the batch to a Flamenco Manager, such as http://farm:8080, instead of"
        " processing it here; needs --manifest and --output-folder",
    )  # fmt: skip
    parser.add_argument(
        "--flamenco-command", metavar="COMMAND", default=argparse.SUPPRESS,
        help=f"Command of Mocap Assist on the workers of Flamenco [default {COMMAND}]",
    )  # fmt: skip


def job_of_batch(
    arguments: argparse.Namespace,
    settings: FlamencoSettings,
    words: list[str],
    add_common: AddOptions,
    add_own: AddOptions,
) -> FlamencoJob:
    """Return the job of a command line.

    Parameters
    ----------
    arguments : Namespace
        The parsed command line.
    settings : FlamencoSettings
    words : list of str
        The command line, without the verb.
    add_common, add_own : callable
        Add the options of every batch, and those of the verb, to a parser.

    Raises
    ------
    InvalidSettingError
        An option is missing, or excludes Flamenco.
    InvalidFileError
        The manifest is invalid.
    """
    _check_options(vars(arguments))
    read_manifest(arguments.manifest)
    own = options_of(add_own)
    common = [each for each in options_of(add_common) if each.dest in PASSED_ON]

    def add_all(parser: argparse.ArgumentParser) -> None:
        add_common(parser)
        add_own(parser)

    texts = texts_of([*own, *common], add_all, words)
    of_verb = {each.dest: texts[each.dest] for each in own}
    has_own_type = job_type_of(arguments.verb) != JOB_TYPE
    return FlamencoJob(
        verb=arguments.verb,
        title=arguments.manifest.stem,
        manifest=arguments.manifest.absolute(),
        output_folder=arguments.output_folder.absolute(),
        texts=of_verb if has_own_type else {},
        options=tuple(words_of([*([] if has_own_type else own), *common], texts)),
        command=getattr(arguments, "flamenco_command", COMMAND),
        settings=settings,
    )


def _check_options(given: Mapping[str, Any]) -> None:
    excluded = [reason for name, reason in NOT_PASSED_ON.items() if given.get(name) is not None]
    if excluded:
        raise InvalidSettingError(excluded[0])
    if given.get("output_folder") is None:
        raise InvalidSettingError(
            "--flamenco needs a folder: name it with --output-folder DIR."
        )
    if given.get("files") or given.get("manifest") is None:
        raise InvalidSettingError(
            "Workers of Flamenco read the takes from a list on shared storage: name it with"
            " --manifest FILE, and no takes on the command line."
        )
