"""The methods of the benchmark of retrieval, by the names of its tables."""

from solvers.retrieval import FindSettings
from solvers.retrieval.published.dictionary import DictionarySettings
from solvers.retrieval.published.pyramid_matching import PyramidSettings

from ..peers.clip_alignment import Resampled, Warped
from ..peers.clip_statistics import BagOfWords, Covariances
from ..peers.motion_volumes import MotionVolumes
from ..peers.string_matching import StringMatching
from .pyramid_methods import PARTS, Pyramids
from .retrieval_default import Default
from .retrieval_fusion import Fused
from .retrieval_protocol import Method

OURS = "ours, find_similar"
PUBLISHED = "[ZLLS14] as published"
CUBES = "[ZLLS14], cubes normalised"
RANKED = "all three, manifold ranking"

CHOSEN = Pyramids(
    DictionarySettings(n_atoms=32, n_nonzeros=1),
    PyramidSettings(gap=1 / 30, n_levels=4, normalize_cubes=True),
    frame_rate=30.0,
    parts=PARTS,
    filled=True,
)
"""By `part_retrieval_choice`, on the training classes."""
WARPED, LOGARITHMS = Warped(), Covariances(ridge=1e-4)
N_NEIGHBORS = 3

METHODS: dict[str, Method] = {
    OURS: Default(),
    "ours, without re-ranking": Default(FindSettings(n_neighbors=0)),
    "ours, codewords alone": Default(FindSettings(n_neighbors=0, n_warped=0)),
    PUBLISHED: Pyramids(),
    CUBES: Pyramids(pyramid=PyramidSettings(normalize_cubes=True)),
    "pyramids, settings chosen": CHOSEN,
    "DTW of 12 components": WARPED,
    "covariances": Covariances(),
    "log-covariances": LOGARITHMS,
    "Euclidean, resampled": Resampled(),
    "bag of codewords": BagOfWords(),
    "low-rank volumes, as [SJF11]": MotionVolumes(),
    "strings of patterns, as [DGL09]": StringMatching(),
    "find_similar + log-covariances": Fused((Default(), LOGARITHMS)),
    "DTW + log-covariances": Fused((WARPED, LOGARITHMS)),
    "pyramids + DTW + log-covariances": Fused((CHOSEN, WARPED, LOGARITHMS)),
    RANKED: Fused((CHOSEN, WARPED, LOGARITHMS), N_NEIGHBORS),
}
"""Peers with an "as" were written from what can be had of their papers."""
