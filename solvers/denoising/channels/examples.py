"""Convert clean recordings to channels with the same parts and frame rate, for learning."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from ...arrays import Array
from ...motion import Motion, Tracks
from ...motion.skeletons import find_shot_boundaries, is_short_shot, shot_ranges
from ...progress import Progress
from ...signals import fill_channel_gaps
from .encode import encode

BLOCK_S = 60.0
"""Seconds encoded at a time. The few windows across two blocks are skipped. It bounds the
memory."""


class ExampleChannels:
    """All examples as channels, about the means of the first and in its order.

    Each request encodes them again, a minute at a time, and keeps nothing: many frames need no
    more memory than few.
    """

    def __init__(
        self,
        examples: Sequence[Motion | Tracks],
        frame_rate: float,
        window: int,
        weights: Sequence[float],
    ) -> None:
        self._frame_rate, self._window = frame_rate, window
        self._takes = [
            (example, weight, *part)
            for example, weight in zip(examples, weights, strict=True)
            for part in _usable_segments(example)
        ]
        example, _, start, stop = self._takes[0]
        first = encode(example.slice(start, stop))
        self.keys, self.references = first.keys, first.references

    @property
    def n_channels(self) -> int:
        """Number of channels."""
        return 3 * len(self.keys)

    def read(self, progress: Progress) -> Iterator[tuple[float, list[Array]]]:
        """Yield the weight of each take, and a list of interleaved clips of it.

        Clips have shape (n_frames, n_channels). Clips shorter than a window are skipped, and so
        are takes with no other clips. Channels that an example lacks, or never shows, are NaN.
        """
        for index, (example, weight, start, stop) in enumerate(self._takes):
            take = example.slice(start, stop)
            channels = encode(take, self.references)
            index_of_key = {key: part for part, key in enumerate(channels.keys)}
            columns = np.full((len(channels.values), len(self.keys), 3), np.nan)
            for part, key in enumerate(self.keys):
                if key in index_of_key:
                    columns[:, part] = channels.values[:, index_of_key[key]]
            flat = columns.reshape(len(columns), -1)
            observed = np.isfinite(flat).any(axis=0)
            clips = _resample(fill_channel_gaps(flat), take.frame_rate, self._frame_rate)
            if long_clips := [clip for clip in clips if len(clip) >= self._window]:
                yield weight, [np.where(observed, clip, np.nan) for clip in long_clips]
            progress((index + 1) / len(self._takes), "Reading examples")


class Moments:
    """Means and standard deviations of channels over the takes that have them."""

    def __init__(self, n_channels: int) -> None:
        self.means = np.empty((0, n_channels))
        """Of each take; NaN where it lacks the channel."""
        self._counts, self._squares = np.empty((0, 1)), np.empty((0, n_channels))

    def add(self, clips: Sequence[Array], weight: float) -> None:
        """Add a take, a list of clips, with this weight."""
        count = sum(map(len, clips))
        mean = sum(clip.sum(axis=0) for clip in clips) / count
        square = sum(((clip - mean) ** 2).sum(axis=0) for clip in clips)
        self.means = np.vstack([self.means, mean])
        self._squares = np.vstack([self._squares, weight * square])
        self._counts = np.vstack([self._counts, [[weight * count]]])

    def total(self) -> tuple[Array, Array]:
        """Return mean and standard deviation of each channel over all takes."""
        is_observed = np.isfinite(self.means)
        counts = self._counts * is_observed
        n_frames = np.where(is_observed.any(axis=0), counts.sum(axis=0), 1.0)
        mean = (counts * np.nan_to_num(self.means)).sum(axis=0) / n_frames
        between = counts * (np.nan_to_num(self.means) - mean) ** 2
        square = (np.nan_to_num(self._squares) + between).sum(axis=0)
        return mean, np.sqrt(square / n_frames)


def _resample(values: Array, frame_rate: float, target_rate: float) -> list[Array]:
    """Return channels at another frame rate.

    A multiple of the target rate is split into interleaved takes, so that no frame is lost.
    Other rates are first interpolated by cubic splines, at the nearest multiple.
    """
    n_takes = max(round(frame_rate / target_rate), 1)
    rate = n_takes * target_rate
    if frame_rate != rate and len(values) > 1:
        from scipy.interpolate import CubicSpline  # slow to import: only when needed

        times = np.arange(0.0, (len(values) - 1) * rate / frame_rate + 1e-9) / rate
        values = CubicSpline(np.arange(len(values)) / frame_rate, values, axis=0)(times)
    return [values[start::n_takes] for start in range(n_takes)]


def _usable_segments(example: Motion | Tracks) -> list[tuple[int, int]]:
    """Return the start and stop frames of the segments of an example that are long enough.

    A joined take is split at its cuts, and long segments into blocks of about a minute.
    """
    segments = [
        (start, stop)
        for start, stop in shot_ranges(example, find_shot_boundaries(example))
        if not is_short_shot(stop - start, example.frame_rate)
    ]
    return [
        part
        for segment in segments or [(0, example.n_frames)]
        for part in _split_into_blocks(*segment, example)
    ]


def _split_into_blocks(
    start: int, stop: int, example: Motion | Tracks
) -> Iterator[tuple[int, int]]:
    """Yield blocks of one to two minutes; a shorter segment is one block."""
    n_parts = max(int((stop - start) / (BLOCK_S * example.frame_rate)), 1)
    edges = np.linspace(start, stop, n_parts + 1).astype(int)
    yield from pairwise(edges.tolist())
