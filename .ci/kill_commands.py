"""Kill commands at random moments, and look for what they leave behind.

    PYTHONPATH=.:tests/fixtures python .ci/kill_commands.py --kills 40
    PYTHONPATH=.:tests/fixtures python .ci/kill_commands.py --kills 0 --each 12 --zip dist/….zip

Each command runs with `--jobs 2`, gets SIGKILL at a random moment, and is run again. Looked for
are processes that go on, half-written files, and results that differ from those of a run that
was not killed. Needs Linux; `each` needs Blender as a Python module.
"""

import argparse
import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from time import monotonic, sleep

from process_checks import descendants_of, is_running, wait_until_gone

from solvers.recordings import write_bvh
from solvers.retrieval import load_clip_library
from solvers.samples import CorruptionSettings, GaitSettings, corrupt, walking_gait

N_TAKES = 24
SECONDS = 4.0
VERBS = ("convert", "denoise", "report", "index")
PACKAGE = "bl_ext.user_default.mocap_assist"
INSTALL = """
import os, sys
import bpy
bpy.ops.extensions.package_install_files(
    filepath=sys.argv[1], repo="user_default", enable_on_install=True
)
os._exit(0)
"""
CURVES = """
import hashlib, json, os, sys
import bpy
found = {}
for path in sys.argv[1:]:
    bpy.ops.wm.open_mainfile(filepath=path)
    curves = [
        (action.name, curve) for action in bpy.data.actions for layer in action.layers
        for strip in layer.strips for bag in strip.channelbags for curve in bag.fcurves
    ]
    keys = [
        (name, curve.data_path, curve.array_index, *(str(k.co) for k in curve.keyframe_points))
        for name, curve in curves
    ]
    found[os.path.basename(path)] = hashlib.sha256(repr(sorted(keys)).encode()).hexdigest()
sys.stdout.write("\\n" + json.dumps(found) + "\\n")
sys.stdout.flush()
os._exit(0)
"""


@dataclass
class Tally:
    """What came of the kills of a command."""

    kills: int = 0
    n_orphans: int = 0
    n_half: int = 0
    n_different: int = 0
    longest: float = 0.0
    """Seconds until the last process that was started had ended."""
    n_made: list[int] = field(default_factory=list)
    """Files that were there when the command was killed."""


@dataclass(frozen=True)
class Command:
    """A command that makes files of takes."""

    start: Callable[[Path], Sequence[str]]
    """From the folder to write to."""
    contents: Callable[[Path], dict[str, str]]
    """What is in that folder, by names; raises an exception where something is half written."""


