"""On a machine that lacks something, the set-up says what, and how to get it."""

import os
import re
import shutil
import subprocess
import sys
from importlib.util import module_from_spec, spec_from_file_location
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
HERE = f"{sys.version_info.major}.{sys.version_info.minor}"
"""The Python that runs this stands for the one that is looked for."""
TOOLS = ("bash", "env", "ls", "make", "sed")
NO_PYTHON = (
    "no Python {} that can make environments was found: not on the PATH, nor in uv's or"
    " pyenv's folders."
)

pytestmark = pytest.mark.skipif(
    not all(map(shutil.which, TOOLS)), reason="needs bash and make, as the set-up itself does"
)


@pytest.fixture
def machine(tmp_path):
    """A machine with nothing but the tools: no Python, no uv, no pyenv."""
    tools = tmp_path / "tools"
    tools.mkdir()
    for tool in TOOLS:
        (tools / tool).symlink_to(shutil.which(tool))
    return Machine(tmp_path)


class Machine:
    def __init__(self, home: Path) -> None:
        self.home = home
        self.path = home / "tools"
        self.environment = {"PATH": str(self.path), "HOME": str(home)}

    def add(self, path: str, script: str = f'exec {sys.executable} "$@"') -> None:
        """Install a program; by default it is a Python that works."""
        program = self.home / path
        program.parent.mkdir(parents=True, exist_ok=True)
        program.write_text(f"#!{shutil.which('bash')}\n{script}\n")
        program.chmod(0o755)

    def run(self, *command: str) -> subprocess.CompletedProcess:
        return subprocess.run(
            [*command], cwd=ROOT, env=self.environment, capture_output=True, text=True,
            check=False, timeout=500,
        )  # fmt: skip

    def find_python(self, version: str = HERE) -> str | None:
        done = self.run(str(ROOT / ".ci" / "find_python"), version)
        assert done.stderr == ""
        assert (done.returncode == 0) == bool(done.stdout)
        return done.stdout.strip() or None


WORKING = [
    f"tools/python{HERE}",
    "tools/python3",
    "tools/python",
    f".local/share/uv/python/cpython-{HERE}.9-linux-x86_64-gnu/bin/python{HERE}",
    f".pyenv/versions/{HERE}.2/bin/python{HERE}",
]


@pytest.mark.parametrize("path", WORKING)
def test_python_is_found_in_every_default_folder(machine, path):
    machine.add(path)

    assert machine.find_python() == sys.executable
    assert machine.find_python("3.99") is None


@pytest.mark.parametrize(
    ("variable", "path"),
    [
        ("UV_PYTHON_INSTALL_DIR", f"cpython-{HERE}.9-linux-x86_64-gnu/bin/python{HERE}"),
        ("PYENV_ROOT", f"versions/{HERE}.2/bin/python{HERE}"),
    ],
)
def test_python_is_found_by_environment_variable(machine, variable, path):
    machine.add(f"elsewhere/{path}")
    assert machine.find_python() is None

    machine.environment[variable] = str(machine.home / "elsewhere")

    assert machine.find_python() == sys.executable


def test_python_of_uv_is_found(machine):
    machine.add("opt/py")
    machine.add("tools/uv", f'[ "$*" = "python find {HERE}" ] && echo {machine.home}/opt/py')

    assert machine.find_python() == sys.executable


@pytest.mark.parametrize(
    "broken",
    [
        f"echo 'pyenv: python{HERE}: command not found' >&2; exit 127",
        "exit 1  # as a Debian Python without ensurepip does",
    ],
)
def test_broken_python_is_skipped(machine, broken):
    machine.add(f"tools/python{HERE}", broken)
    assert machine.find_python() is None

    machine.add(f".pyenv/versions/{HERE}.2/bin/python{HERE}")

    assert machine.find_python() == sys.executable


def test_set_up_stops_without_python_311(machine):
    done = machine.run("make", "libraries")

    assert done.returncode
    assert done.stdout == (
        f"Stopped: {NO_PYTHON.format('3.11')}\n"
        "On Debian and Ubuntu: sudo apt-get install python3.11-venv\n"
    )


