"""Each tuned number has a unit and a source, in the docstring or comment beside it.

A source is a paper, a standard, a definition, a guard that is named as one, a training script,
or a sweep: "Chosen by hand: x0.5 costs 3 %, x2 costs 1 %" quotes `make sensitivity`, see
docs/benchmarks/sensitivity.md.
"""

import re
from pathlib import Path

import pytest

from tests.benchmarks.sensitivity.constants import (
    FAMILIES,
    ROOT,
    Constant,
    constants_in,
    constants_of,
)

SOURCE = re.compile(
    r"\[[A-Z]\w*\d\d|doi:|eq\. |\bet al\.|by hand|learned by|make sensitivity|sweep"
    r"|by definition|guard|three-sigma|95 % efficiency|rounding|bounds the"
    r"|\b(Winter|Harrington|Handa) (19|20)\d\d",
    re.IGNORECASE,
)


def has_float(constant: Constant) -> bool:
    """Whether it is a float or holds one."""
    return isinstance(constant.value, float) or "." in repr(constant.value)


@pytest.mark.parametrize("family", FAMILIES)
def test_tuned_floats_have_a_unit_and_a_source(family):
    without_source = [
        constant.key
        for constant in constants_of(family)
        if has_float(constant) and not SOURCE.search(constant.text)
    ]
    without_unit = [
        constant.key
        for constant in constants_of(family)
        if has_float(constant) and constant.unit == "-"
    ]
    assert not without_source, "no source beside them"
    assert not without_unit, "no unit in the name or beside them"


def test_every_module_of_a_family_is_measured_by_one():
    listed = {constant.path for family in FAMILIES for constant in constants_of(family)}
    folders = {Path(path).parts[1] for paths in FAMILIES.values() for path in paths}
    for folder in sorted(folders - {"signals"}):
        for module in sorted((ROOT / "solvers" / folder).rglob("*.py")):
            assert {each.path for each in constants_in(module)} <= listed, module


def test_each_tuned_constant_was_swept():
    unswept = [
        constant.key
        for family in FAMILIES
        for constant in constants_of(family)
        if re.search(r"no sweep yet|not swept", constant.text, re.IGNORECASE)
    ]
    assert not unswept


def test_constants_that_move_no_error_name_their_case():
    nameless = [
        constant.key
        for family in FAMILIES
        for constant in constants_of(family)
        if re.search(r"\bno\s+error", constant.text)
    ]
    assert not nameless


@pytest.mark.parametrize("family", FAMILIES)
def test_document_lists_only_constants_that_exist(family):
    existing = {
        f"{Path(constant.path).stem}.{constant.name}" for constant in constants_of(family)
    }
    assert listed_constants(family) <= existing


def listed_constants(family: str) -> set[str]:
    """Return what a section of the document names, as module and constant."""
    title = f"\n## {family.replace('_', ' ').capitalize()}\n"
    document = (ROOT / "docs" / "benchmarks" / "sensitivity.md").read_text(encoding="utf-8")
    section = document.partition(title)[2].partition("\n## ")[0]
    listed = set(re.findall(r"`(\w+\.\w+)`", section))
    for module, names in re.findall(r"^\| (\w+) \| (.*`\w+`.*) \|$", section, re.MULTILINE):
        listed |= {f"{module}.{name}" for name in re.findall(r"`(\w+)`", names)}
    return listed
