"""Keys of F-Curves in bulk, as arrays: never one key at a time."""

import bpy
import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

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


def is_on(curve: bpy.types.FCurve) -> bool:
    """Whether the curve animates anything: neither it nor its group is muted."""
    return not (curve.mute or (curve.group is not None and curve.group.mute))


def read_keys(curve: bpy.types.FCurve) -> Array:
    """Return the keys in order of time, shape (n_keys, 2): frame and value."""
    keys = np.empty(2 * len(curve.keyframe_points), np.float32)
    curve.keyframe_points.foreach_get("co", keys)
    return keys.reshape(-1, 2).astype(np.float64)


def read_values(curve: bpy.types.FCurve, frames: Array) -> Array:
    """Return the curve's value at each frame, shape (n_frames,).

    Keys that lie on the frames are taken as they are. Between keys, beyond them and on curves
    with modifiers, Blender evaluates.
    """
    keys = read_keys(curve)
    if not len(keys) or len(curve.modifiers):
        return _evaluated(curve, frames)
    place = np.searchsorted(keys[:, 0], frames - ON_FRAME).clip(max=len(keys) - 1)
    values = keys[place, 1]
    between = np.abs(keys[place, 0] - frames) > ON_FRAME
    values[between] = _evaluated(curve, frames[between])
    return values


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
    points, start, stop = curve.keyframe_points, frames[0] - ON_FRAME, frames[-1] + ON_FRAME
    times = read_keys(curve)[:, 0]
    before, after = np.searchsorted(times, [start, stop])
    kept = np.r_[:before, after : len(times)]
    columns = {name: _column(points, name)[kept] for name in KEY} if len(kept) else {}
    points.clear()
    points.add(len(kept) + len(frames))
    new = {
        "co": np.column_stack([frames, values]),
        "interpolation": np.full(len(frames), interpolation),
        "type": np.full(len(frames), MEASURED) if types is None else types,
    }
    for name in KEY if len(kept) else new:
        width, usual = KEY[name]
        rows = new.get(name, np.full((len(frames), width), usual)).reshape(-1, width)
        if len(kept):
            rows = np.concatenate([columns[name][:before], rows, columns[name][before:]])
        points.foreach_set(name, rows.astype(_kind(name)).ravel())
    curve.update()


def _evaluated(curve: bpy.types.FCurve, frames: Array) -> Array:
    return np.fromiter(map(curve.evaluate, frames.tolist()), np.float64, len(frames))


def _column(points: bpy.types.FCurveKeyframePoints, name: str) -> NDArray[np.generic]:
    width = KEY[name][0]
    column = np.empty(width * len(points), _kind(name))
    points.foreach_get(name, column)
    return column.reshape(-1, width)


def _kind(name: str) -> type[np.generic]:
    """Blender's own kinds of number; any other takes five times as long."""
    return np.float32 if isinstance(KEY[name][1], float) else np.uint8
