"""How long orthogonal matching pursuit takes, compared with scikit-learn's."""

import warnings
from time import process_time

import numpy as np
from sklearn.decomposition import sparse_encode

from solvers.arrays import Array
from solvers.retrieval.postures.clip_postures import clip_postures
from solvers.retrieval.published.dictionary import DictionarySettings, learn_dictionary
from solvers.retrieval.published.observed_signals import observed_signals
from solvers.retrieval.published.sparse_codes import sparse_codes

from ..shared.tables import number, table
from ..shared.timing import run_times
from .retrieval_clips import training_library

N_SIGNALS, N_ATOMS = 300, 700
RATE_HZ = 30.0
REPEATS = 5


def compare_pursuits() -> str:
    """Return a table of milliseconds for 300 postures, the least of five runs."""
    clips = [clip_postures(clip.tracks, RATE_HZ) for clip in training_library()]
    found = [observed_signals(clip.positions) for clip in clips]
    postures = np.concatenate([signals for signals, observed in found if observed.all()])
    rng = np.random.default_rng(0)
    drawn = rng.permutation(len(postures))
    signals_, first = postures[drawn[:N_SIGNALS]], postures[drawn[N_SIGNALS:][:N_ATOMS]]
    settings = DictionarySettings(n_atoms=N_ATOMS, n_rounds=5, n_examples=5000)
    random = rng.normal(size=first.shape)
    atoms = {
        "learned by K-SVD": learn_dictionary(clips, settings).atoms,
        "postures": first / np.linalg.norm(first, axis=1, keepdims=True),
        "random": random / np.linalg.norm(random, axis=1, keepdims=True),
    }
    rows = {}
    for name, each in atoms.items():
        for n_nonzeros in (35, 5):
            label = f"{name}, {n_nonzeros} non-zeros"
            rows[label] = _row(signals_, each, n_nonzeros)
    header = [f"{N_ATOMS} atoms", "ours, ms", "scikit-learn, ms", "times", "left, mm", "theirs"]
    return f"**Sparse codes of {N_SIGNALS} postures**\n\n{table(header, rows)}\n"


def _row(signals: Array, atoms: Array, n_nonzeros: int) -> list[str]:
    def theirs() -> Array:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", RuntimeWarning)
            found = sparse_encode(signals, atoms, algorithm="omp", n_nonzero_coefs=n_nonzeros)
        return np.asarray(found @ atoms)

    def ours() -> Array:
        return sparse_codes(signals, atoms, n_nonzeros).signals(atoms)

    times = [1e3 * min(run_times(each, REPEATS, process_time)) for each in (ours, theirs)]
    left = [1000.0 * np.abs(each() - signals).mean() for each in (ours, theirs)]
    return [*map(number, times), f"{times[1] / times[0]:.1f}", *map(number, left)]
