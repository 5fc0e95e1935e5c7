"""Settings of the search for similar clips."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...settings import Choice, Settings, setting
from ..index import MEAN_POSTURE_WEIGHT
from ..postures import BodyPart

RELIABILITY_POWER = 4.0
"""Exponent of the reliability of a part in its weight. It guards queries with a limb that was
hardly tracked."""
SENSOR_MEAN_POSTURE_WEIGHT = 0.4
"""Maximum weight of the mean posture for sensor data. Chosen by a sweep over the training data
of docs/benchmarks/retrieval.md."""
MIN_ACTIVITY = 0.05
"""Movement of the most active part, relative to the average, below which the query counts as a
static pose. It guards queries of a static pose."""
REST_WEIGHT = 0.2
"""Activity of a part at rest, as a fraction of that of the most active part. It guards
queries that move one hand: any clip that moves this hand would answer them."""


class FindMethod(Choice):
    """Method of the comparison of clips."""

    WORDS = "words and warping", "Compare pose words of each body part, then align in time"
    PUBLISHED = "published", "Compare pyramids of sparse codes; slower and less accurate"


@dataclass(frozen=True, kw_only=True)
class FindSettings(Settings):
    """Settings of `find_similar`.

    `stance`, `busy` and the tracked joints of the query weight the comparison of the query with
    the clips. The distances between clips (`n_neighbors`) do not depend on the query if all
    parts are compared and the library has at most `search_index.MAX_PAIRWISE_SPANS` segments:
    they are then computed once for all queries, with the default stance and equal part weights.
    Otherwise they use the weights of the query.
    """

    method: FindMethod = setting(
        FindMethod.WORDS, "Search method; the default is faster and performed best in tests",
        advanced=True, research=True,
    )  # fmt: skip

    n_matches: int = setting(
        0, "Number of results, best first; 0 ranks all clips",
        minimum=0, maximum=1_000_000, label="Results",
    )  # fmt: skip
    trunk: bool = setting(True, "Compare trunk, head and the travel of the body")
    left_arm: bool = setting(True, "Compare the left arm")
    right_arm: bool = setting(True, "Compare the right arm")
    left_leg: bool = setting(True, "Compare the left leg")
    right_leg: bool = setting(True, "Compare the right leg")
    busy: float = setting(
        0.5, "Weight body parts by their motion in the query; at 0 all parts count the same",
        minimum=0.0, maximum=4.0, advanced=True, research=True, label="Motion Weight",
    )  # fmt: skip
    stance: float = setting(
        MEAN_POSTURE_WEIGHT,
        "Weight of the mean pose relative to the motion; at most 0.4 for sensor recordings",
        minimum=0.0, maximum=1.0, advanced=True, research=True, label="Pose Weight",
    )  # fmt: skip
    n_warped: int = setting(
        128, "Number of best clips to compare in time as well; more is slower",
        minimum=0, maximum=2_000, advanced=True, research=True, label="Aligned Clips",
    )  # fmt: skip
    warping: float = setting(
        3.0, "Weight of timing relative to poses",
        minimum=0.0, maximum=100.0, advanced=True, research=True, label="Timing Weight",
    )  # fmt: skip
    n_neighbors: int = setting(
        8, "Similar clips that also vote on each result; at most one in twenty clips",
        minimum=0, maximum=100, advanced=True, research=True, label="Neighbors",
        former="n_alike",
    )  # fmt: skip
    n_aligned: int = setting(
        8, "Number of best matches to align frame by frame with the query",
        minimum=0, maximum=10_000, advanced=True, research=True, label="Aligned Matches",
    )  # fmt: skip

    def for_sensor(self) -> "FindSettings":
        """Return the settings for sensor data."""
        return replace(self, stance=min(self.stance, SENSOR_MEAN_POSTURE_WEIGHT))

    @property
    def compares_all_parts(self) -> bool:
        """Whether all body parts are compared."""
        return all(getattr(self, part.name.lower()) for part in BodyPart)

    def part_weights(
        self,
        coverage: NDArray[np.float64],
        reliability: NDArray[np.float64],
        activity: NDArray[np.float64],
    ) -> NDArray[np.float64]:
        """Return the weight of each part, shape (5,), with mean 1.

        Parameters
        ----------
        coverage : shape (5,)
            Tracked fraction of each part.
        reliability : shape (5,)
            Explained fraction of the variance of each part; not 0.
        activity : shape (5,)
            Movement of each part relative to the average.

        Raises
        ------
        InvalidMotionError
            No part is selected, or none of the selected parts was tracked.
        """
        selected = [part for part in BodyPart if getattr(self, part.name.lower())]
        if not selected:
            raise InvalidMotionError("No part of the body is chosen; choose at least one.")
        is_selected = np.array([part in selected for part in BodyPart])
        max_activity = np.maximum(activity[is_selected].max(), MIN_ACTIVITY)
        relative_activity = np.minimum(activity / max_activity, 1.0) + REST_WEIGHT
        if not coverage[is_selected].any():
            names = ", ".join(part.value for part in selected)
            raise InvalidMotionError(
                f"The query has no tracked joints in: {names}. Select other body parts."
            )
        weights = np.where(
            is_selected, reliability**RELIABILITY_POWER * relative_activity**self.busy, 0.0
        )
        return np.asarray(weights * len(weights) / weights.sum())


DEFAULT_FIND_SETTINGS = FindSettings()
