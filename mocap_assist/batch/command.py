"""Parse a command line within Blender, process the armatures of the open file and save it."""

import argparse
import json
import sys
from collections.abc import Sequence
from contextlib import AbstractContextManager, nullcontext

import bpy

from ...solvers.command_line.arguments import SentenceParser
from ...solvers.command_line.batches import Screen, escape_undecodable_names, printable
from ...solvers.errors import InvalidFileError, InvalidSettingError, MocapAssistError
from ...solvers.files import reason_of, write_atomically
from ...solvers.processes import add_threads_option
from ..actions.markers.holders import markers_of
from ..depth.depth_preview import shows_depth
from ..scene import history
from .capture_verb import HELP as CAPTURE_HELP
from .capture_verb import add_capture_options, perform_capture
from .each_child import OPTION, lock_target
from .each_verb import HELP as EACH_HELP
from .each_verb import add_each_options, perform_each
from .import_verb import HELP as IMPORT_HELP
from .import_verb import add_import_options, perform_import
from .library_verbs import INDEX_HELP, add_index_options, perform_index
from .pictures import draw_result
from .report_verb import HELP as REPORT_HELP
from .report_verb import add_report_options, perform_report
from .saving import STDOUT, add_output_options, check_folder, save, target_file
from .verbs import VERBS, SceneVerb

PROG = "blender FILE --command mocap_assist"
FAILED_STATUS = 2


def run(words: Sequence[str]) -> int:
    """Run a command line; return the exit status, 0 or 2.

    Each failure is one sentence on stderr. Nothing is saved after a failure, except by
    `import`, `capture` and `each`, which save what succeeded.
    """
    escape_undecodable_names(sys.stdout)
    screen = Screen()
    try:
        own, after = _split_words(list(words))
        arguments = _parser().parse_args(own)
        arguments.words = _check_words(after)
        with _child_context(arguments):
            arguments.work(arguments, screen)
    except MocapAssistError as error:
        screen.write_line(str(error))
        return FAILED_STATUS
    except OSError as error:
        screen.write_line(f"{error.filename or 'The output'}: {reason_of(error)}.")
        return FAILED_STATUS
    except SystemExit as stop:  # a usage error, or --help
        return int(stop.code or 0)
    return 0


def _child_context(arguments: argparse.Namespace) -> AbstractContextManager[None]:
    """Return the context of a child of `each`, or an empty one."""
    return lock_target(arguments.output) if arguments.child_of_each else nullcontext()


def _split_words(words: list[str]) -> tuple[list[str], list[str]]:
    """Split the arguments of `each` from those of its verb, at the first --."""
    if words[:1] != ["each"] or "--" not in words:
        return words, []
    at = words.index("--")
    return words[:at], words[at + 1 :]


def _check_words(words: list[str]) -> list[str]:
    """Return the arguments of the verb of `each` after checking them.

    Raises
    ------
    InvalidSettingError
        The verb saves no file.
    SystemExit
        There is no such verb or option; the parser has reported it.
    """
    if not words:
        return words
    verb = VERBS.get(words[0])
    if words[0] == "each" or (verb is not None and not verb.writes):
        raise InvalidSettingError(
            f"{words[0]} saves no .blend file; each is for verbs that do, such as denoise."
        )
    files = ["FILE"] if words[0] in {"import", "capture"} else []
    _parser().parse_args([words[0], *files, *words[1:]])
    return words


def _parser() -> SentenceParser:
    parser = SentenceParser(prog=PROG, description="Captured motion in .blend files.")
    parser.add_argument(OPTION, action="store_true", help=argparse.SUPPRESS)
    choices = parser.add_subparsers(dest="verb", metavar="VERB", required=True)
    for name, verb in VERBS.items():
        described = choices.add_parser(name, help=verb.help, description=verb.help)
        described.add_argument(
            "--armature",
            metavar="NAME",
            help="armature to work on, or the empty above the markers to work on [default: all"
            " animated armatures; if there are none, all markers]",
        )
        add_output_options(described, saves=verb.writes)
        if verb.solves:
            add_threads_option(described)
        verb.add_options(described)
        described.set_defaults(work=_work)
    described = choices.add_parser("import", help=IMPORT_HELP, description=IMPORT_HELP)
    add_output_options(described, saves=True)
    add_import_options(described)
    described.set_defaults(work=perform_import)
    described = choices.add_parser("capture", help=CAPTURE_HELP, description=CAPTURE_HELP)
    add_output_options(described, saves=True)
    add_threads_option(described)
    add_capture_options(described)
    described.set_defaults(work=perform_capture)
    described = choices.add_parser("index", help=INDEX_HELP, description=INDEX_HELP)
    add_threads_option(described)
    add_index_options(described)
    described.set_defaults(work=perform_index)
    described = choices.add_parser("report", help=REPORT_HELP, description=REPORT_HELP)
    add_report_options(described)
    described.set_defaults(work=perform_report)
    described = choices.add_parser("each", help=EACH_HELP, description=EACH_HELP)
    add_each_options(described)
    described.set_defaults(work=perform_each)
    return parser


def _work(arguments: argparse.Namespace, screen: Screen) -> None:
    verb = VERBS[arguments.verb]
    excluded_armature = verb.excluded_armature(arguments)
    subjects = _subjects(arguments.armature, excluded_armature, verb)
    target = target_file(arguments) if verb.writes else None
    verb.check(arguments, subjects)
    figures_file = None if arguments.json in {None, STDOUT} else check_folder(arguments.json)
    lines = []
    for subject in subjects:
        screen.title = subject.name
        text, figures = verb.perform(bpy.context.scene, subject, arguments, screen.progress)
        screen.clear()
        lines.append(json.dumps({"armature": subject.name} | figures) + "\n")
        sys.stdout.write(lines[-1] if arguments.json == STDOUT else f"{printable(text)}\n")
        sys.stdout.flush()
    if target is not None:
        save(target)
    if figures_file is not None:
        with write_atomically(figures_file) as part:
            part.write_text("".join(lines), encoding="utf-8")
    if arguments.picture is not None:
        made = bpy.data.objects.get(excluded_armature, subjects[0])
        if shows_depth(made):
            made = bpy.context.view_layer.objects.active  # the armature that was tracked
        draw_result(bpy.context.scene, made, arguments.picture, screen)


def _subjects(
    name: str | None, excluded_armature: str, verb: SceneVerb
) -> list[bpy.types.Object]:
    """Return the armatures, parents of markers, or points of depth images to process."""
    objects = list(bpy.context.scene.objects)
    armatures = [each for each in objects if each.type == "ARMATURE"]
    holders = [
        each
        for each in objects
        if (verb.on_markers and each.type == "EMPTY" and markers_of(each))
        or (verb.on_depth and shows_depth(each))
    ]
    if name is None:
        found = [
            each for each in armatures if _is_animated(each) and each.name != excluded_armature
        ]
        found = found or holders
        missing = "The scene has no animated armature."
    else:
        found = [each for each in [*armatures, *holders] if each.name == name]
        there = ", ".join(each.name for each in [*armatures, *holders]) or "none"
        missing = f"There is no armature {name}; the scene has {there}."
    if not found:
        raise InvalidFileError(missing)
    return found


def _is_animated(armature: bpy.types.Object) -> bool:
    """Return whether it plays an action; drivers alone are animation data too."""
    animation = armature.animation_data
    if animation is None:
        return False
    return animation.action is not None or history.played_result(armature) is not None
