"""Axes and unit of the file that a recording was read from."""

from dataclasses import dataclass
from typing import Literal

AxisName = Literal["X", "Y", "Z", "-X", "-Y", "-Z"]
"""An axis of a file, with its sign."""
UNIT_NAMES = {
    1.0: "meters", 0.1: "decimeters", 0.01: "centimeters", 0.001: "millimeters",
    0.0254: "inches", 0.3048: "feet",
}  # fmt: skip
OFFSET_ADDED = "positions added to offsets"


@dataclass(frozen=True)
class FileConventions:
    """Interpretation of the numbers of a file; stated by it, or estimated from the body."""

    up: AxisName = "Z"
    """Axis of the file that became +Z."""
    forward: AxisName = "-Y"
    """Axis of the file that became -Y, where actors face."""
    unit: float = 1.0
    """Meters per unit of the file."""
    rest_up: AxisName | None = None
    """Axis of the rest pose that became +Z; None where that of the motion did."""
    offset_added: bool = False
    """Whether the position channels of a BVH file were added to the offsets."""
    confidence: float = 1.0
    """In the up axis, 0 to 1; 1 where the file states it."""
    is_unit_guessed: bool = False
    """Whether the size of the body overruled the unit that the file states."""
    stated_up: AxisName | None = None
    """Axis that the file states to be up, where the body refuted it."""
    has_floor: bool = True
    """Whether height 0 is a measured floor: not with depth cameras and video models."""
    is_mirrored: bool = False
    """Whether left and right were swapped in the file, and X was negated."""

    @property
    def is_certain(self) -> bool:
        """Whether a report need not mention the confidence in the up axis."""
        return f"{self.confidence:.0%}" == "100%"

    def sentence(self) -> str:
        """Return what was estimated, for a report: without a period."""
        certainty = "" if self.is_certain else self._confidence_in_up()
        rest = "" if self.rest_up in {None, self.up} else self._up_at_rest()
        added = f", {OFFSET_ADDED}" if self.offset_added else ""
        return (
            f"{self.up} is up{rest}{certainty}{added}, {self.forward} is forward, lengths are"
            f" in {unit_name(self.unit)}"
        )

    def _confidence_in_up(self) -> str:
        return f" ({self.confidence:.0%} confidence)"

    def _up_at_rest(self) -> str:
        return f", {self.rest_up} in the rest pose"


def unit_name(unit: float) -> str:
    """Return the name of a unit of length in the plural, or its length in meters."""
    return UNIT_NAMES.get(unit, f"units of {unit:.4g} m")
