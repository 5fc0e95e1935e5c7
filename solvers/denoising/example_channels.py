"""Clean recordings as channels to learn from, all of the same parts and at one frame rate."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import CubicSpline

from ..motion import Motion, Tracks
from ..progress import Progress
from .channels import Channels
from .channels_encode import encode
from .cuts import find_cuts, is_short, pieces
from .noise import interpolated

Array = NDArray[np.float64]

NEAR_MULTIPLE = 0.02
"""Part by which a frame rate may miss a multiple of another and still count as one."""


def encode_examples(
    examples: Sequence[Motion | Tracks], frame_rate: float, progress: Progress
) -> tuple[Channels, list[list[Array]]]:
    """Encode all examples about the means of the first; columns are in its order.

    Each piece of an example is a list of interleaved takes at the frame rate. What an example
    does not have, or never shows, is NaN.
    """
    takes = [piece for example in examples for piece in _whole_pieces(example)]
    first = encode(takes[0])
    found = []
    for index, take in enumerate(takes):
        channels = encode(take, first.references) if index else first
        place = {key: part for part, key in enumerate(channels.keys)}
        columns = np.full((len(channels.values), len(first.keys), 3), np.nan)
        for part, key in enumerate(first.keys):
            if key in place:
                columns[:, part] = channels.values[:, place[key]]
        flat = columns.reshape(len(columns), -1)
        seen = np.isfinite(flat).any(axis=0)
        parts = _at_rate(interpolated(flat), take.frame_rate, frame_rate)
        found.append([np.where(seen, part, np.nan) for part in parts])
        progress((index + 1) / len(takes), "Reading examples")
    return first, found


def moments(clips: Sequence[Array]) -> tuple[Array, Array]:
    """Return mean and standard deviation of each channel over the clips that have it."""
    n_frames = np.array([len(clip) for clip in clips])
    count = np.maximum(n_frames @ np.array([np.isfinite(clip[0]) for clip in clips]), 1)
    mean = sum(np.nan_to_num(clip).sum(axis=0) for clip in clips) / count
    square = sum((np.nan_to_num(clip - mean) ** 2).sum(axis=0) for clip in clips)
    return np.asarray(mean), np.sqrt(square / count)


def _at_rate(values: Array, frame_rate: float, wanted: float) -> list[Array]:
    """Return channels at another frame rate.

    A multiple of the wanted rate is split into interleaved takes, so that no frame is lost;
    other rates are interpolated by cubic splines.
    """
    step = frame_rate / wanted
    if step >= 1.0 and abs(step - round(step)) < NEAR_MULTIPLE * step:
        return [values[start :: round(step)] for start in range(round(step))]
    if len(values) < 2:
        return [values]
    times = np.arange(0.0, (len(values) - 1) * wanted / frame_rate + 1e-9) / wanted
    spline = CubicSpline(np.arange(len(values)) / frame_rate, values, axis=0)
    return [np.asarray(spline(times))]


def _whole_pieces(example: Motion | Tracks) -> list[Motion | Tracks]:
    """Return the pieces of which an example was joined, without those that show no movement."""
    found = [
        example.slice(start, stop)
        for start, stop in pieces(example, find_cuts(example))
        if not is_short(stop - start, example.frame_rate)
    ]
    return found or [example]
