"""Presets: named values of a few settings, for the buttons and for both command lines.

A preset changes only the settings that presets of its verb mention. Those that it leaves out
get their defaults, so that *Light* after *Heavy* is the same as *Light* alone.
"""

from collections.abc import Mapping
from typing import Any, NamedTuple

from .errors import InvalidSettingError


class Preset(NamedTuple):
    """Values of some settings, and the takes that they suit."""

    help: str
    """What it is for, for the tooltip and the manual."""
    values: Mapping[str, Any]
    """By the name of the setting; a choice by its stored value. The others are defaults."""


PRESETS: dict[str, dict[str, Preset]] = {
    "denoise": {
        "Light": Preset(
            "Apply half of the correction, and let planted feet turn",
            {"strength": 0.5, "hold_rotation": False},
        ),
        "Normal": Preset("Use the defaults", {}),
        "Heavy": Preset(
            "Keep feet in place for as long as they stand, with long blends",
            {"blend": 0.5, "hold": 1000.0, "softness": 0.02},
        ),
        "Optical": Preset(
            "Keep the height and rotation of feet, which a calibrated stage measures",
            {"floor": False, "hold_rotation": False},
        ),
        "Suit": Preset(
            "Keep feet in place for as long as they stand, against drift of the hips",
            {"hold": 1000.0},
        ),
        "Video AI": Preset(
            "Blend feet for longer, since contacts in videos are found late",
            {"blend": 0.5, "hold": 1000.0},
        ),
        "Depth Camera": Preset(
            "Blend feet for longer, and reserve leg length against pops of the knees",
            {"blend": 0.5, "softness": 0.02},
        ),
    },
    "reconstruct": {
        "Light": Preset(
            "Smooth less, and rely more on joints that the sensor guessed",
            {"smoothing": 0.025, "inferred": 0.75},
        ),
        "Normal": Preset("Use the defaults", {}),
        "Heavy": Preset(
            "Smooth more, and rebuild joints that the sensor guessed",
            {"smoothing": 0.1, "inferred": 0.0},
        ),
        "Video AI": Preset(
            "Leave out the joint offsets of depth sensors, and smooth more",
            {"smoothing": 0.1, "shift": False},
        ),
        "Depth Camera": Preset("Use the defaults, which were chosen for depth cameras", {}),
    },
    "retarget": {
        "Light": Preset(
            "Keep the rotations of arms, and lower the hips as little as possible",
            {"keep_hands": False, "softness": 0.0},
        ),
        "Normal": Preset("Use the defaults", {}),
        "Heavy": Preset(
            "Bend knees and lower the hips more, so that no leg is fully straight",
            {"softness": 0.02},
        ),
        "Optical": Preset("Use the defaults: feet, hands and floor were measured", {}),
        "Suit": Preset(
            "Put the lowest feet on the floor, since the height of a suit drifts",
            {"to_ground": True},
        ),
        "Video AI": Preset(
            "Put the lowest feet on the floor, with leg length in reserve",
            {"to_ground": True, "softness": 0.02},
        ),
        "Depth Camera": Preset(
            "Put the lowest feet on the floor, with leg length in reserve",
            {"to_ground": True, "softness": 0.02},
        ),
    },
    "simulate": {
        "Light": Preset("Apply half of the simulated motion", {"strength": 0.5}),
        "Normal": Preset("Use the defaults", {}),
        "Heavy": Preset(
            "Follow the take loosely, so that weight and ground show more",
            {"response": 3.0, "smoothing": 0.05},
        ),
        "Optical": Preset(
            "Follow the take closely, without smoothing it first",
            {"response": 8.0, "smoothing": 0.0},
        ),
        "Suit": Preset(
            "Put the ground under the feet, since the height of a suit drifts",
            {"ground": "auto"},
        ),
        "Video AI": Preset(
            "Put the ground under the feet, and smooth the take first",
            {"ground": "auto", "smoothing": 0.05},
        ),
        "Depth Camera": Preset(
            "Put the ground under the feet, smooth the take, and follow it loosely",
            {"ground": "auto", "smoothing": 0.05, "response": 4.0},
        ),
    },
    "vary": {
        "Light": Preset(
            "Vary pose and timing half as much as the examples", {"amount": 0.5, "timing": 0.5}
        ),
        "Normal": Preset("Use the defaults", {}),
        "Heavy": Preset(
            "Vary pose and timing more than the examples", {"amount": 1.5, "timing": 1.5}
        ),
    },
}
"""Presets by verb and name. The values are chosen by hand, by the reason that each help states,
and no table of docs/benchmarks compares them; those of *Normal* are the defaults, which the
tables measure."""


def mentioned_settings(verb: str) -> tuple[str, ...]:
    """Return the names of the settings that any preset of a verb changes."""
    return tuple(dict.fromkeys(name for each in PRESETS[verb].values() for name in each.values))


def find_preset(verb: str, name: str) -> Preset:
    """Return a preset by its name; "Video AI" may be written as video-ai.

    Raises
    ------
    InvalidSettingError
        The verb has no such preset.
    """
    found = {_plain_name(each): preset for each, preset in PRESETS[verb].items()}
    if _plain_name(name) not in found:
        raise InvalidSettingError(
            f"{verb} has no preset {name!r}. Choose one of: {', '.join(found)}."
        )
    return found[_plain_name(name)]


def _plain_name(name: str) -> str:
    return name.strip().lower().replace(" ", "-").replace("_", "-")
