"""A peer of retrieval: hierarchical string matching, as in [DGL09].

[DGL09] Deng, Gu, Li (2009). Perceptually consistent example-based human motion retrieval. I3D.
Written from what [ZH14] says of it and from its abstract: the body is a hierarchy of parts, the
postures of each part are clustered into patterns, a clip becomes one string of patterns for
each part, and clips whose strings have long common substrings are similar.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.distance import cdist
from sklearn.cluster import KMeans

from solvers.arrays import Array, Flags
from solvers.motion import Tracks

from .complete_postures import CompletePostures, learn_complete_postures

String = tuple[int, ...]

PARTS: dict[tuple[int, ...], float] = {
    tuple(range(1, 20)): 1.0,
    (1, 2, 3, *range(4, 12)): 0.5,
    tuple(range(12, 20)): 0.5,
    (1, 2, 3): 0.25, (4, 5, 6, 7): 0.25, (8, 9, 10, 11): 0.25,
    (12, 13, 14, 15): 0.25, (16, 17, 18, 19): 0.25,
}  # fmt: skip
"""Joints of the parts and their weights: the body, its halves, torso and limbs."""


@dataclass(frozen=True)
class StringMatching:
    n_patterns: int = 32
    frame_rate: float = 30.0

    def prepare(self, clips: Sequence[Tracks]) -> "StringLibrary":
        complete, found = learn_complete_postures(clips, self.frame_rate)
        frames = np.concatenate(found)
        patterns = [
            KMeans(self.n_patterns, n_init=1, random_state=0)
            .fit(_of(frames, joints))
            .cluster_centers_
            for joints in PARTS
        ]
        strings = [strings_of(each, patterns) for each in found]
        return StringLibrary(complete, patterns, strings)


@dataclass(frozen=True, eq=False)
class StringLibrary:
    complete: CompletePostures
    patterns: list[Array]
    strings: list[list[String]]

    def describe(self, tracks: Tracks) -> list[String]:
        return strings_of(self.complete(tracks), self.patterns)

    def distances(self, query: list[String], allowed: Flags) -> Array:
        result = np.zeros(len(self.strings))
        for index in np.flatnonzero(allowed):
            pairs = zip(query, self.strings[index], PARTS.values(), strict=True)
            result[index] = -sum(weight * common_fraction(a, b) for a, b, weight in pairs)
        return result


def strings_of(frames: Array, patterns: list[Array]) -> list[String]:
    """Return the string of each part: its sequence of patterns, repetitions once."""
    strings = []
    for joints, centers in zip(PARTS, patterns, strict=True):
        nearest = cdist(_of(frames, joints), centers).argmin(axis=1)
        strings.append(tuple(nearest[np.flatnonzero(np.diff(nearest, prepend=-1))].tolist()))
    return strings


def common_fraction(a: String, b: String) -> float:
    """Return the length of the longest common piece, over the mean length of both."""
    lengths = np.zeros(len(b) + 1, dtype=int)
    second, longest = np.array(b), 0
    for letter in a:
        lengths[1:] = np.where(second == letter, lengths[:-1] + 1, 0)
        longest = max(longest, int(lengths.max()))
    return 2.0 * longest / (len(a) + len(b))


def _of(frames: Array, joints: tuple[int, ...]) -> Array:
    return frames.reshape(len(frames), 20, 3)[:, joints].reshape(len(frames), -1)
