"""The one solve that runs beside Blender's work: shown while it runs, ended with its file."""

import logging
from collections.abc import Callable, Iterable
from typing import Any, Protocol

import bpy
from bpy.app import handlers

from .jobs.job import Job
from .scene.view_drawing import redraw

logger = logging.getLogger(__name__)

BETWEEN_LOOKS = 0.1  # seconds
BUSY = (
    "Another solve is running. Let it end, or press Esc in the window in which it was started."
)

_on: list["Watch"] = []


class View(Protocol):
    """Shows what a solve shows meanwhile, in whatever way."""

    def look(
        self, scene: bpy.types.Scene, thing: bpy.types.Object, shown: Iterable[Any]
    ) -> None:
        """Show what is new."""

    def close(self) -> None:
        """Show nothing more."""


class Watch:
    """A job, and what the status bar and the sidebar say about it until it ends."""

    def __init__(
        self, context: bpy.types.Context, solve: Callable[..., Any], owner: str
    ) -> None:
        """Start to solve; `owner` names the panel that tells how far it is."""
        self.job: Job[Any] = Job(solve)
        self.view: View | None = None
        manager = context.window_manager
        manager.mocap_assist_job.owner = owner
        self._timer = manager.event_timer_add(BETWEEN_LOOKS, window=context.window)
        _on.append(self)
        self.show(context, 0.0, "Starting")

    def go_on(self, solve: Callable[..., Any]) -> None:
        """Let another job follow the one that has ended."""
        self.job = Job(solve)

    @property
    def is_on(self) -> bool:
        """Whether it is still shown; not after another file was loaded."""
        return self in _on

    def show(self, context: bpy.types.Context, fraction: float, message: str) -> None:
        """Say how far the job is."""
        state = context.window_manager.mocap_assist_job
        state.running, state.fraction, state.message = True, fraction, message
        context.workspace.status_text_set(f"{message} {fraction:.0%}   Esc: cancel")
        redraw(context)

    def end(self, context: bpy.types.Context) -> None:
        """Show nothing more."""
        _on.remove(self)
        context.window_manager.event_timer_remove(self._timer)
        context.window_manager.mocap_assist_job.running = False
        context.workspace.status_text_set(None)
        self.close_view()
        redraw(context)

    def close_view(self) -> None:
        """Look on no longer, whatever goes wrong with that: the result is worth more."""
        view, self.view = self.view, None
        try:
            if view is not None:
                view.close()
        except Exception:
            logger.exception("What was shown of a solve could not be put away")

    def abandon(self, context: bpy.types.Context) -> None:
        """End the job too, whatever it has found."""
        self.job.cancel()
        self.job.tidy_up()
        self.end(context)


def why_busy() -> str:
    """Return why no other solve can start, or nothing."""
    return BUSY if _on else ""


@handlers.persistent
def _abandon_all(*_: object) -> None:
    while _on:
        _on[-1].abandon(bpy.context)


@handlers.persistent
def _nothing_runs(*_: object) -> None:
    """A file that was saved while a solve ran says that it still does."""
    for manager in bpy.data.window_managers:
        manager.mocap_assist_job.running = False


def register() -> None:
    """End a solve before the file that it works on is replaced."""
    handlers.load_pre.append(_abandon_all)
    handlers.load_post.append(_nothing_runs)


def unregister() -> None:
    """End it with the extension, too: Blender forgets the button without a word."""
    _abandon_all()
    handlers.load_post.remove(_nothing_runs)
    handlers.load_pre.remove(_abandon_all)
