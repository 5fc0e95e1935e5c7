"""Each tuned number has a unit and a source, in the docstring or comment next to it.

A source is a paper, a standard, a definition, a training script, what it guards or bounds, what
was measured on takes, or a sweep: what "`make sensitivity`" says has a row in
docs/benchmarks/sensitivity.md, which alone holds its figures. Where there is neither, a number,
a file or a test follows "by hand".
"""

import re
from fnmatch import fnmatchcase
from pathlib import Path

import pytest

from tests.benchmarks.sensitivity.constants import (
    FAMILIES,
    ROOT,
    UNMEASURED,
    Constant,
    constants_in,
    constants_of,
)
from tests.benchmarks.sensitivity.fixed_constants import GUARD, patterns, reason
from tests.benchmarks.sensitivity.guards import GUARDS, WITHOUT
from tests.benchmarks.sensitivity.other_constants import REASONS as OTHER_REASONS
from tests.benchmarks.sensitivity.other_constants import other_constants

SOURCE = re.compile(
    r"\[[A-Z]\w*\d\d|doi:|eq\. |\bet al\.|learned by|make sensitivity|sweep"
    r"|by definition|three-sigma|95 % efficiency|rounding|bounds? the"
    r"|\b(Winter|Harrington|Handa|Contini|Elberink|Hoaglin|Protection) \(?(19|20)\d\d"
    r"|\bmeasured\b(?:[^.]|\.(?=\w))*?\d|measured on the same takes"
    # By hand, and in the same sentence a number, a path, a test, a data set or a paper.
    r"|by hand\b[^.]*(?:\d|\w/\w|`test_\w+`|[A-Z]{3}|the paper gives no|training only)"
    # What it guards: a word of its own, not "a guard" or "it guards.".
    r"|\bguards?\s+(?:against\s+|of\s+)?(?:an?\s+|the\s+)?\w{3,}",
    re.IGNORECASE,
)
NO_BETTER = "Half and twice are no better"
SMALL_GAIN = "Half and twice gain less than 1 %"
HALF_IS_WORSE = "Half is worse"
COPIED_FIGURE = re.compile(r"\bx(?:0\.5|2)\b(?:[^.;]|\.\d)*?(?:\d %|\bnothing\b|\bfails\b)")
"""What half or twice of a constant changes, as the page of the sweep says it."""
OTHER_SWEEP = "development takes of the first press"
"""Takes of a sweep whose figures no page holds."""


def has_float(constant: Constant) -> bool:
    """Whether it is a float or holds one."""
    return isinstance(constant.value, float) or "." in repr(constant.value)


def tuned(family: str) -> list[Constant]:
    """Return the floats of a measured family, and what is tuned of the rest."""
    return [
        constant
        for constant in constants_of(family)
        if (family in FAMILIES and has_float(constant)) or not reason(constant.key)
    ]


@pytest.mark.parametrize("family", FAMILIES | UNMEASURED)
def test_tuned_numbers_say_their_unit_and_source(family):
    without_source = [each.key for each in tuned(family) if not SOURCE.search(each.text)]
    without_unit = [each.key for each in tuned(family) if each.unit == "-"]
    assert not without_source, "no source next to them"
    assert not without_unit, "no unit in the name or next to them"


def test_numbers_that_no_family_lists_say_their_unit_and_source():
    not_tuned = [pattern for some in OTHER_REASONS.values() for pattern in some]
    others = list(other_constants())
    tuned_ones = [
        constant
        for constant in others
        if not any(fnmatchcase(constant.key, pattern) for pattern in not_tuned)
    ]
    assert not [each.key for each in tuned_ones if not SOURCE.search(each.text)]
    assert not [each.key for each in tuned_ones if each.unit == "-"]
    keys = [each.key for each in others]
    assert all(any(fnmatchcase(key, each) for key in keys) for each in not_tuned)


@pytest.mark.parametrize(
    "text",
    [
        "Chosen by hand.",
        "Meters. Chosen by hand. It is 3 elsewhere.",
        "A guard.",
        "A guard: any value does.",
        "Measured on many takes. It is 3 elsewhere.",
        "Number of rounds.",
    ],
)
def test_words_without_a_case_are_no_source(text):
    assert not SOURCE.search(text)


def test_each_pattern_of_what_is_not_tuned_matches_a_constant():
    keys = {each.key for family in FAMILIES | UNMEASURED for each in constants_of(family)}
    unused = [
        pattern for pattern in patterns() if not any(fnmatchcase(key, pattern) for key in keys)
    ]
    assert not unused


def test_each_guard_is_a_constant_with_a_test():
    keys = {each.key for family in FAMILIES for each in constants_of(family)}
    assert not {*GUARDS, *WITHOUT} - keys
    for key, guard in GUARDS.items():
        file, _, test = guard.test.partition("::")
        source = (ROOT / "tests" / "solvers" / file).read_text(encoding="utf-8")
        assert f"\ndef {test}(" in source, key


@pytest.mark.parametrize(
    ("name", "value", "text", "unit"),
    [
        ("N_UPDATES", 30, "Number of updates of a weight.", "count"),
        ("N_CONTEXT_FRAMES", 8, "Frames on each side.", "frames"),
        ("OUTLIER_DENSITY", 1.0 / 120.0, "Per degree or centimeter.", "1/deg"),
        ("MAX_STEP_RAD", 0.5, "Meters are no unit of it.", "rad"),
    ],
)
def test_unit_of_a_constant(name, value, text, unit):
    assert Constant("solvers/any.py", name, value, text, 1).unit == unit


