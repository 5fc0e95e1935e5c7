"""Depth images of a skinned body: joints with a given body, and the actor found in a room."""

from collections.abc import Callable
from typing import Any

import numpy as np

from solvers.depth_scene import Camera, DepthRecording, find_actor
from solvers.depth_tracking import capture
from tests.fixtures.depth_rooms import in_room, room, tilted

from ...depth.depth_sequences import Sequence, sequence
from ..takes import missed_or_false, point_error

TAKES = {"walk_side": range(20, 40, 4)}
"""Frames of each take that are tracked: eight a second, of every second row and column."""
ROOM_FRAMES = range(0, 75, 5)
ROOM_TAKE = "walk_side"
CAMERA_TILT_DEG = 8.0
WALL_M = 5.5
ACCURATE_M = 0.1
"""Joints within it count as found, as in the benchmark of depth tracking."""


def prepare() -> dict[str, Any]:
    """Choose frames of a take, and put a room around a walking actor, with sensor noise."""
    tracked = {}
    for name, frames in TAKES.items():
        one = sequence(name)
        images = np.stack([one.depth.frame(frame)[::2, ::2] for frame in frames])
        tracked[name] = one.depth.camera.every(2), images, one.usual, one.joints[list(frames)]
    return {"tracked": tracked, "in_a_room": _in_a_room(sequence(ROOM_TAKE))}


def measure(
    tracked: dict[str, tuple[Any, ...]], in_a_room: tuple[Camera, Any, Any, float]
) -> dict[str, float]:
    """Error of the joints, flags that are wrong, and pixels and floor that are wrong."""
    figures = {}
    for name, (camera, images, body, truth) in tracked.items():
        found = capture(_recording(camera, images, 7.5), body)
        positions = found.joints.positions
        wrong = np.linalg.norm(positions - truth, axis=-1) > ACCURATE_M
        jerk = np.linalg.norm(np.diff(positions, n=2, axis=0), axis=-1)
        figures[f"{name}: mm"] = point_error(positions, truth)
        figures[f"{name}: joints off %"] = 1.0 + float(100.0 * wrong.mean())
        figures[f"{name}: flags missed or false %"] = 1.0 + missed_or_false(
            found.low_confidence, wrong
        )
        figures[f"{name}: second difference mm"] = float(1000.0 * jerk.mean())
    camera, images, actor, height = in_a_room
    result = find_actor(_recording(camera, images, 10.0))
    masks = np.stack([result.recording.frame(frame) > 0.0 for frame in range(len(images))])
    figures["room: pixels missed or false %"] = 1.0 + missed_or_false(masks, actor)
    floor = 1.0 if result.floor is None else abs(result.floor.height - height)
    figures["room: height of the floor mm"] = 1.0 + 1000.0 * floor
    return figures


def _recording(camera: Camera, images: Any, frame_rate: float) -> DepthRecording:
    read: Callable[[int], Any] = images.__getitem__
    return DepthRecording(camera, len(images), frame_rate, read)


def _in_a_room(one: Sequence) -> tuple[Camera, Any, Any, float]:
    """Add a floor below, a wall behind and a cupboard."""
    camera = one.depth.camera
    actor = np.stack([one.depth.frame(frame) for frame in ROOM_FRAMES])
    lowest = [
        camera.back_project(image)[image > 0.0, 1].max() for image in actor if image.any()
    ]
    height = float(np.quantile(lowest, 0.9)) + 0.01
    empty = room(camera, tilted(0.0), height, WALL_M)
    empty[40:200, 5:60] = np.minimum(empty[40:200, 5:60], 3.0)
    alone = _recording(camera, actor, 10.0)
    filled = in_room(alone, empty, 0.0015)
    images = np.stack([filled.frame(frame) for frame in range(len(actor))])
    return camera, images, actor > 0.0, height
