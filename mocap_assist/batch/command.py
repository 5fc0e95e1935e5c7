"""Parse a command line within Blender, work on the armatures of the open file, save it."""

import argparse
import json
import sys
from collections.abc import Sequence
from pathlib import Path

import bpy

from ...solvers.command_line import SentenceParser
from ...solvers.command_line.screen import Screen
from ...solvers.errors import InvalidFileError, MocapAssistError
from ...solvers.files import written_whole
from ..scene import history
from .verbs import VERBS

PROG = "blender FILE --command mocap_assist"
FAILED = 2
STDOUT = Path("-")
_commands: list[object] = []


def run(words: Sequence[str]) -> int:
    """Do what the command line says; return the exit status, 0 or 2.

    Each failure is one sentence on stderr. Nothing is saved if anything failed.
    """
    screen = Screen()
    try:
        arguments = _parser().parse_args(list(words))
        _work(arguments, screen)
    except MocapAssistError as error:
        screen.say(str(error))
        return FAILED
    except SystemExit as stop:  # a slip in the command line, or --help
        return int(stop.code or 0)
    return 0


def register() -> None:
    """Let `blender --command mocap_assist` find `run`."""
    _commands.append(bpy.utils.register_cli_command("mocap_assist", run))


def unregister() -> None:
    """Take the command away again."""
    while _commands:
        bpy.utils.unregister_cli_command(_commands.pop())


def _parser() -> SentenceParser:
    parser = SentenceParser(prog=PROG, description="Clean up captured motion in a .blend file.")
    choices = parser.add_subparsers(dest="verb", metavar="VERB", required=True)
    for name, verb in VERBS.items():
        described = choices.add_parser(name, help=verb.help, description=verb.help)
        described.add_argument(
            "--armature",
            metavar="NAME",
            help="work on this one [default: all that are animated]",
        )
        described.add_argument(
            "--json",
            nargs="?",
            type=Path,
            const=STDOUT,
            metavar="FILE",
            help="write one line of JSON for each armature, and nothing else, to FILE; without"
            " FILE print the lines, each of which begins with {, among what Blender prints",
        )
        if verb.writes:
            described.add_argument(
                "--output", type=Path, metavar="FILE",
                help="save the result there [default: in the opened file]",
            )  # fmt: skip
        verb.add_options(described)
    return parser


def _work(arguments: argparse.Namespace, screen: Screen) -> None:
    verb = VERBS[arguments.verb]
    armatures = _armatures(arguments.armature, verb.left_alone(arguments))
    target = _target(arguments) if verb.writes else None
    verb.check(arguments, armatures)
    figures_file = None if arguments.json in {None, STDOUT} else _in_a_folder(arguments.json)
    lines = []
    for armature in armatures:
        screen.title = armature.name
        text, figures = verb.perform(bpy.context.scene, armature, arguments, screen.progress)
        screen.clear()
        lines.append(json.dumps({"armature": armature.name} | figures) + "\n")
        sys.stdout.write(lines[-1] if arguments.json == STDOUT else f"{text}\n")
        sys.stdout.flush()
    if target is not None:
        _save(target)
    if figures_file is not None:
        with written_whole(figures_file) as part:
            part.write_text("".join(lines), encoding="utf-8")


def _save(target: Path) -> None:
    try:
        bpy.ops.wm.save_as_mainfile(filepath=str(target), check_existing=False)
    except RuntimeError as error:
        reason = str(error).strip().removeprefix("Error: ")
        raise InvalidFileError(f"{target} was not saved: {reason}") from error


def _target(arguments: argparse.Namespace) -> Path:
    target = arguments.output or (Path(bpy.data.filepath) if bpy.data.filepath else None)
    if target is None:
        raise InvalidFileError("No file is open: say which one to save with --output FILE.")
    return _in_a_folder(target)


def _in_a_folder(path: Path) -> Path:
    """Return the whole path, whose folder must exist."""
    if not path.resolve().parent.is_dir():
        raise InvalidFileError(f"There is no folder {path.resolve().parent} to save in.")
    return path.resolve()


def _armatures(name: str | None, left_alone: str) -> list[bpy.types.Object]:
    armatures = [each for each in bpy.context.scene.objects if each.type == "ARMATURE"]
    if name is None:
        found = [each for each in armatures if _plays(each) and each.name != left_alone]
        missing = "The scene has no animated armature."
    else:
        found = [each for each in armatures if each.name == name]
        there = ", ".join(each.name for each in armatures) or "none"
        missing = f"There is no armature {name}; the scene has {there}."
    if not found:
        raise InvalidFileError(missing)
    return found


def _plays(armature: bpy.types.Object) -> bool:
    """Whether it plays an action; drivers alone are animation data too."""
    animation = armature.animation_data
    if animation is None:
        return False
    return animation.action is not None or history.played_result(armature) is not None
