"""Joints that are wrong as a whole: one channel's outlier makes its fellows' likely."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

MAX_OUTLIER_PROBABILITY = 0.9
"""Probability of being an outlier that no fellow can exceed."""
MIN_OUTLIER_PROBABILITY = 1e-4
"""Probability of being an outlier that every sample has."""
MIN_OUTLIER_FRACTION = 0.01
"""Share of a take that must be outliers to tell whether joints are wrong as a whole."""


@dataclass(frozen=True, eq=False)
class JointOutlierPrior:
    """Which channels belong to one joint, and how its channels outside this group fare.

    A tracker that loses a limb turns the whole joint; a slip of the hand in a curve, or the
    noise that methods are usually tested with, one channel. The take itself tells which it is.
    """

    joints: NDArray[np.intp]
    """Of each channel of the group, ascending; a joint has at most three."""
    other_channels: Array
    """Greatest outlier probability of its joint's channels that were solved for before."""

    def outlier_rates(
        self, outlier_probability: Array, observed: NDArray[np.bool_], rate: float
    ) -> Array:
        """Return how likely each sample is to be an outlier before it is looked at.

        Parameters
        ----------
        outside : shape (n_frames, n_channels)
            Probability of being an outlier so far, 0 where not `known`.
        known : same shape
        rate : float
            Share of outliers.
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
        # So that all together are as likely as before.
        rate_without_joint = (rate * n_observed - rate_with_joint * total_joint_outliers) / max(
            n_observed - total_joint_outliers, 1.0
        )
        rate_without_joint = max(rate_without_joint, MIN_OUTLIER_PROBABILITY)
        return np.asarray(
            rate_without_joint + joint_outliers * (rate_with_joint - rate_without_joint)
        )
