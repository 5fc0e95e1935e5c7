"""Assign the samples of a recording to scene frames."""

from math import ceil
from typing import NamedTuple

import bpy
import numpy as np

from ...solvers.arrays import Array
from ...solvers.settings import Choice

RATE_ROUNDING = 1e-6
"""Relative difference of two frame rates that is only rounding in single precision."""


class FrameRate(Choice):
    """Conversion of recordings with another frame rate than the scene."""

    AUTO = (
        "auto",
        "Adopt the recording's rate and length if nothing else is animated; otherwise resample",
    )
    SCALE = "scale FPS", "Keep every sample at its time; keys may lie between frames"
    RESAMPLE = "resample to scene FPS", "Keep the timing and put one key on each scene frame"
    UPDATE = "update scene FPS", "Set the scene frame rate to that of the first recording"
    ONE = (
        "one sample a frame",
        "Put each sample on its own frame; changes the playback speed",
        "One Sample per Frame",
    )


class Timing(NamedTuple):
    """Scene frames of samples."""

    start: float
    """Scene frame of the first sample."""
    step: float
    """Scene frames from one sample to the next."""

    def frames(self, n_frames: int) -> Array:
        """Return the scene frame of each sample."""
        return self.start + self.step * np.arange(n_frames)


def scene_rate(scene: bpy.types.Scene) -> float:
    """Return the scene's frames per second."""
    rate = scene.render.fps / scene.render.fps_base
    rounded = round(rate)
    return float(rounded) if abs(rate - rounded) < RATE_ROUNDING * rate else rate


def set_scene_rate(scene: bpy.types.Scene, frame_rate: float) -> None:
    """Set the frame rate of the scene, which may be fractional."""
    scene.render.fps = max(round(frame_rate), 1)
    scene.render.fps_base = scene.render.fps / frame_rate


def timing(scene: bpy.types.Scene, choice: FrameRate, frame_rate: float, start: int) -> Timing:
    """Return the scene frames of samples at `frame_rate`; the scene is not changed."""
    step = scene_rate(scene) / frame_rate
    if choice in {FrameRate.UPDATE, FrameRate.ONE} or is_same_rate(step, 1.0):
        step = 1.0
    return Timing(float(start), step)


def is_same_rate(one: float, other: float) -> bool:
    """Whether two rates differ by rounding only."""
    return abs(one - other) < RATE_ROUNDING * other


def set_duration(scene: bpy.types.Scene, first_frame: int, last_frame: float) -> None:
    """Set the scene's range; a current frame outside moves to the first one."""
    scene.frame_start, scene.frame_end = first_frame, ceil(last_frame - RATE_ROUNDING)
    if not scene.frame_start <= scene.frame_current <= scene.frame_end:
        scene.frame_set(scene.frame_start)


def extend_duration(scene: bpy.types.Scene, last_frame: float) -> None:
    """Let the scene last until a frame; it is never made shorter."""
    scene.frame_end = max(scene.frame_end, ceil(last_frame - RATE_ROUNDING))
