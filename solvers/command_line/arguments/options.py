"""Generate command-line options from settings classes, so that each setting is defined once."""

import argparse
from collections.abc import Callable
from dataclasses import Field, fields
from enum import Enum
from math import degrees, isfinite, radians
from pathlib import Path
from typing import Any, NoReturn, TypeVar

from ...errors import InvalidSettingError
from ...presets import PRESETS, find_preset
from ...settings import Described, Settings, former_names
from ..sharing import parse_hook, parse_shard

SettingsClass = TypeVar("SettingsClass", bound=Settings)
MAX_LISTED_LETTERS = 32
"""Number of letters of the choices that a usage line lists; help lists longer ones."""


class SentenceParser(argparse.ArgumentParser):
    """A parser that reports an error in one sentence and exits with status 2."""

    def error(self, message: str) -> NoReturn:
        """Print the sentence on stderr, without the usage."""
        sentence = message[:1].upper() + message[1:].rstrip(".")
        self.exit(2, f"{sentence}. See: {self.prog} --help\n")


def add_sharing_options(parser: argparse.ArgumentParser) -> None:
    """Add the options for batches of many machines and many takes."""
    parser.add_argument(
        "--manifest", type=Path, metavar="FILE",
        help='Read the inputs from FILE: a path, or {"input": PATH, "output": PATH}, per line;'
        " *.json has a list of them",
    )  # fmt: skip
    parser.add_argument(
        "--shard", type=parse_shard, metavar="I/N",
        help="Process the I-th of N parts of the takes, which is the same on all machines",
    )  # fmt: skip
    parser.add_argument(
        "--after", type=parse_hook, metavar="COMMAND",
        help="Run COMMAND after each take, without a shell; {input}, {output} and {record} are"
        " replaced by the take's files",
    )  # fmt: skip
    parser.add_argument(
        "--wait", action="store_true", default=None,
        help="Wait for takes that other processes have, and make those of processes that ended;"
        " otherwise they are skipped",
    )  # fmt: skip


def add_cluster_option(parser: argparse._ActionsContainer) -> None:
    """Add the option for the workers of a cluster."""
    parser.add_argument(
        "--cluster", metavar="ADDRESS",
        help="Process the files on the workers of a Dask cluster, such as tcp://farm01:8786",
    )  # fmt: skip


def arguments_from(parser: argparse._ActionsContainer, *classes: type[Settings]) -> None:
    """Add an option for each setting: `foot_speed` becomes `--foot-speed`.

    Angles are given in degrees. Settings of the same name in two classes become one option.

    Parameters
    ----------
    parser : ArgumentParser, or a group of its arguments
    *classes : subclasses of Settings
    """
    described = {item.name: item for each in classes for item in reversed(fields(each))}
    for name, item in sorted(described.items()):
        parser.add_argument(
            _option(name), **_kind(item), help=_help(item), default=argparse.SUPPRESS
        )
    former = {old: new for each in classes for old, new in former_names(each).items()}
    for old, new in sorted(former.items()):
        hidden = _kind(described[new]) | {"dest": new, "help": argparse.SUPPRESS}
        parser.add_argument(_option(old), **hidden, default=argparse.SUPPRESS)


def add_preset_option(parser: argparse.ArgumentParser, verb: str) -> None:
    """Add the option for named values of a verb's settings."""
    names = ", ".join(name.lower().replace(" ", "-") for name in PRESETS[verb])

    def known_preset(name: str) -> str:
        try:
            found = find_preset(verb, name)
        except InvalidSettingError as error:
            raise argparse.ArgumentTypeError(str(error)) from error
        return next(known for known, preset in PRESETS[verb].items() if preset is found)

    parser.add_argument(
        "--preset", type=known_preset, metavar="NAME", default=argparse.SUPPRESS,
        help=f"Named values of some settings; other options replace them [{names}]",
    )  # fmt: skip


def _option(name: str) -> str:
    return f"--{name.replace('_', '-')}"


def settings_from_arguments(
    arguments: argparse.Namespace, settings_class: type[SettingsClass]
) -> SettingsClass:
    """Return settings from the command line, with defaults for missing options.

    Options replace the values of a preset.

    Raises
    ------
    InvalidSettingError
        A value is out of its range.
    """
    given: dict[str, Any] = {}
    if hasattr(arguments, "preset"):
        values = find_preset(arguments.verb, arguments.preset).values
        given = settings_class.values_of(values)
    names = [item.name for item in fields(settings_class)]
    given |= {name: getattr(arguments, name) for name in names if hasattr(arguments, name)}
    return settings_class(**given)


def _kind(item: "Field[Any]") -> dict[str, Any]:
    """Return the argparse arguments for the type of a setting."""
    kind: type = type(item.default)
    if kind is bool:
        return {"action": argparse.BooleanOptionalAction}
    if issubclass(kind, Enum):
        choices = "|".join(str(one.value) for one in kind)
        metavar = f"{{{choices}}}" if len(choices) <= MAX_LISTED_LETTERS else item.name.upper()
        return {"type": _choice_of(kind), "metavar": metavar}
    if item.metadata["described"].unit == "rad":
        return {"type": _angle, "metavar": "DEGREES"}
    return {"type": kind, "metavar": {int: "N", float: "X", str: "TEXT"}[kind]}


def _choice_of(kind: type[Enum]) -> Callable[[str], Enum]:
    choices = {str(one.value): one for one in kind}

    def choice(word: str) -> Enum:
        if word not in choices:
            raise argparse.ArgumentTypeError(f"{word!r} is not one of {', '.join(choices)}")
        return choices[word]

    return choice


def _angle(word: str) -> float:
    return radians(float(word))


_angle.__name__ = "angle"


def _help(item: "Field[Any]") -> str:
    """Return the setting's help with its unit, range and default value."""
    described: Described = item.metadata["described"]
    default: Any = item.default
    kind, in_degrees = type(default), described.unit == "rad"

    def shown(value: float) -> str:
        return f"{degrees(value) if in_degrees else value:g}"

    facts = ["degrees" if in_degrees else described.unit] if described.unit else []
    if kind in {int, float}:
        if isfinite(described.minimum) and isfinite(described.maximum):
            facts.append(f"{shown(described.minimum)} to {shown(described.maximum)}")
        facts.append(f"default {shown(default)}")
    elif kind is bool:
        facts.append(f"default {'yes' if default else 'no'}")
    elif issubclass(kind, Enum):
        choices = [str(one.value) for one in kind]
        if len("|".join(choices)) > MAX_LISTED_LETTERS:
            facts.append(", ".join(choices))
        facts.append(f"default {default.value}")
    else:
        facts.append(f"default {default!r}")
    return f"{described.help} [{', '.join(facts)}]".replace("%", "%%")
