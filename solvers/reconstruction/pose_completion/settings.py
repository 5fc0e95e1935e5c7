"""How postures are reconstructed from a library."""

from dataclasses import dataclass
from enum import Enum

from ...settings import Settings, setting


class PostureMethod(Enum):
    """How a posture is chosen among those that its neighbours span."""

    PROBABLE = "probable"
    """The most probable one, if the neighbours are a sample of a normal distribution."""
    PUBLISHED = "published"
    """The one of least energy by the stochastic search of [SHJT13], frame by frame. Nothing
    else is done: `smoothing`, `memory`, `pace` and `rounds` have no effect."""


@dataclass(frozen=True, kw_only=True)
class PostureSettings(Settings):
    """How postures are reconstructed."""

    method: PostureMethod = setting(
        PostureMethod.PROBABLE, "What is taken for the best posture among those that are alike"
    )
    causal: bool = setting(
        False, "Use only what came before each frame, as a live system must; less smooth"
    )
    n_neighbours: int = setting(
        30, "Postures of the library that each posture is made of; more vary more",
        minimum=2, maximum=200,
    )  # fmt: skip
    n_dimensions: int = setting(
        20, "Ways in which a posture may differ from its neighbours' mean",
        minimum=1, maximum=60, advanced=True,
    )  # fmt: skip
    noise: float = setting(
        0.005, "Error of joints that are trusted; more makes them steadier", unit="m",
        minimum=1e-4, maximum=0.1,
    )  # fmt: skip
    smoothing: float = setting(
        0.1, "Over how long synthesised postures are smoothed", unit="s",
        minimum=0.0, maximum=2.0,
    )  # fmt: skip
    memory: float = setting(
        0.5, "How long a lost joint remembers where it was seen", unit="s",
        minimum=0.02, maximum=10.0, advanced=True,
    )  # fmt: skip
    pace: float = setting(
        0.2, "How much movement counts against the posture when looking for like ones; 0 as"
        " published", unit="s", minimum=0.0, maximum=2.0, advanced=True,
    )  # fmt: skip
    rounds: int = setting(
        2, "How often like postures are looked for, each time with what was found before",
        minimum=1, maximum=10, advanced=True,
    )  # fmt: skip
    seed: int = setting(
        0, "Start of the random numbers of the published method", minimum=0, maximum=2**31 - 1,
        advanced=True,
    )  # fmt: skip


DEFAULT_SETTINGS = PostureSettings()
