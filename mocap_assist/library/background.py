"""Index in the background: the window stays responsive; only one runs at a time."""

from collections.abc import Callable

import bpy

from ..blender.redrawing import redraw
from ..jobs.job import Job
from ..runtime.file_change_handlers import ends_with_file
from .solve_indexing import Indexed

RUNNING = "The library is being built. Wait until it is done, or press Esc."

_on: list["Indexing"] = []


class Indexing:
    """A running Index, and its progress in the sidebar."""

    def __init__(self, context: bpy.types.Context, solve: Callable[..., Indexed]) -> None:
        self.job: Job[Indexed] = Job(solve)
        _on.append(self)
        self.show(context)

    @property
    def is_on(self) -> bool:
        """Whether it still runs; not after another file was loaded."""
        return self in _on

    def show(self, context: bpy.types.Context) -> None:
        """Show the progress."""
        state = context.window_manager.mocap_assist_indexing
        fraction, message = self.job.progress()
        changed = (state.running, state.fraction, state.message) != (True, fraction, message)
        if changed:
            state.running, state.fraction, state.message = True, fraction, message
            redraw(context)

    def end(self, context: bpy.types.Context, message: str) -> None:
        """Replace the progress by the result."""
        _on.remove(self)
        state = context.window_manager.mocap_assist_indexing
        state.running, state.report = False, message
        redraw(context)

    def abandon(self, context: bpy.types.Context) -> None:
        """End the job too; what it has written stays."""
        self.job.cancel()
        self.job.tidy_up()
        self.end(context, "")


def why_indexing() -> str:
    """Return why no other Index can start, or an empty text."""
    return RUNNING if _on else ""


def message_of(indexed: Indexed) -> str:
    """Return a sentence about what was done."""
    n_refused = len(indexed.refused)
    parts = [
        *[f"{indexed.n_added} read"] * bool(indexed.n_added),
        *[f"{indexed.n_kept} unchanged"] * bool(indexed.n_kept),
        *[f"{indexed.n_removed} removed"] * bool(indexed.n_removed),
        *[f"{n_refused} unusable"] * bool(n_refused),
    ]
    clips = "1 clip" if indexed.n_clips == 1 else f"{indexed.n_clips} clips"
    done = ", ".join(parts) or "nothing to do"
    return f"The library has {clips}: {done}."


register, unregister = ends_with_file(_on, "mocap_assist_indexing")
