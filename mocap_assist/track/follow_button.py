"""The button Track Live: it goes on until the recording ends, or Esc is pressed."""

from contextlib import suppress
from time import monotonic
from typing import Any

import bpy

from ..blender.last_press import note_press
from ..jobs.job import Job
from ..languages import translated
from ..runtime.solver_operator import in_background
from ..runtime.watch import CANCEL_TEXT
from ..runtime.watched_operator import WatchedOperator
from .following import read_following, watch_following, write_followed

STOP, FINISHING = "Stop", "Finishing the take"
ESC_ENDS = "Esc ends the take and creates the armature"
ESC_DISCARDS = "Esc discards the take"
BLOCKS = (
    "A script would block the window until the recording ends. Call the operator with"
    " INVOKE_DEFAULT, or use capture --follow."
)
LOOK_INTERVAL_S = 1.0 / 120.0
"""Seconds between two looks at the poses that were tracked. It bounds the delay of the body; a
shorter one takes more of Blender's time."""
MIN_DISCARD_S = 1.0
"""Seconds after the end of a take from which Esc discards it. It guards a take from a second
press of Esc that was meant to end it."""


def selected_scene(context: bpy.types.Context) -> bpy.types.Scene:
    """Return the scene: the recording is not in it yet."""
    return context.scene


def why_not_follow(context: bpy.types.Context) -> str:
    """Return an empty text: any scene can get the recording."""
    return ""


class FollowButton(WatchedOperator):
    """Mix in before bpy.types.Operator.

    The first Esc ends the take; while it finishes, another one discards it.
    """

    settings_group = "track_live"
    look_interval_s = LOOK_INTERVAL_S
    selected, why_not = selected_scene, why_not_follow
    read_scene, write_scene = read_following, write_followed
    open_view = watch_following
    _ended_at = float("inf")

    def prepare(self, context: bpy.types.Context) -> None:
        """Copy the settings of this button's panel, and those that it shares with Track."""
        super().prepare(context)
        self.copy_settings(context.scene.mocap_assist.track)

    def execute(self, context: bpy.types.Context) -> set[str]:
        if not in_background():  # nothing but the recording would end it
            self.report({"ERROR"}, translated(BLOCKS))
            note_press(self, sentence=BLOCKS)
            return {"CANCELLED"}
        return super().execute(context)

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        outcome = super().invoke(context, event)
        if outcome == {"RUNNING_MODAL"}:
            self._watch.ending, self._watch.button = ESC_ENDS, STOP
        return outcome

    def progress_of(self, job: Job[Any]) -> tuple[float, str]:
        """Return the progress of the take; it is endless until Esc."""
        if self._ended_at == float("inf"):
            return super().progress_of(job)
        with suppress(OSError):  # It is tried again at the next look.
            job.end_early()
        return 1.0, FINISHING

    def ends_early(self, job: Job[Any]) -> bool:
        """Let the first Esc end the take; a later one discards it."""
        if self._ended_at < float("inf"):
            return False
        self._note_end()
        return True

    def result_from_job(self, job: Job[Any]) -> Any:
        """Return the result of the job; one that ended by itself is guarded from Esc, too."""
        if self._ended_at == float("inf"):
            self._note_end()
        return super().result_from_job(job)

    def heeds_esc(self) -> bool:
        """Return whether Esc has an effect: not just after the end, see `MIN_DISCARD_S`."""
        is_running = self._ended_at == float("inf")
        return is_running or monotonic() - self._ended_at > MIN_DISCARD_S

    def _note_end(self) -> None:
        self._ended_at = monotonic()
        self._watch.ending, self._watch.button = ESC_DISCARDS, CANCEL_TEXT

    def draw(self, context: bpy.types.Context) -> None:
        """Draw nothing: a take cannot be recorded again with other settings."""
