"""A release: one version everywhere, and no release of what is not ready."""

import subprocess
from pathlib import Path

import pytest
import release

ROOT = Path(__file__).parents[2]
CHANGELOG = """# Changelog

## [Unreleased]

### Added

- A button.

## [0.9.0] - 2026-01-01

- The first.
"""


@pytest.fixture
def checkout(tmp_path) -> Path:
    """A repository of git with the files that have a version."""
    (tmp_path / "blender_manifest.toml").write_text('version = "0.9.0"\nid = "x"\n')
    (tmp_path / "CITATION.cff").write_text("cff-version: 1.2.0\nversion: 0.9.0\n")
    (tmp_path / "CHANGELOG.md").write_text(CHANGELOG)
    git(tmp_path, "init", "--quiet")
    commit(tmp_path)
    return tmp_path


def git(root, *words):
    who = ["-c", "user.name=Tests", "-c", "user.email=tests@localhost"]
    subprocess.run(["git", "-C", str(root), *who, *words], check=True)


def commit(root):
    git(root, "add", ".")
    git(root, "commit", "--quiet", "--message", "Change")


def test_a_version_is_written_everywhere_and_can_be_released(checkout, capsys):
    release.write_version(checkout, "0.10.0")
    commit(checkout)
    release.check_commit(checkout, is_tested=True)

    assert 'version = "0.10.0"\n' in (checkout / "blender_manifest.toml").read_text()
    citation = (checkout / "CITATION.cff").read_text()
    assert citation == "cff-version: 1.2.0\nversion: 0.10.0\n"
    changelog = (checkout / "CHANGELOG.md").read_text()
    assert release.section(changelog, "0.10.0") == "### Added\n\n- A button."
    assert release.section(changelog, "Unreleased") == ""
    assert "This commit can be v0.10.0.\n" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("number", "sentence"),
    [("0.9.0", "0.9.0 is not above 0.9.0"), ("0.8.9", "not above"), ("v1", "v1 is no version")],
)
def test_a_wrong_version_changes_nothing(checkout, number, sentence):
    with pytest.raises(SystemExit, match=sentence):
        release.write_version(checkout, number)

    assert release.git(checkout, "status", "--porcelain") == ""


def test_every_reason_against_a_release_is_named(checkout):
    (checkout / "CITATION.cff").write_text("version: 0.1.0\n")
    git(checkout, "tag", "v0.9.0")

    with pytest.raises(SystemExit) as stopped:
        release.check_commit(checkout, is_tested=False)

    assert [line.split()[0] for line in str(stopped.value).splitlines()] == [
        "Not", "There", "The", "CHANGELOG.md", "CITATION.cff", "Run",
    ]  # fmt: skip


def test_this_checkout_has_one_version():
    number = release.version_of(ROOT)

    assert release.released_versions((ROOT / "CHANGELOG.md").read_text("utf-8"))[0] == number
    assert f"\nversion: {number}\n" in (ROOT / "CITATION.cff").read_text("utf-8")
