"""Send pose previews from a solve, and receive them."""

from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple

from ...solvers.depth_scene import FloorPlane
from ...solvers.depth_tracking.body import BodyModel
from ...solvers.depth_tracking.tracking import PosePreview

Show = Callable[[Any], None]


def no_preview(preview: Any) -> None:
    """Ignore a preview; the default of solves."""


ObjectNumber = tuple[str, int, str]
"""Kind, session UID and name of an object, as in a `BlockReference`."""


class FloorPreview(NamedTuple):
    """First preview: the floor under the actor, and the points of the other cameras."""

    floor: FloorPlane | None
    others: tuple[ObjectNumber, ...] = ()


class PosePreviewSender:
    """Sends poses; sends a body only when it changes."""

    def __init__(self, show: Show) -> None:
        self._show = show
        self._body: BodyModel | None = None

    def __call__(self, pose: PosePreview) -> None:
        """Send a pose."""
        if pose.body is not self._body:
            self._show(pose.body)
            self._body = pose.body
        self._show((pose.frame, pose.pose, pose.quality))


class PosePreviewReceiver:
    """Rebuilds poses from the previews of a sender."""

    def __init__(self) -> None:
        self.floor: FloorPlane | None = None
        self.others: tuple[ObjectNumber, ...] = ()
        self._body: BodyModel | None = None

    def poses(self, previews: Iterable[Any]) -> Iterator[PosePreview]:
        """Yield the poses of new previews; they share a body."""
        for preview in previews:
            if isinstance(preview, FloorPreview):
                self.floor, self.others = preview
            elif isinstance(preview, BodyModel):
                self._body = preview
            elif self._body is not None:
                yield PosePreview(self._body, *preview)
