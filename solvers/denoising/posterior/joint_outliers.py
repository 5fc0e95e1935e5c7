"""Joints that are wrong as a whole: one channel's outlier makes its fellows' likely."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

MOST = 0.9
"""Probability of being an outlier that no fellow can exceed."""
LEAST = 1e-4
"""Probability of being an outlier that every sample has."""
DOUBT = 0.01
"""Share of a take that must be outliers to tell whether joints are wrong as a whole."""


@dataclass(frozen=True, eq=False)
class WholeJoints:
    """Which channels belong to one joint, and how its channels outside this group fare.

    A tracker that loses a limb turns the whole joint; a slip of the hand in a curve, or the
    noise that methods are usually tested with, one channel. The take itself tells which it is.
    """

    joints: NDArray[np.intp]
    """Of each channel of the group, ascending; a joint has at most three."""
    elsewhere: Array
    """Greatest outlier probability of its joint's channels that were solved for before."""

    def rates(self, outside: Array, known: NDArray[np.bool_], rate: float) -> Array:
        """Return how likely each sample is to be an outlier before it is looked at.

        Parameters
        ----------
        outside : shape (n_frames, n_channels)
            Probability of being an outlier so far, 0 where not `known`.
        known : same shape
        rate : float
            Share of outliers.
        """
        fellows = self.elsewhere.copy()
        for step in (1, 2):
            (first,) = np.nonzero(self.joints[step:] == self.joints[:-step])
            second = first + step
            fellows[:, first] = np.maximum(fellows[:, first], outside[:, second])
            fellows[:, second] = np.maximum(fellows[:, second], outside[:, first])
        n_known, of_fellows = np.count_nonzero(known), float(fellows[known].sum())
        both = float((outside * fellows).sum())
        together = min(both / max(of_fellows + DOUBT * n_known, DOUBT), MOST)
        if together <= rate:
            return np.full(fellows.shape, rate)
        # So that all together are as likely as before.
        alone = (rate * n_known - together * of_fellows) / max(n_known - of_fellows, 1.0)
        alone = max(alone, LEAST)
        return np.asarray(alone + fellows * (together - alone))
