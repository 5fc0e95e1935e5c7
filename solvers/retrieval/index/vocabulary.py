"""Learn codewords of body-part poses from the clips of a library.

[ZH14, 3.3] codes complete postures sparsely by atoms of a dictionary. Here each body part has
its own dictionary, a sample is a posture with its velocities, and the code uses the few
nearest words (locality-constrained rather than greedy: the support of a greedy code changes
with small noise).
"""

import warnings
from dataclasses import dataclass

import numpy as np
import scipy

from ...arrays import Array
from ..postures import (
    N_COORDINATES,
    N_FEATURES,
    N_PARTS,
    ClipPostures,
    PostureDistribution,
    is_covariance,
    learn_posture_distribution,
    part_features,
)

N_AXES = 8
"""Number of principal components of a part. Half and twice gain less than 1 %
(`make sensitivity`)."""
N_WORDS = 64
"""Number of codewords of a part. Half and twice gain less than 1 % (`make sensitivity`)."""
N_NEAREST = 3
"""Number of words with a nonzero weight in one frame. Half and twice gain less than 1 %
(`make sensitivity`)."""
JITTER_M = 1e-6
"""Meters of random noise that separates equal frames: k-means needs distinct points. It guards
a search for clusters."""
MIN_SPREAD_M2 = 1e-6
"""Squared meters. It guards a division."""
MAX_VALUE = 1e12
"""Limit of all learned numbers; squared meters and frame counts stay far below. It guards
against damaged files."""
MAX_TRAINING_FRAMES = 12000
"""Number of training frames; more are slower and not better. It bounds the run time of
indexing."""
RELEARNING_RATIO = 4
"""Ratio of library frames to training frames above which the words are learned again. It bounds
the run time of updates: a library that grows is indexed again each time it is four times as
long."""
SUFFICIENT_FRAMES = 8 * MAX_TRAINING_FRAMES
"""Training frames from which on the words are never learned again."""
SHAPES = {
    "centre": (N_PARTS, N_FEATURES),
    "axes": (N_PARTS, N_FEATURES, N_AXES),
    "words": (N_PARTS, -1, N_AXES),
    "spread": (N_PARTS,),
    "mean": (N_COORDINATES,),
    "covariance": (N_COORDINATES, N_COORDINATES),
    "n_frames": (),
}
LEARNED = {"centre": "center", "axes": "axes", "words": "words", "spread": "spread"}
"""Stored names of the learned arrays, and their attributes."""
FROZEN = "frozen"
"""Name of a stored 1; missing where the vocabulary may be learned again."""


@dataclass(frozen=True, eq=False)
class Vocabulary:
    """Codewords of the five body parts, and the features that they code.

    Attributes
    ----------
    center, axes : shapes (5, 22) and (5, 22, 8)
        Mean and principal components of the features of each part.
    words : shape (5, n_words, 8)
    spread : shape (5,), squared meters
        Median squared distance of a frame from its nearest word.
    posture_distribution : PostureDistribution
        Prior for joints that are not tracked.
    n_frames : int
        Number of frames in the training clips.
    is_frozen : bool
        Whether libraries share it: then it is never learned again.
    """

    center: Array
    axes: Array
    words: Array
    spread: Array
    posture_distribution: PostureDistribution
    n_frames: int
    is_frozen: bool = False

    def is_outgrown(self, n_frames: float) -> bool:
        """Whether a library of so many frames at 20 Hz needs a new vocabulary."""
        is_kept = self.is_frozen or self.n_frames >= SUFFICIENT_FRAMES
        return not is_kept and n_frames > RELEARNING_RATIO * self.n_frames

    def describes_like(self, other: "Vocabulary") -> bool:
        """Whether both describe any clip by the same numbers, so that searches may merge."""
        one, two = vocabulary_arrays(self), vocabulary_arrays(other)
        return all(one[name] == two[name] for name in (*LEARNED, "mean", "covariance"))

    def features(self, postures: ClipPostures) -> Array:
        """Return the features of each part, shape (n_frames, 5, 8), meters."""
        filled = self.posture_distribution.fill_gaps(postures)
        features = part_features(filled.positions, filled.root_velocity, filled.frame_rate)
        return np.asarray(np.einsum("fpd,pdk->fpk", features - self.center, self.axes))

    def activity(self, features: Array) -> Array:
        """Return the movement of each part in a clip relative to the average, shape (5,)."""
        average = self.words.var(axis=1).sum(axis=-1)
        movement = features.var(axis=0).sum(axis=-1)
        return np.asarray(np.sqrt(movement / np.maximum(average, JITTER_M)))

    def codes(self, features: Array) -> Array:
        """Return the weight of each word in each frame, shape (n_frames, 5, n_words).

        The three nearest words have nonzero weights, which sum to 1 and decrease with distance.
        """
        by_part = features.swapaxes(0, 1) @ self.words.swapaxes(1, 2)
        distance: Array = (self.words**2).sum(axis=-1) - 2.0 * by_part.swapaxes(0, 1)
        n_nearest = min(N_NEAREST, self.words.shape[1])
        nearest = np.argpartition(distance, n_nearest - 1, axis=-1)[..., :n_nearest]
        near = np.take_along_axis(distance, nearest, axis=-1)
        excess = near - near.min(axis=-1, keepdims=True)
        weights = np.exp(-0.5 * excess / self.spread[:, None])
        codes = np.zeros_like(distance)
        np.put_along_axis(
            codes, nearest, weights / weights.sum(axis=-1, keepdims=True), axis=-1
        )
        return codes


