"""Grow one randomized tree, level by level, over all pixels at once."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Single
from ...progress import Progress, unwatched
from ...settings import Settings, setting
from .depth_differences import PixelFeatures, depth_differences
from .parts import N_PARTS

Nodes = NDArray[np.int32]

CM_PER_M = 100.0
"""Centimeters in a meter, by definition."""
_POSITIVE_THRESHOLDS = (15, 30, 50, 80, 120, 180, 260, 380, 550, 1000)
THRESHOLDS_MM = np.array(
    [*(-edge for edge in reversed(_POSITIVE_THRESHOLDS)), 0, *_POSITIVE_THRESHOLDS],
    dtype=np.int16,
)
"""Tested thresholds. Differences beyond the outermost involve the background."""
N_BINS = len(THRESHOLDS_MM) + 1
_CLIP_VALUE = _POSITIVE_THRESHOLDS[-1] + 1
_BIN_OF_VALUE = np.searchsorted(THRESHOLDS_MM, np.arange(-_CLIP_VALUE, _CLIP_VALUE + 1)).astype(
    np.int32
)
PIXELS_PER_BLOCK = 1 << 15
"""Pixels per feature computation, chosen to fit the processor's cache."""
NODES_PER_BLOCK = 2048
AT_LEAF = -1


@dataclass(frozen=True, kw_only=True)
class TreeSettings(Settings):
    """Size of a tree, and number of tested features."""

    levels: int = setting(
        16, "Maximum depth of the tree; higher is finer and larger", minimum=1, maximum=24
    )
    n_candidates: int = setting(
        100, "Features tested per level; more give better splits and take longer",
        minimum=1, maximum=100_000,
    )  # fmt: skip
    min_pixels: int = setting(
        40, "Minimum pixels of a split node; higher gives a smaller tree",
        minimum=2, maximum=1_000_000,
    )  # fmt: skip
    reach: float = setting(
        1.0, "Maximum offset of a feature from its pixel", unit="m", minimum=0.05, maximum=1.27
    )
    first_pixels: int = setting(
        300_000, "Pixels used by the first levels; deeper levels use all",
        minimum=100, maximum=1_000_000_000,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Tree:
    """Nodes breadth first: both children of the i-th split node are nodes 1 + 2 i and 2 + 2 i.

    Attributes
    ----------
    splits : bool, shape (n_nodes,)
    offsets : int8, shape (n_splits, 4), centimeters
    thresholds : int16, shape (n_splits,), millimeters
        Pixels at or below the threshold go to the first child.
    shares : uint8, shape (n_leaves, N_PARTS)
        Part histogram of each leaf, with a sum of about 255.
    """

    splits: NDArray[np.bool_]
    offsets: NDArray[np.int8]
    thresholds: NDArray[np.int16]
    shares: NDArray[np.uint8]


class _BestTests(NamedTuple):
    """Best test of each node of one level."""

    gain: Single
    feature: Nodes
    edge: Nodes


def grow_tree(
    views: PixelFeatures,
    parts: NDArray[np.uint8],
    settings: TreeSettings,
    rng: np.random.Generator,
    *,
    progress: Progress = unwatched,
) -> Tree:
    """Grow a tree that classifies the parts (n,) of pixels, independent of their order.

    At each level the same random features are tested in all nodes. Each node takes the feature
    and threshold with the largest information gain.
    """
    node = np.zeros(len(parts), dtype=np.int32)
    n_nodes, splits, offsets, thresholds = 1, [], [], []
    histograms = [np.empty((0, N_PARTS), dtype=np.uint8)]
    for level in range(settings.levels + 1):
        counts = _counts(node, parts, n_nodes)
        open_nodes = (counts.sum(axis=1) >= settings.min_pixels) & (
            counts.max(axis=1) < counts.sum(axis=1)
        )
        if level == settings.levels:
            open_nodes[:] = False
        features = random_offsets(settings.n_candidates, settings.reach, rng)
        best = _best_tests(views, parts, node, open_nodes, features, settings, level, rng)
        split = open_nodes & (best.gain > 0.0)
        splits.append(split)
        offsets.append(features[best.feature[split]])
        thresholds.append(THRESHOLDS_MM[best.edge[split]])
        histograms.append(_leaf_histograms(counts[~split]))
        node = _next_nodes(views, node, split, features, best)
        n_nodes = 2 * int(split.sum())
        progress((level + 1) / (settings.levels + 1), "Growing a tree")
        if not n_nodes:
            break
    return Tree(
        np.concatenate(splits),
        np.concatenate(offsets),
        np.concatenate(thresholds),
        np.concatenate(histograms),
    )


def random_offsets(n: int, reach: float, rng: np.random.Generator) -> NDArray[np.int8]:
    """Return n features (n, 4), centimeters: log-uniform offsets, or one at the pixel."""
    angle = rng.uniform(0.0, 2.0 * np.pi, (n, 2))
    radius = np.exp(rng.uniform(np.log(0.02), np.log(reach), (n, 2)))
    radius[rng.random(n) < 0.25, 1] = 0.0
    offsets = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=2).reshape(n, 4)
    rounded: NDArray[np.int8] = np.rint(offsets * CM_PER_M).astype(np.int8)
    return rounded


