"""Track several bodies in one direction, with one depth buffer."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Integers
from ...depth_scene import level_distances
from ...progress import Progress
from ..capturing import Pass, PassTracker, TrackingContext
from .shared_images import REACH_M, SharedImages


def track_together(
    people: Sequence[TrackingContext],
    images: SharedImages,
    order: Sequence[int],
    starts: Sequence[Array | None],
    progress: Progress,
) -> list[Pass]:
    """Track the bodies of several people frame by frame, each with the pixels it owns.

    In each frame the bodies share the pixels by their expected poses. They are tracked from the
    nearest to the farthest; each tracked pose replaces the expected one. A hidden body moves
    as its center is expected to. A person who is absent is detected after entering.

    Parameters
    ----------
    people : sequence of TrackingContext
        Their recordings are replaced by the pixels that each owns.
    images : SharedImages
    order : sequence of int
        Frames, ascending or descending.
    starts : sequence of shape (36,) arrays, or None
        Pose of each person near the first frame.
    progress : Progress
    """
    together = _Together(people, images, starts)
    for done, frame in enumerate(order):
        together.track(frame)
        progress((done + 1) / len(order), "Tracking")
    return together.result()


class _Together:
    """The trackers of all people, and the pixels that each owns in the current frame."""

    def __init__(
        self,
        people: Sequence[TrackingContext],
        images: SharedImages,
        starts: Sequence[Array | None],
    ) -> None:
        self._images = images
        self._owners: Integers = np.zeros((0, 0), dtype=np.intp)
        self._trackers = [
            PassTracker(
                replace(person, depth=images.recording_of(index, lambda _: self._owners)), start
            )
            for index, (person, start) in enumerate(zip(people, starts, strict=True))
        ]
        self._last_frame: int | None = None
        self._is_hidden = [False] * len(people)

    def track(self, frame: int) -> None:
        """Track all people in the next frame, from the nearest to the farthest."""
        centers = self._images.centers[:, frame]
        present = np.isfinite(centers).all(axis=-1)
        for person, tracker in enumerate(self._trackers):
            if self._is_hidden[person] and self._last_frame is not None:
                tracker.move(self._level_step(person, frame))
            if not present[person] or self._is_lost(person, centers[person]):
                tracker.forget()
        poses = [tracker.expected for tracker in self._trackers]
        for person in self._front_to_back(poses, centers, present):
            self._owners = self._images.owners(frame, poses)
            self._is_hidden[person] = not self._trackers[person].track(frame)
            poses[person] = self._trackers[person].last
        self._last_frame = frame

    def _is_lost(self, person: int, center: Array) -> bool:
        """Whether a hidden body is out of reach of where the person is expected."""
        last = self._trackers[person].last
        if not self._is_hidden[person] or last is None:
            return False
        distance = level_distances(last[np.newaxis, :3], center[np.newaxis], self._images.up)
        return bool(distance[0, 0] > REACH_M)

    def _level_step(self, person: int, frame: int) -> Array:
        """Return the horizontal step of a center since the last frame, (3,) meters.

        Its height is that of the visible part, which changes while a person is being hidden.
        """
        centers, up = self._images.centers[person], self._images.up
        step = np.nan_to_num(centers[frame] - centers[self._last_frame])
        level: Array = step - (step @ up) * up
        return level

    @staticmethod
    def _front_to_back(
        poses: Sequence[Array | None], centers: Array, present: NDArray[np.bool_]
    ) -> list[int]:
        distances = [
            center[2] if pose is None else pose[2]
            for pose, center in zip(poses, centers, strict=True)
        ]
        return sorted(np.flatnonzero(present).tolist(), key=lambda person: distances[person])

    def result(self) -> list[Pass]:
        """Return what was tracked of each person."""
        return [tracker.result() for tracker in self._trackers]
