"""Pyramid matching as a method of the benchmark: as published, and as settings say."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from scipy.sparse import vstack

from solvers.arrays import Array, Flags
from solvers.motion import Tracks
from solvers.retrieval.postures.body_parts import JOINTS, ROOTS
from solvers.retrieval.postures.clip_postures import ClipPostures, clip_postures
from solvers.retrieval.postures.mean_postures import (
    PostureDistribution,
    learn_posture_distribution,
)
from solvers.retrieval.published.dictionary import (
    DictionarySettings,
    PostureDictionary,
    learn_dictionary,
)
from solvers.retrieval.published.pyramid_matching import (
    PyramidSettings,
    pyramid_descriptor,
    pyramid_kernel,
)

BODY = ((0, tuple(range(20))),)
PARTS = tuple(
    (int(root), tuple(joints.tolist())) for root, joints in zip(ROOTS, JOINTS, strict=True)
)
"""Of `solvers.retrieval.postures.body_parts`: from where joints are measured, and which."""


@dataclass(frozen=True)
class Pyramids:
    """Spatial temporal pyramid matching; `cosine` divides by both clips' own size.

    With `PARTS`, each part of the body has a dictionary and pyramids of its own, whose kernels
    are added. With `filled`, missing joints are filled from the others,
    as the product does; without, codes are those that fit the observed joints best.
    """

    dictionary: DictionarySettings = DictionarySettings()
    pyramid: PyramidSettings = PyramidSettings()
    frame_rate: float = 120.0
    cosine: bool = False
    parts: tuple[tuple[int, tuple[int, ...]], ...] = BODY
    filled: bool = False

    def prepare(self, clips: Sequence[Tracks]) -> "PyramidLibrary":
        postures = [clip_postures(clip, self.frame_rate) for clip in clips]
        part_libraries = []
        for root, joints in self.parts:
            of_part = [only(each, root, joints) for each in postures]
            dictionary = learn_dictionary(of_part, self.dictionary)
            rows = [pyramid_descriptor(each, dictionary, self.pyramid) for each in of_part]
            sizes = np.array([row.sum() for row in rows])
            part_libraries.append(PartLibrary(dictionary, vstack(rows).tocsc(), sizes))
        return PyramidLibrary(self, part_libraries, learn_posture_distribution(postures))


@dataclass(frozen=True, eq=False)
class PartLibrary:
    dictionary: PostureDictionary
    rows: Any
    sizes: Array


@dataclass(frozen=True, eq=False)
class PyramidLibrary:
    method: Pyramids
    part_libraries: list[PartLibrary]
    distribution: PostureDistribution

    def describe(self, tracks: Tracks) -> list[Any]:
        return self.described(clip_postures(tracks, self.method.frame_rate))

    def described(self, postures: ClipPostures) -> list[Any]:
        if self.method.filled:
            postures = self.distribution.fill_gaps(postures)
        return [
            pyramid_descriptor(
                only(postures, root, joints), part.dictionary, self.method.pyramid
            )
            for (root, joints), part in zip(self.method.parts, self.part_libraries, strict=True)
        ]

    def distances(self, query: list[Any], allowed: Flags) -> Array:
        total = np.zeros(len(allowed))
        for row, part in zip(query, self.part_libraries, strict=True):
            kernel = pyramid_kernel(row, part.rows)[0]
            size = np.sqrt(part.sizes * row.sum()) if self.method.cosine else 1.0
            total -= kernel / np.maximum(size, 1e-12)
        return total


def only(postures: ClipPostures, root: int, joints: tuple[int, ...]) -> ClipPostures:
    """Return poses with only these joints, relative to the root."""
    if not root and len(joints) == postures.positions.shape[1]:
        return postures
    positions = np.zeros_like(postures.positions)
    relative = postures.positions[:, list(joints)] - postures.positions[:, root, None]
    positions[:, list(joints)] = relative
    return replace(postures, positions=positions)
