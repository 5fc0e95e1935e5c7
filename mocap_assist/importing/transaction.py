"""Add recordings to the scene one by one, and remove them again on failure."""

import logging
from dataclasses import asdict, replace
from pathlib import Path
from typing import Any, NamedTuple

import bpy

from ...solvers.depth_scene import DepthRecording
from ...solvers.errors import MocapAssistError
from ...solvers.faults import Failure, attempt
from ...solvers.motion import JointRecording, Motion, Tracks
from ...solvers.progress import Progress, unwatched
from ...solvers.recordings import recording_figures
from ...solvers.recordings.conventions import conventions_of
from ..actions.markers.holders import markers_of
from ..scene.origin import note_origin, origin_of_file
from ..scene.other_animation import is_animated
from ..scene.scene_objects import (
    Numbers,
    in_object_mode,
    remove_data,
    select_only,
    undo_on_error,
)
from ..scene.scene_rate import (
    FrameRate,
    extend_duration,
    is_same_rate,
    scene_rate,
    set_duration,
    set_scene_rate,
)
from ..scene.scene_state import SceneState
from .bind_meshes import bind_skinned_meshes
from .button_settings import ImportChoices
from .depth_objects import make_preview
from .recording_objects import add_takes, make_objects
from .solve_reading import ReadRecording, Recording, in_one_tree

logger = logging.getLogger(__name__)

MAX_WARNINGS = 2  # of a reader
MAX_LISTED = 3  # recordings that the redo panel lists
READING_FRACTION = 0.6  # fraction of the time that reading takes


class Imported(NamedTuple):
    """Result of an import."""

    made: tuple[bpy.types.Object, ...]
    messages: tuple[str, ...]
    """A sentence for each file that was read."""
    failed: tuple[str, ...]
    """A sentence for each that was not."""
    figures: tuple[dict[str, Any], ...] = ()
    """Of each file that was read: `recording_figures`, and warnings as one text."""

    @property
    def note(self) -> str:
        """Message for the redo panel: the first few recordings."""
        more = len(self.messages) - MAX_LISTED
        return " ".join([*self.messages[:MAX_LISTED], *[f"And {more} more."] * (more > 0)])

    @property
    def sentence(self) -> str:
        """Message for the status bar, failures first."""
        several = [f"{len(self.failed)} of {len(self.made) + len(self.failed)} files failed."]
        return " ".join([
            *several * bool(self.failed and self.made),
            *self.failed,
            *self.messages,
        ])


