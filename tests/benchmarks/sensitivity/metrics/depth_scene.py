"""The actor and the floor in depth images of a room."""

from collections.abc import Callable
from typing import Any

import numpy as np

from solvers.depth_scene import Camera, DepthRecording, find_actor
from tests.fixtures.depth_rooms import in_room, room, tilted

from ...depth.depth_sequences import Sequence, sequence
from ..takes import missed_or_false

TAKE = "walk_side"
FRAMES = range(0, 75, 5)
FRAME_RATE_HZ = 6.0
WALL_M = 5.5


def prepare() -> dict[str, Any]:
    """Put a room around a walking actor, with sensor noise."""
    return {"in_a_room": _in_a_room(sequence(TAKE))}


def measure(in_a_room: tuple[Camera, Any, Any, float]) -> dict[str, float]:
    """Pixels that are wrong, and the error of the floor."""
    camera, images, actor, height = in_a_room
    result = find_actor(_recording(camera, images))
    masks = np.stack([result.recording.frame(frame) > 0.0 for frame in range(len(images))])
    floor = 1.0 if result.floor is None else abs(result.floor.height - height)
    return {
        "pixels missed or false %": 1.0 + missed_or_false(masks, actor),
        "height of the floor mm": 1.0 + 1000.0 * floor,
    }


def _recording(camera: Camera, images: Any) -> DepthRecording:
    read: Callable[[int], Any] = images.__getitem__
    return DepthRecording(camera, len(images), FRAME_RATE_HZ, read)


def _in_a_room(one: Sequence) -> tuple[Camera, Any, Any, float]:
    """Add a floor below, a wall behind and a cupboard."""
    camera = one.depth.camera
    actor = np.stack([one.depth.frame(frame) for frame in FRAMES])
    lowest = [
        camera.back_project(image)[image > 0.0, 1].max() for image in actor if image.any()
    ]
    height = float(np.quantile(lowest, 0.9)) + 0.01
    empty = room(camera, tilted(0.0), height, WALL_M)
    empty[40:200, 5:60] = np.minimum(empty[40:200, 5:60], 3.0)
    alone = _recording(camera, actor)
    filled = in_room(alone, empty, 0.0015)
    images = np.stack([filled.frame(frame) for frame in range(len(actor))])
    return camera, images, actor > 0.0, height
