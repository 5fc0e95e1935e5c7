"""Correlate outliers within a joint: one channel's outlier makes the others' likely."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array

MAX_OUTLIER_PROBABILITY = 0.9
"""Largest prior probability of being an outlier, whatever the joint's other channels. Chosen by
hand: x0.5 and x2 move no error; it guards against a certain outlier."""
MIN_OUTLIER_PROBABILITY = 1e-4
"""Prior probability of being an outlier that every sample has. Chosen by hand: x0.5 and x2 move
no error; it guards against a prior of zero, also at a hundredth of it."""
MIN_OUTLIER_FRACTION = 0.01
"""Fraction of a take that must be outliers to show whether joints are wrong as a unit. Chosen
by hand: x0.5 costs nothing, x2 costs nothing."""


@dataclass(frozen=True, eq=False)
class JointOutlierPrior:
    """Outlier rates given the outliers of the joint's other channels.

    A tracker that loses a limb rotates the entire joint. An accidental edit of a curve, or the
    noise of typical tests, affects one channel. The take itself shows which of them it is.
    """

    joints: NDArray[np.intp]
    """Joint of each channel of the group, ascending; a joint has at most three."""
    other_channels: Array
    """Largest outlier probability of the joint's channels in groups solved earlier."""

    def outlier_rates(
        self, outlier_probability: Array, observed: NDArray[np.bool_], rate: float
    ) -> Array:
        """Return each sample's prior probability of being an outlier.

        Parameters
        ----------
        outlier_probability : shape (n_frames, n_channels)
            Current probability of being an outlier, 0 where not `observed`.
        observed : same shape
        rate : float
            Fraction of outliers.
        """
        joint_outliers = self.other_channels.copy()
        for step in (1, 2):
            (first,) = np.nonzero(self.joints[step:] == self.joints[:-step])
            second = first + step
            joint_outliers[:, first] = np.maximum(
                joint_outliers[:, first], outlier_probability[:, second]
            )
            joint_outliers[:, second] = np.maximum(
                joint_outliers[:, second], outlier_probability[:, first]
            )
        n_observed, total_joint_outliers = (
            np.count_nonzero(observed),
            float(joint_outliers[observed].sum()),
        )
        joint_and_own = float((outlier_probability * joint_outliers).sum())
        rate_with_joint = min(
            joint_and_own
            / max(
                total_joint_outliers + MIN_OUTLIER_FRACTION * n_observed, MIN_OUTLIER_FRACTION
            ),
            MAX_OUTLIER_PROBABILITY,
        )
        if rate_with_joint <= rate:
            return np.full(joint_outliers.shape, rate)
        # This keeps the total rate unchanged.
        rate_without_joint = (rate * n_observed - rate_with_joint * total_joint_outliers) / max(
            n_observed - total_joint_outliers, 1.0
        )
        rate_without_joint = max(rate_without_joint, MIN_OUTLIER_PROBABILITY)
        return np.asarray(
            rate_without_joint + joint_outliers * (rate_with_joint - rate_without_joint)
        )
