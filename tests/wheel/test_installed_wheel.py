"""What `pip install` of the wheel gives: one package, one command, and nothing of the checkout.

    make wheel
    MOCAP_ASSIST_WHEEL=dist/mocap_assist-VERSION-py3-none-any.whl \
        .venv-4.5/bin/python -m pytest tests/wheel

The wheel is installed into a new environment that borrows the libraries of this one, so that
nothing is downloaded. pip still compares their versions with what the wheel asks for.
"""

import json
import os
import re
import shlex
import subprocess
import sys
import sysconfig
import tomllib
import venv
from pathlib import Path
from zipfile import ZipFile

import pytest

from solvers.command_line.verbs import VERBS
from solvers.motion import Motion
from solvers.recordings import read_bvh, write_bvh
from solvers.samples import CorruptionSettings, GaitSettings, corrupt, walking_gait

ROOT = Path(__file__).parents[2]
VERSION = tomllib.loads((ROOT / "blender_manifest.toml").read_text(encoding="utf-8"))["version"]
PACKAGE = "mocap_assist_solvers"
PAGE_TEXT = (ROOT / "docs" / "technical" / "pipelines.md").read_text(encoding="utf-8")
SCRIPT = re.compile(r"^```python\n(# (\w+\.py)\n.*?)^```", re.MULTILINE | re.DOTALL)
"""A block of the page that names its file in the first line."""
IMPORT_EVERYTHING = f"""
import importlib, importlib.util, pkgutil, {PACKAGE}
assert "site-packages" in {PACKAGE}.__file__, {PACKAGE}.__file__
others = [importlib.util.find_spec(name) for name in ("solvers", "mocap_assist", "tests")]
assert not any(others), others
for found in pkgutil.walk_packages({PACKAGE}.__path__, "{PACKAGE}."):
    if not found.name.endswith("__main__"):
        module = importlib.import_module(found.name)
        for name in getattr(module, "__all__", ()):
            getattr(module, name)
print(len([name for name in __import__("sys").modules if name.startswith("{PACKAGE}.")]))
"""


@pytest.fixture(scope="module")
def wheel() -> Path:
    if "MOCAP_ASSIST_WHEEL" not in os.environ:
        pytest.fail("MOCAP_ASSIST_WHEEL must name the wheel; see `make test-wheel`.")
    return Path(os.environ["MOCAP_ASSIST_WHEEL"]).resolve()


class Installed:
    """An environment with the wheel in it, and a folder with takes and the page's scripts."""

    def __init__(self, home: Path) -> None:
        self.programs = home / "environment" / "bin"
        self.folder = home / "work"
        (self.folder / "takes").mkdir(parents=True)
        for name in ("one.bvh", "walk.bvh"):
            write_bvh(take(), self.folder / "takes" / name)
        for script, name in SCRIPT.findall(PAGE_TEXT):
            (self.folder / name).write_text(script, encoding="utf-8")

    def run(self, program: str, *words: str) -> str:
        """Return what a program of the environment prints; it must print no error."""
        environment = {"PATH": f"{self.programs}{os.pathsep}{os.environ['PATH']}"}
        done = subprocess.run(
            [str(self.programs / program), *words], cwd=self.folder, env=environment,
            capture_output=True, text=True, check=False, timeout=600,
        )  # fmt: skip
        assert (done.returncode, done.stderr) == (0, "")
        return done.stdout


@pytest.fixture(scope="module")
def installed(wheel, tmp_path_factory) -> Installed:
    home = tmp_path_factory.mktemp("installed")
    venv.create(home / "environment", with_pip=False)
    python = home / "environment" / "bin" / "python"
    own = next((home / "environment" / "lib").glob("python3.*/site-packages"))
    (own / "borrowed.pth").write_text(f"{sysconfig.get_path('purelib')}\n")
    command = [sys.executable, "-m", "pip", "--python", str(python), "install", "--quiet"]
    command += ["--no-index", "--no-compile", "--disable-pip-version-check"]
    subprocess.run([*command, str(wheel)], check=True, timeout=600)
    return Installed(home)


def test_wheel_holds_one_package_with_all_its_files(wheel):
    with ZipFile(wheel) as archive:
        names = {Path(name) for name in archive.namelist() if not name.endswith("/")}
    packaged = {path for path in names if path.parts[0] != f"mocap_assist-{VERSION}.dist-info"}
    ours = {
        PACKAGE / path.relative_to(ROOT / "solvers")
        for path in (ROOT / "solvers").rglob("*")
        if path.is_file() and "__pycache__" not in path.parts
    }

    assert packaged == ours
    kinds = {".py", ".npz", ".html", ".js", ".sh", ".typed", ".yaml"}
    assert {path.suffix for path in packaged} == kinds


def test_every_package_and_public_name_can_be_imported(installed):
    n_modules = int(installed.run("python", "-W", "error", "-c", IMPORT_EVERYTHING))

    assert n_modules >= len([*(ROOT / "solvers").rglob("*.py")]) - 2


def test_command_lists_every_verb_and_its_version(installed):
    help_text = installed.run("mocap-assist", "--help")

    assert help_text.startswith("usage: mocap-assist ")
    assert set(VERBS) <= set(re.findall(r"^ +([a-z-]+)", help_text, re.MULTILINE))
    assert installed.run("mocap-assist", "--version") == f"Mocap Assist {VERSION}\n"


def test_jobs_that_the_package_submits_start_the_package(installed):
    code = f"from {PACKAGE}.command_line.farm import COMMAND; print(COMMAND)"

    assert installed.run("python", "-c", code) == f"python3 -m {PACKAGE}\n"


def test_command_converts_a_recording(installed):
    installed.run("mocap-assist", "convert", "takes/one.bvh", "copy.bvh")

    assert read_bvh(installed.folder / "copy.bvh").n_frames == take().n_frames


def test_recipe_of_the_page_runs(installed):
    assert "outliers" in installed.run("python", "clean.py")
    assert read_bvh(installed.folder / "walk_clean.bvh").n_frames == take().n_frames


def test_command_cleans_in_several_processes_and_calls_the_hook_of_the_page(installed):
    call = re.search(r"^mocap-assist denoise .*--after.*$", PAGE_TEXT, re.MULTILINE)

    lines = installed.run(*shlex.split(call[0]), "--jobs", "2", "--report", "--json")

    results = [json.loads(line) for line in lines.splitlines()]
    assert {Path(each["output"]).name for each in results} == {"one.bvh", "walk.bvh"}
    for each in results:
        jitter = [each[when]["mean_jitter_m_per_s3"] for when in ("before", "after")]
        assert jitter[1] < 0.5 * jitter[0]
    assert (installed.folder / "clean" / "report.html").stat().st_size
    record = next((installed.folder / "clean" / ".mocap_assist").glob("walk.bvh.*"))
    hook = json.loads(record.read_text(encoding="utf-8"))["after"]
    assert re.search(r"walk\.bvh: jitter \d+ to \d+ m/s3", json.dumps(hook))


def take() -> Motion:
    """A second and a half of a shaky walk."""
    walk = walking_gait(GaitSettings(duration=1.5, frame_rate=30.0))
    return corrupt(walk, CorruptionSettings(jitter=3.0))
