"""Poses on their way from a solve to whoever looks on."""

from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

from ...solvers.depth_scene import Floor
from ...solvers.depth_tracking.body import BodyModel
from ...solvers.depth_tracking.tracking import PosePreview

Show = Callable[[Any], None]


def unseen(thing: Any) -> None:
    """The `Show` of a solve on which nobody looks."""


class Place(NamedTuple):
    """Shown first: the floor on which the actor is."""

    floor: Floor | None


class Glimpses:
    """Shows poses; a body goes along only where it is not the one before."""

    def __init__(self, show: Show) -> None:
        self._show = show
        self._body: BodyModel | None = None

    def __call__(self, found: PosePreview) -> None:
        """Show a pose."""
        if found.body is not self._body:
            self._show(found.body)
            self._body = found.body
        self._show((found.frame, found.pose, found.quality))


class Onlooker:
    """Understands what was shown."""

    def __init__(self) -> None:
        self.floor: Floor | None = None
        self._body: BodyModel | None = None

    def poses(self, shown: Iterable[Any]) -> Iterator[PosePreview]:
        """Return the poses in what was shown since the last time; their body is shared."""
        for thing in shown:
            if isinstance(thing, Place):
                self.floor = thing.floor
            elif isinstance(thing, BodyModel):
                self._body = thing
            elif self._body is not None:
                yield PosePreview(self._body, *thing)
