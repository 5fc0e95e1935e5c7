"""Settings of planting: blends, and what may move to hold a foot."""

from dataclasses import dataclass

from ..settings import Settings, setting


@dataclass(frozen=True, kw_only=True)
class PlantSettings(Settings):
    """Settings of `plant_feet`."""

    blend: float = setting(
        0.3,
        "Time to blend a planted foot back to its own motion; higher is softer and longer",
        unit="s", minimum=0.02, maximum=2.0,
    )  # fmt: skip
    hold: float = setting(
        10.0,
        "Longest time a sliding foot stays fixed before it may slide on; higher is stricter",
        unit="s",
        minimum=0.5,
        maximum=1000.0,
        advanced=True,
        label="Max Hold Time",
    )
    hold_rotation: bool = setting(
        True,
        "Also keep feet that stand flat from turning and tilting",
        label="Lock Foot Rotation",
    )
    floor: bool = setting(
        True,
        "Level planted feet that are near the floor, all at one height",
        label="Level Floor",
    )
    softness: float = setting(
        0.01,
        "Fraction of the leg length held in reserve; higher bends knees and lowers hips more",
        minimum=0.0, maximum=0.2, advanced=True, label="Leg Reserve",
    )  # fmt: skip
    spare_knees: bool = setting(
        True, "Shift hips and heels slightly so that knees bend smoothly",
        label="Protect Knees",
    )  # fmt: skip
    move_root: bool = setting(
        True, "Shift the hips slightly and smoothly where a leg cannot reach", label="Move Hips"
    )
    hands_and_knees: bool = setting(
        True,
        "Also keep hands and knees on the floor in place, and hips where they are keyed",
        label="Body Contacts",
    )
