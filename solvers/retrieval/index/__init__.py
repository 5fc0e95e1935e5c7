"""Index clips by codewords of their segments, and compare them."""

from .clip import Clip, ClipEntry, Match, Origin, find_tags_fault, find_text_fault
from .clip_segments import (
    CLIP_RATE_HZ,
    HISTOGRAM_SCALE,
    MEAN_POSTURE_WEIGHT,
    N_CUBES,
    Segments,
    describe_all_segments,
    describe_clip_segments,
    describe_segments,
    weight_mean_posture,
)
from .describe_clip import DescribedClip, describe_clip
from .index_block import IndexBlock, block_arrays, block_from_arrays, build_block, merge_blocks
from .reranking import pairwise_warping_costs, rerank_by_neighbors
from .search_index import SearchIndex, default_distances, may_cache_distances
from .time_warping import frame_distances, warping_costs
from .vocabulary import (
    N_AXES,
    Vocabulary,
    learn_vocabulary,
    vocabulary_arrays,
    vocabulary_from_arrays,
)

__all__ = [
    "CLIP_RATE_HZ",
    "HISTOGRAM_SCALE",
    "MEAN_POSTURE_WEIGHT",
    "N_AXES",
    "N_CUBES",
    "Clip",
    "ClipEntry",
    "DescribedClip",
    "IndexBlock",
    "Match",
    "Origin",
    "SearchIndex",
    "Segments",
    "Vocabulary",
    "block_arrays",
    "block_from_arrays",
    "build_block",
    "default_distances",
    "describe_all_segments",
    "describe_clip",
    "describe_clip_segments",
    "describe_segments",
    "find_tags_fault",
    "find_text_fault",
    "frame_distances",
    "learn_vocabulary",
    "may_cache_distances",
    "merge_blocks",
    "pairwise_warping_costs",
    "rerank_by_neighbors",
    "vocabulary_arrays",
    "vocabulary_from_arrays",
    "warping_costs",
    "weight_mean_posture",
]
