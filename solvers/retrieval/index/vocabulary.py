"""Words for what a part of the body does in an instant, learned from the clips of a library.

[ZH14, 3.3] codes whole postures sparsely by atoms of a dictionary. Here each part of the body
has a dictionary of its own, an instant is a posture with its speeds, and the code is that of
the few nearest words (locality-constrained rather than greedy: the support of a greedy code
changes with the least noise).
"""

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.cluster.vq import kmeans2

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

Array = NDArray[np.float64]

N_AXES = 8
N_WORDS = 64
FRAMES_PER_WORD = 4
N_NEAREST = 3
"""Words that share a frame between them."""
JITTER_M = 1e-6
"""Metres by which frames that are the same are set apart: clusters cannot be."""
MIN_SPREAD_M2 = 1e-6
"""Squared metres."""
MAX_VALUE = 1e12
"""Of all numbers that are learned: squares of metres, and frames, stay far below."""
MAX_TRAINING_FRAMES = 12000
"""Of which words are learned: more make it slower, and no better."""
RELEARNING_RATIO = 4
"""A library of so many times the frames that its words were learned from learns new ones."""
SUFFICIENT_FRAMES = 8 * MAX_TRAINING_FRAMES
"""Frames from which on words are good for whatever comes."""
SHAPES = {
    "centre": (N_PARTS, N_FEATURES),
    "axes": (N_PARTS, N_FEATURES, N_AXES),
    "words": (N_PARTS, -1, N_AXES),
    "spread": (N_PARTS,),
    "mean": (N_COORDINATES,),
    "covariance": (N_COORDINATES, N_COORDINATES),
    "n_frames": (),
}
LEARNED = ("centre", "axes", "words", "spread")


@dataclass(frozen=True, eq=False)
class Vocabulary:
    """What is known of how bodies move.

    Attributes
    ----------
    centre, axes : shapes (5, 22) and (5, 22, 8)
        Of the principal components of each part's features.
    words : shape (5, n_words, 8)
    spread : shape (5,), squared metres
        Usual squared distance of a frame from its nearest word.
    usual : UsualPostures
        By which joints that are not tracked are filled in.
    n_frames : int
        Of how many it was learned.
    """

    centre: Array
    axes: Array
    words: Array
    spread: Array
    usual: PostureDistribution
    n_frames: int

    def is_outgrown(self, n_frames: float) -> bool:
        """Whether it was learned from too little for a library of so many frames at 20 Hz."""
        return self.n_frames < SUFFICIENT_FRAMES and n_frames > RELEARNING_RATIO * self.n_frames

    def features(self, postures: ClipPostures) -> Array:
        """Return what each part does, shape (n_frames, 5, 8), metres."""
        whole = self.usual.completed(postures)
        told = part_features(whole.positions, whole.course, whole.frame_rate)
        return np.asarray(np.einsum("fpd,pdk->fpk", told - self.centre, self.axes))

    def activity(self, features: Array) -> Array:
        """Return how much each part moves in a clip, shape (5,), as a share of the usual."""
        usual = self.words.var(axis=1).sum(axis=-1)
        moves = features.var(axis=0).sum(axis=-1)
        return np.asarray(np.sqrt(moves / np.maximum(usual, JITTER_M)))

    def codes(self, features: Array) -> Array:
        """Return how far each word says what each part does, shape (n_frames, 5, n_words).

        The three nearest words share one frame between them, the nearer the more.
        """
        by_part = features.swapaxes(0, 1) @ self.words.swapaxes(1, 2)
        apart: Array = (self.words**2).sum(axis=-1) - 2.0 * by_part.swapaxes(0, 1)
        few = min(N_NEAREST, self.words.shape[1])
        nearest = np.argpartition(apart, few - 1, axis=-1)[..., :few]
        near = np.take_along_axis(apart, nearest, axis=-1)
        beyond = near - near.min(axis=-1, keepdims=True)
        shares = np.exp(-0.5 * beyond / self.spread[:, None])
        codes = np.zeros_like(apart)
        np.put_along_axis(codes, nearest, shares / shares.sum(axis=-1, keepdims=True), axis=-1)
        return codes


