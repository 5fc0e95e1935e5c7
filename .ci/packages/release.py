"""Prepare a release; nothing is uploaded, and no tag is made.

    python .ci/packages/release.py version 0.2.0   write version and date of the CHANGELOG
    python .ci/packages/release.py check --tested  stop unless this commit can be released
    python .ci/packages/release.py collect         gather zips and wheel, checksums and notes

`make version NUMBER=0.2.0` runs the first, `make release TESTED=yes` builds between the others.
"""

import argparse
import re
import shutil
import subprocess
import sys
from collections.abc import Sequence
from datetime import UTC, datetime
from pathlib import Path

import build_extension
import build_repository

ROOT = Path(__file__).resolve().parents[2]
UNRELEASED = "## [Unreleased]"
NOTES = "NOTES.md"
NUMBER = re.compile(r"\d+\.\d+\.\d+")


def main(arguments: Sequence[str] | None = None) -> None:
    """Do what the command line asks for, or stop with one sentence."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    steps = parser.add_subparsers(required=True)
    version = steps.add_parser("version", help="write the version of the next release")
    version.add_argument("number")
    version.set_defaults(step=lambda options: write_version(ROOT, options.number))
    check = steps.add_parser("check", help="stop unless this commit can be released")
    check.add_argument("--tested", action="store_true", help="make test passed on this commit")
    check.set_defaults(step=lambda options: check_commit(ROOT, is_tested=options.tested))
    collect = steps.add_parser("collect", help="gather the files of the release")
    collect.set_defaults(step=lambda options: collect_files(ROOT / "dist"))
    options = parser.parse_args(arguments)
    options.step(options)


def write_version(root: Path, number: str) -> None:
    """Write the version into the manifest and CITATION.cff, and close the CHANGELOG's list."""
    if not NUMBER.fullmatch(number):
        sys.exit(f"{number} is no version; it has three numbers, such as 0.2.0.")
    changelog = (root / "CHANGELOG.md").read_text(encoding="utf-8")
    former = released_versions(changelog)[0]
    if numbers(number) <= numbers(former):
        sys.exit(f"{number} is not above {former}, the last version in CHANGELOG.md.")
    if not section(changelog, "Unreleased"):
        sys.exit("CHANGELOG.md names no change under [Unreleased].")
    today = datetime.now(tz=UTC).date()
    heading = f"{UNRELEASED}\n\n## [{number}] - {today}"
    substitute(root / "CHANGELOG.md", re.escape(UNRELEASED), heading)
    substitute(root / "blender_manifest.toml", r"version = \".*\"", f'version = "{number}"')
    substitute(root / "CITATION.cff", r"version: .*", f"version: {number}")
    print(f"Version {number}. Commit it, run make test, then make release TESTED=yes.")


def check_commit(root: Path, *, is_tested: bool) -> None:
    """Stop unless the commit is complete, named and tested; else print the tag to make."""
    number = version_of(root)
    changelog = (root / "CHANGELOG.md").read_text(encoding="utf-8")
    tag = f"v{number}"
    problems = []
    if git(root, "status", "--porcelain"):
        problems.append("There are changes that are not committed.")
    if git(root, "tag", "--list", tag):
        problems.append(f"The tag {tag} exists: set the next version with make version.")
    if released_versions(changelog)[0] != number or not section(changelog, number):
        problems.append(f"The first version in CHANGELOG.md is not {number}, or is empty.")
    if section(changelog, "Unreleased"):
        problems.append("CHANGELOG.md has changes under [Unreleased]: run make version.")
    if f"\nversion: {number}\n" not in (root / "CITATION.cff").read_text(encoding="utf-8"):
        problems.append(f"CITATION.cff has another version than {number}.")
    if not is_tested:
        problems.append("Run make test on this commit; if it passes, add TESTED=yes.")
    if problems:
        sys.exit("\n".join(["Not released:", *problems]))
    print(f"This commit can be {tag}.")


def collect_files(dist: Path) -> None:
    """Gather the built files, their checksums and the notes in a folder of the release."""
    number = version_of(ROOT)
    release = dist / f"release-{number}"
    built = sorted([
        *dist.glob(f"mocap_assist-{number}-*.zip"),
        *dist.glob(f"mocap_assist-{number}-*.whl"),
    ])
    if not built:
        sys.exit(f"There are no files of {number} in {dist}; make release builds them.")
    shutil.rmtree(release, ignore_errors=True)
    release.mkdir()
    copies = [Path(shutil.copy(path, release)) for path in built]
    build_repository.write_checksums(release, copies)
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    notes = f"# Mocap Assist {number}\n\n{section(changelog, number)}\n"
    (release / NOTES).write_text(notes, encoding="utf-8", newline="\n")
    for path in sorted(release.iterdir()):
        print(f"{path.stat().st_size / 1e6:6.1f} MB  {path}")
    print(f"Then: git tag --annotate v{number} --file {release / NOTES} --cleanup=verbatim")


def version_of(root: Path) -> str:
    """Return the version of the manifest."""
    return str(build_extension.read_manifest(root)["version"])


def released_versions(changelog: str) -> list[str]:
    """Return the versions in a changelog, the last one first."""
    return re.findall(r"^## \[(\d\S*)\]", changelog, re.MULTILINE)


def numbers(version: str) -> list[int]:
    """Return the numbers of a version, to compare it with another one."""
    return [int(number) for number in version.split(".")]


def section(changelog: str, version: str) -> str:
    """Return the text below the heading of a version; empty without changes."""
    heading = rf"^## \[{re.escape(version)}\].*?$\n(.*?)(?=^## |\Z)"
    found = re.search(heading, changelog, re.MULTILINE | re.DOTALL)
    return found[1].strip() if found else ""


def substitute(path: Path, line: str, new: str) -> None:
    """Replace the one line of a file that matches."""
    text = path.read_text(encoding="utf-8")
    text, n_found = re.subn(rf"^{line}$", lambda _: new, text, flags=re.MULTILINE)
    if n_found != 1:
        sys.exit(f"{path.name} has {n_found} lines like {line}, and must have one.")
    path.write_text(text, encoding="utf-8", newline="\n")


def git(root: Path, *words: str) -> str:
    """Return what a command of git prints."""
    command = ["git", "-C", str(root), *words]
    return subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip()


if __name__ == "__main__":
    main()
