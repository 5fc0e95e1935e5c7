"""Keys of F-Curves in bulk, as arrays: never one key at a time."""

from functools import cached_property
from typing import Any

import bpy
import numpy as np
from numpy.typing import NDArray

from ...solvers.arrays import Array
from ...solvers.errors import InvalidMotionError
from .curve_modifiers import LAST_FRAME, Written, keep_outside

CONSTANT, LINEAR = 0, 1  # Blender's numbers for interpolation
MEASURED, GENERATED = 0, 5  # and for its key types KEYFRAME and GENERATED
AUTO_CLAMPED = 4  # and for that type of handle
ON_FRAME = 1e-3
"""Frames that are only rounding: keys are 32-bit numbers, whose precision at frame 10,000 is
this."""


# Everything that a key is, with its Blender array length and the value of a new key.
KEY = {
    "co": (2, 0.0), "handle_left": (2, 0.0), "handle_right": (2, 0.0),
    "interpolation": (1, LINEAR), "easing": (1, 0), "type": (1, MEASURED),
    "handle_left_type": (1, AUTO_CLAMPED), "handle_right_type": (1, AUTO_CLAMPED),
    "back": (1, 1.70158), "amplitude": (1, 0.8), "period": (1, 4.1),
    "select_control_point": (1, False), "select_left_handle": (1, False),
    "select_right_handle": (1, False),
}  # fmt: skip
SELECTED = tuple(name for name in KEY if name.startswith("select"))


class Channel:
    """An F-Curve and its keys, which are read once, at first use."""

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
        keys = keys.reshape(-1, 2)
        if fault := _fault(keys[:, 0]):
            raise InvalidMotionError(f"{self.curve.data_path} has {fault}")
        return keys.astype(np.float64)

    def read_keys(self) -> None:
        """Read the keys now, if they were not read yet."""
        _ = self.keys

    def with_keys_of(self, before: "Channel | None") -> "Channel":
        """Take over the keys that were read before from the same curve, if they were."""
        if before is not None and "keys" in vars(before):
            self.keys = before.keys
        return self

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
            return self._evaluate_curve(frames)
        if self.keyed_at(frames):
            return self.keys[:, 1]
        times, values = self.keys.T
        indices = np.searchsorted(times, frames - ON_FRAME).clip(max=len(times) - 1)
        between = np.abs(times[indices] - frames) > ON_FRAME
        found: Array = values[indices]
        found[between] = self._evaluate_curve(frames[between])
        return found

    def _evaluate_curve(self, frames: Array) -> Array:
        values = map(self.curve.evaluate, frames.tolist())
        return np.fromiter(values, np.float64, len(frames))


def _fault(times: NDArray[np.float32]) -> str:
    """Return what is wrong with the frames of keys, or nothing."""
    if np.isnan(times).any():
        return (
            "a key whose frame is not a number (NaN). Delete that curve, or the key, and set it"
            " again."
        )
    if (beyond := times[np.abs(times) > LAST_FRAME]).size:
        return (
            f"a key at frame {beyond[0]:.3g}; Blender plays no key beyond {LAST_FRAME:,.0f}."
            " Delete that key."
        )
    if (np.diff(times) < 0.0).any():
        return (
            "keys that are not in the order of their frames. Move one of them in the Graph"
            " Editor, which sorts them."
        )
    return ""


def types_of(curve: bpy.types.FCurve) -> NDArray[np.uint8]:
    """Return Blender's number for the type of each key, shape (n_keys,)."""
    return _column(curve.keyframe_points, "type")[:, 0]


def write_first(
    curve: bpy.types.FCurve, frames: Array, values: Array, interpolation: int = LINEAR
) -> None:
    """Give a curve without keys or modifiers one MEASURED key on each of the frames."""
    points = curve.keyframe_points
    points.add(len(frames))
    points.foreach_set("co", np.stack([frames, values], axis=1).astype(np.float32).ravel())
    points.foreach_set("interpolation", np.full(len(frames), interpolation, np.uint8))
    curve.update()


