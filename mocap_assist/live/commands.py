"""Commands that Blender runs on gestures.

Each function returns the message to show. Zoom and turn affect the 3D Views of the window of
the button.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import bpy

from ...solvers.gestures import Gesture, GestureEvent
from ...solvers.motion import JointRecording
from ..find_similar.performing import (
    new_message,
    search_with,
    search_with_shown,
    show_all,
    show_library,
    show_next_match,
)
from ..overlays.view_control import rotate_views, zoom_views

STARTED = "Perform what you search for, then clap."


@dataclass(frozen=True)
class Library:
    """Commands for the library."""

    show: Callable[[bpy.types.Context], str]
    page: Callable[[bpy.types.Context, int], str]
    """By 1 (the next page) or -1."""
    search: Callable[[bpy.types.Context, JointRecording], str]
    """For a performance."""
    show_all: Callable[[bpy.types.Context], str]
    choose: Callable[[bpy.types.Context], str]
    """Search with the clip that is shown."""
    news: Callable[[], str]
    """Message about what has ended in the background since the last call."""


LIBRARY = Library(
    show_library, show_next_match, search_with, show_all, search_with_shown, new_message
)
"""The one that gestures reach."""


def library_news() -> str:
    """Return the message about what the library has done in the background, if any."""
    return LIBRARY.news()


def run_command(context: bpy.types.Context, event: GestureEvent) -> str:
    """Execute the command of a gesture; return the message to show."""
    gesture = event.gesture
    if gesture is Gesture.HAND_UP:
        return LIBRARY.show(context)
    if gesture is Gesture.HAND_UP_AGAIN:
        return LIBRARY.show_all(context)
    if gesture is Gesture.LEFT_HAND_UP:
        return LIBRARY.choose(context)
    if gesture in {Gesture.PAGE_NEXT, Gesture.PAGE_BACK}:
        return LIBRARY.page(context, 1 if gesture is Gesture.PAGE_NEXT else -1)
    if gesture is Gesture.ZOOM:
        return zoom_views(context.window, event.amount)
    if gesture is Gesture.TURN:
        return rotate_views(context.window, event.amount)
    return STARTED if gesture is Gesture.CAPTURE_START else ""


def run_commands(context: bpy.types.Context, events: Sequence[GestureEvent]) -> str:
    """Execute the commands of gestures in order; return the last message."""
    messages = [run_command(context, event) for event in events]
    return next((sentence for sentence in reversed(messages) if sentence), "")


def search_for(context: bpy.types.Context, query: JointRecording) -> str:
    """Search for a performance; return the sentence to show."""
    return LIBRARY.search(context, query)