def learn_vocabulary(clips: list[ClipPostures]) -> Vocabulary:
    """Learn the codewords of clips.

    Principal components, then k-means with the seeding of Arthur and Vassilvitskii (2007).
    """
    rng = np.random.default_rng(0)
    n_frames = sum(clip.n_frames for clip in clips)
    posture_distribution = learn_posture_distribution(clips)
    step = max(n_frames // MAX_TRAINING_FRAMES, 1)
    samples = np.concatenate([
        part_features(clip.positions, clip.root_velocity, clip.frame_rate)[
            rng.integers(min(step, clip.n_frames)) :: step
        ]
        for clip in map(posture_distribution.fill_gaps, clips)
    ])  # fmt: skip
    center = samples.mean(axis=0)
    deviations = samples - center
    _, axes = np.linalg.eigh(np.einsum("fpd,fpe->pde", deviations, deviations) / len(samples))
    axes = axes[..., ::-1][..., :N_AXES]
    features = np.einsum("fpd,pdk->fpk", deviations, axes)
    n_words = min(N_WORDS, len(samples))
    words = np.stack([_learn_words(features[:, part], n_words, rng) for part in range(N_PARTS)])
    nearest = np.stack([
        ((features[:, part, None] - words[part]) ** 2).sum(axis=-1).min(axis=-1)
        for part in range(N_PARTS)
    ])  # fmt: skip
    spread = np.maximum(np.median(nearest, axis=-1), MIN_SPREAD_M2)
    return Vocabulary(center, axes, words, spread, posture_distribution, n_frames)


def _learn_words(features: Array, n_words: int, rng: np.random.Generator) -> Array:
    """Return the centers of clusters; empty clusters get a random frame."""
    distance = features + rng.normal(scale=JITTER_M, size=features.shape)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "One of the clusters is empty")
        words, labels = scipy.cluster.vq.kmeans2(
            distance, n_words, minit="++", seed=rng, missing="warn"
        )
    empty = np.setdiff1d(np.arange(n_words), labels)
    words[empty] = features[rng.integers(len(features), size=len(empty))]
    return np.asarray(words)


def vocabulary_arrays(vocabulary: Vocabulary) -> dict[str, bytes]:
    """Return the stored bytes of a vocabulary: little-endian doubles, by name."""
    numbers = {
        "mean": vocabulary.posture_distribution.mean,
        "covariance": vocabulary.posture_distribution.covariance,
        "n_frames": np.array(vocabulary.n_frames),
    } | {name: getattr(vocabulary, attribute) for name, attribute in LEARNED.items()}
    if vocabulary.is_frozen:
        numbers[FROZEN] = np.array(1)
    return {name: values.astype("<f8").tobytes() for name, values in numbers.items()}


def vocabulary_from_arrays(stored: dict[str, bytes]) -> Vocabulary:
    """Return the vocabulary from the bytes of `vocabulary_arrays`.

    Raises
    ------
    KeyError, ValueError
        An array is missing, has another size, or has implausible values.
    """
    read = {
        name: np.frombuffer(stored[name], "<f8").reshape(shape)
        for name, shape in SHAPES.items()
    }
    if not _is_learned(read):
        raise ValueError("The vocabulary has implausible values.")
    return Vocabulary(
        **{attribute: read[name] for name, attribute in LEARNED.items()},
        posture_distribution=PostureDistribution(read["mean"], read["covariance"]),
        n_frames=int(read["n_frames"]),
        is_frozen=FROZEN in stored,
    )


def _is_learned(read: dict[str, Array]) -> bool:
    """Whether all values are plausible; a search divides by some of them."""
    in_range = [
        *((np.abs(values) <= MAX_VALUE).all() for values in read.values()),
        (np.abs(read["axes"]) < 1.0 + JITTER_M).all(),
        (read["spread"] >= MIN_SPREAD_M2).all(),
        read["n_frames"] >= 1,
    ]
    return all(in_range) and read["words"].size > 0 and is_covariance(read["covariance"])
