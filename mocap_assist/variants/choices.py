"""What an animator chooses for Vary and for a crowd, besides the solvers' own settings."""

from dataclasses import dataclass
from math import pi
from typing import NamedTuple

from ...solvers.denoising import PlantSettings
from ...solvers.settings import Settings, setting
from ...solvers.variation import VarySettings


@dataclass(frozen=True, kw_only=True)
class VaryChoices(Settings):
    """Of which actions, and how many variants."""

    actions: str = setting(
        "",
        "Names of the actions that show the behaviour, separated by semicolons; without any,"
        " what the armature plays",
    )
    n_variants: int = setting(20, "How many new actions", minimum=1, maximum=1000)
    plant_feet: bool = setting(True, "Keep feet from sliding while they stand")


class VaryBundle(NamedTuple):
    """All that the button Vary offers."""

    choices: VaryChoices
    varying: VarySettings
    planting: PlantSettings


@dataclass(frozen=True, kw_only=True)
class CrowdChoices(Settings):
    """How the members of a crowd differ in time and place."""

    delay: float = setting(
        1.0, "Latest start of a member after the current frame", unit="s",
        minimum=0.0, maximum=3600.0,
    )  # fmt: skip
    spread: float = setting(
        0.0, "Farthest that a member is shifted on the ground from where it stands", unit="m",
        minimum=0.0, maximum=1000.0,
    )  # fmt: skip
    turn: float = setting(
        0.0, "Farthest that a member is turned to either side", unit="rad",
        minimum=0.0, maximum=pi,
    )  # fmt: skip
    crowd_seed: int = setting(
        0, "Another seed makes another crowd of the same variants", minimum=0,
        maximum=2**31 - 1, label="Seed",
    )  # fmt: skip


class CrowdBundle(NamedTuple):
    """All that the button Assign to Selected offers."""

    choices: CrowdChoices
