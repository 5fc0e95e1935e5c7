"""Settings of Fix My Take, in addition to those of the solver."""

from dataclasses import dataclass
from typing import NamedTuple

from ...solvers.settings import Settings, setting
from ...solvers.workflows import FixSettings


@dataclass(frozen=True, kw_only=True)
class FixChoices(Settings):
    """Recipient of the fixed motion."""

    rig: str = setting(
        "",
        "Armature that also receives the fixed motion, such as a production rig; empty: none",
        label="Retarget To",
    )


class FixBundle(NamedTuple):
    """Settings of the button."""

    fixing: FixSettings
    choices: FixChoices = FixChoices()
