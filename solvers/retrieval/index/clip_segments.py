"""Describe segments of clips by codeword histograms of the complete segment and its halves."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...progress import Progress, unwatched
from ..postures import N_PARTS, ClipPostures, half_precision
from .vocabulary import N_AXES, Vocabulary

CLIP_RATE_HZ = 20.0
"""Hertz at which clips are compared: more than twice 6 Hz, below which nearly all power of
walking is (Winter et al. 1974, Journal of Biomechanics 7, 157). Half and twice gain less than
1 % (`make sensitivity`)."""
MIN_SEGMENT_S = 2.0
"""Seconds; other segments are two, four ... times as long. It guards libraries of takes of
minutes, in which an action is a small part: clips of twice this length are also indexed in
segments."""
MAX_SEGMENT_FRACTION = 0.7
"""Maximum length of a segment, relative to the clip. It bounds the size of the index: a longer
one would describe the clip itself again."""
N_CUBES = 3
N_STEPS = 16
"""Time samples of a segment for dynamic time warping. Half and twice gain less than 1 %
(`make sensitivity`)."""
MAX_FRAMES = 1200
"""Frames of a segment for its histogram, evenly spaced. It bounds the run time: at 20 Hz,
longer segments than a minute are subsampled."""
MEAN_POSTURE_WEIGHT = 0.8
"""Default weight of the mean posture of a segment, relative to the deviation from it. Chosen by
hand; `make sensitivity` varies it."""
HISTOGRAM_SCALE = 255.0
"""Integer that is stored for a histogram value of 1, a ratio. By definition of an unsigned
byte."""


@dataclass(frozen=True, eq=False)
class Segments:
    """The indexed segments of one clip.

    Attributes
    ----------
    frames : int32, shape (n_segments, 2)
        First frame and the frame after the last, at 20 Hz; the first is the complete clip.
    histograms : uint8, shape (n_segments, 5, 3, n_words)
        For each body part: over the complete segment and over each half.
    summaries : float16, shape (n_segments, 16, 5, 8), meters
        Features of each body part at evenly spaced time samples.
    """

    frames: NDArray[np.int32]
    histograms: NDArray[np.uint8]
    summaries: NDArray[np.float16]


def describe_clip_segments(postures: ClipPostures, vocabulary: Vocabulary) -> Segments:
    """Describe a clip and, if it is long, its segments of 2, 4, 8 ... seconds."""
    features = vocabulary.features(postures)
    frames = segment_frames(len(features), postures.frame_rate)
    return describe_segments(features, frames, vocabulary)


def describe_all_segments(
    clips: list[ClipPostures], vocabulary: Vocabulary, progress: Progress = unwatched
) -> list[Segments]:
    """Describe the segments of several clips."""
    described = []
    for index, clip in enumerate(clips):
        progress(index / len(clips), "Indexing")
        described.append(describe_clip_segments(clip, vocabulary))
    return described


def describe_segments(
    features: Array, frames: NDArray[np.int32], vocabulary: Vocabulary
) -> Segments:
    """Describe segments of a clip from its features, (n_frames, n_parts, n_axes).

    The rows of `frames`, (n_segments, 2), are the first frame and the one after the last.
    """
    histograms = [_histograms(features[start:stop], vocabulary) for start, stop in frames]
    summaries = [_sample_features(features[start:stop]) for start, stop in frames]
    return Segments(
        frames,
        np.round(HISTOGRAM_SCALE * np.stack(histograms)).astype(np.uint8),
        half_precision(np.stack(summaries)),
    )


def weight_mean_posture(
    summaries: NDArray[np.float32], mean_weight: float
) -> NDArray[np.float32]:
    """Scale the mean over time of summaries, (n, 16, ...), and keep the deviation from it.

    The mean contains the stance of the actor, the posture of arms during a kick, and the joint
    offsets of a sensor. The deviation contains the movement.
    """
    mean = summaries.mean(axis=1, keepdims=True)
    return np.asarray(summaries - np.float32(1.0 - mean_weight) * mean)


def segment_frames(n_frames: int, frame_rate: float) -> NDArray[np.int32]:
    """Return the first and end frames of the segments of a clip, shape (n_segments, 2)."""
    segments = [(0, n_frames)]
    length = MIN_SEGMENT_S * frame_rate
    while (
        n_frames > 2.0 * MIN_SEGMENT_S * frame_rate and length < MAX_SEGMENT_FRACTION * n_frames
    ):
        n_segments = int(np.ceil(2.0 * (n_frames - length) / length)) + 1
        starts = np.linspace(0, n_frames - length, n_segments)
        segments += [(round(start), round(start + length)) for start in starts]
        length *= 2.0
    return np.array(segments, dtype=np.int32)


def _histograms(features: Array, vocabulary: Vocabulary) -> Array:
    """Return unit vectors of square roots of histograms (Hellinger), (5, 3, n_words).

    The halves overlap, so that a small time shift near the middle changes little.
    """
    features = features[:: -(-len(features) // MAX_FRAMES)]
    time = (np.arange(len(features)) + 0.5) / len(features)
    halves = [np.clip(2.0 - 2.0 * np.abs(2.0 * time - side), 0.0, 1.0) for side in (0.5, 1.5)]
    weights = np.stack([np.ones_like(time), *halves])
    codes = vocabulary.codes(features)
    counts = (weights @ codes.reshape(len(codes), -1)).reshape(N_CUBES, *codes.shape[1:])
    counts = counts.swapaxes(0, 1)
    fractions = counts / np.maximum(counts.sum(axis=-1, keepdims=True), 1e-12)
    return np.asarray(np.sqrt(fractions))


def _sample_features(features: Array) -> Array:
    """Return the features at evenly spaced time samples, shape (16, 5, 8)."""
    samples = np.linspace(0.0, len(features) - 1.0, N_STEPS)
    before = np.minimum(samples.astype(int), max(len(features) - 2, 0))
    after = np.minimum(before + 1, len(features) - 1)
    fraction = (samples - before)[:, None, None]
    interpolated = (1.0 - fraction) * features[before] + fraction * features[after]
    return np.asarray(interpolated.reshape(N_STEPS, N_PARTS, N_AXES))
