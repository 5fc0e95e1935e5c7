"""The job types of Flamenco: their scripts, and their settings, made of a verb's options."""

import argparse
import shlex
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields
from pathlib import Path

from ...settings import Settings

JOB_TYPE = "mocap-assist"
"""Job type for all verbs. A Flamenco Manager names a job type after its script."""
OF_ONE_VERB = ("fix", "denoise", "reconstruct")
"""Verbs with a job type of their own: those with settings that takes of one batch share."""
SCRIPTS = Path(__file__).with_name("scripts")
"""Folder of the scripts, which are for the folder of the same name next to the Manager."""
NO_TEXT = ""
"""Text of a setting that is the command's default."""


def job_type_of(verb: str) -> str:
    """Return the name of the job type of a verb."""
    return f"{JOB_TYPE}-{verb}" if verb in OF_ONE_VERB else JOB_TYPE


def script_of(job_type: str) -> Path:
    """Return the script of a job type."""
    return SCRIPTS / f"{job_type.replace('-', '_')}.js"


def options_of(add_options: Callable[[argparse.ArgumentParser], None]) -> list[argparse.Action]:
    """Return the options that a function adds to a parser, without hidden ones."""
    parser = argparse.ArgumentParser(add_help=False)
    add_options(parser)
    return [
        option
        for option in parser._actions
        if option.option_strings and option.help is not argparse.SUPPRESS
    ]


def kind_of(option: argparse.Action) -> list[str]:
    """Return the kind of an option and its words: of a switch, those for yes and no."""
    names = [name for name in option.option_strings if name.startswith("--")]
    if option.nargs == 0:
        return ["switch", names[0], names[-1] if len(names) > 1 else ""]
    return ["many" if option.nargs else "one", names[0]]


def texts_of(
    options: Sequence[argparse.Action],
    add_options: Callable[[argparse.ArgumentParser], None],
    words: Sequence[str],
) -> dict[str, str]:
    """Return the text of each option as a command line gives it, and empty texts for others.

    Parameters
    ----------
    options : sequence of argparse.Action
    add_options : callable
        Adds these options to a parser, and all others that the command line may have.
    words : sequence of str
        A command line that the parser accepts.
    """
    parser = argparse.ArgumentParser(add_help=False)
    add_options(parser)
    for option in parser._actions:  # Numbers and angles stay as they were written.
        option.type = _absolute_path if option.type is Path else None
        option.default = argparse.SUPPRESS
    given = vars(parser.parse_args(words))
    return {option.dest: _text(given.get(option.dest)) for option in options}


def texts_of_settings(
    add_options: Callable[[argparse.ArgumentParser], None], settings: Settings
) -> dict[str, str]:
    """Return the text of each option: the value of its setting, or an empty one."""
    texts = {option.dest: NO_TEXT for option in options_of(add_options)}
    return texts | {item.name: _text(getattr(settings, item.name)) for item in fields(settings)}


def words_of(options: Sequence[argparse.Action], texts: Mapping[str, str]) -> list[str]:
    """Return the words of a command line with these texts, as the scripts make them."""
    words: list[str] = []
    for option in options:
        kind, name, *opposite = kind_of(option)
        text = texts[option.dest]
        if text == NO_TEXT:
            continue
        if kind == "switch":
            words += [name] if text == "yes" else opposite
        elif kind == "many":
            words += [name, *shlex.split(text)]
        else:
            words.append(f"{name}={text}")
    return words


def _absolute_path(path: str) -> str:
    """Return an absolute path: workers have other working folders."""
    return str(Path(path).absolute())


def _text(value: object) -> str:
    if value is None:
        return NO_TEXT
    if isinstance(value, bool):
        return "yes" if value else "no"
    return shlex.join(value) if isinstance(value, list) else str(value)
