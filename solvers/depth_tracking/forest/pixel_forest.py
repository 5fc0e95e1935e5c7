"""Random forest that classifies the body part of each depth pixel."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...archives import ArchiveLayout
from ...depth_scene import Camera, DepthImage
from ...errors import InvalidMotionError
from ...npz_members import Values, integers, words
from .depth_differences import depth_differences, pad_depth_image, pixel_features
from .grow_tree import CM_PER_M, Tree
from .parts import N_PARTS, PARTS

MAX_INT16 = 2**15 - 1
"""Largest offset or threshold: the range of 16-bit integers."""
LAYOUT = ArchiveLayout(
    "pixel forest",
    1,
    {
        "parts": words("parts"),
        "n_nodes": integers("trees", minimum=1),
        "splits": Values("u", ("bytes",), maximum=255),
        "offsets": integers("splits", 4, minimum=-MAX_INT16, maximum=MAX_INT16),
        "thresholds": integers("splits", minimum=-MAX_INT16, maximum=MAX_INT16),
        "shares": integers("leaves", N_PARTS, minimum=0, maximum=255),
        "trained_on": words(),
    },
    holds="a damaged forest",
    remedy="Train it again.",
)
SHIPPED = Path(__file__).parent / "forest.npz"


@dataclass(frozen=True, eq=False)
class PixelForest:
    """Trees with part probabilities in their leaves.

    Attributes
    ----------
    trees : tuple of Tree
    trained_on : str
        Description of the training data.
    """

    trees: tuple[Tree, ...]
    trained_on: str = ""

    def __post_init__(self) -> None:
        if not self.trees:
            raise InvalidMotionError("A forest needs at least one tree.")

    def save(self, path: Path | str) -> None:
        """Write an archive that `load_pixel_forest` reads."""
        arrays: dict[str, NDArray[Any]] = {
            "parts": np.array(PARTS),
            "n_nodes": np.array([len(tree.splits) for tree in self.trees]),
            "splits": np.packbits(np.concatenate([tree.splits for tree in self.trees])),
            "trained_on": np.array(self.trained_on),
        }
        for name in ("offsets", "thresholds", "shares"):
            arrays[name] = np.concatenate([getattr(tree, name) for tree in self.trees])
        LAYOUT.write(path, arrays)

    @cached_property
    def _nodes(self) -> "_Nodes":
        return _flatten_trees(self.trees)


class _Nodes:
    """All nodes of all trees, concatenated."""

    def __init__(
        self,
        roots: NDArray[np.int32],
        offsets: NDArray[np.float32],
        thresholds: NDArray[np.int32],
        children: NDArray[np.int32],
        probabilities: NDArray[np.float32],
    ) -> None:
        self.roots, self.offsets, self.thresholds = roots, offsets, thresholds
        self.children, self.probabilities = children, probabilities


@dataclass(frozen=True, eq=False)
class PixelParts:
    """The classified pixels of a body.

    Attributes
    ----------
    rows, columns : int arrays, shape (n,)
        Pixels with a reading.
    probabilities : float32, shape (n, N_PARTS)
        Probability of each of the `PARTS`; sums to one.
    """

    rows: NDArray[np.intp]
    columns: NDArray[np.intp]
    probabilities: NDArray[np.float32]

    @cached_property
    def labels(self) -> NDArray[np.intp]:
        """Most probable part of each pixel, as index in `PARTS`."""
        return np.asarray(self.probabilities.argmax(axis=1))


def classify_pixels(depth: DepthImage, camera: Camera, forest: PixelForest) -> PixelParts:
    """Classify the body part of each pixel with a reading.

    Parameters
    ----------
    depth : float32, shape (height, width), meters
        Contains only the body; 0: no reading.
    camera : Camera
    forest : PixelForest
        The probabilities of its trees are averaged: Wei, Zhang, Chai 2012, eq. 13.
    """
    rows, columns = np.nonzero(depth)
    images = pad_depth_image(depth)[np.newaxis]
    nodes = forest._nodes
    n_trees = len(forest.trees)
    views = pixel_features(images, np.zeros(len(rows), dtype=np.intp), rows, columns, camera)
    views = views.select(np.tile(np.arange(len(rows)), n_trees))
    current = np.repeat(nodes.roots, len(rows))
    active = np.arange(len(current))
    while len(active):
        current_nodes = current[active]
        values = depth_differences(views, nodes.offsets[:, current_nodes])
        current[active] = current_nodes = nodes.children[current_nodes] + (
            values > nodes.thresholds[current_nodes]
        )
        still_active = np.flatnonzero(nodes.children[current_nodes] >= 0)
        if len(still_active) < len(active):
            active, views = active[still_active], views.select(still_active)
    leaves = (-1 - nodes.children[current]).reshape(n_trees, len(rows))
    probabilities = nodes.probabilities[leaves[0]]
    for leaf in leaves[1:]:
        probabilities += nodes.probabilities[leaf]
    return PixelParts(rows, columns, probabilities / np.float32(n_trees))


def load_pixel_forest(path: Path | str = SHIPPED) -> PixelForest:
    """Read what `PixelForest.save` wrote; without a path, the forest that is shipped.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or holds something else.
    """
    arrays = LAYOUT.read(path)
    arrays["splits"] = arrays["splits"].astype(np.uint8)
    if fault := _find_fault(arrays):
        raise LAYOUT.damaged(path, fault)
    ends = np.cumsum(arrays["n_nodes"])
    splits = np.unpackbits(arrays["splits"], count=int(ends[-1])).astype(np.bool_)
    split_ends = np.cumsum(splits)[ends - 1]
    leaf_ends = ends - split_ends
    trees = (
        np.split(splits, ends[:-1]),
        np.split(arrays["offsets"], split_ends[:-1]),
        np.split(arrays["thresholds"], split_ends[:-1]),
        np.split(arrays["shares"], leaf_ends[:-1]),
    )
    return PixelForest(
        tuple(Tree(*tree) for tree in zip(*trees, strict=True)), str(arrays["trained_on"])
    )


def _find_fault(arrays: dict[str, NDArray[Any]]) -> str:
    """Return the reason that the arrays of a file are invalid, or an empty string."""
    if tuple(arrays["parts"].tolist()) != PARTS:
        return "it has other parts"
    n_nodes = arrays["n_nodes"]
    total = sum(n_nodes.tolist())  # Python integers: NumPy integers would overflow.
    if not len(n_nodes) or len(arrays["splits"]) != -(-total // 8):
        return "its nodes do not fit"
    splits = np.unpackbits(arrays["splits"], count=total)
    n_splits = [int(part.sum()) for part in np.split(splits, np.cumsum(n_nodes)[:-1])]
    if (n_nodes != 2 * np.array(n_splits) + 1).any():
        return "its nodes do not fit"
    sizes = {
        "offsets": sum(n_splits), "thresholds": sum(n_splits), "shares": total - sum(n_splits),
    }  # fmt: skip
    if wrong := [name for name, size in sizes.items() if len(arrays[name]) != size]:
        return f"the shapes do not fit, first that of {wrong[0]}"
    return "" if (arrays["shares"].sum(axis=1) > 0).all() else "a leaf is empty"


def _flatten_trees(trees: Sequence[Tree]) -> _Nodes:
    """Concatenate the nodes of all trees, each with the index of its first child.

    The child of a leaf is minus one minus its index among the leaves.
    """
    starts = np.cumsum([0, *(len(tree.splits) for tree in trees)])
    leaf_starts = np.cumsum([0, *(len(tree.shares) for tree in trees)])
    offsets = np.zeros((4, starts[-1]), dtype=np.float32)
    thresholds = np.zeros(starts[-1], dtype=np.int32)
    children = np.empty(starts[-1], dtype=np.int32)
    for tree, start, leaf_start in zip(trees, starts, leaf_starts, strict=False):
        split = start + np.flatnonzero(tree.splits)
        leaf = start + np.flatnonzero(~tree.splits)
        offsets[:, split] = tree.offsets.T / CM_PER_M
        thresholds[split] = tree.thresholds
        children[split] = start + 1 + 2 * np.arange(len(split))
        children[leaf] = -1 - (leaf_start + np.arange(len(leaf)))
    probabilities = np.concatenate([tree.shares for tree in trees]).astype(np.float32)
    probabilities /= probabilities.sum(axis=1, keepdims=True)
    return _Nodes(starts[:-1].astype(np.int32), offsets, thresholds, children, probabilities)
