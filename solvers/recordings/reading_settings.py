"""Settings for what a file may not say about itself: axes, unit, floor, height of the actor."""

from dataclasses import dataclass

from ..motion import AxisName
from ..motion.humanoid import ADULT_STATURE_M
from ..settings import Choice, Settings, setting


class Axis(Choice):
    """An axis of a file."""

    AUTO = "auto", "Determine the axis from the file and from the body in it", "Auto"
    X = "x", "Use the file's +X axis", "X"
    Y = "y", "Use the file's +Y axis", "Y"
    Z = "z", "Use the file's +Z axis", "Z"
    MINUS_X = "-x", "Use the file's -X axis", "-X"
    MINUS_Y = "-y", "Use the file's -Y axis", "-Y"
    MINUS_Z = "-z", "Use the file's -Z axis", "-Z"

    @property
    def axis(self) -> AxisName | None:
        """The axis of the file; None estimates it."""
        return AXES.get(self)

    @classmethod
    def of(cls, axis: AxisName) -> "Axis":
        """Return the choice that means an axis."""
        return next(each for each in cls if each.axis == axis)


AXES: dict[Axis, AxisName] = {
    Axis.X: "X", Axis.Y: "Y", Axis.Z: "Z", Axis.MINUS_X: "-X", Axis.MINUS_Y: "-Y",
    Axis.MINUS_Z: "-Z",
}  # fmt: skip


class Unit(Choice):
    """Unit of the lengths in files."""

    GUESS = "guess", "Read the unit from the file, or estimate it from the body size", "Auto"
    METRES = "metres", "Read lengths in the files as meters", "Meters"
    CENTIMETRES = "centimetres", "Read lengths in the files as centimeters", "Centimeters"
    MILLIMETRES = "millimetres", "Read lengths in the files as millimeters", "Millimeters"
    INCHES = "inches", "Read lengths in the files as inches", "Inches"
    FEET = "feet", "Read lengths in the files as feet", "Feet (ft)"

    @property
    def meters(self) -> float | None:
        """Meters in one of these; None if the file states it or its reader estimates it."""
        return METERS.get(self)


METERS = {
    Unit.METRES: 1.0, Unit.CENTIMETRES: 0.01, Unit.MILLIMETRES: 0.001, Unit.INCHES: 0.0254,
    Unit.FEET: 0.3048,
}  # fmt: skip


class FloorPlacement(Choice):
    """Whether a take is moved up or down onto the floor."""

    AUTO = (
        "auto",
        "Place takes without a measured floor: depth cameras, video models, hips at the origin",
        "Auto",
    )
    ALWAYS = "always", "Put the lowest level that the body rests on at height 0", "On"
    NEVER = "never", "Keep the heights of the file", "Off"


@dataclass(frozen=True, kw_only=True)
class ReadingSettings(Settings):
    """Conventions that a file may not state."""

    up: Axis = setting(
        Axis.AUTO,
        "Axis of the file that points up; set it if the actor lies on the floor",
        label="Up",
    )
    forward: Axis = setting(
        Axis.AUTO,
        "Axis of the file along which the actor faces; it becomes -Y, the front view",
        label="Forward",
    )
    unit: Unit = setting(
        Unit.GUESS, "Length unit of the files; the import message reports what Auto found"
    )
    height: float = setting(
        ADULT_STATURE_M,
        "Stature of the actor for SMPL files, which have no bone lengths",
        unit="m",
        minimum=0.1,
        maximum=9.0,
    )


@dataclass(frozen=True, kw_only=True)
class FloorPlacementSettings(Settings):
    """Placement of a take relative to the floor."""

    place_on_floor: FloorPlacement = setting(
        FloorPlacement.AUTO,
        "Move the take so that the lowest level the actor stands on is height 0",
        label="Place on Floor",
    )


DEFAULT_READING = ReadingSettings()
