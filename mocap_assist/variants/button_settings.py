"""Settings of Vary and of crowds, in addition to those of the solvers."""

from dataclasses import dataclass
from math import pi
from typing import NamedTuple

from ...solvers.denoising import PlantSettings
from ...solvers.settings import Settings, setting
from ...solvers.variation import VarySettings


@dataclass(frozen=True, kw_only=True)
class VaryChoices(Settings):
    """Source actions, and the number of variants."""

    actions: str = setting(
        "",
        "Example actions of one behavior, separated by semicolons; empty for the current"
        " action",
    )
    n_variants: int = setting(
        20, "Number of new actions to generate", minimum=1, maximum=1000, label="Variants"
    )
    plant_feet: bool = setting(True, "Keep planted feet from sliding")


class VaryBundle(NamedTuple):
    """Settings of the button Vary."""

    choices: VaryChoices
    varying: VarySettings
    planting: PlantSettings


@dataclass(frozen=True, kw_only=True)
class CrowdChoices(Settings):
    """Differences of the members of a crowd in time and position."""

    delay: float = setting(
        1.0, "Latest start after the current frame", unit="s",
        minimum=0.0, maximum=3600.0,
    )  # fmt: skip
    spread: float = setting(
        0.0, "Largest distance that each armature is moved on the ground", unit="m",
        minimum=0.0, maximum=1000.0,
    )  # fmt: skip
    turn: float = setting(
        0.0, "Largest angle that each armature is rotated to either side", unit="rad",
        minimum=0.0, maximum=pi,
    )  # fmt: skip
    crowd_seed: int = setting(
        0, "Random seed; a different seed arranges the same variants differently", minimum=0,
        maximum=2**31 - 1, label="Seed",
    )  # fmt: skip


class CrowdBundle(NamedTuple):
    """Settings of the button Assign to Selected."""

    choices: CrowdChoices
