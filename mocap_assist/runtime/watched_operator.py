"""A button whose solve shows previews, and may keep a partial result on Esc."""

import logging
from collections.abc import Callable, Generator, Iterable
from functools import partial
from typing import Any, ClassVar, Protocol

import bpy

from ...solvers.errors import MocapAssistError, SolveCancelled
from ..jobs.job import Job
from .solver_operator import SolverOperator

logger = logging.getLogger(__name__)


class PreviewDisplay(Protocol):
    """Display of the previews of a solve."""

    def show(
        self, scene: bpy.types.Scene, target: bpy.types.Object, previews: Iterable[Any]
    ) -> None:
        """Show new previews."""

    def close(self) -> None:
        """Remove the display."""


class WatchedOperator(SolverOperator):
    """Mix in like SolverOperator if `read_scene` returns a `PreviewSolve`."""

    open_view: ClassVar[Callable[..., PreviewDisplay | None]]
    """Return a view for a scene, subject and settings; None without previews."""
    rescue: ClassVar[Callable[..., Callable[[list[Any]], Any] | None]] = staticmethod(
        lambda scene, target, settings: None
    )
    """Return a function that makes a result of all previews on Esc.

    It is called with scene, subject and settings. None, the default, keeps no result.
    """
    _view: PreviewDisplay | None = None

    def _solve(self, solve: "partial[Any]") -> Generator[tuple[float, str], None, Any]:
        self._view = type(self).open_view(*self._read_arguments())
        try:
            return (yield from super()._solve(solve))
        finally:
            self._close_view()

    def show_previews(self, job: Job[Any]) -> None:
        """Show new previews; none if the animator has removed the subject."""
        if self._view is None:
            return
        try:
            self._view.show(*self._subject.find(), job.new_previews())
        except MocapAssistError:
            pass
        except Exception:  # from previews, handlers, files: the solve must continue
            logger.exception("The previews of this solve are switched off")
            self._close_view()

    def result_from_job(self, job: Job[Any]) -> Any:
        """Return the result of the job or, after Esc, its partial result."""
        self._close_view()
        if not job.cancelled:
            return super().result_from_job(job)
        try:
            rescue = type(self).rescue(*self._read_arguments())
            if rescue is None:
                raise SolveCancelled("Cancelled.")
            return rescue(job.all_previews())
        finally:
            job.tidy_up()

    def _close_view(self) -> None:
        """Close the view, and only log its errors: the result matters more."""
        view, self._view = self._view, None
        try:
            if view is not None:
                view.close()
        except Exception:
            logger.exception("The previews of a solve could not be removed")
