"""What an animator may choose about variants."""

from dataclasses import dataclass
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from ..settings import Settings, setting
from .partitions import Partition

Array = NDArray[np.float64]


class Method(Enum):
    """How variants are drawn."""

    MIXTURE = "mixture"
    """Examples in common time are mixed; shares are Gaussian processes (`mixtures`)."""
    COREGIONALISED = "coregionalised"
    """Frame after frame, with a latent factor model of each joint (`stepwise_draw`)."""
    PUBLISHED = "published"
    """Frame after frame, as written in [ZH14, chapter 4]."""


@dataclass(frozen=True, kw_only=True)
class VarySettings(Settings):
    """How strongly and in what variants differ."""

    method: Method = setting(
        Method.MIXTURE, "How variants are drawn; mixtures of the examples measured best",
        advanced=True,
    )  # fmt: skip
    amount: float = setting(
        1.0, "0 copies an example, 1 varies as much as the examples do, 2 boldly",
        minimum=0.0, maximum=2.0,
    )  # fmt: skip
    timing: float = setting(
        1.0, "Share of the amount for how fast it goes; 0 keeps the time of the example",
        minimum=0.0, maximum=2.0,
    )  # fmt: skip
    trunk: float = setting(
        1.0, "Share of the amount for trunk and head", minimum=0.0, maximum=2.0
    )
    left_arm: float = setting(
        1.0, "Share of the amount for the left arm", minimum=0.0, maximum=2.0
    )
    right_arm: float = setting(
        1.0, "Share of the amount for the right arm", minimum=0.0, maximum=2.0
    )
    left_leg: float = setting(
        1.0, "Share of the amount for the left leg", minimum=0.0, maximum=2.0
    )
    right_leg: float = setting(
        1.0, "Share of the amount for the right leg", minimum=0.0, maximum=2.0
    )
    length: float = setting(
        1.0, "Length of the variants by that of the examples; 2 is twice as slow",
        minimum=0.25, maximum=4.0,
    )  # fmt: skip
    pin_start: bool = setting(False, "Begin in the pose in which the example begins")
    pin_end: bool = setting(False, "End in the pose in which the example ends")
    base: int = setting(
        0, "Example that is copied where the amount is less than 1, counted from 1; 0 takes the"
        " one that is nearest to all others",
        minimum=0, maximum=10_000, advanced=True,
    )  # fmt: skip
    seed: int = setting(0, "Another seed makes other variants", minimum=0, maximum=2**31 - 1)

    def amounts(self) -> Array:
        """Return the amount of each partition, shape (5,)."""
        return self.amount * np.array([getattr(self, part.name.lower()) for part in Partition])


USUAL = VarySettings()
