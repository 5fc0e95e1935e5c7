"""Stretches of clips as histograms of words, over all of their time and over its halves."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...progress import Progress, unwatched
from ..postures import N_PARTS, ClipPostures, half_precision
from .vocabulary import N_AXES, Vocabulary

Array = NDArray[np.float64]

RATE = 20.0
"""Hertz at which clips are compared."""
LONG_CLIP_S = 4.0
"""Seconds of a clip from which on parts of it are found by themselves."""
MIN_SEGMENT_S = 2.0
"""Seconds; other parts are twice, four times as long and so on."""
MAX_SEGMENT_FRACTION = 0.7
"""Of the clip: parts that are longer are the clip."""
N_CUBES = 3
N_STEPS = 16
"""Moments by which a span is compared in detail."""
MAX_FRAMES = 1200
"""Of a span that are looked at, evenly spread."""
MEAN_POSTURE_WEIGHT = 0.8
"""How much the mean posture of a clip counts beside how the clip departs from it."""
HISTOGRAM_SCALE = 255.0
"""What the whole length of a histogram is stored as."""


@dataclass(frozen=True, eq=False)
class Segments:
    """What is compared of one clip.

    Attributes
    ----------
    frames : int32, shape (n_spans, 2)
        First frame and the one after the last, at 20 Hz; the first span is the whole clip.
    histograms : uint8, shape (n_spans, 5, 3, n_words)
        For each part of the body, over all the time and over either half of it.
    summaries : float16, shape (n_spans, 16, 5, 8), metres
        What each part does, evenly spread over the span.
    """

    frames: NDArray[np.int32]
    histograms: NDArray[np.uint8]
    summaries: NDArray[np.float16]


def describe_clip_segments(postures: ClipPostures, vocabulary: Vocabulary) -> Segments:
    """Describe a clip, and what lasts for 2, 4, 8 ... seconds in it if it is long."""
    features = vocabulary.features(postures)
    frames = segment_frames(len(features), postures.frame_rate)
    return describe_segments(features, frames, vocabulary)


def describe_all_segments(
    clips: list[ClipPostures], vocabulary: Vocabulary, progress: Progress = unwatched
) -> list[Segments]:
    """Describe the spans of several clips."""
    described = []
    for place, clip in enumerate(clips):
        progress(place / len(clips), "Indexing")
        described.append(describe_clip_segments(clip, vocabulary))
    return described


def describe_segments(
    features: Array, frames: NDArray[np.int32], vocabulary: Vocabulary
) -> Segments:
    """Describe these spans of a clip with these features."""
    histograms = [_histograms(features[start:stop], vocabulary) for start, stop in frames]
    summaries = [_sample_features(features[start:stop]) for start, stop in frames]
    return Segments(
        frames,
        np.round(HISTOGRAM_SCALE * np.stack(histograms)).astype(np.uint8),
        half_precision(np.stack(summaries)),
    )


def weight_mean_posture(summaries: NDArray[np.float32], stance: float) -> NDArray[np.float32]:
    """Return what parts do at moments of spans, (n, 16, ...), their mean being so much of it.

    What the arms do while a leg kicks, how somebody stands, and where a sensor takes joints to
    be are in the mean over a span; the movement itself is not.
    """
    mean = summaries.mean(axis=1, keepdims=True)
    return np.asarray(summaries - np.float32(1.0 - stance) * mean)


def segment_frames(n_frames: int, frame_rate: float) -> NDArray[np.int32]:
    """Return the spans that a clip of so many frames is found by, shape (n_spans, 2)."""
    spans = [(0, n_frames)]
    length = MIN_SEGMENT_S * frame_rate
    while n_frames > LONG_CLIP_S * frame_rate and length < MAX_SEGMENT_FRACTION * n_frames:
        n_parts = int(np.ceil(2.0 * (n_frames - length) / length)) + 1
        starts = np.linspace(0, n_frames - length, n_parts)
        spans += [(round(start), round(start + length)) for start in starts]
        length *= 2.0
    return np.array(spans, dtype=np.int32)


def _histograms(features: Array, vocabulary: Vocabulary) -> Array:
    """Return unit vectors of square roots of histograms (Hellinger), (5, 3, n_words).

    The halves overlap, so that a moment near the middle does not tip over.
    """
    features = features[:: -(-len(features) // MAX_FRAMES)]
    time = (np.arange(len(features)) + 0.5) / len(features)
    halves = [np.clip(2.0 - 2.0 * np.abs(2.0 * time - side), 0.0, 1.0) for side in (0.5, 1.5)]
    weights = np.stack([np.ones_like(time), *halves])
    codes = vocabulary.codes(features)
    counts = (weights @ codes.reshape(len(codes), -1)).reshape(N_CUBES, *codes.shape[1:])
    counts = counts.swapaxes(0, 1)
    shares = counts / np.maximum(counts.sum(axis=-1, keepdims=True), 1e-12)
    return np.asarray(np.sqrt(shares))


def _sample_features(features: Array) -> Array:
    """Return the features at evenly spread moments, shape (16, 5, 8)."""
    moments = np.linspace(0.0, len(features) - 1.0, N_STEPS)
    before = np.minimum(moments.astype(int), max(len(features) - 2, 0))
    after = np.minimum(before + 1, len(features) - 1)
    part = (moments - before)[:, None, None]
    told = (1.0 - part) * features[before] + part * features[after]
    return np.asarray(told.reshape(N_STEPS, N_PARTS, N_AXES))
