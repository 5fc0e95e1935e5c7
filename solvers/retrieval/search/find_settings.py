"""What is alike, and how closely it is looked at."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...settings import Choice, Settings, setting
from ..index import STANCE
from ..postures import BodyPart

BELIEF = 4.0
"""Power of the share of a part that is known by which it counts."""
STANCE_OF_SENSOR = 0.4
STILL = 0.05
"""Activity of the busiest part below which the query is a pose: all count alike, or nearly."""
AT_REST = 0.2
"""Of the busiest part's activity that one counts as having that does not move at all."""


class FindMethod(Choice):
    """How clips are compared."""

    WORDS = "words and warping", "Compare pose words of each body part, then align in time"
    PUBLISHED = "published", "Compare pyramids of sparse codes; slower and less accurate"


@dataclass(frozen=True, kw_only=True)
class FindSettings(Settings):
    """Settings of `find_similar`.

    `stance`, `busy` and what was tracked of the query count where it is compared with clips.
    How like clips are to each other (`n_alike`) does not depend on the query, and is told with
    the usual stance and all parts alike, once for all queries, as long as all parts are asked
    for and the library has no more than `search_index.MOST_COMPARED` spans. Otherwise it is
    told as the query is.
    """

    method: FindMethod = setting(
        FindMethod.WORDS, "Search method; the default is faster and measured best",
        advanced=True,
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
        minimum=0.0, maximum=4.0, advanced=True, label="Weight by Motion",
    )  # fmt: skip
    stance: float = setting(
        STANCE, "Weight of the mean pose against the motion; at most 0.4 for sensor recordings",
        minimum=0.0, maximum=1.0, advanced=True, label="Pose Weight",
    )  # fmt: skip
    n_warped: int = setting(
        128, "Number of best clips to compare in time as well; more is slower",
        minimum=0, maximum=2_000, advanced=True, label="Time-Aligned Clips",
    )  # fmt: skip
    warping: float = setting(
        3.0, "Weight of timing against poses",
        minimum=0.0, maximum=100.0, advanced=True, label="Timing Weight",
    )  # fmt: skip
    n_alike: int = setting(
        8, "Similar clips that also vote on each result; at most one in twenty clips",
        minimum=0, maximum=100, advanced=True, label="Neighbors",
    )  # fmt: skip
    n_aligned: int = setting(
        8, "Number of best matches to align frame by frame with the query",
        minimum=0, maximum=10_000, advanced=True, label="Aligned Matches",
    )  # fmt: skip

    def for_sensor(self) -> "FindSettings":
        """Return settings for a query that a sensor saw."""
        return replace(self, stance=min(self.stance, STANCE_OF_SENSOR))

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
        most = np.maximum(activity[wanted].max(), STILL)
        moved = np.minimum(activity / most, 1.0) + AT_REST
        if not coverage[wanted].any():
            names = ", ".join(part.value for part in chosen)
            raise InvalidMotionError(f"The query shows nothing of what is asked for: {names}.")
        weights = np.where(wanted, reliability**BELIEF * moved**self.busy, 0.0)
        return np.asarray(weights * len(weights) / weights.sum())


USUAL = FindSettings()
