"""What is alike, and how closely it is looked at."""

from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...settings import Settings, setting
from ..index import MEAN_POSTURE_WEIGHT
from ..postures import BodyPart

RELIABILITY_POWER = 4.0
"""Power of the share of a part that is known by which it counts."""
SENSOR_MEAN_POSTURE_WEIGHT = 0.4
MIN_ACTIVITY = 0.05
"""Activity of the busiest part below which the query is a pose: all count alike, or nearly."""
REST_WEIGHT = 0.2
"""Of the busiest part's activity that one counts as having that does not move at all."""


class FindMethod(Enum):
    """How clips are compared."""

    WORDS = "words and warping"
    PUBLISHED = "published"


@dataclass(frozen=True, kw_only=True)
class FindSettings(Settings):
    """Settings of `find_similar`.

    `stance`, `busy` and the tracked joints of the query weight the comparison of the query with
    the clips. The distances between clips (`n_alike`) do not depend on the query if all parts
    are compared and the library has at most `search_index.MAX_PAIRWISE_SPANS` segments: they
    are then computed once for all queries, with the default stance and equal part weights.
    Otherwise they use the weights of the query.
    """

    method: FindMethod = setting(
        FindMethod.WORDS, "Words of each part of the body and warping measured best; published"
        " is pyramids of sparse codes of the whole body, which is slow and finds less",
        advanced=True,
    )  # fmt: skip

    n_matches: int = setting(
        0, "Clips that are told, the best first; 0 ranks all of them",
        minimum=0, maximum=1_000_000, label="Matches",
    )  # fmt: skip
    trunk: bool = setting(True, "Compare trunk and head, and how the body travels")
    left_arm: bool = setting(True, "Compare the left arm")
    right_arm: bool = setting(True, "Compare the right arm")
    left_leg: bool = setting(True, "Compare the left leg")
    right_leg: bool = setting(True, "Compare the right leg")
    busy: float = setting(
        0.5, "How much more those parts of the body count that move more in the query; at 0 an"
        " arm that only hangs counts like any other",
        minimum=0.0, maximum=4.0, advanced=True, label="Busy Parts",
    )  # fmt: skip
    stance: float = setting(
        MEAN_POSTURE_WEIGHT, "Weight of the mean posture relative to the movement around it;"
        " at most 0.4 for sensor data, because sensors place joints differently",
        minimum=0.0, maximum=1.0, advanced=True,
    )  # fmt: skip
    n_warped: int = setting(
        128, "Best clips whose course in time is compared as well; more is slower",
        minimum=0, maximum=2_000, advanced=True, label="Warped",
    )  # fmt: skip
    warping: float = setting(
        3.0, "How much the course in time counts beside which postures there are",
        minimum=0.0, maximum=100.0, advanced=True,
    )  # fmt: skip
    n_alike: int = setting(
        8, "Clips most like each one that tell as well how like the query it is; at most one"
        " of twenty clips",
        minimum=0, maximum=100, advanced=True, label="Ask the Like",
    )  # fmt: skip
    n_aligned: int = setting(
        8, "Best matches whose frames are aligned with the query's",
        minimum=0, maximum=10_000, advanced=True, label="Aligned",
    )  # fmt: skip

    def for_sensor(self) -> "FindSettings":
        """Return settings for a query that a sensor saw."""
        return replace(self, stance=min(self.stance, SENSOR_MEAN_POSTURE_WEIGHT))

    @property
    def asks_for_all(self) -> bool:
        """Whether all parts of the body are compared."""
        return all(getattr(self, part.name.lower()) for part in BodyPart)

    def part_weights(
        self,
        coverage: NDArray[np.float64],
        reliability: NDArray[np.float64],
        activity: NDArray[np.float64],
    ) -> NDArray[np.float64]:
        """Return how much each part counts, shape (5,), on average 1.

        Parameters
        ----------
        coverage : shape (5,)
            How much of each part was tracked.
        reliability : shape (5,)
            How much of what each part does is known, from itself or from others; not 0.
        activity : shape (5,)
            How much each part moves, as a share of the usual.

        Raises
        ------
        InvalidMotionError
            No part is chosen, or none of those that are was tracked.
        """
        chosen = [part for part in BodyPart if getattr(self, part.name.lower())]
        if not chosen:
            raise InvalidMotionError("No part of the body is chosen; choose at least one.")
        wanted = np.array([part in chosen for part in BodyPart])
        most = np.maximum(activity[wanted].max(), MIN_ACTIVITY)
        moved = np.minimum(activity / most, 1.0) + REST_WEIGHT
        if not coverage[wanted].any():
            names = ", ".join(part.value for part in chosen)
            raise InvalidMotionError(f"The query shows nothing of what is asked for: {names}.")
        weights = np.where(wanted, reliability**RELIABILITY_POWER * moved**self.busy, 0.0)
        return np.asarray(weights * len(weights) / weights.sum())


DEFAULT_FIND_SETTINGS = FindSettings()
