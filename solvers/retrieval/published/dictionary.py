"""Learn a dictionary of posture atoms by K-SVD."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...errors import InvalidMotionError
from ...progress import Progress, unwatched
from ...settings import Settings, setting
from ..postures import ClipPostures
from .observed_signals import observed_signals
from .sparse_codes import SparseCodes, sparse_codes

MIN_ATOM_FRACTION = 0.1
"""Fraction of the length of an atom that must be observed. Chosen by hand; the paper has no
gaps."""


@dataclass(frozen=True, kw_only=True)
class DictionarySettings(Settings):
    """Settings of `learn_dictionary`."""

    n_atoms: int = setting(
        700, "Atoms; more distinguish postures better", minimum=2, maximum=100_000
    )
    n_nonzeros: int = setting(
        35, "Atoms per posture; more are more accurate", minimum=1, maximum=57
    )
    centered: bool = setting(
        False, "Subtract the mean posture first, so that atoms represent deviations from it"
    )
    n_rounds: int = setting(
        10, "Iterations of sparse coding and dictionary update", minimum=1, maximum=1000
    )
    n_examples: int = setting(
        20_000,
        "Maximum number of training postures; more are subsampled evenly",
        minimum=2,
        maximum=10_000_000,
        advanced=True,
    )
    seed: int = setting(
        0, "Random seed of the initial atoms", minimum=0, maximum=2**31 - 1, advanced=True
    )


@dataclass(frozen=True, eq=False)
class PostureDictionary:
    """Atoms of a sparse representation of postures.

    Attributes
    ----------
    atoms : shape (n_atoms, 60), of length 1
    mean : shape (60,), meters
        Mean that is subtracted from postures; 0 unless centered.
    n_nonzeros : int
        Atoms per posture.
    """

    atoms: Array
    mean: Array
    n_nonzeros: int

    def codes(self, postures: ClipPostures) -> SparseCodes:
        """Return the sparse codes of each frame.

        Gaps are interpolated linearly. Atoms are restricted to the joints that were tracked.
        """
        signals, observed = observed_signals(postures.positions)
        atoms = self.atoms[:, observed]
        sizes = np.linalg.norm(atoms, axis=1, keepdims=True)
        usable = sizes > MIN_ATOM_FRACTION
        normalized = np.where(usable, atoms / np.where(usable, sizes, 1.0), 0.0)
        n_nonzeros = max(min(self.n_nonzeros, len(normalized), int(observed.sum())), 1)
        return sparse_codes(signals[:, observed] - self.mean[observed], normalized, n_nonzeros)


def learn_dictionary(
    clips: Sequence[ClipPostures],
    settings: DictionarySettings = DictionarySettings(),
    *,
    progress: Progress = unwatched,
) -> PostureDictionary:
    """Learn a dictionary for sparse codes of postures by K-SVD [1]_.

    Each round updates the codes with fixed atoms (orthogonal matching pursuit), then each atom
    and its weights by the first singular vectors of the residual without that atom. Unused
    atoms are replaced by the postures with the largest residual. The initial atoms are random
    postures.

    Parameters
    ----------
    clips : sequence of ClipPostures
        Clips with a joint that was never tracked are skipped.

    Raises
    ------
    InvalidMotionError
        There are fewer complete postures than atoms.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Aharon, Elad, Bruckstein (2006). K-SVD: an algorithm for designing overcomplete
       dictionaries for sparse representation. IEEE Trans. Signal Processing 54(11).
       doi:10.1109/TSP.2006.881199
    """
    examples = _examples(clips, settings)
    mean = examples.mean(axis=0) if settings.centered else np.zeros(examples.shape[1])
    examples = examples - mean
    random = np.random.default_rng(settings.seed)
    sizes = np.linalg.norm(examples, axis=1)
    initial = random.permutation(np.flatnonzero(sizes > 0.0))[: settings.n_atoms]
    atoms = examples[initial] / sizes[initial, None]
    for done in range(settings.n_rounds):
        progress(done / settings.n_rounds, "Learning poses")
        codes = sparse_codes(examples, atoms, min(settings.n_nonzeros, *atoms.shape))
        atoms = _update_atoms(examples, atoms, codes)
    return PostureDictionary(atoms, mean, settings.n_nonzeros)


def _examples(clips: Sequence[ClipPostures], settings: DictionarySettings) -> Array:
    pairs = [observed_signals(clip.positions) for clip in clips]
    complete = [signals for signals, observed in pairs if observed.all()]
    n_complete = sum(map(len, complete))
    if n_complete < settings.n_atoms:
        raise InvalidMotionError(
            f"{settings.n_atoms} atoms cannot be learned from {n_complete} complete postures."
            " Add clips, or set fewer atoms."
        )
    step = -(-n_complete // settings.n_examples)
    return np.asarray(np.concatenate(complete)[:: min(step, n_complete // settings.n_atoms)])


def _update_atoms(examples: Array, atoms: Array, codes: SparseCodes) -> Array:
    """Return atoms, each the best rank-one approximation of its residual."""
    atoms, weights = atoms.copy(), codes.weights.copy()
    residual = examples - codes.signals(atoms)
    order = np.argsort(codes.atoms, axis=None, kind="stable")
    starts = np.searchsorted(codes.atoms.ravel()[order], np.arange(len(atoms) + 1))
    for atom in range(len(atoms)):
        entries = order[starts[atom] : starts[atom + 1]]
        rows, steps = np.divmod(entries, weights.shape[1])
        is_used = weights[rows, steps] != 0.0
        rows, steps = rows[is_used], steps[is_used]
        if not len(rows):
            worst = int((residual**2).sum(axis=1).argmax())
            size = np.linalg.norm(examples[worst])
            atoms[atom] = examples[worst] / size if size else atoms[atom]
            residual[worst] = 0.0
            continue
        target = residual[rows] + weights[rows, steps, None] * atoms[atom]
        atoms[atom] = np.linalg.eigh(target.T @ target)[1][:, -1]
        weights[rows, steps] = target @ atoms[atom]
        residual[rows] = target - weights[rows, steps, None] * atoms[atom]
    return atoms
