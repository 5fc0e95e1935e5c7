"""The wheel and its libraries as pip installs them: on Python 3.12, and in the lowest versions.

    make test-wheel
    make test-wheel-oldest

pip fills an environment from the package index once; later tests use it again.
"""

import os
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

from solvers.recordings import read_bvh, write_bvh
from solvers.samples import GaitSettings, walking_gait

ROOT = Path(__file__).parents[2]
PIP_TIMEOUT_S = 500
REQUIREMENT = re.compile(r"([\w-]+)>=([\d.]+)")


@pytest.fixture(scope="module")
def wheel() -> Path:
    if "MOCAP_ASSIST_WHEEL" not in os.environ:
        pytest.fail("MOCAP_ASSIST_WHEEL must name the wheel; see `make test-wheel`.")
    return Path(os.environ["MOCAP_ASSIST_WHEEL"]).resolve()


@pytest.mark.skipif(sys.version_info[:2] != (3, 11), reason="runs once, on Python 3.11")
def test_newest_libraries_on_python_3_12(wheel, tmp_path):
    programs = environment("3.12", "3.12", [f"mocap-assist[physics] @ {wheel.as_uri()}"])

    install(programs, "--no-deps", "--force-reinstall", str(wheel))

    clean_and_simulate(programs, tmp_path)


@pytest.mark.skipif("MOCAP_ASSIST_OLDEST" not in os.environ, reason="make test-wheel-oldest")
def test_lowest_versions_of_the_libraries(wheel, tmp_path):
    project = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    ranges = [*project["dependencies"], *project["optional-dependencies"]["physics"]]
    lowest = ["==".join(REQUIREMENT.match(each).groups()) for each in ranges]
    programs = environment("oldest", "3.11", lowest)

    install(programs, "--no-deps", "--force-reinstall", str(wheel))

    clean_and_simulate(programs, tmp_path)


def environment(name: str, version: str, requirements: list[str]) -> Path:
    """Return the programs of an environment with these libraries; make it if it has others."""
    home = ROOT / f".venv-wheel-{name}"
    ready, wanted = home / "ready", "\n".join(requirements)
    if not ready.exists() or ready.read_text(encoding="utf-8") != wanted:
        found = run(ROOT / ".ci" / "find_python", version)
        if found.returncode:
            pytest.skip(f"no Python {version} was found")
        made = run(found.stdout.strip(), "-m", "venv", "--clear", home)
        assert made.returncode == 0, made.stderr
        filled = install(home / "bin", "--only-binary=:all:", *requirements, check=False)
        if filled.returncode:
            reason = filled.stderr.strip().splitlines()[-1]
            pytest.skip(f"pip cannot install the libraries from the package index: {reason}")
        ready.write_text(wanted, encoding="utf-8")
    return home / "bin"


def install(programs: Path, *words: str, check: bool = True) -> subprocess.CompletedProcess:
    pip = [programs / "python", "-m", "pip", "install", "--quiet"]
    done = run(*pip, "--disable-pip-version-check", "--no-compile", *words)
    assert not check or done.returncode == 0, done.stderr
    return done


def clean_and_simulate(programs: Path, folder: Path) -> None:
    """Run two verbs, which need all libraries but Pillow; the report needs that."""
    walk = walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))
    write_bvh(walk, folder / "walk.bvh")
    for verb, *options in (["denoise", "--report"], ["simulate"]):
        words = [verb, folder / "walk.bvh", "--output-folder", folder / verb, *options]
        done = run(programs / "mocap-assist", *words, folder=folder)
        assert (done.returncode, done.stderr) == (0, "")
        assert read_bvh(folder / verb / "walk.bvh").n_frames == walk.n_frames
    assert (folder / "denoise" / "report" / "walk.bvh.png").exists()


def run(*words: str | Path, folder: Path = ROOT) -> subprocess.CompletedProcess:
    names = {name: text for name, text in os.environ.items() if name != "PYTHONPATH"}
    return subprocess.run(
        [*map(str, words)], cwd=folder, env=names, capture_output=True, text=True, check=False,
        timeout=PIP_TIMEOUT_S,
    )  # fmt: skip
