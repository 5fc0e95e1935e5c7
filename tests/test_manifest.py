"""The manifest must name what Blender can install, and agree with the files around it."""

import re
import tomllib
from itertools import product
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
MANIFEST = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
WHEELS = [Path(wheel).name for wheel in MANIFEST["wheels"]]
PURE = "py3-none-any"
# The endings of wheels' names for each platform, and the Pythons of Blender 4.5 and 5.2.
PLATFORMS = {
    "linux-x64": r"manylinux\S*_x86_64",
    "windows-x64": r"win_amd64",
    "macos-x64": r"macosx_\d+_\d+_x86_64",
    "macos-arm64": r"macosx_\d+_\d+_arm64",
}
PYTHONS = ["cp311", "cp313"]
# The platform's own list; its command-line tool accepts any.
TAGS = {"Animation", "Import-Export", "Pipeline", "Rigging", "Tracking"}


def test_every_library_has_wheels_for_every_platform_and_python():
    libraries = {tuple(wheel.split("-")[:2]) for wheel in WHEELS}

    assert set(MANIFEST["platforms"]) == set(PLATFORMS)
    for (name, version), platform, python in product(libraries, PLATFORMS, PYTHONS):
        wanted = rf"{name}-{version}-({PURE}|{python}-{python}-{PLATFORMS[platform]})\.whl"
        fitting = [wheel for wheel in WHEELS if re.fullmatch(wanted, wheel)]
        assert len(fitting) == 1, f"{name} on {platform}, {python}: {fitting}"


def test_every_wheel_fits_a_shipped_platform():
    patterns = [PURE, *(f"{py}-{py}-{end}" for py, end in product(PYTHONS, PLATFORMS.values()))]

    for wheel in WHEELS:
        assert any(re.search(rf"-{pattern}\.whl$", wheel) for pattern in patterns), wheel
    assert sorted(set(WHEELS)) == WHEELS


@pytest.mark.parametrize("blender", ["4.5", "5.2"])
def test_tests_use_the_shipped_library_versions(blender):
    pins = requirements(ROOT / ".ci" / f"requirements-{blender}.txt")

    for name, version in {tuple(wheel.split("-")[:2]) for wheel in WHEELS}:
        assert pins.get(name.replace("_", "-")) == version


@pytest.mark.parametrize("environment", ["4.5", "5.2", "fuzz", "wheel"])
def test_environments_pin_every_package(environment):
    assert all(requirements(ROOT / ".ci" / f"requirements-{environment}.txt").values())


def test_changelog_has_this_version():
    changelog = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    versions = re.findall(r"^## \[(\d\S*)\]", changelog, flags=re.MULTILINE)

    assert versions[0] == MANIFEST["version"]


def test_tags_are_those_of_the_extensions_platform():
    assert set(MANIFEST["tags"]) <= TAGS


def test_manifest_license_matches_the_license_file():
    license_text = (ROOT / "LICENSE").read_text(encoding="utf-8")

    assert MANIFEST["license"] == ["SPDX:GPL-3.0-or-later"]
    assert license_text.lstrip().startswith("GNU GENERAL PUBLIC LICENSE\n")
    assert "Version 3, 29 June 2007" in license_text


def requirements(path: Path) -> dict[str, str]:
    """Version of each package that a requirements file asks for; empty where it is open."""
    pins = {}
    for line in path.read_text(encoding="utf-8").splitlines():
        wanted = line.partition("#")[0].strip()
        if wanted.startswith("-r"):
            pins |= requirements(path.parent / wanted.removeprefix("-r").strip())
        elif wanted:
            name, _, version = wanted.partition("==")
            pins[name] = version
    return pins
