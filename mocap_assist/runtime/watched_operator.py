"""A button whose solve can be watched, and of which something may be kept on Esc."""

import logging
from collections.abc import Callable, Generator, Iterable
from functools import partial
from typing import Any, ClassVar, Protocol

import bpy

from ...solvers.errors import MocapAssistError, SolveCancelled
from ..jobs.job import Job
from .solver_operator import SolverOperator

logger = logging.getLogger(__name__)


class View(Protocol):
    """Shows what a solve shows meanwhile, in whatever way."""

    def look(
        self, scene: bpy.types.Scene, thing: bpy.types.Object, shown: Iterable[Any]
    ) -> None:
        """Show what is new."""

    def close(self) -> None:
        """Show nothing more."""


class WatchedOperator(SolverOperator):
    """Mix in as SolverOperator, where `read_scene` returns a `PreviewSolve` solve."""

    open_view: ClassVar[Callable[..., View | None]]
    """From scene, subject and settings; None if nobody wants to look on."""
    rescue: ClassVar[Callable[..., Callable[[list[Any]], Any] | None]] = staticmethod(
        lambda scene, thing, settings: None
    )
    """From scene, subject and settings: what makes a result of all that was shown on Esc.

    None, as here, where nothing is kept.
    """
    _view: View | None = None

    def _solve(self, solve: "partial[Any]") -> Generator[tuple[float, str], None, Any]:
        self._view = type(self).open_view(*self._read_arguments())
        try:
            return (yield from super()._solve(solve))
        finally:
            self._close_view()

    def look(self, job: Job[Any]) -> None:
        """Show what is new; nothing where the animator has removed what is looked at."""
        if self._view is None:
            return
        try:
            self._view.look(*self._subject.find(), job.shown())
        except MocapAssistError:
            pass
        except Exception:  # from what is shown, handlers, files: the solve must go on
            logger.exception("Nothing more is shown of this solve")
            self._close_view()

    def answer(self, job: Job[Any]) -> Any:
        """Return what the job has solved or, after Esc, what is kept of it."""
        self._close_view()
        if not job.cancelled:
            return super().answer(job)
        try:
            rescue = type(self).rescue(*self._read_arguments())
            if rescue is None:
                raise SolveCancelled("Cancelled.")
            return rescue(job.all_shown())
        finally:
            job.tidy_up()

    def _close_view(self) -> None:
        """Look on no longer, whatever goes wrong with that: the result is worth more."""
        view, self._view = self._view, None
        try:
            if view is not None:
                view.close()
        except Exception:
            logger.exception("What was shown of a solve could not be put away")
