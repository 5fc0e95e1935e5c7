"""What the button Import makes of files."""

from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import bpy

from ..solvers.errors import MocapAssistError, SolveCancelled
from ..solvers.progress import Progress, unwatched, within
from .import_choices import ImportChoices
from .recent_files import read_again
from .recording_objects import make_objects
from .scene.origin import note_origin, origin_of_file
from .scene.scene_objects import all_or_nothing, choose
from .scene.scene_rate import FrameRate, extend_duration, scene_rate, set_scene_rate

NOTED = 3  # recordings that the redo panel lists
READING = 0.6  # share of the time that goes into reading


EXTENSIONS = (
    ".bvh", ".amc", ".asf", ".c3d", ".trc", ".skeleton", ".csv", ".json", ".txt", ".npy",
    ".npz",
)  # fmt: skip
"""What files of a format known here may be called; what they hold decides."""
FILTER = ";".join(f"*{extension}" for extension in EXTENSIONS)


class Imported(NamedTuple):
    """What became of the files."""

    made: tuple[bpy.types.Object, ...]
    said: tuple[str, ...]
    """A sentence for each file that was read."""
    failed: tuple[str, ...]
    """A sentence for each that was not."""

    @property
    def note(self) -> str:
        """What the redo panel says: the first few recordings."""
        more = len(self.said) - NOTED
        return " ".join([*self.said[:NOTED], *[f"And {more} more."] * (more > 0)])

    @property
    def sentence(self) -> str:
        """What to say in the status bar: what failed first."""
        several = [f"{len(self.failed)} of {len(self.made) + len(self.failed)} files failed."]
        return " ".join([*several * bool(self.failed and self.made), *self.failed, *self.said])


def chosen_paths(operator: bpy.types.Operator) -> list[Path]:
    """Return the files that an operator was given, as a list in a folder or as one path.

    The skeleton that an AMC file needs may be among them: it is found anyway.
    """
    folder = bpy.path.abspath(operator.directory)
    paths = [Path(folder, each.name) for each in operator.files if each.name]
    if not paths and operator.filepath:
        paths = [Path(bpy.path.abspath(operator.filepath))]
    if any(path.suffix.lower() == ".amc" for path in paths):
        paths = [path for path in paths if path.suffix.lower() != ".asf"]
    return paths


def import_watched(
    context: bpy.types.Context, paths: list[Path], choices: ImportChoices
) -> Imported:
    """Import files while the mouse pointer shows how far the work is."""
    manager = context.window_manager
    manager.progress_begin(0.0, 1.0)
    try:
        return import_files(
            context, paths, choices, progress=lambda done, _="": manager.progress_update(done)
        )
    finally:
        manager.progress_end()


def preview(context: bpy.types.Context, paths: list[Path]) -> str:
    """Return a line about the first file, for a dialog that asks how to import it."""
    try:
        recording = read_again(paths[0])
    except MocapAssistError as error:
        return str(error)
    scene = scene_rate(context.scene)
    return (
        f"{paths[0].name}: {recording.n_frames} frames at {recording.frame_rate:g} Hz;"
        f" the scene plays {scene:g} frames per second"
    )


def import_files(
    context: bpy.types.Context,
    paths: list[Path],
    choices: ImportChoices,
    *,
    progress: Progress = unwatched,
) -> Imported:
    """Make an armature or empties of each file; those that cannot be read are told of.

    A file that fails leaves nothing behind. Raises SolveCancelled by `progress`.
    """
    made, said = [], []
    failed = [] if paths else ["No file was chosen."]
    for index, path in enumerate(paths):
        share = within(progress, index / len(paths), (index + 1) / len(paths))
        rate = choices.frame_rate
        if made and rate is FrameRate.UPDATE:  # the first recording has set the scene's rate
            rate = FrameRate.SCALE
        try:
            with all_or_nothing(context):
                one = replace(choices, frame_rate=rate)
                thing, sentence = import_file(context, path, one, progress=share)
        except SolveCancelled:
            raise
        except MocapAssistError as error:
            said_where = path.name in str(error)
            failed.append(str(error) if said_where else f"{path.name}: {error}")
        else:
            made.append(thing)
            said.append(sentence)
    if made:
        choose(context, made, made[-1])
    return Imported(tuple(made), tuple(said), tuple(failed))


def import_file(
    context: bpy.types.Context, path: Path, choices: ImportChoices, *, progress: Progress
) -> tuple[bpy.types.Object, str]:
    """Make an armature or empties of one file; return it, and a sentence about it."""
    recording = read_again(path, within(progress, 0.0, READING))
    made = make_objects(
        context, path.stem, recording, choices, progress=within(progress, READING, 1.0)
    )
    for owner in (made.top, made.action):
        note_origin(owner, origin_of_file(path, recording))
    if choices.frame_rate is FrameRate.UPDATE:
        set_scene_rate(context.scene, recording.frame_rate)
    if choices.update_scene_duration:
        extend_duration(context.scene, made.last_frame)
    rate = f"{recording.n_frames} frames at {recording.frame_rate:g} Hz"
    return made.top, f"{made.top.name}: {made.what}, {rate}."