def learn_vocabulary(clips: list[ClipPostures], seed: int = 0) -> Vocabulary:
    """Learn the words of clips, in which gaps are left out.

    Principal components, then k-means with the seeding of Arthur and Vassilvitskii (2007).
    """
    rng = np.random.default_rng(seed)
    n_frames = sum(clip.n_frames for clip in clips)
    usual = learn_posture_distribution(clips)
    step = max(n_frames // MAX_TRAINING_FRAMES, 1)
    told = np.concatenate([
        part_features(clip.positions, clip.course, clip.frame_rate)[
            rng.integers(min(step, clip.n_frames)) :: step
        ]
        for clip in map(usual.completed, clips)
    ])  # fmt: skip
    centre = told.mean(axis=0)
    beside = told - centre
    _, axes = np.linalg.eigh(np.einsum("fpd,fpe->pde", beside, beside) / len(told))
    axes = axes[..., ::-1][..., :N_AXES]
    features = np.einsum("fpd,pdk->fpk", beside, axes)
    n_words = max(min(N_WORDS, len(told) // FRAMES_PER_WORD), 1)
    words = np.stack([_learn_words(features[:, part], n_words, rng) for part in range(N_PARTS)])
    nearest = np.stack([
        ((features[:, part, None] - words[part]) ** 2).sum(axis=-1).min(axis=-1)
        for part in range(N_PARTS)
    ])  # fmt: skip
    spread = np.maximum(np.median(nearest, axis=-1), MIN_SPREAD_M2)
    return Vocabulary(centre, axes, words, spread, usual, n_frames)


def _learn_words(features: Array, n_words: int, rng: np.random.Generator) -> Array:
    """Return the middles of clusters; of those that lost all they had, any frame."""
    apart = features + rng.normal(scale=JITTER_M, size=features.shape)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "One of the clusters is empty")
        words, of = kmeans2(apart, n_words, minit="++", seed=rng, missing="warn")
    empty = np.setdiff1d(np.arange(n_words), of)
    words[empty] = features[rng.integers(len(features), size=len(empty))]
    return np.asarray(words)


def vocabulary_arrays(vocabulary: Vocabulary) -> dict[str, bytes]:
    """Return what is stored of a vocabulary: little-endian doubles, by name."""
    numbers = {
        "mean": vocabulary.usual.mean,
        "covariance": vocabulary.usual.covariance,
        "n_frames": np.array(vocabulary.n_frames),
    } | {name: getattr(vocabulary, name) for name in LEARNED}
    return {name: values.astype("<f8").tobytes() for name, values in numbers.items()}


def vocabulary_from_arrays(stored: dict[str, bytes]) -> Vocabulary:
    """Return the vocabulary that `vocabulary_arrays` told.

    Raises
    ------
    KeyError, ValueError
        A part is missing, of another size, or of numbers that were never learned.
    """
    read = {
        name: np.frombuffer(stored[name], "<f8").reshape(shape)
        for name, shape in SHAPES.items()
    }
    if not _is_learned(read):
        raise ValueError("The vocabulary was not learned.")
    return Vocabulary(
        **{name: read[name] for name in LEARNED},
        usual=PostureDistribution(read["mean"], read["covariance"]),
        n_frames=int(read["n_frames"]),
    )


def _is_learned(read: dict[str, Array]) -> bool:
    """Whether numbers are such as `learn_vocabulary` finds: a search divides by some."""
    in_range = [
        *((np.abs(values) <= MAX_VALUE).all() for values in read.values()),
        (np.abs(read["axes"]) < 1.0 + JITTER_M).all(),
        (read["spread"] >= MIN_SPREAD_M2).all(),
        read["n_frames"] >= 1,
    ]
    return all(in_range) and read["words"].size > 0 and is_covariance(read["covariance"])
