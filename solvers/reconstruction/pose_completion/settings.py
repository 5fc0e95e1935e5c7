"""Settings of pose completion from a library."""

from dataclasses import dataclass
from enum import Enum

from ...settings import Settings, setting


class PostureMethod(Enum):
    """Method that chooses a pose in the space of its neighbors."""

    PROBABLE = "probable"
    """The most probable pose, if the neighbors are samples of a normal distribution."""
    PUBLISHED = "published"
    """The pose of least energy by the stochastic search of [SHJT13], frame by frame. Nothing
    else is done: `smoothing`, `memory`, `pace` and `rounds` have no effect."""


@dataclass(frozen=True, kw_only=True)
class PostureSettings(Settings):
    """Settings of `reconstruct_postures`."""

    method: PostureMethod = setting(
        PostureMethod.PROBABLE, "Criterion for the best pose among the neighbors"
    )
    causal: bool = setting(False, "Use only earlier frames, as a live system must; less smooth")
    n_neighbours: int = setting(
        30, "Library poses that each pose is computed from; more allow more variation",
        minimum=2, maximum=200,
    )  # fmt: skip
    n_dimensions: int = setting(
        20, "Principal components in which a pose may differ from its neighbors' mean",
        minimum=1, maximum=60, advanced=True,
    )  # fmt: skip
    noise: float = setting(
        0.005, "Standard deviation of reliable joints; higher values smooth more", unit="m",
        minimum=1e-4, maximum=0.1,
    )  # fmt: skip
    smoothing: float = setting(
        0.1, "Time over which synthesized poses are smoothed", unit="s",
        minimum=0.0, maximum=2.0,
    )  # fmt: skip
    memory: float = setting(
        0.5, "Time over which a missing joint moves from its last position to the library's",
        unit="s", minimum=0.02, maximum=10.0, advanced=True,
    )  # fmt: skip
    pace: float = setting(
        0.2, "Time that turns velocity into distance in the search for neighbors; higher weighs"
        " movement more, 0 as published", unit="s", minimum=0.0, maximum=2.0, advanced=True,
    )  # fmt: skip
    rounds: int = setting(
        2, "Searches for neighbors; each uses the result of the one before",
        minimum=1, maximum=10, advanced=True,
    )  # fmt: skip
    seed: int = setting(
        0, "Seed of the random numbers of the published method", minimum=0, maximum=2**31 - 1,
        advanced=True,
    )  # fmt: skip


DEFAULT_SETTINGS = PostureSettings()
