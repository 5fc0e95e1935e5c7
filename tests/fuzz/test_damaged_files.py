"""Files that a fuzzer or a user found are read or refused in one sentence, for good.

To add one: tests/data/damaged/TARGET/what_is_wrong_with_it.
"""

from pathlib import Path

import pytest

from tests.fuzz.targets import read_target, targets

FOUND = Path(__file__).parents[1] / "data" / "damaged"
FILES = sorted(path for path in FOUND.glob("*/*") if path.is_file())
TARGETS = targets()


@pytest.mark.parametrize("name", TARGETS)
def test_undamaged_file_is_read(name, tmp_path):
    target = TARGETS[name]
    for other, content in target.required_files:
        (tmp_path / other).write_bytes(content)
    (tmp_path / target.name).write_bytes(target.seed)

    target.read(tmp_path / target.name)


@pytest.mark.parametrize("path", FILES, ids=lambda path: f"{path.parent.name}/{path.name}")
def test_recorded_fuzz_file_is_read_or_refused(path, tmp_path):
    read_target(TARGETS[path.parent.name], path.read_bytes(), tmp_path)


def test_each_file_of_the_fuzzer_has_a_target():
    assert FILES
    assert {path.parent.name for path in FILES} <= set(TARGETS)