def test_every_module_of_a_family_is_measured_by_one():
    listed = {constant.path for family in FAMILIES for constant in constants_of(family)}
    folders = {Path(path).parts[1] for paths in FAMILIES.values() for path in paths}
    for folder in sorted(folders - {"signals"}):
        for module in sorted((ROOT / "solvers" / folder).rglob("*.py")):
            assert {each.path for each in constants_in(module)} <= listed, module


def test_what_is_said_to_be_varied_has_a_row():
    page = (ROOT / "docs" / "benchmarks" / "sensitivity.md").read_text(encoding="utf-8")
    names = {word for line in page.splitlines() for word in re.findall(r"`([\w.]+)`", line)}
    missing = [
        constant.key
        for family in FAMILIES
        for constant in constants_of(family)
        if "make sensitivity" in " ".join(constant.text.split())
        and names.isdisjoint({constant.name, f"{Path(constant.path).stem}.{constant.name}"})
    ]
    assert not missing


@pytest.mark.parametrize("family", FAMILIES)
def test_what_half_and_twice_are_said_to_change_agrees_with_the_page(family):
    found = mean_changes(family)
    wrong = [
        constant.key
        for constant in constants_of(family)
        if not agrees(constant.text, found.get(f"{Path(constant.path).stem}.{constant.name}"))
    ]
    assert not wrong


@pytest.mark.parametrize(
    ("text", "changes", "expected"),
    [
        (NO_BETTER, (0.0, 4.0), True),
        (NO_BETTER, (-0.1, 4.0), False),
        (SMALL_GAIN, (-0.9, 4.0), True),
        (SMALL_GAIN, (3.0, -1.0), False),
        (SMALL_GAIN, (3.0, None), False),
        (HALF_IS_WORSE, (0.4, None), True),
        (HALF_IS_WORSE, (0.0, None), False),
        ("Chosen by hand.", (-9.0, -9.0), True),
        (NO_BETTER, None, True),
    ],
)
def test_changes_that_agree_with_a_text(text, changes, expected):
    assert agrees(text, changes) == expected


def test_figures_of_the_sweep_stand_on_its_page_alone():
    listed = set().union(*(listed_constants(family) for family in FAMILIES))
    copied = [
        constant.key
        for family in FAMILIES
        for constant in constants_of(family)
        if f"{Path(constant.path).stem}.{constant.name}" in listed
        and COPIED_FIGURE.search(constant.text)
        and OTHER_SWEEP not in constant.text
    ]
    assert not copied


def test_constants_that_move_no_error_name_their_case():
    nameless = [
        constant.key
        for family in FAMILIES
        for constant in constants_of(family)
        if re.search(r"\bno\s+error", constant.text)
    ]
    assert not nameless


def test_guards_name_a_test_that_exists():
    tests = {
        name
        for path in (ROOT / "tests").rglob("test_*.py")
        for name in re.findall(
            r"^def (test_\w+)", path.read_text(encoding="utf-8"), re.MULTILINE
        )
    }
    unguarded = [
        constant.key
        for family in FAMILIES
        for constant in constants_of(family)
        if reason(constant.key) == GUARD
        and not tests.issuperset(re.findall(r"`(test_\w+)`", constant.text) or [""])
    ]
    assert not unguarded


@pytest.mark.parametrize("family", FAMILIES)
def test_document_lists_only_constants_that_exist(family):
    existing = {
        f"{Path(constant.path).stem}.{constant.name}" for constant in constants_of(family)
    }
    assert listed_constants(family) <= existing


def agrees(text: str, changes: tuple[float | None, float | None] | None) -> bool:
    """Whether a docstring states the mean changes, percent, by half and twice of a constant.

    Those of no row are less than 0.1 %. None in a row is a run that failed.
    """
    half, twice = changes or (0.0, 0.0)
    if HALF_IS_WORSE in text:
        return half is not None and half > 0.0 and twice is None
    if NO_BETTER in text or SMALL_GAIN in text:
        if half is None or twice is None:
            return False
        return min(half, twice) >= 0.0 if NO_BETTER in text else min(half, twice) > -1.0
    return True


def mean_changes(family: str) -> dict[str, tuple[float | None, float | None]]:
    """Return the mean changes by half and twice in a section's first table, by constant."""
    rows = section_of(family).partition("| without | mean |")[0]
    pattern = r"^\| `(\w+\.\w+)` \|.*\| ([-+.\d %]+) \| ([-+.\d %]+) \| [^|]+ \|$"
    return {
        name: (percent(half), percent(twice))
        for name, half, twice in re.findall(pattern, rows, re.MULTILINE)
    }


def percent(text: str) -> float | None:
    """Return a figure of a table; None for the dash of a run that failed."""
    return None if text == "-" else float(text.rstrip(" %"))


def section_of(family: str) -> str:
    """Return the section of the document on a family."""
    title = f"\n## {family.replace('_', ' ').capitalize()}\n"
    document = (ROOT / "docs" / "benchmarks" / "sensitivity.md").read_text(encoding="utf-8")
    return document.partition(title)[2].partition("\n## ")[0]


def listed_constants(family: str) -> set[str]:
    """Return what a section of the document names, as module and constant."""
    section = section_of(family)
    listed = set(re.findall(r"`(\w+\.\w+)`", section))
    for module, names in re.findall(r"^\| (\w+) \| (.*`\w+`.*) \|$", section, re.MULTILINE):
        listed |= {f"{module}.{name}" for name in re.findall(r"`(\w+)`", names)}
    return listed
