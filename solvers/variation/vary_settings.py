"""Settings of Vary: the method, and how far each part of the body may vary."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..settings import Choice, Settings, setting
from .curves import Partition


class VaryMethod(Choice):
    """Method that draws variants."""

    MIXTURE = "mixture", "Mix time-aligned examples with weights from Gaussian processes"
    """Mix the examples in common time, with Gaussian-process weights (`mixtures`)."""
    COREGIONALISED = (
        "coregionalised",
        "Draw frame by frame with a latent factor model of each joint",
        "Coregionalized",
    )
    """Draw frame by frame from a latent factor model of each joint (`published`)."""
    PUBLISHED = "published", "Draw frame by frame as published by Zhou (2014)", "Zhou 2014"
    """Draw frame by frame, as written in [ZH14, chapter 4]."""


@dataclass(frozen=True, kw_only=True)
class VarySettings(Settings):
    """Strength and kind of variation."""

    method: VaryMethod = setting(
        VaryMethod.MIXTURE, "Choose how to generate variants; the default performed best in"
        " tests",
        advanced=True, research=True,
    )  # fmt: skip
    amount: float = setting(
        1.0, "Amount of variation; 0 copies an example, 1 varies as the examples do, 2"
        " exaggerates",
        minimum=0.0, maximum=2.0,
    )  # fmt: skip
    timing: float = setting(
        1.0, "Amount of variation in timing; 0 keeps the timing of the example",
        minimum=0.0, maximum=2.0,
    )  # fmt: skip
    trunk: float = setting(
        1.0, "Amount of variation of trunk and head", minimum=0.0, maximum=2.0
    )
    left_arm: float = setting(
        1.0, "Amount of variation of the left arm", minimum=0.0, maximum=2.0
    )
    right_arm: float = setting(
        1.0, "Amount of variation of the right arm", minimum=0.0, maximum=2.0
    )
    left_leg: float = setting(
        1.0, "Amount of variation of the left leg", minimum=0.0, maximum=2.0
    )
    right_leg: float = setting(
        1.0, "Amount of variation of the right leg", minimum=0.0, maximum=2.0
    )
    length: float = setting(
        1.0, "Length relative to the examples; 2 is half as fast",
        minimum=0.25, maximum=4.0,
    )  # fmt: skip
    pin_start: bool = setting(False, "Start in the pose in which the example starts")
    pin_end: bool = setting(False, "End in the pose in which the example ends")
    base: int = setting(
        0, "Example to copy at amounts below 1, counted from 1; 0 chooses the most typical one",
        minimum=0, maximum=10_000, advanced=True, label="Base Example",
    )  # fmt: skip
    seed: int = setting(
        0,
        "Random seed; a different seed generates different variants",
        minimum=0,
        maximum=2**31 - 1,
    )

    def amounts(self) -> Array:
        """Return the amount of each partition, shape (5,)."""
        return self.amount * np.array([getattr(self, part.name.lower()) for part in Partition])


DEFAULT_SETTINGS = VarySettings()
