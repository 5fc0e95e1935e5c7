"""Build and check the extension's zips, with their wheels, from the manifest.

    python .ci/packages/build_extension.py                       every platform of the manifest
    python .ci/packages/build_extension.py --platform linux-x64  one of them
    python .ci/packages/build_extension.py --per-python          a smaller zip for each Python
    python .ci/packages/build_extension.py --plain               without wheels

Needs an installed `bpy`, because Blender's own build tool travels in it; imports nothing of it.
"""

import argparse
import json
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib
from collections.abc import Iterator, Sequence
from importlib.util import find_spec
from itertools import groupby
from pathlib import Path
from typing import Any, NamedTuple

import write_manual

ROOT = Path(__file__).resolve().parents[2]
WHEELS = ROOT / "wheels"
# What is shipped is for the manifest to say; these are only slow to copy.
NOT_COPIED = shutil.ignore_patterns(".*", "__pycache__", "build", "dist", "wheels")
PAGES = Path("mocap_assist") / "ui" / "pages"
"""Where the pages of the manual are in the zip."""
OPERATING_SYSTEMS = {"linux": "linux", "windows": "win", "macos": "macosx"}
BLENDERS = {
    "3.11": 'blender_version_min = "4.5.0"\nblender_version_max = "5.1.0"',
    "3.13": 'blender_version_min = "5.1.0"',
}
"""By Python, the lines of a manifest for the Blenders that have it; the maximum is excluded."""
PROCESSORS = {"x64": ("x86_64", "amd64"), "arm64": ("arm64", "aarch64")}


class Wheel(NamedTuple):
    """What the name of a wheel says: `name-version-python-abi-platform.whl`."""

    python: str
    """Such as cp311, or py3 for every Python."""
    platform: str
    """Such as win_amd64, or several with dots between; any for pure Python."""
    name: str
    version: str
    file: str

    @classmethod
    def from_path(cls, path: str) -> "Wheel":
        """Read a name such as ./wheels/scipy-1.15.3-cp311-cp311-win_amd64.whl."""
        name, version, python, _, platform = Path(path).stem.split("-")
        return cls(python, platform, name, version, Path(path).name)

    def fits(self, python: str) -> bool:
        """Whether a Python, such as 3.11, can use it."""
        return self.python in {"py3", f"cp{python.replace('.', '')}"}

    def serves(self, blender_platform: str) -> bool:
        """Whether a Blender platform, such as linux-x64, can use it."""
        system, processor = blender_platform.split("-")
        named_system = OPERATING_SYSTEMS[system] in self.platform.split("_")[0]
        return self.platform == "any" or (
            named_system and self.platform.endswith(PROCESSORS[processor])
        )


def main(arguments: Sequence[str] | None = None) -> None:
    """Build what the command line asks for; the paths of the zips are printed."""
    manifest = read_manifest()
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--platform", action="append", choices=manifest["platforms"])
    kind = parser.add_mutually_exclusive_group()
    kind.add_argument("--plain", action="store_true", help="leave the wheels out")
    kind.add_argument("--per-python", action="store_true", help="one zip for each Python")
    parser.add_argument("--output", type=Path, default=ROOT / "dist")
    options = parser.parse_args(arguments)

    platforms = [] if options.plain else options.platform or manifest["platforms"]
    for path in build_zips(manifest, platforms, options.output, per_python=options.per_python):
        print(path)


def read_manifest(root: Path = ROOT) -> dict[str, Any]:
    """Return the manifest of a checkout."""
    return tomllib.loads((root / "blender_manifest.toml").read_text(encoding="utf-8"))


def build_zips(
    manifest: dict[str, Any], platforms: Sequence[str], output: Path, *, per_python: bool
) -> Iterator[Path]:
    """Build a zip for each platform, or one without wheels if there is none; yield each."""
    wheels = [
        wheel
        for wheel in map(Wheel.from_path, manifest["wheels"])
        if any(wheel.serves(platform) for platform in platforms)
    ]
    fetch(wheels)
    output.mkdir(parents=True, exist_ok=True)
    stem = f"{manifest['id']}-{manifest['version']}"
    for python in BLENDERS if per_python else (None,):
        fitting = [wheel for wheel in wheels if python is None or wheel.fits(python)]
        ending = ".zip" if python is None else f"-python{python}.zip"
        with tempfile.TemporaryDirectory(dir=output) as folder:
            staging = Path(folder) / "source"
            stage(staging, platforms, fitting, python)
            for path in build(staging, Path(folder), stem, platforms):
                yield path.replace(output / f"{path.stem}{ending}")


