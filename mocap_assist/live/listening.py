"""The listening session, which runs next to Blender's work, and its display."""

import logging
from typing import Any

import bpy
from bpy.app import handlers

from ...solvers.gestures import Mode
from ...solvers.recordings.streams import (
    ListenerState,
    StreamListener,
    StreamProtocol,
    allowed_networks,
)
from ...solvers.workflows import LiveSession, SessionUpdate
from ..blender.redrawing import redraw
from ..languages import translated
from ..overlays.live_figure import LiveFigure
from ..overlays.view_drawing import Color
from .commands import library_news, run_commands, search_for
from .stream_state import issue_text

logger = logging.getLogger(__name__)

TIMER_INTERVAL_S = 1.0 / 30.0
"""Seconds between two looks at the socket. It bounds the delay to a frame of 30 Hz."""
WAITING = "No data yet. Start your tracker."
MODES = {
    Mode.IDLE: "Clap to perform, raise the right hand for the library",
    Mode.BROWSING: "Wave to page, left hand up to search with this clip, clap to perform",
    Mode.CAPTURING: "Performing; clap to end",
}

_on: list["Listening"] = []


class Listening:
    """A socket, a session, the figure of the actor; shown in the status bar until it ends.

    Raises
    ------
    InvalidSettingError
        The port is taken.
    """

    def __init__(
        self,
        context: bpy.types.Context,
        port: int,
        protocol: StreamProtocol,
        allowed: str,
        person: int,
        color: Color,
        width: float,
    ) -> None:
        self.listener = StreamListener(port, protocol, allowed_networks(allowed), person=person)
        self.session = LiveSession()
        self.message = ""
        library_news()  # of an earlier session
        self._shown_texts: list[str] = []
        self.figure = LiveFigure(color, width)
        manager = context.window_manager
        self._timer = manager.event_timer_add(TIMER_INTERVAL_S, window=context.window)
        _on.append(self)
        self._show(context)

    @property
    def is_on(self) -> bool:
        """Whether it still listens; not after another file was loaded."""
        return self in _on

    @property
    def stream_state(self) -> ListenerState:
        """State of the stream."""
        return self.listener.state

    def state(self) -> str:
        """Return the available commands in a few words."""
        return MODES[self.session.mode] if self.stream_state.counts.frames else WAITING

    def poll(self, context: bpy.types.Context) -> None:
        """Receive new frames, execute their commands, and show the result."""
        frames = self.listener.poll()
        self.message = library_news() or self.message
        if frames:
            self._perform(context, self.session.add(frames))
        if frames or self._texts() != self._shown_texts:
            self._show(context)

    def _perform(self, context: bpy.types.Context, news: SessionUpdate) -> None:
        """Show the actor, and execute the commands of gestures."""
        if news.frame is not None:
            self.figure.show(news.frame)
        message = run_commands(context, news.events)
        if news.query is not None:
            message = search_for(context, news.query)
        self.message = news.message or message or self.message

    def end(self, context: bpy.types.Context) -> None:
        """Stop listening; a second call has no effect."""
        if not self.is_on:
            return
        _on.remove(self)
        counts = self.listener.counts
        self.listener.close()
        self.figure.remove()
        context.window_manager.event_timer_remove(self._timer)
        context.workspace.status_text_set(None)
        logger.info("Listened to %d frames, dropped %d", counts.frames, counts.dropped)
        redraw(context, "VIEW_3D")

    def _texts(self) -> list[str]:
        """Return the texts of the status bar."""
        texts = (self.message, self.state(), issue_text(self.stream_state))
        return [text for text in texts if text]

    def _show(self, context: bpy.types.Context) -> None:
        self._shown_texts = self._texts()
        shown = [*map(translated, self._shown_texts), translated("Esc: stop listening")]
        context.workspace.status_text_set("   ".join(shown))
        redraw(context, "VIEW_3D")


def current() -> Listening | None:
    """Return the running session, if any."""
    return _on[-1] if _on else None


@handlers.persistent
def _end_all(*_: Any) -> None:
    while _on:
        _on[-1].end(bpy.context)


def register() -> None:
    """End before the file is replaced."""
    handlers.load_pre.append(_end_all)


def unregister() -> None:
    """End with the extension, too."""
    _end_all()
    handlers.load_pre.remove(_end_all)