def deselect(curve: bpy.types.FCurve) -> None:
    """Deselect all keys of a curve: Blender selects new ones."""
    points = curve.keyframe_points
    for name in SELECTED:
        points.foreach_set(name, np.zeros(len(points), np.bool_))


def write_values(
    curve: bpy.types.FCurve,
    frames: Array,
    values: Array,
    types: NDArray[np.uint8] | None = None,
    interpolation: int = LINEAR,
) -> None:
    """Replace the keys from the first to the last of `frames` by one key on each of them.

    Keys outside stay as they are, and so do modifiers there; within, the values were read
    through the modifiers, which are not applied a second time. A new key is selected if the
    key that it replaces was. New keys are interpolated linearly by default: captured
    keys lie one frame apart, where handles would only repeat the next key.
    `types`, shape (n_frames,), are Blender's key types; without it all are MEASURED.
    """
    points = curve.keyframe_points
    old = _column(points, "co")
    times = old[:, 0]
    first, last = np.searchsorted(times, [frames[0] - ON_FRAME, frames[-1] + ON_FRAME])
    keep_outside(curve, Written(frames[0], frames[-1], *_adjacent_keys(times, first, last)))
    new = {
        "co": np.stack([frames, values], axis=1, dtype=np.float32, casting="same_kind"),
        "interpolation": interpolation,
        "type": MEASURED if types is None else types[:, None],
        "handle_left_type": AUTO_CLAMPED,
        "handle_right_type": AUTO_CLAMPED,
    }
    replaced = times[first:last]
    if len(replaced) == len(frames) and (np.abs(replaced - frames) <= ON_FRAME).all():
        all_new = last - first == len(times)
        for name, rows in new.items():
            column = old if name == "co" else _column(points, name, blank=all_new)
            column[first:last] = rows
            points.foreach_set(name, column.ravel())
    else:
        chosen = _selected_frames(points, times, frames)
        _rebuild(points, first, last, new | dict.fromkeys(SELECTED, chosen[:, None]))
    curve.update()


def _rebuild(
    points: bpy.types.FCurveKeyframePoints, first: int, last: int, new: dict[str, Any]
) -> None:
    """Replace the keys from `first` to `last` by a different number of new keys."""
    kept = {name: _column(points, name) for name in KEY}
    n_new = len(new["co"])
    n_keys = len(points) - (last - first) + n_new
    points.clear()
    points.add(n_keys)
    for name, (width, default) in KEY.items():
        rows = np.empty((n_new, width), _kind(name))
        rows[:] = new.get(name, default)
        column = np.concatenate([kept[name][:first], rows, kept[name][last:]])
        points.foreach_set(name, column.ravel())


def _selected_frames(
    points: bpy.types.FCurveKeyframePoints, times: NDArray[Any], frames: Array
) -> NDArray[np.bool_]:
    """Return which of the frames have a selected key, shape (n_frames,)."""
    selected = _column(points, SELECTED[0])[:, 0]
    if not selected.any():
        return np.zeros(len(frames), bool)
    marked = times[selected]
    indices = np.searchsorted(marked, frames - ON_FRAME).clip(max=len(marked) - 1)
    return np.asarray(np.abs(marked[indices] - frames) <= ON_FRAME)


def _adjacent_keys(
    times: NDArray[Any], first: int, last: int
) -> tuple[float | None, float | None]:
    """Return the frames of the keys before `first` and after `last`, if they exist."""
    before = float(times[first - 1]) if first else None
    after = float(times[last]) if last < len(times) else None
    return before, after


def _column(
    points: bpy.types.FCurveKeyframePoints, name: str, *, blank: bool = False
) -> NDArray[Any]:
    """Return one property of all keys, or room for it: shape (n_keys, width)."""
    width = KEY[name][0]
    column = np.empty(width * len(points), _kind(name))
    if not blank:
        points.foreach_get(name, column)
    return column.reshape(-1, width)


def _kind(name: str) -> type[np.generic]:
    """Blender's own number types; any other takes five times as long."""
    default = KEY[name][1]
    return {float: np.float32, bool: np.bool_, int: np.uint8}[type(default)]