def fetch(wheels: Sequence[Wheel]) -> None:
    """Download the wheels that `wheels/` lacks, in the very files that the manifest names."""
    missing = sorted(wheel for wheel in wheels if not (WHEELS / wheel.file).is_file())
    for (python, platform), group in groupby(missing, lambda wheel: wheel[:2]):
        command = [sys.executable, "-m", "pip", "download", "-qq", "--no-deps"]
        command += ["--only-binary=:all:", "--dest", str(WHEELS)]
        if platform != "any":
            command += ["--python-version", python.removeprefix("cp")]
            command += [f"--platform={tag}" for tag in platform.split(".")]
        subprocess.run(
            [*command, *(f"{wheel.name}=={wheel.version}" for wheel in group)], check=True
        )
    not_downloaded = [wheel.file for wheel in wheels if not (WHEELS / wheel.file).is_file()]
    if not_downloaded:
        sys.exit(
            "The package index has other files than the manifest names: "
            f"{', '.join(not_downloaded)}."
        )


def stage(
    staging: Path, platforms: Sequence[str], wheels: Sequence[Wheel], python: str | None
) -> None:
    """Copy the checkout, with a manifest that names only these platforms and wheels."""
    shutil.copytree(ROOT, staging, ignore=NOT_COPIED)
    write_manual.main(staging / PAGES)
    (staging / "wheels").mkdir()
    for wheel in wheels:
        (staging / "wheels" / wheel.file).symlink_to(WHEELS / wheel.file)
    text = (ROOT / "blender_manifest.toml").read_text(encoding="utf-8")
    text = restricted(text, platforms, wheels, python)
    (staging / "blender_manifest.toml").write_text(text, encoding="utf-8")


def restricted(
    manifest: str, platforms: Sequence[str], wheels: Sequence[Wheel], python: str | None
) -> str:
    """Return the manifest with these platforms and wheels, for the Blenders of a Python."""
    for key, values in (
        ("platforms", list(platforms)),
        ("wheels", [f"./wheels/{wheel.file}" for wheel in wheels]),
    ):
        line = f"{key} = {json.dumps(values)}" if values else ""
        manifest = re.sub(rf"^{key} = \[.*?\]$", line, manifest, flags=re.MULTILINE | re.DOTALL)
    if python is None:
        return manifest
    return re.sub(r"^blender_version_min = .*$", BLENDERS[python], manifest, flags=re.MULTILINE)


def build(staging: Path, output: Path, stem: str, platforms: Sequence[str]) -> list[Path]:
    """Run Blender's own tool over the staged copy, then over each zip; return the zips."""
    if platforms:
        names = [f"{stem}-{platform.replace('-', '_')}.zip" for platform in platforms]
        target = ["--output-dir", str(output), "--split-platforms"]
    else:
        names = [f"{stem}-plain.zip"]
        target = ["--output-filepath", str(output / names[0])]
    run_tool("build", "--source-dir", str(staging), *target)
    for name in names:
        run_tool("validate", str(output / name))
    return [output / name for name in names]


def run_tool(*words: str) -> None:
    """Run a command of Blender's tool; what it prints appears only if it fails."""
    command = [sys.executable, str(build_tool()), *words]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode:
        sys.exit(f"{done.stdout}{done.stderr}")


def build_tool() -> Path:
    """The command-line tool of Blender's extension system, which needs no Blender to run."""
    bpy = find_spec("bpy")
    if bpy is None or bpy.origin is None:
        sys.exit("There is no bpy in this Python; `make extension` uses one that has it.")
    return next(Path(bpy.origin).parent.glob("*/scripts/addons_core/bl_pkg/cli/blender_ext.py"))


if __name__ == "__main__":
    main()
