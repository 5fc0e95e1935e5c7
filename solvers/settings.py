"""Define solver settings once: default value, range, unit and help text.

From the same description come Blender's properties with their tooltips, the command-line
flags and the table in the documentation.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, fields
from enum import Enum
from math import inf
from typing import Any, Self

from .errors import InvalidSettingError

__all__ = ["Choice", "Settings"]
SMALL_WORDS = {"a", "an", "and", "as", "at", "by", "for", "from", "in", "of", "on", "or", "the",
               "to", "with"}  # fmt: skip


@dataclass(frozen=True)
class Described:
    """Metadata of a setting in addition to its name and default value."""

    help: str
    unit: str = ""
    minimum: float = -inf
    maximum: float = inf
    advanced: bool = False
    """Folded away in the user interface."""
    research: bool = False
    """For comparisons and experiments: the user interface shows it only on request."""
    label: str = ""
    """Label in the user interface; by default made from the name."""
    former: str = ""
    """Name in older versions; still an option, and read from their files."""


class Choice(Enum):
    """Base of the enums of settings: each member is its stored value, then its help.

    A member may have a label of its own as third item, as in
    `TAKE = "this take", "Learn the motion from this take alone", "From This Take"`. Its `value`
    is the first item; files and the command line know it by that.
    """

    help: str
    """Effect of the choice, for the tooltip."""
    label: str
    """Name in the user interface."""

    def __new__(cls, value: str, help: str, label: str = "") -> Self:
        """Give a member its value, and to the value its help and label."""
        member = object.__new__(cls)
        member._value_ = value
        member.help = help
        member.label = label or in_title_case(value)
        return member


def setting(default: Any, help: str, **limits: Any) -> Any:
    """Return a dataclass field for a float, int, bool, str or `enum.Enum` setting.

    `limits` are the further attributes of `Described`. The help says what *more* does.
    """
    return field(default=default, metadata={"described": Described(help, **limits)})


def former_names(settings_class: type["Settings"]) -> dict[str, str]:
    """Return the present names of settings that older versions stored under other names."""
    return {
        item.metadata["described"].former: item.name
        for item in fields(settings_class)
        if item.metadata["described"].former
    }


def research_names(settings_class: type["Settings"]) -> tuple[str, ...]:
    """Return the names of the settings that are shown only on request."""
    return tuple(
        item.name for item in fields(settings_class) if item.metadata["described"].research
    )


def with_present_names(
    settings_class: type["Settings"], stored: Mapping[str, Any]
) -> dict[str, Any]:
    """Return values that any version stored, by the present names of their settings."""
    present = former_names(settings_class)
    return {present.get(name, name): value for name, value in dict(stored).items()}


def label_of(item: Any) -> str:
    """Return the label of a field of a `Settings` class."""
    described: Described = item.metadata["described"]
    return described.label or in_title_case(item.name.replace("_", " "))


def in_title_case(words: str) -> str:
    """Return a text in Blender's title case: "Learn from", "Frame Range"."""
    first, *others = words.split(" ")
    return " ".join([
        first[:1].upper() + first[1:],
        *(word if word in SMALL_WORDS else word[:1].upper() + word[1:] for word in others),
    ])


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Base of every settings class; values are validated on construction."""

    def __post_init__(self) -> None:
        wrong = [sentence for item in fields(self) if (sentence := self._fault(item))]
        if wrong:
            raise InvalidSettingError(" ".join(wrong))

    @classmethod
    def values_of(cls, stored: Mapping[str, Any]) -> dict[str, Any]:
        """Return those stored values that are settings of this class, choices as members."""
        kinds: dict[str, Any] = {item.name: type(item.default) for item in fields(cls)}
        return {name: kinds[name](value) for name, value in stored.items() if name in kinds}

    def _fault(self, item: Any) -> str:
        value, described = getattr(self, item.name), item.metadata["described"]
        kind = type(item.default)
        if issubclass(kind, (Enum, str)):
            return "" if isinstance(value, kind) else _not_a(item.name, value, kind)
        if isinstance(value, (Enum, str)) or value is None:
            return _not_a(item.name, value, kind)
        if described.minimum <= value <= described.maximum:
            return ""
        unit = f" {described.unit}" if described.unit else ""
        return (
            f"{item.name} is {value:g}{unit}; it must lie between"
            f" {described.minimum:g} and {described.maximum:g}."
        )


def _not_a(name: str, value: object, kind: type) -> str:
    allowed = [str(one.value) for one in kind] if issubclass(kind, Enum) else [kind.__name__]
    return f"{name} is {value!r}; it must be one of: {', '.join(allowed)}."
