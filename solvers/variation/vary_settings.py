"""Settings of Vary."""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from ..settings import Settings, setting
from .partitions import Partition

Array = NDArray[np.float64]


class Method(Enum):
    """Method that draws variants."""

    MIXTURE = "mixture"
    """Mix the examples in common time, with Gaussian-process weights (`mixtures`)."""
    COREGIONALISED = "coregionalised"
    """Draw frame by frame from a latent factor model of each joint (`stepwise_draw`)."""
    PUBLISHED = "published"
    """Draw frame by frame, as written in [ZH14, chapter 4]."""


@dataclass(frozen=True, kw_only=True)
class VarySettings(Settings):
    """Strength and kind of variation."""

    method: Method = setting(
        Method.MIXTURE, "Method that draws variants; mixtures of the examples measured best",
        advanced=True,
    )  # fmt: skip
    amount: float = setting(
        1.0, "0 copies an example, 1 varies as much as the examples do, 2 more strongly",
        minimum=0.0, maximum=2.0,
    )  # fmt: skip
    timing: float = setting(
        1.0, "Factor on the amount for timing; 0 keeps the timing of the example",
        minimum=0.0, maximum=2.0,
    )  # fmt: skip
    trunk: float = setting(
        1.0, "Factor on the amount for trunk and head", minimum=0.0, maximum=2.0
    )
    left_arm: float = setting(
        1.0, "Factor on the amount for the left arm", minimum=0.0, maximum=2.0
    )
    right_arm: float = setting(
        1.0, "Factor on the amount for the right arm", minimum=0.0, maximum=2.0
    )
    left_leg: float = setting(
        1.0, "Factor on the amount for the left leg", minimum=0.0, maximum=2.0
    )
    right_leg: float = setting(
        1.0, "Factor on the amount for the right leg", minimum=0.0, maximum=2.0
    )
    length: float = setting(
        1.0, "Duration of the variants relative to the examples; 2 is twice as slow",
        minimum=0.25, maximum=4.0,
    )  # fmt: skip
    pin_start: bool = setting(False, "Keep the first pose of the example")
    pin_end: bool = setting(False, "Keep the last pose of the example")
    base: int = setting(
        0, "Number of the example that an amount below 1 approaches, from 1; 0 takes the"
        " example nearest to all others",
        minimum=0, maximum=10_000, advanced=True,
    )  # fmt: skip
    seed: int = setting(
        0, "Random seed; another one makes other variants", minimum=0, maximum=2**31 - 1
    )

    def amounts(self) -> Array:
        """Return the amount of each partition, shape (5,)."""
        return self.amount * np.array([getattr(self, part.name.lower()) for part in Partition])


DEFAULT_SETTINGS = VarySettings()
