"""Every setting and every choice has a help text that fits a tooltip."""

import re
from dataclasses import fields
from enum import Enum
from importlib import import_module
from inspect import get_annotations
from pathlib import Path
from typing import Any

import pytest

from solvers.settings import Choice, Settings, former_names

SOLVERS = Path(__file__).parents[2] / "solvers"
MAX_HELP = 90
"""Characters of a tooltip."""
MIN_CHOICE_HELP = 10
TWO_SENTENCES = re.compile(r"[.!?] [A-Z]")


def settings_classes() -> list[type[Settings]]:
    """Return the settings classes of all modules of solvers."""
    for module in sorted(SOLVERS.rglob("*.py")):
        if module.stem not in {"__init__", "__main__"} and "setting(" in module.read_text():
            import_module(
                ".".join(["solvers", *module.relative_to(SOLVERS).with_suffix("").parts])
            )
    found, waiting = [], [Settings]
    while waiting:
        waiting += (below := waiting.pop().__subclasses__())
        found += [each for each in below if each.__module__.startswith("solvers.")]
    return found


SETTINGS: dict[str, Any] = {
    f"{each.__name__}.{item.name}": item for each in settings_classes() for item in fields(each)
}
ENUMS = {
    type(item.default) for item in SETTINGS.values() if issubclass(type(item.default), Enum)
}


@pytest.mark.parametrize("name", SETTINGS)
def test_help_of_a_setting_fits_a_tooltip(name):
    help = SETTINGS[name].metadata["described"].help

    assert 0 < len(help) <= MAX_HELP
    assert not help.endswith(".")
    assert not TWO_SENTENCES.search(help)


@pytest.mark.parametrize("enum", sorted(ENUMS, key=str))
def test_every_choice_has_a_help_text_and_a_label(enum):
    assert issubclass(enum, Choice)
    for choice in enum:
        assert MIN_CHOICE_HELP <= len(choice.help) <= MAX_HELP, choice
        assert not choice.help.endswith("."), choice
        assert not TWO_SENTENCES.search(choice.help), choice
        assert choice.label, choice
        assert enum(choice.value) is choice


@pytest.mark.parametrize("settings", settings_classes(), ids=lambda each: each.__name__)
def test_no_setting_hides_one_of_its_base(settings):
    own = set(get_annotations(settings))

    assert not own & {item.name for base in settings.__bases__ for item in fields(base)}
    assert not former_names(settings).keys() & {item.name for item in fields(settings)}
