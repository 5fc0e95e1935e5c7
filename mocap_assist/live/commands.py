"""What Blender does on each gesture. Whoever has a library connects it here.

`LIBRARY` holds the three functions of the library; `connect_library` puts others in their
place. Each returns the sentence that is shown. Zoom and turn move the 3D Views of the window
in which Listen was pressed.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import bpy

from ...solvers.motion import JointRecording
from ...solvers.retrieval.gesture_events import Gesture, GestureEvent
from ..scene.view_control import turn_views, zoom_views

NO_LIBRARY = "Right hand up. There is no library to show yet."
NO_PAGES = "A wave. There is no library to page yet."
STARTED = "Perform what you search for, then clap."
VIEWS = (Gesture.ZOOM, Gesture.TURN)

_performed: list[JointRecording] = []


@dataclass(frozen=True)
class Library:
    """What the library can be told to do."""

    show: Callable[[bpy.types.Context], str]
    page: Callable[[bpy.types.Context, int], str]
    """By 1 (the next page) or -1."""
    search: Callable[[bpy.types.Context, JointRecording], str]
    """For a performance."""


def last_performance() -> JointRecording | None:
    """Return what was performed last between two claps, until Blender is closed."""
    return _performed[-1] if _performed else None


def obey(context: bpy.types.Context, event: GestureEvent) -> str:
    """Do what a gesture asks for; return the sentence to show."""
    gesture = event.gesture
    if gesture is Gesture.HAND_UP:
        return LIBRARY[-1].show(context)
    if gesture in {Gesture.PAGE_NEXT, Gesture.PAGE_BACK}:
        return LIBRARY[-1].page(context, 1 if gesture is Gesture.PAGE_NEXT else -1)
    if gesture is Gesture.ZOOM:
        return zoom_views(context.window, event.amount)
    if gesture is Gesture.TURN:
        return turn_views(context.window, event.amount)
    return STARTED if gesture is Gesture.CAPTURE_START else ""


def obey_all(context: bpy.types.Context, events: Sequence[GestureEvent]) -> str:
    """Do what gestures ask for, in their order; return the last sentence there is."""
    said = [obey(context, event) for event in events]
    return next((sentence for sentence in reversed(said) if sentence), "")


def search_for(context: bpy.types.Context, query: JointRecording) -> str:
    """Keep a performance, and search for it; return the sentence to show."""
    _performed[:] = [query]
    return LIBRARY[-1].search(context, query)


def connect_library(library: Library) -> None:
    """Let gestures reach a library."""
    LIBRARY[:] = [library]


def _not_shown(context: bpy.types.Context) -> str:
    return NO_LIBRARY


def _not_paged(context: bpy.types.Context, step: int) -> str:
    return NO_PAGES


def _not_searched(context: bpy.types.Context, query: JointRecording) -> str:
    return (
        f"Captured {query.n_frames} frames at {query.frame_rate:g} Hz. There is no library to"
        " search yet."
    )


LIBRARY = [Library(_not_shown, _not_paged, _not_searched)]
"""The one that gestures reach."""
