"""A button whose solve can be watched, and of which something may be kept on Esc."""

import logging
from collections.abc import Callable
from typing import Any, ClassVar

import bpy

from ..solvers.errors import MocapAssistError, SolveCancelled
from .jobs.job import Job
from .solver_operator import SolverOperator
from .watch import View

logger = logging.getLogger(__name__)


class WatchedOperator(SolverOperator):
    """Mix in as SolverOperator, where `read_scene` returns a `Showing` solve."""

    open_view: ClassVar[Callable[..., View | None]]
    """From scene, subject and settings; None if nobody wants to look on."""
    rescue: ClassVar[Callable[..., Callable[[list[Any]], Any] | None]] = staticmethod(
        lambda scene, thing, settings: None
    )
    """From scene, subject and settings: what makes a result of all that was shown on Esc.

    None, as here, where nothing is kept.
    """

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        outcome = super().invoke(context, event)
        if outcome == {"RUNNING_MODAL"}:
            asked = (*self._subject.find(), self.settings())
            self._watch.view = type(self).open_view(*asked)
        return outcome

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        watch = self._watch
        if watch.is_on and event.type == "TIMER" and watch.view is not None:
            self._look(watch.view, watch.job)
        return super().modal(context, event)

    def _look(self, view: View, job: Job[Any]) -> None:
        """Show what is new; nothing where the animator has removed what is looked at."""
        try:
            view.look(*self._subject.find(), job.shown())
        except MocapAssistError:
            pass
        except Exception:  # from what is shown, handlers, files: the solve must go on
            logger.exception("Nothing more is shown of this solve")
            self._watch.close_view()

    def _answer(self, job: Job[Any]) -> Any:
        if not job.cancelled:
            return super()._answer(job)
        try:
            rescue = type(self).rescue(*self._subject.find(), self.settings())
            if rescue is None:
                raise SolveCancelled("Cancelled.")
            return rescue(job.all_shown())
        finally:
            job.tidy_up()
