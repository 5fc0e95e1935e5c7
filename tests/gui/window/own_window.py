"""A window for the drivers where the tool is missing: Xvfb, and the `blender` on the PATH."""

import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

NEEDED = ("blender", "Xvfb", "xdotool", "maim")
SIZE = (1600, 1000)
SECONDS = 1600
WRONG = re.compile(r"Traceback|property not found|unknown operator|operator missing")
"""In the log: Blender goes on after errors in buttons and panels."""


def missing() -> list[str]:
    """Return the programs that are not there."""
    return [program for program in NEEDED if shutil.which(program) is None]


def run(zip_path: Path, driver: Path, given: list[Path], picture: Path) -> tuple[int, str]:
    """Install the extension for a new user and run a driver; return its status and the log."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        for path in (*given, Path(__file__).with_name("bgui.py")):
            copy = shutil.copytree if path.is_dir() else shutil.copy
            copy(path, folder / path.name)
        shutil.copy(driver, folder / "driver.py")
        (folder / "home").mkdir()
        (folder / "runtime").mkdir(mode=0o700)
        environment = os.environ | {
            "HOME": str(folder / "home"),
            "XDG_RUNTIME_DIR": str(folder / "runtime"),
            "LIBGL_ALWAYS_SOFTWARE": "1",
            "BGUI_OUT": str(picture.parent),
            "BGUI_SHOT": str(picture),
        }
        with screen() as display:
            environment["DISPLAY"] = display
            log = ""
            for command in commands(zip_path.resolve(), folder):
                try:
                    ended = subprocess.run(
                        command, cwd=folder, env=environment, timeout=SECONDS, check=False,
                        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                    )  # fmt: skip
                except subprocess.TimeoutExpired:
                    return 124, f"{log}Stopped after {SECONDS} s.\n"
                log += ended.stdout
                if ended.returncode:
                    return ended.returncode, log
    return int("bgui: PASS" not in log or bool(WRONG.search(log))), log


@contextmanager
def screen() -> Iterator[str]:
    """Start an X server with a virtual screen; yield its display."""
    reading, writing = os.pipe()
    command = ["Xvfb", "-displayfd", str(writing), "-screen", "0", f"{SIZE[0]}x{SIZE[1]}x24"]
    server = subprocess.Popen(
        [*command, "-nolisten", "tcp", "-noreset"],
        pass_fds=[writing],
        stderr=subprocess.DEVNULL,
    )
    os.close(writing)
    with os.fdopen(reading) as numbers:
        number = numbers.readline().strip()
    try:
        yield f":{number}"
    finally:
        server.terminate()
        server.wait()


def commands(zip_path: Path, folder: Path) -> list[list[str]]:
    """Install the extension, switch the splash off, and drive a Blender in a window."""
    width, height = map(str, SIZE)
    preferences = (
        "import bpy; bpy.context.preferences.view.show_splash = False;"
        " bpy.ops.wm.save_userpref()"
    )
    install = ["extension", "install-file", "-r", "user_default", "--enable", str(zip_path)]
    return [
        ["blender", "--factory-startup", "--command", *install],
        ["blender", "--background", "--python-exit-code", "1", "--python-expr", preferences],
        [
            "blender", "--gpu-backend", "opengl", "-noaudio",
            "--window-geometry", "0", "0", width, height, "--python-exit-code", "1",
            "--python-expr", f"import sys; sys.path.insert(0, {str(folder)!r})",
            "--python", "driver.py",
        ],
    ]  # fmt: skip
