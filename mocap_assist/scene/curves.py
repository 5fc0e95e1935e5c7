"""Keys of F-Curves in bulk, as arrays: never one key at a time."""

from functools import cached_property

import bpy
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Rows = dict[str, NDArray[np.generic]]

CONSTANT, LINEAR = 0, 1  # Blender's numbers for interpolation
MEASURED, GENERATED = 0, 5  # and for its key types KEYFRAME and GENERATED
ON_FRAME = 1e-3  # frames; keys are 32-bit numbers, whose grain at frame 10,000 is this

# Everything that a key is, with its Blender array length and the value of a new key.
KEY = {
    "co": (2, 0.0), "handle_left": (2, 0.0), "handle_right": (2, 0.0),
    "interpolation": (1, LINEAR), "easing": (1, 0), "type": (1, MEASURED),
    "handle_left_type": (1, 4), "handle_right_type": (1, 4),  # AUTO_CLAMPED
    "back": (1, 1.70158), "amplitude": (1, 0.8), "period": (1, 4.1),
}  # fmt: skip


class Channel:
    """An F-Curve and its keys, which are read once, when they are asked for."""

    def __init__(self, curve: bpy.types.FCurve) -> None:
        self.curve = curve

    @property
    def is_on(self) -> bool:
        """Whether the curve animates anything: neither it nor its group is muted."""
        group = self.curve.group
        return not (self.curve.mute or (group is not None and group.mute))

    @cached_property
    def keys(self) -> Array:
        """Frame and value of the keys in order of time, shape (n_keys, 2)."""
        keys = np.empty(2 * len(self.curve.keyframe_points), np.float32)
        self.curve.keyframe_points.foreach_get("co", keys)
        return keys.reshape(-1, 2).astype(np.float64)

    def keyed_at(self, frames: Array) -> bool:
        """Whether there is one key on each of the frames, and no other."""
        times = self.keys[:, 0]
        return len(times) == len(frames) and bool((np.abs(times - frames) <= ON_FRAME).all())

    def values(self, frames: Array) -> Array:
        """Return the value at each frame, shape (n_frames,).

        Keys that lie on the frames are taken as they are. Between keys, beyond them and on
        curves with modifiers, Blender evaluates.
        """
        if len(self.curve.modifiers) or len(frames) == 1 or not len(self.keys):
            return self._evaluated(frames)
        if self.keyed_at(frames):
            return self.keys[:, 1]
        times, values = self.keys.T
        place = np.searchsorted(times, frames - ON_FRAME).clip(max=len(times) - 1)
        between = np.abs(times[place] - frames) > ON_FRAME
        found = values[place]
        found[between] = self._evaluated(frames[between])
        return found

    def _evaluated(self, frames: Array) -> Array:
        values = map(self.curve.evaluate, frames.tolist())
        return np.fromiter(values, np.float64, len(frames))


def write_values(
    curve: bpy.types.FCurve,
    frames: Array,
    values: Array,
    types: NDArray[np.uint8] | None = None,
    interpolation: int = LINEAR,
) -> None:
    """Replace the keys from the first to the last of `frames` by one key on each of them.

    Keys outside stay as they are. Modifiers go: the values were read through them.
    `types`, shape (n_frames,), are Blender's key types; without it all are MEASURED.
    """
    for modifier in reversed(curve.modifiers):
        curve.modifiers.remove(modifier)
    points = curve.keyframe_points
    before, after = _kept_outside(points, frames)
    points.clear()
    points.add(len(before["co"]) + len(frames) + len(after["co"]))
    new = {
        "co": np.stack([frames, values], axis=1, dtype=np.float32, casting="same_kind"),
        "interpolation": np.full((len(frames), 1), interpolation),
    }
    if types is not None:
        new["type"] = types[:, None]
    alone = not (len(before["co"]) or len(after["co"]))
    for name in new if alone else KEY:
        width, usual = KEY[name]
        rows = new.get(name, np.full((len(frames), width), usual)).astype(
            _kind(name), copy=False
        )
        if not alone:
            rows = np.concatenate([before[name], rows, after[name]])
        points.foreach_set(name, rows.ravel())
    curve.update()


def _kept_outside(points: bpy.types.FCurveKeyframePoints, frames: Array) -> tuple[Rows, Rows]:
    """Everything about the keys before and after the frames, by the name in KEY."""
    start, stop = frames[0] - ON_FRAME, frames[-1] + ON_FRAME
    if not len(points) or (points[0].co.x >= start and points[-1].co.x <= stop):
        nothing = {name: np.empty((0, width)) for name, (width, _) in KEY.items()}
        return nothing, nothing
    whole = {name: _column(points, name) for name in KEY}
    first, last = np.searchsorted(whole["co"][:, 0], [start, stop])
    return (
        {name: column[:first] for name, column in whole.items()},
        {name: column[last:] for name, column in whole.items()},
    )


def _column(points: bpy.types.FCurveKeyframePoints, name: str) -> NDArray[np.generic]:
    width = KEY[name][0]
    column = np.empty(width * len(points), _kind(name))
    points.foreach_get(name, column)
    return column.reshape(-1, width)


def _kind(name: str) -> type[np.generic]:
    """Blender's own kinds of number; any other takes five times as long."""
    return np.float32 if isinstance(KEY[name][1], float) else np.uint8
