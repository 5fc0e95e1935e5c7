"""The wheels hold what their names say, for the Pythons and systems of Blender.

`make extension` downloads all of them; those that are not there are skipped.
"""

import re
import tomllib
from email.parser import Parser
from pathlib import Path, PurePosixPath
from zipfile import ZipFile

import pytest
from packaging.markers import default_environment
from packaging.requirements import Requirement
from packaging.specifiers import SpecifierSet
from packaging.tags import Tag, parse_tag
from packaging.utils import canonicalize_name, parse_wheel_filename

ROOT = Path(__file__).parents[2]
MANIFEST = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))
WHEELS = [Path(wheel).name for wheel in MANIFEST["wheels"]]
BLENDERS = {"cp311": ("3.11", "1.26.4"), "cp313": ("3.13", "2.3.4")}
"""By tag of a wheel: Blender's Python and numpy."""
UNUSED = {"mujoco": {"absl-py", "etils", "glfw", "pyopengl"}}
"""What libraries ask for and the extension does not need: MuJoCo's window and examples."""
OLDEST_MACOS = {"x86_64": (11, 2), "arm64": (12, 0)}
"""Blender 4.5 needs macOS 11.2; SciPy for Apple's processors needs 12."""
NATIVE = {"win_amd64": ".pyd", "macosx": ".so", "manylinux": ".so"}


class Wheel:
    """A downloaded wheel and what its metadata says."""

    def __init__(self, name: str) -> None:
        path = ROOT / "wheels" / name
        if not path.is_file():
            pytest.skip(f"{name} is not downloaded; make extension does that")
        self.name, self.version, _, self.tags = parse_wheel_filename(name)
        with ZipFile(path) as archive:
            self.files = archive.namelist()
            folder = next(f for f in self.files if f.endswith(".dist-info/WHEEL"))
            self.wheel = Parser().parsestr(archive.read(folder).decode("utf-8"))
            metadata = folder.replace("WHEEL", "METADATA")
            self.metadata = Parser().parsestr(archive.read(metadata).decode("utf-8"))

    @property
    def pythons(self) -> list[tuple[str, str]]:
        """Pythons and numpys of the Blenders that unpack it."""
        own = {tag.interpreter for tag in self.tags}
        return [each for tag, each in BLENDERS.items() if tag in own or "py3" in own]


@pytest.fixture(params=WHEELS)
def wheel(request) -> Wheel:
    return Wheel(request.param)


def test_metadata_says_what_the_name_says(wheel):
    tags: set[Tag] = set()
    for written in wheel.wheel.get_all("Tag"):
        tags |= parse_tag(written)

    assert canonicalize_name(wheel.metadata["Name"]) == wheel.name
    assert wheel.metadata["Version"] == str(wheel.version)
    assert wheel.tags <= tags


def test_python_and_libraries_of_blender_are_what_it_needs(wheel):
    shipped = {parse_wheel_filename(name)[0]: parse_wheel_filename(name)[1] for name in WHEELS}
    unused = UNUSED.get(wheel.name, set())

    assert wheel.pythons
    for python, numpy in wheel.pythons:
        assert python in SpecifierSet(wheel.metadata["Requires-Python"] or "")
        environment = {**default_environment(), "python_version": python, "extra": ""}
        for text in wheel.metadata.get_all("Requires-Dist") or ():
            needed = Requirement(text)
            if needed.marker is not None and not needed.marker.evaluate(environment):
                continue
            name = canonicalize_name(needed.name)
            version = numpy if name == "numpy" else shipped.get(name)
            assert name in unused or version in needed.specifier, text


def test_native_modules_are_for_one_system_and_old_enough(wheel):
    native = {PurePosixPath(f).suffix for f in wheel.files} & {*NATIVE.values()}
    named = {
        end for tag in wheel.tags for start, end in NATIVE.items()
        if tag.platform.startswith(start)
    }  # fmt: skip

    assert native == named
    for tag in wheel.tags:
        if found := re.fullmatch(r"macosx_(\d+)_(\d+)_(\w+)", tag.platform):
            assert (int(found[1]), int(found[2])) <= OLDEST_MACOS[found[3]], tag


def test_no_two_files_differ_in_case_only(wheel):
    """Windows and macOS would unpack one over the other."""
    assert len({name.casefold() for name in wheel.files}) == len(set(wheel.files))
