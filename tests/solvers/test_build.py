"""A build differs from others of its version by its code and learned data."""

import shutil
from pathlib import Path

import pytest

from solvers import version

ROOT = Path(__file__).parents[2]


@pytest.fixture
def build_of(tmp_path, monkeypatch):
    """Return the build of a copy of a small package, with its files as given."""

    def build(**contents: bytes) -> str:
        package = tmp_path / "solvers"
        shutil.rmtree(package, ignore_errors=True)
        (package / "motion").mkdir(parents=True)
        shutil.copy(ROOT / "blender_manifest.toml", tmp_path)
        files = {"a.py": b"A = 1\n", "motion/b.npz": b"1\r\n"}
        for name, content in {**files, **contents}.items():
            (package / name).write_bytes(content)
        monkeypatch.setattr(version, "__file__", str(package / "version.py"))
        version.version.cache_clear()
        version.build.cache_clear()
        return version.build()

    yield build
    version.version.cache_clear()
    version.build.cache_clear()


def test_build_changes_with_code_and_data_alone(build_of):
    first = build_of()

    assert first.startswith("0.") and "+" in first
    assert build_of(**{"a.py": b"A = 2\n"}) != first
    assert build_of(**{"c.py": b""}) != first
    assert build_of(**{"motion/b.npz": b"2\r\n"}) != first
    assert build_of(**{"a.pyc": b"x"}) == first
    assert build_of(**{"._a.py": b"x"}) == first  # macOS on a share
    assert build_of(**{"a.py": b"A = 1\r\n"}) == first  # Git on Windows