class ImportTransaction:
    """Objects that an import has added so far.

    It refers to data-blocks by number, since undo in another window invalidates pointers.
    """

    def __init__(self, context: bpy.types.Context, choices: ImportChoices) -> None:
        auto = choices.frame_rate is FrameRate.AUTO
        self._sets_duration = auto and not is_animated(context.scene)
        if auto:
            rate = FrameRate.UPDATE if self._sets_duration else FrameRate.RESAMPLE
            choices = replace(choices, frame_rate=rate)
        self.choices = choices
        """With the frame rate decided."""
        self._state = SceneState.of(context)
        self._created: list[Numbers] = []
        self._tops: list[int] = []
        self._messages: list[str] = []
        self._failed: list[str] = []
        self._figures: list[dict[str, Any]] = []

    def add(
        self,
        context: bpy.types.Context,
        path: Path,
        content: ReadRecording,
        progress: Progress = unwatched,
        *,
        moving: Motion | Tracks | None = None,
    ) -> None:
        """Create the objects of a recording completely, or note why not.

        `moving` is its converted motion (`make_objects`).
        """
        built = attempt(path, self._build, context, path, content, moving, progress)
        if isinstance(built, Failure):
            self.refuse(path, built.as_error())
            return
        made, top, sentence = built
        self._created.append(made)
        self._tops.append(top.session_uid)
        self._messages.append(
            " ".join([
                sentence,
                *[f"{text.rstrip('.')}." for text in content.warnings[:MAX_WARNINGS]],
            ])
        )
        self._figures.append(_figures(content))

    def refuse(self, path: Path, error: MocapAssistError) -> None:
        """Note that a file failed."""
        for note in getattr(error, "__notes__", ()):  # where that was not foreseen
            logger.error("%s: %s", path, note)
        named = path.name in str(error)
        self._failed.append(str(error) if named else f"{path.name}: {error}")

    def take_back(self, context: bpy.types.Context) -> None:
        """Restore the scene as it was before the import."""
        if self._created:
            in_object_mode(context)
            for made in self._created:
                remove_data(made)
        self._state.restore(context)

    def end(self, context: bpy.types.Context) -> Imported:
        """Select the imported objects; return the result."""
        objects = {each.session_uid: each for each in context.view_layer.objects}
        tops = tuple(objects[number] for number in self._tops if number in objects)
        if tops:
            chosen = [each for top in tops for each in markers_of(top) or [top]]
            select_only(context, chosen, tops[-1])
        failed = self._failed if self._messages or self._failed else ["No file was chosen."]
        return Imported(tops, tuple(self._messages), tuple(failed), tuple(self._figures))

    def _build(
        self,
        context: bpy.types.Context,
        path: Path,
        content: ReadRecording,
        moving: Motion | Tracks | None,
        progress: Progress,
    ) -> tuple[Numbers, bpy.types.Object, str]:
        with undo_on_error(context) as made:
            return made, *self._make(context, path, content, moving, progress)

    def _make(
        self,
        context: bpy.types.Context,
        path: Path,
        content: ReadRecording,
        moving: Motion | Tracks | None,
        progress: Progress,
    ) -> tuple[bpy.types.Object, str]:
        choices, recording = self.choices, content.recording
        name = f"{path.stem} {content.body}".strip()
        if self._tops and choices.frame_rate is FrameRate.UPDATE:  # the first has set the rate
            choices = replace(choices, frame_rate=FrameRate.RESAMPLE)
        if isinstance(recording, DepthRecording):
            made = make_preview(context, path, recording, choices, progress=progress)
        else:
            made = make_objects(
                context, name, recording, choices, moving=moving, progress=progress
            )
        if content.others:
            made = add_takes(context, made, path, content, choices)
        if content.meshes is not None:
            bound = bind_skinned_meshes(context, content.meshes, content.armature, made.top)
            made = made._replace(what=made.what + bound)
        for owner in filter(None, (made.top, made.action)):
            origin = origin_of_file(path, recording, choices.global_scale, content.body)
            note_origin(owner, origin)
        what, rate = ", ".join(made.what), f"{recording.frame_rate:.5g}"
        sentences = [f"{made.top.name}: {what}, {recording.n_frames} frames at {rate} Hz."]
        sentences += made.notes
        if not isinstance(recording, DepthRecording):
            sentences.append(f"{conventions_of(recording).sentence()}.")
        sentences += self._set_time(context.scene, choices, recording, made.last_frame)
        return made.top, " ".join(sentences)

    def _set_time(
        self,
        scene: bpy.types.Scene,
        choices: ImportChoices,
        recording: Recording,
        last_frame: float,
    ) -> list[str]:
        """Set the scene's rate and range as far as chosen; return sentences about it."""
        before, end, sentences = scene_rate(scene), scene.frame_end, []
        is_moving = not isinstance(recording, DepthRecording)
        if is_same_rate(recording.frame_rate, before):
            pass
        elif choices.frame_rate is FrameRate.UPDATE:
            set_scene_rate(scene, recording.frame_rate)
            sentences.append(f"The scene now plays at {scene_rate(scene):.5g} FPS.")
        elif choices.frame_rate is FrameRate.RESAMPLE and is_moving:
            sentences.append(f"Resampled to the scene's {before:.5g} FPS.")
        if self._sets_duration and not self._tops:
            set_duration(scene, choices.frame_start, last_frame)
        elif self._sets_duration or choices.update_scene_duration:
            extend_duration(scene, last_frame)
        elif last_frame > end:
            sentences.append(f"It ends at frame {last_frame:.0f}, the scene at {end}.")
        return sentences


def _figures(content: ReadRecording) -> dict[str, Any]:
    recording, warnings = content.recording, content.warnings
    figures = recording_figures(recording)
    never_observed = figures.pop("never_seen", [])
    texts = [
        *warnings,
        *[f"Never observed: {', '.join(never_observed)}"] * bool(never_observed),
    ]
    if isinstance(recording, JointRecording) and not in_one_tree(recording):
        texts.append("The parents of the joints are unknown")
    if not isinstance(recording, DepthRecording):
        figures |= {"conventions": asdict(conventions_of(recording))}
    return {**figures, "warnings": ". ".join(texts)}