def main() -> None:
    """Kill, count, and print a line for each command."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, default=40, help="of commands without Blender")
    parser.add_argument("--each", type=int, default=0, help="kills of each")
    parser.add_argument("--zip", type=Path, help="the extension, for --each")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    rng = random.Random(options.seed)
    tallies: dict[str, Tally] = {}
    with tempfile.TemporaryDirectory(prefix="kills-") as folder:
        work_folder = Path(folder)
        (work_folder / "scratch").mkdir()
        os.environ["TMPDIR"] = str(work_folder / "scratch")
        write_takes(work_folder / "takes")
        n_of = Counter(VERBS[number % len(VERBS)] for number in range(options.kills))
        commands = {name: solver_command(name, work_folder / "takes") for name in n_of}
        if options.each:
            install(options.zip, work_folder)
            commands["each"], n_of["each"] = each_command(work_folder / "takes"), options.each
        for name, command in commands.items():
            tallies[name] = killed_often(command, work_folder / name, n_of[name], rng)
            print(name, tallies[name], flush=True)
        left = [path.name for path in (work_folder / "scratch").glob("mocap_assist_*")]
    print(f"left among the temporary files: {left or 'nothing'}")
    n_losses = sum(each.n_orphans + each.n_half + each.n_different for each in tallies.values())
    print(f"{sum(each.kills for each in tallies.values())} kills, {n_losses} losses")
    sys.exit(bool(n_losses or left))


def killed_often(
    command: Command, work_folder: Path, n_kills: int, rng: random.Random
) -> Tally:
    """Run a command to its end, then kill it that often and take it up again."""
    tally = Tally()
    (work_folder / "complete").mkdir(parents=True)
    began = monotonic()
    subprocess.run(
        command.start(work_folder / "complete"), check=True, stdout=subprocess.DEVNULL
    )
    duration = monotonic() - began
    expected = command.contents(work_folder / "complete")
    for number in range(n_kills):
        folder = work_folder / str(number)
        folder.mkdir()
        kill_one(command, folder, rng.uniform(0.1, 1.0) * duration, tally)
        check_made(command, folder, expected, tally)
        again = subprocess.run(
            command.start(folder), check=False, stdout=subprocess.DEVNULL
        ).returncode
        hidden = [path for path in folder.rglob(".*") if path.name != ".mocap_assist"]
        tally.n_different += bool(again or hidden or command.contents(folder) != expected)
        shutil.rmtree(folder)
    return tally


def kill_one(command: Command, folder: Path, seconds: float, tally: Tally) -> None:
    """Kill the command after some seconds, and wait for what it has started."""
    with subprocess.Popen(
        command.start(folder), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    ) as running:
        sleep(seconds)
        started = descendants_of(running.pid)
        running.kill()
    killed = monotonic()
    while any(map(is_running, started)) and monotonic() - killed < 30.0:
        sleep(0.02)
    tally.longest = max(tally.longest, monotonic() - killed)
    tally.n_orphans += len(wait_until_gone(started))
    tally.kills += 1


def check_made(command: Command, folder: Path, expected: dict[str, str], tally: Tally) -> None:
    """Count the kill where a file that is there is not what it should be."""
    try:
        made = command.contents(folder)
    except Exception as error:
        print(f"half written: {error!r}")
        tally.n_half += 1
        return
    tally.n_made.append(len(made))
    if any(expected.get(name) != content for name, content in made.items()):
        print("half written:", [name for name in made if made[name] != expected.get(name)])
        tally.n_half += 1


def solver_command(name: str, takes: Path) -> Command:
    """Return a command of `python -m solvers`."""
    start = [sys.executable, "-m", "solvers"]
    if name == "index":
        return Command(
            lambda folder: [
                *start, "index", str(folder / "a.clips"), str(takes), "--jobs", "2"
            ],
            clips_in,
        )  # fmt: skip
    verb = ["denoise", "--report"] if name == "report" else [name]
    return Command(
        lambda folder: [
            *start, *verb, str(takes), "--output-folder", str(folder), "--jobs", "2"
        ],
        bytes_in,
    )  # fmt: skip


def bytes_in(folder: Path) -> dict[str, str]:
    """Return all takes and pictures; notes and the report must be complete."""
    for notes in folder.glob("*.json"):
        json.loads(notes.read_text(encoding="utf-8"))
    for page in folder.glob("*.html"):
        assert page.read_text(encoding="utf-8").rstrip().endswith("</html>")
    return {
        path.relative_to(folder).as_posix(): path.read_bytes().hex()
        for path in folder.rglob("*")
        if path.suffix in {".bvh", ".png"} and not path.name.startswith(".")
    }


def clips_in(folder: Path) -> dict[str, str]:
    """Return the clips of the library."""
    if not (folder / "a.clips").exists():
        return {}
    if not (folder / "a.clips").stat().st_size:
        return {}
    with load_clip_library(folder / "a.clips") as library:
        return {
            entry.name: str((entry.origin, library.postures(number).positions.sum()))
            for number, entry in library.numbered().items()
        }


def each_command(takes: Path) -> Command:
    """Return `each ... -- import`, in a Blender that is a module of Python."""
    code = (Path(__file__).parents[1] / "mocap_assist" / "batch" / "each_verb.py").read_text()
    child = code.split('MODULE_CHILD = """')[1].split('"""')[0]
    start = [sys.executable, "-c", child, PACKAGE, "", "each", str(takes), "--jobs", "2"]
    last = ["--", "import"]
    return Command(
        lambda folder: [*start, "--report", "--output-folder", str(folder), *last], curves_in
    )


def curves_in(folder: Path) -> dict[str, str]:
    """Return what is keyed in each .blend file; its bytes hold addresses of memory."""
    bytes_in(folder)
    files = [str(path) for path in sorted(folder.glob("*.blend"))]
    if not files:
        return {}
    done = subprocess.run(
        [sys.executable, "-c", CURVES, *files], check=True, capture_output=True, text=True
    )
    found: dict[str, str] = json.loads(done.stdout.splitlines()[-1])
    return found


def install(zipped: Path, work_folder: Path) -> None:
    """Install the extension into a Blender of its own."""
    os.environ["BLENDER_USER_RESOURCES"] = str(work_folder / "resources")
    (work_folder / "resources").mkdir()
    subprocess.run(
        [sys.executable, "-c", INSTALL, str(zipped.resolve())],
        check=True, stdout=subprocess.DEVNULL, cwd=work_folder,
    )  # fmt: skip


def write_takes(folder: Path) -> None:
    """Write walks with noise, each different."""
    folder.mkdir()
    for number in range(N_TAKES):
        walk = walking_gait(
            GaitSettings(duration=SECONDS, frame_rate=60.0, cadence=100.0 + 2 * number)
        )
        noisy = corrupt(walk, CorruptionSettings(jitter=2.0, seed=number))
        write_bvh(noisy, folder / f"take{number}.bvh")


if __name__ == "__main__":
    main()