def _best_tests(
    views: PixelFeatures,
    parts: NDArray[np.uint8],
    node: Nodes,
    open_nodes: NDArray[np.bool_],
    features: NDArray[np.int8],
    settings: TreeSettings,
    level: int,
    rng: np.random.Generator,
) -> _BestTests:
    """Return the feature, the edge and the gain of the best test of each node."""
    n_nodes = len(open_nodes)
    best = _BestTests(
        np.zeros(n_nodes, dtype=np.float32),
        np.zeros(n_nodes, dtype=np.int32),
        np.zeros(n_nodes, dtype=np.int32),
    )
    rank = np.where(open_nodes, np.cumsum(open_nodes) - 1, AT_LEAF).astype(np.int32)
    chosen = np.flatnonzero((node >= 0) & open_nodes[node])
    max_pixels = settings.first_pixels * 2 ** (level // 2)
    if len(chosen) > max_pixels:
        chosen = np.sort(rng.choice(chosen, max_pixels, replace=False))
    if not len(chosen):
        return best
    selected_views, key = (
        views.select(chosen),
        rank[node[chosen]] * (N_BINS * N_PARTS) + parts[chosen],
    )
    open_indices = np.flatnonzero(open_nodes)
    for feature_index, feature in enumerate(features):
        gain, edge = _gains(_histograms(selected_views, key, feature, len(open_indices)))
        better = open_indices[gain > best.gain[open_indices]]
        ranks = rank[better]
        best.gain[better], best.edge[better] = gain[ranks], edge[ranks]
        best.feature[better] = feature_index
    return best


def _histograms(
    views: PixelFeatures, key: NDArray[np.int32], feature: NDArray[np.int8], n_nodes: int
) -> NDArray[np.int64]:
    """Count pixels by node, bin of the feature and part: (n_nodes, N_BINS, N_PARTS)."""
    keys = np.empty(len(key), dtype=np.int32)
    for start in range(0, len(key), PIXELS_PER_BLOCK):
        block = slice(start, start + PIXELS_PER_BLOCK)
        keys[block] = key[block] + N_PARTS * _bins(views.select(block), feature)
    counts = np.bincount(keys, minlength=n_nodes * N_BINS * N_PARTS)
    return counts.reshape(n_nodes, N_BINS, N_PARTS)


def _bins(views: PixelFeatures, feature: NDArray[np.int8]) -> NDArray[np.int32]:
    values = depth_differences(views, feature.astype(np.float32) / np.float32(CM_PER_M))
    return np.asarray(_BIN_OF_VALUE[np.clip(values, -_CLIP_VALUE, _CLIP_VALUE) + _CLIP_VALUE])


def _gains(counts: NDArray[np.int64]) -> tuple[Single, Nodes]:
    """Return the largest information gain of each node, and the index of its threshold.

    The gain is in nats times pixels: the entropy of the node minus that of both children.
    """
    gain = np.empty(len(counts), dtype=np.float32)
    edge = np.empty(len(counts), dtype=np.int32)
    for start in range(0, len(counts), NODES_PER_BLOCK):
        block = slice(start, start + NODES_PER_BLOCK)
        below = np.cumsum(counts[block], axis=1, dtype=np.float32)
        total = below[:, -1:]
        gains = (
            _negative_entropy(below[:, :-1])
            + _negative_entropy(total - below[:, :-1])
            - _negative_entropy(total)
        )
        edge[block] = gains.argmax(axis=1)
        gain[block] = gains.max(axis=1)
    return gain, edge


def _negative_entropy(counts: Single) -> Single:
    """Return minus the entropy times the number of pixels, over the last axis."""
    each = counts * np.log(np.maximum(counts, 1.0))
    total = counts.sum(axis=-1)
    return np.asarray(each.sum(axis=-1) - total * np.log(np.maximum(total, 1.0)))


def _counts(node: Nodes, parts: NDArray[np.uint8], n_nodes: int) -> NDArray[np.int64]:
    """Count pixels by node and part; pixels in leaves are excluded."""
    is_active = node >= 0
    key = node[is_active] * N_PARTS + parts[is_active]
    return np.bincount(key, minlength=n_nodes * N_PARTS).reshape(n_nodes, N_PARTS)


def _leaf_histograms(counts: NDArray[np.int64]) -> NDArray[np.uint8]:
    total = np.maximum(counts.sum(axis=1, keepdims=True), 1)
    histograms: NDArray[np.uint8] = np.rint(255.0 * counts / total).astype(np.uint8)
    return histograms


def _next_nodes(
    views: PixelFeatures,
    node: Nodes,
    split: NDArray[np.bool_],
    features: NDArray[np.int8],
    best: _BestTests,
) -> Nodes:
    """Return the node of each pixel on the next level, or AT_LEAF in a leaf."""
    next_nodes = np.full(len(node), AT_LEAF, dtype=np.int32)
    first_child = (2 * (np.cumsum(split) - 1)).astype(np.int32)
    meters = features.astype(np.float32).T / np.float32(CM_PER_M)
    for start in range(0, len(node), PIXELS_PER_BLOCK):
        block = np.arange(start, min(start + PIXELS_PER_BLOCK, len(node)))
        block = block[node[block] >= 0]
        block = block[split[node[block]]]
        current = node[block]
        values = depth_differences(views.select(block), meters[:, best.feature[current]])
        next_nodes[block] = first_child[current] + (values > THRESHOLDS_MM[best.edge[current]])
    return next_nodes
