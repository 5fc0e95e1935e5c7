"""Separate the actor from the room in each image as it arrives."""

from dataclasses import replace

import numpy as np

from ..arrays import Array
from .actor import Actor
from .foreground import ActorImages
from .people import MAX_GAP_S
from .recording import DepthImage, DepthRecording


class CausalActor:
    """Cuts out the actor of a recording in the images after it, by those before each.

    Floor, room and method are those that `find_actor` found. The actor is the body next to the
    last position. After a second without one, it is the body with the largest surface: the
    actor may return elsewhere.

    Parameters
    ----------
    actor : Actor
        Of the first images.
    from_start : bool
        Whether these first images are cut out again, before those after them.
    """

    def __init__(self, actor: Actor, *, from_start: bool = False) -> None:
        images = actor.recording.read_depth
        assert isinstance(images, ActorImages) and images.trajectory is not None
        self._images, self._camera = images, actor.recording.camera
        self._frame_rate = actor.recording.frame_rate
        self._position: Array | None = images.trajectory[actor.visible][0 if from_start else -1]
        self._n_missing = 0

    def cut_out(self, depth: DepthImage) -> DepthImage:
        """Return the actor's depth (height, width) in the next image, meters; 0 elsewhere."""
        image = DepthRecording(self._camera, 1, self._frame_rate, lambda _: depth)
        trajectory = None if self._position is None else self._position[np.newaxis]
        actor: DepthImage = replace(self._images, recording=image, trajectory=trajectory)(0)
        if actor.any():
            self._position = np.median(self._camera.back_project(actor)[actor > 0.0], axis=0)
            self._n_missing = 0
            return actor
        self._n_missing += 1
        if self._n_missing > MAX_GAP_S * self._frame_rate:
            self._position = None
        return actor
