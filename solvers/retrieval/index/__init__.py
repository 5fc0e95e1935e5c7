"""What a search compares: codewords of segments in an inverted index."""

from .clip import Clip, ClipEntry, Match, Origin, is_utf_8, tags_fault, text_fault
from .describe_clip import DescribedClip, describe_clip
from .index_block import IndexBlock, block_arrays, block_from_arrays, block_of, merged
from .reranking import between_courses, judged_by_likes
from .search_index import SearchIndex
from .segments import (
    FULL,
    N_CUBES,
    RATE,
    STANCE,
    Spans,
    describe,
    describe_all_spans,
    with_stance,
)
from .time_warping import frame_distances, warping_costs
from .vocabulary import (
    N_AXES,
    Vocabulary,
    learn_vocabulary,
    vocabulary_arrays,
    vocabulary_from_arrays,
)

__all__ = [
    "FULL",
    "N_AXES",
    "N_CUBES",
    "RATE",
    "STANCE",
    "Clip",
    "ClipEntry",
    "DescribedClip",
    "IndexBlock",
    "Match",
    "Origin",
    "SearchIndex",
    "Spans",
    "Vocabulary",
    "between_courses",
    "block_arrays",
    "block_from_arrays",
    "block_of",
    "describe",
    "describe_all_spans",
    "describe_clip",
    "frame_distances",
    "is_utf_8",
    "judged_by_likes",
    "learn_vocabulary",
    "merged",
    "tags_fault",
    "text_fault",
    "vocabulary_arrays",
    "vocabulary_from_arrays",
    "warping_costs",
    "with_stance",
]
