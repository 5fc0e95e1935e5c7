"""Recordings that come into the scene one after the other, and go again if need be."""

import logging
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, NamedTuple

import bpy

from ...solvers.depth_scene import DepthRecording
from ...solvers.errors import MocapAssistError
from ...solvers.faults import Failure, attempt
from ...solvers.motion import JointRecording, Motion, Tracks
from ...solvers.progress import Progress, unwatched
from ...solvers.recordings import recording_figures
from ..scene.origin import note_origin, origin_of_file
from ..scene.scene_objects import Numbers, all_or_nothing, choose, in_object_mode, remove
from ..scene.scene_rate import FrameRate, extend_duration, set_scene_rate
from ..scene.scene_state import SceneState
from .choices import ImportChoices
from .depth_objects import make_preview
from .recording_objects import make_objects
from .solve_reading import Recording, in_one_tree

logger = logging.getLogger(__name__)

TOLD = 2  # of what a reader said
NOTED = 3  # recordings that the redo panel lists
READING = 0.6  # share of the time that goes into reading


class Imported(NamedTuple):
    """What became of the files."""

    made: tuple[bpy.types.Object, ...]
    said: tuple[str, ...]
    """A sentence for each file that was read."""
    failed: tuple[str, ...]
    """A sentence for each that was not."""
    figures: tuple[dict[str, Any], ...] = ()
    """Of each file that was read: `recording_figures`, and warnings as one text."""

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


class Arrival:
    """What has come in so far.

    Everything is known by its number, since undo in another window replaces what Blender's own
    pointers mean.
    """

    def __init__(self, context: bpy.types.Context, choices: ImportChoices) -> None:
        self._choices = choices
        self._state = SceneState.of(context)
        self._made: list[Numbers] = []
        self._tops: list[int] = []
        self._said: list[str] = []
        self._failed: list[str] = []
        self._figures: list[dict[str, Any]] = []

    def add(
        self,
        context: bpy.types.Context,
        path: Path,
        recording: Recording,
        progress: Progress = unwatched,
        *,
        moving: Motion | Tracks | None = None,
        warnings: Sequence[str] = (),
    ) -> None:
        """Make an armature or empties of a recording, or note why not; all or nothing.

        `moving` is what it becomes (`make_objects`), `warnings` what its reader said of it.
        """
        built = attempt(path, self._build, context, path, recording, moving, progress)
        if isinstance(built, Failure):
            self.refuse(path, built.as_error())
            return
        made, top, sentence = built
        self._made.append(made)
        self._tops.append(top.session_uid)
        self._said.append(" ".join([sentence, *[f"{told}." for told in warnings[:TOLD]]]))
        self._figures.append(_figures(recording, warnings))

    def refuse(self, path: Path, error: MocapAssistError) -> None:
        """Note that a file failed."""
        for note in getattr(error, "__notes__", ()):  # where that was not foreseen
            logger.error("%s: %s", path, note)
        named = path.name in str(error)
        self._failed.append(str(error) if named else f"{path.name}: {error}")

    def take_back(self, context: bpy.types.Context) -> None:
        """Leave the scene as it was before all."""
        if self._made:
            in_object_mode(context)
            for made in self._made:
                remove(made)
        self._state.restore(context)

    def end(self, context: bpy.types.Context) -> Imported:
        """Select what came in; return it."""
        there = {each.session_uid: each for each in context.view_layer.objects}
        tops = tuple(there[number] for number in self._tops if number in there)
        if tops:
            choose(context, list(tops), tops[-1])
        failed = self._failed if self._said or self._failed else ["No file was chosen."]
        return Imported(tops, tuple(self._said), tuple(failed), tuple(self._figures))

    def _build(
        self,
        context: bpy.types.Context,
        path: Path,
        recording: Recording,
        moving: Motion | Tracks | None,
        progress: Progress,
    ) -> tuple[Numbers, bpy.types.Object, str]:
        with all_or_nothing(context) as made:
            return made, *self._make(context, path, recording, moving, progress)

    def _make(
        self,
        context: bpy.types.Context,
        path: Path,
        recording: Recording,
        moving: Motion | Tracks | None,
        progress: Progress,
    ) -> tuple[bpy.types.Object, str]:
        choices = self._choices
        if self._tops and choices.frame_rate is FrameRate.UPDATE:  # the first has set the rate
            choices = replace(choices, frame_rate=FrameRate.SCALE)
        if isinstance(recording, DepthRecording):
            made = make_preview(context, path, recording, choices, progress=progress)
        else:
            made = make_objects(
                context, path.stem, recording, choices, moving=moving, progress=progress
            )
        for owner in filter(None, (made.top, made.action)):
            note_origin(owner, origin_of_file(path, recording))
        if choices.frame_rate is FrameRate.UPDATE:
            set_scene_rate(context.scene, recording.frame_rate)
        if choices.update_scene_duration:
            extend_duration(context.scene, made.last_frame)
        rate = f"{recording.n_frames} frames at {recording.frame_rate:.5g} Hz"
        return made.top, f"{made.top.name}: {made.what}, {rate}."


def _figures(recording: Recording, warnings: Sequence[str]) -> dict[str, Any]:
    figures = recording_figures(recording)
    lost = figures.pop("never_seen", [])
    told = [*warnings, *[f"Never observed: {', '.join(lost)}"] * bool(lost)]
    if isinstance(recording, JointRecording) and not in_one_tree(recording):
        told.append("The parents of the joints are unknown")
    return {**figures, "warnings": ". ".join(told)}
