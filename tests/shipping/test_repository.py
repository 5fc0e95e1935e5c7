"""What a studio serves from a share: Blender finds it, and takes what suits it."""

import hashlib
import os
import subprocess
import sys
from importlib.util import find_spec
from pathlib import Path
from zipfile import ZipFile

import pytest

ROOT = Path(__file__).parents[2]
pytestmark = pytest.mark.skipif(
    find_spec("bpy") is None, reason="no bpy, which carries the tool that writes indexes"
)
MANIFEST = """
schema_version = "1.0.0"
id = "mocap_assist"
version = "{version}"
name = "Mocap Assist"
tagline = "A stand-in without solvers"
maintainer = "Tests"
type = "add-on"
blender_version_min = "{minimum}"
license = ["SPDX:GPL-3.0-or-later"]
"""
# Online access is needed to install, also from a file; no other repository is asked.
INSTALL = """
import os, sys
import bpy
from bl_pkg.bl_extension_cli import cli_extension_handler as run
bpy.context.preferences.system.use_online_access = True
commands = (
    ["repo-remove", "blender_org"],
    ["repo-add", "studio", "--name", "Studio", "--url", sys.argv[1]],
    ["install", "studio.mocap_assist", "--sync", "--enable"],
)
status = any(run(words) for words in commands)
from bl_ext.studio import mocap_assist
print("Enabled:", mocap_assist.NAME, flush=True)
os._exit(status)
"""


def package(folder, version, minimum="4.5.0"):
    """Write the zip of an extension."""
    path = folder / f"mocap_assist-{version}-plain.zip"
    with ZipFile(path, "w") as archive:
        archive.writestr(
            "blender_manifest.toml", MANIFEST.format(version=version, minimum=minimum)
        )
        archive.writestr(
            "__init__.py", f"NAME = {version!r}\ndef register(): pass\ndef unregister(): pass\n"
        )
    return path


def make_repository(zips, output):
    script = ROOT / ".ci" / "packages" / "build_repository.py"
    command = [sys.executable, str(script), "--zips", str(zips), "--output", str(output)]
    return subprocess.run(command, capture_output=True, text=True, check=False, timeout=500)


def test_blender_installs_from_the_folder_the_zip_that_suits_it(tmp_path):
    zips, served = tmp_path / "zips", tmp_path / "a share"
    zips.mkdir()
    package(zips, "7.1.0")
    package(zips, "7.2.0", minimum="9.0.0")

    made = make_repository(zips, served)

    assert made.returncode == 0, made.stderr
    lines = (served / "SHA256SUMS").read_text(encoding="utf-8").splitlines()
    assert [line.split("  ") for line in lines] == [
        [hashlib.sha256(path.read_bytes()).hexdigest(), path.name]
        for path in sorted(served.glob("*.zip"))
    ]
    assert len(lines) == 2
    assert "Allow Online Access" in (served / "index.html").read_text(encoding="utf-8")
    address = (served / "index.json").as_uri()
    installed = subprocess.run(
        [sys.executable, "-c", INSTALL, address], capture_output=True, text=True, check=False,
        timeout=500, env={**os.environ, "BLENDER_USER_RESOURCES": str(tmp_path / "user")},
    )  # fmt: skip
    assert "Enabled: 7.1.0" in installed.stdout, installed.stdout + installed.stderr
    assert installed.returncode == 0


def test_a_new_version_takes_the_place_of_the_old_one(tmp_path):
    zips, served = tmp_path / "zips", tmp_path / "served"
    zips.mkdir()
    old = package(zips, "7.1.0")
    make_repository(zips, served)
    (served / "notes.txt").write_text("of the studio")
    old.unlink()
    package(zips, "7.2.0")

    make_repository(zips, served)

    assert {path.name for path in served.iterdir()} == {
        "SHA256SUMS", "index.html", "index.json", "notes.txt", "mocap_assist-7.2.0-plain.zip",
    }  # fmt: skip
    for name in ("index.html", "index.json"):
        assert "7.2.0" in (served / name).read_text(encoding="utf-8")
        assert "7.1.0" not in (served / name).read_text(encoding="utf-8")


def test_a_damaged_zip_leaves_the_repository_as_it_was(tmp_path):
    zips, served = tmp_path / "zips", tmp_path / "served"
    zips.mkdir()
    complete = package(zips, "7.1.0")
    make_repository(zips, served)
    before = {path.name: path.read_bytes() for path in served.iterdir()}
    complete.write_bytes(complete.read_bytes()[:200])

    made = make_repository(zips, served)

    assert made.returncode == 1
    assert f"Not an extension, or damaged: {complete.name}. Build it again.\n" == made.stderr
    assert {path.name: path.read_bytes() for path in served.iterdir()} == before
