"""Learn the atoms of postures: K-SVD."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...progress import Progress, unwatched
from ...settings import Settings, setting
from ..postures import ClipPostures
from .observed_signals import observed_signals
from .sparse_codes import SparseCodes, sparse_codes

Array = NDArray[np.float64]

MIN_ATOM_FRACTION = 0.1
"""Part of an atom's length that must be seen for it to be used."""


@dataclass(frozen=True, kw_only=True)
class DictionarySettings(Settings):
    """How the atoms of postures are learned."""

    n_atoms: int = setting(
        700, "Atoms; more tell postures apart better", minimum=2, maximum=100_000
    )
    n_nonzeros: int = setting(
        35, "Atoms that each posture is made of; more tell it closer", minimum=1, maximum=57
    )
    centred: bool = setting(
        False, "Take the mean posture out first, so that atoms only tell what differs from it"
    )
    n_rounds: int = setting(
        10, "Times that codes and atoms are renewed in turn", minimum=1, maximum=1000
    )
    n_examples: int = setting(
        20_000,
        "Most postures to learn from; of more, evenly spaced ones",
        minimum=2,
        maximum=10_000_000,
        advanced=True,
    )
    seed: int = setting(
        0, "Which examples the atoms begin as", minimum=0, maximum=2**31 - 1, advanced=True
    )


@dataclass(frozen=True, eq=False)
class PostureDictionary:
    """Atoms that postures are sums of.

    Attributes
    ----------
    atoms : shape (n_atoms, 60), of length 1
    mean : shape (60,), metres
        What is taken out of a posture before; 0 unless centred.
    n_nonzeros : int
        Atoms of each posture.
    """

    atoms: Array
    mean: Array
    n_nonzeros: int

    def codes(self, postures: ClipPostures) -> SparseCodes:
        """Return the sparse codes of each frame.

        Gaps are bridged by straight lines. Of joints that were never tracked, atoms are cut
        to what was: codes are those that tell it best.
        """
        signals, seen = observed_signals(postures.positions)
        atoms = self.atoms[:, seen]
        sizes = np.linalg.norm(atoms, axis=1, keepdims=True)
        known = sizes > MIN_ATOM_FRACTION
        unit = np.where(known, atoms / np.where(known, sizes, 1.0), 0.0)
        n_nonzeros = max(min(self.n_nonzeros, len(unit), int(seen.sum())), 1)
        return sparse_codes(signals[:, seen] - self.mean[seen], unit, n_nonzeros)


def learn_dictionary(
    clips: Sequence[ClipPostures],
    settings: DictionarySettings = DictionarySettings(),
    *,
    progress: Progress = unwatched,
) -> PostureDictionary:
    """Learn atoms of which all postures are sums of few, by K-SVD [1]_.

    In turn, codes are renewed with fixed atoms (orthogonal matching pursuit), and each atom
    with its weights by the first singular vectors of what the other atoms leave. Atoms that no
    posture uses become the postures that are told worst. The first atoms are postures drawn
    at random.

    Parameters
    ----------
    clips : sequence of ClipPostures
        Frames in which a joint was never tracked in the clip are left out.

    Raises
    ------
    InvalidMotionError
        There are fewer whole postures than atoms.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Aharon, Elad, Bruckstein (2006). K-SVD: an algorithm for designing overcomplete
       dictionaries for sparse representation. IEEE Trans. Signal Processing 54(11).
       doi:10.1109/TSP.2006.881199
    """
    examples = _examples(clips, settings)
    mean = examples.mean(axis=0) if settings.centred else np.zeros(examples.shape[1])
    examples = examples - mean
    random = np.random.default_rng(settings.seed)
    sizes = np.linalg.norm(examples, axis=1)
    drawn = random.permutation(np.flatnonzero(sizes > 0.0))[: settings.n_atoms]
    atoms = examples[drawn] / sizes[drawn, None]
    for done in range(settings.n_rounds):
        progress(done / settings.n_rounds, "Learning postures")
        codes = sparse_codes(examples, atoms, min(settings.n_nonzeros, *atoms.shape))
        atoms = _update_atoms(examples, atoms, codes)
    return PostureDictionary(atoms, mean, settings.n_nonzeros)


def _examples(clips: Sequence[ClipPostures], settings: DictionarySettings) -> Array:
    found = [observed_signals(clip.positions) for clip in clips]
    whole = [signals for signals, seen in found if seen.all()]
    n_whole = sum(map(len, whole))
    if n_whole < settings.n_atoms:
        raise InvalidMotionError(
            f"{settings.n_atoms} atoms cannot be learned from {n_whole} whole postures; give"
            " more clips, or ask for fewer atoms."
        )
    step = -(-n_whole // settings.n_examples)
    return np.asarray(np.concatenate(whole)[:: min(step, n_whole // settings.n_atoms)])


def _update_atoms(examples: Array, atoms: Array, codes: SparseCodes) -> Array:
    """Return atoms, each the best rank-one part of what the others leave to it."""
    atoms, weights = atoms.copy(), codes.weights.copy()
    left = examples - codes.signals(atoms)
    order = np.argsort(codes.atoms, axis=None, kind="stable")
    starts = np.searchsorted(codes.atoms.ravel()[order], np.arange(len(atoms) + 1))
    for atom in range(len(atoms)):
        used = order[starts[atom] : starts[atom + 1]]
        rows, steps = np.divmod(used, weights.shape[1])
        asked = weights[rows, steps] != 0.0
        rows, steps = rows[asked], steps[asked]
        if not len(rows):
            worst = int((left**2).sum(axis=1).argmax())
            size = np.linalg.norm(examples[worst])
            atoms[atom] = examples[worst] / size if size else atoms[atom]
            left[worst] = 0.0
            continue
        rest = left[rows] + weights[rows, steps, None] * atoms[atom]
        atoms[atom] = np.linalg.eigh(rest.T @ rest)[1][:, -1]
        weights[rows, steps] = rest @ atoms[atom]
        left[rows] = rest - weights[rows, steps, None] * atoms[atom]
    return atoms