def test_set_up_continues_without_python_313(machine, tmp_path):
    shutil.copytree(ROOT / ".ci", tmp_path / "fresh" / ".ci")
    for name in ("Makefile", "blender_manifest.toml"):
        shutil.copy(ROOT / name, tmp_path / "fresh")
    fresh = ("make", "--no-print-directory", "-C", str(tmp_path / "fresh"), "optional-5.2")

    done = machine.run(*fresh)

    skipped = f"SKIPPED on Blender 5.2: {NO_PYTHON.format('3.13')}\n"
    assert (done.returncode, done.stdout) == (0, skipped)
    ready = tmp_path / "fresh" / ".venv-5.2" / "ready"
    ready.parent.mkdir()
    ready.touch()
    assert machine.run(*fresh).stdout == "", "what is there already is not skipped"


def test_workflow_runs_what_make_test_runs():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    workflow = (ROOT / ".github" / "workflows" / "test.yml").read_text(encoding="utf-8")
    parts = re.search(r"--keep-going \\\n\t +(.+)$", makefile, re.MULTILINE)[1].split()

    jobs = re.search(r"target: \[(.+)\]$", workflow, re.MULTILINE)[1].split(", ")
    run = " ".join(re.findall(r"run: make ([a-z -]+)$", workflow, re.MULTILINE)).split()

    assert sorted(jobs) == sorted(parts)
    assert run
    assert all(f"\n{target}:" in makefile for target in [*jobs, *run])


@pytest.fixture
def check_libraries(monkeypatch):
    spec = spec_from_file_location("check_libraries", ROOT / ".ci" / "check_libraries.py")
    module = module_from_spec(spec)
    spec.loader.exec_module(module)
    monkeypatch.setattr(sys, "argv", ["check_libraries.py"])
    monkeypatch.setattr(module, "loads", lambda library: library in module.there)
    monkeypatch.setattr(module.shutil, "which", lambda tool: f"/usr/bin/{tool}")
    monkeypatch.setattr(module.os, "geteuid", lambda: 0, raising=False)
    monkeypatch.setattr(module.subprocess, "run", lambda *_, **__: pytest.fail("ran it"))
    module.there = set(module.PACKAGES) - {"libX11.so.6", "libGL.so.1"}
    return module


def test_missing_libraries_are_named_with_the_command(check_libraries):
    with pytest.raises(SystemExit) as stopped:
        check_libraries.main()

    assert stopped.value.code == (
        "Blender needs system libraries that are missing: libX11.so.6, libGL.so.1.\n"
        "Install them with:  sudo apt-get install -y libx11-6 libgl1\n"
        "(those are the names of Debian and Ubuntu), and run make again."
    )


def test_set_up_prints_nothing_when_nothing_is_missing(check_libraries, capsys):
    check_libraries.there = set(check_libraries.PACKAGES)

    check_libraries.main()

    assert capsys.readouterr() == ("", "")


@pytest.mark.parametrize("helps", [True, False])
def test_build_machine_installs_missing_libraries(check_libraries, monkeypatch, helps):
    commands = []

    def run(command, **options):
        commands.append(" ".join(command))
        if helps and "install" in command:
            check_libraries.there = set(check_libraries.PACKAGES)

    monkeypatch.setattr(sys, "argv", ["check_libraries.py", "--install"])
    monkeypatch.setattr(check_libraries.subprocess, "run", run)

    if helps:
        check_libraries.main()
    else:
        with pytest.raises(SystemExit, match=r"libX11\.so\.6, libGL\.so\.1"):
            check_libraries.main()

    assert commands == ["apt-get update", "apt-get install -y libx11-6 libgl1"]


def test_nothing_is_installed_without_permission(check_libraries, monkeypatch):
    monkeypatch.setattr(sys, "argv", ["check_libraries.py", "--install"])
    monkeypatch.setattr(check_libraries.os, "geteuid", lambda: 1000, raising=False)

    with pytest.raises(SystemExit, match="Install them with:  sudo apt-get"):
        check_libraries.main()


def test_libraries_are_searched_in_the_loader_paths():
    spec = spec_from_file_location("check_libraries", ROOT / ".ci" / "check_libraries.py")
    module = module_from_spec(spec)
    spec.loader.exec_module(module)

    assert module.loads("libc.so.6") == (os.uname().sysname == "Linux")
    assert not module.loads("libnowhere.so.1")
