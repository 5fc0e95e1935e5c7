"""Settings of pose completion from a library."""

from dataclasses import dataclass

from ...settings import Settings, setting


@dataclass(frozen=True, kw_only=True)
class PostureSettings(Settings):
    """Settings of `reconstruct_postures`."""

    causal: bool = setting(False, "Use only earlier frames, as in a live system; less smooth")
    n_neighbors: int = setting(
        30, "Number of library poses that each pose is made of; more gives more variety",
        minimum=2, maximum=200, label="Neighbors", former="n_neighbours",
    )  # fmt: skip
    n_dimensions: int = setting(
        20, "Dimensions in which a pose may differ from the mean of its neighbors",
        minimum=1, maximum=60, advanced=True, label="Dimensions",
    )  # fmt: skip
    noise: float = setting(
        0.005, "Position error of reliable joints; higher smooths them more", unit="m",
        minimum=1e-4, maximum=0.1,
    )  # fmt: skip
    smoothing: float = setting(
        0.1, "Time over which synthesized poses are smoothed", unit="s",
        minimum=0.0, maximum=2.0,
    )  # fmt: skip
    memory: float = setting(
        0.5, "Time for which a missing joint remembers where it was last observed", unit="s",
        minimum=0.02, maximum=10.0, advanced=True,
    )  # fmt: skip
    pace: float = setting(
        0.2, "Weight of velocity relative to pose in the search for similar poses; 0 as"
        " published",
        unit="s", minimum=0.0, maximum=2.0, advanced=True,
    )  # fmt: skip
    rounds: int = setting(
        2, "Number of searches for similar poses, each with the previous result",
        minimum=1, maximum=10, advanced=True,
    )  # fmt: skip


DEFAULT_SETTINGS = PostureSettings()
