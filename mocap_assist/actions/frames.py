"""Choose the frames at which an action is read: a range, on the grid of its keys."""

from collections.abc import Sequence
from typing import NamedTuple

import bpy
import numpy as np

from ...solvers.arrays import Array
from ...solvers.errors import InvalidMotionError
from ...solvers.settings import Choice
from ..scene.played_time import played_time
from .curves import ON_FRAME, Channel

MAX_RECORDED_STEP_FRAMES = 2.5
"""Frames between keys up to which a take counts as recorded. It guards actions that an animator
keyed by hand: they are read on every frame."""
MIN_GRID_KEYS_FRACTION = 0.9
"""Fraction of keys of each curve that must be on the grid. It guards keys that an exporter adds
between frames."""
MAX_GRID_OFFSET_STEPS = 0.05
"""Fraction of a step by which a key is on the grid. It guards against rounding of times to
milliseconds: at 30 Hz it is 1.7 ms."""
MIN_FILLED_FRACTION = 0.5
"""Fraction of the grid that has keys. It guards takes of exporters that add keys between frames
where motion is fast; these do not make the grid finer."""
MAX_FRAMES_PER_KEY = 20
"""Frames per key, a ratio: a range with more, and with more frames than the next, is no take.
It guards actions with a key far outside, which would be sampled for minutes."""
MAX_FRAMES_OF_FEW_KEYS = 10_000
"""Frames up to which a range may have any number of keys. It guards short actions that an
animator keyed by hand."""
SPACING_TOLERANCE = 0.1
"""Fraction by which times between keys may differ. It guards against rounding of times to
milliseconds: at 30 Hz it is 3 ms."""


class FrameRange(Choice):
    """Frames to work on."""

    ACTION = "action", "Use all frames of the action", "Whole Action"
    SCENE = "scene", "Use the frames from the start to the end of the scene"
    PREVIEW = "preview", "Use the frames of the preview range of the timeline", "Preview Range"
    SELECTED_KEYS = "selected keys", "Use the frames from the first to the last selected key"


def range_bounds(
    choice: FrameRange,
    scene: bpy.types.Scene,
    channels: Sequence[Channel],
    player: bpy.types.Object,
) -> tuple[float, float]:
    """Return the first and last frame of a range, as frames of the action that is played.

    Raises
    ------
    InvalidMotionError
        There is no preview range, or no key is selected.
    """
    if choice is FrameRange.SCENE:
        return _played_range(player, scene.frame_start, scene.frame_end)
    if choice is FrameRange.PREVIEW:
        if not scene.use_preview_range:
            raise InvalidMotionError(
                "The scene has no preview range. Set one in the timeline (P), or work on"
                " another frame range."
            )
        return _played_range(player, scene.frame_preview_start, scene.frame_preview_end)
    if choice is FrameRange.SELECTED_KEYS:
        selected = [_selected_keys(channel) for channel in channels]
        times = np.concatenate([np.empty(0), *selected])
        if not len(times):
            raise InvalidMotionError(
                "No keys are selected. Select some in the Dope Sheet, or work on another"
                " frame range."
            )
        return float(times.min()), float(times.max())
    return -np.inf, np.inf


def _played_range(player: bpy.types.Object, first: float, last: float) -> tuple[float, float]:
    """Return the frames of the action that are played on a range of the scene."""
    return played_time(player, first).action_range(first, last)


class Grid(NamedTuple):
    """Evenly spaced frames."""

    frames: Array
    """Scene frames, shape (n_frames,), not always whole ones."""
    step: float
    """Frames from one to the next."""
    joins: tuple[bool, bool]
    """Whether there are keys before the first frame, and after the last."""


def key_grid(
    channels: Sequence[Channel], bounds: tuple[float, float], *, recorded: bool = False
) -> Grid:
    """Return the frames within `bounds` on which the channels have their keys.

    A take keyed four times a frame, or at .5 of every frame, or on every second one, is read
    where its keys are; where keys follow no grid, or lie many frames apart, on every whole
    frame. An action that is known to be `recorded` may have samples many frames apart.

    Raises
    ------
    InvalidMotionError
        There are no keys, or none within the bounds.
    """
    keyed = [channel for channel in channels if len(channel.keys)]
    if not keyed:
        raise InvalidMotionError("The action has no keys on this armature's bones.")
    longest = max((channel.keys[:, 0] for channel in keyed), key=len)
    start = min(channel.keys[:, 0].min() for channel in keyed)
    stop = max(channel.keys[:, 0].max() for channel in keyed)
    step, phase = _grid_of(longest, np.inf if recorded else MAX_RECORDED_STEP_FRAMES)
    first, last = max(start, bounds[0]), min(stop, bounds[1])
    lowest = np.ceil((first - phase - ON_FRAME) / step)
    n_frames = np.floor((last - phase + ON_FRAME) / step) + 1 - lowest
    if n_frames < 1:
        raise InvalidMotionError(
            f"The action has keys from frame {start:g} to {stop:g}, none of them within the"
            f" chosen range {bounds[0]:g} to {bounds[1]:g}."
        )
    if n_frames > max(MAX_FRAMES_PER_KEY * len(longest), MAX_FRAMES_OF_FEW_KEYS):
        raise InvalidMotionError(_stray_key(keyed, n_frames))
    frames = phase + step * (lowest + np.arange(n_frames))
    joins = (bool(start < frames[0] - step / 2), bool(stop > frames[-1] + step / 2))
    return Grid(frames, step, joins)


def _grid_of(times: Array, widest: float) -> tuple[float, float]:
    """Return step and phase of the grid of the keys, or of integer frames."""
    if len(times) == 1:
        return 1.0, float(times[0])
    span, spacing = times[-1] - times[0], _spacing(times)
    step = float(span / max(np.round(span / spacing), 1.0))
    grid_positions = (times - times[0]) / step
    on_grid = np.abs(grid_positions - np.round(grid_positions)) < MAX_GRID_OFFSET_STEPS
    filled = len(times) >= MIN_FILLED_FRACTION * (span / step + 1)
    if step <= widest and on_grid.mean() >= MIN_GRID_KEYS_FRACTION and filled:
        return step, float(times[0])
    return 1.0, float(np.ceil(times[0] - ON_FRAME))


def _stray_key(channels: Sequence[Channel], n_frames: float) -> str:
    """Return a message about the key with the largest distance from its neighbors."""
    times = np.unique(np.concatenate([channel.keys[:, 0] for channel in channels]))
    widest = int(np.argmax(np.diff(times)))
    after = len(times) - 1 - widest <= widest + 1
    frame = times[widest + 1] if after else times[widest]
    paths = [each.curve.data_path for each in channels if (each.keys[:, 0] == frame).any()]
    return (
        f"The action has far fewer keys than its {n_frames:,.0f} frames: {paths[0]} has one at"
        f" frame {frame:,.10g}, {times[widest + 1] - times[widest]:,.0f} frames from the next."
        " Delete it, or choose a frame range."
    )


def _spacing(times: Array) -> float:
    """Return the typical time between keys: the mean of those near the median.

    Blender keeps times in single precision: late in a long take the median alone is off by a
    thousandth, which over its many keys adds up to whole frames.
    """
    spacings = np.diff(times)
    median = np.median(spacings)
    return float(spacings[np.abs(spacings - median) <= SPACING_TOLERANCE * median].mean())


def _selected_keys(channel: Channel) -> Array:
    selected = np.empty(len(channel.keys), bool)
    channel.curve.keyframe_points.foreach_get("select_control_point", selected)
    times: Array = channel.keys[selected, 0]
    return times
