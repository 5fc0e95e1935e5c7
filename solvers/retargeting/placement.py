"""Where a body of another size stands, walks and sits."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .body import SIDES, Body

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

UP = np.array([0.0, 0.0, 1.0])
ANKLE_HEIGHT = 0.08
"""Of the length of a leg: height of the ankle above the sole (Winter 2009, figure 4.1)."""
STANDS_LOW, STANDS_HIGH = 0.02, 0.25
"""Parts of the leg by which the lowest joint of a rig that stands on height 0 is below, and
its ankles are above the ground at most."""
FLOOR_MISREAD = 0.15
"""Part of the leg by which the ground may seem to be off height 0 before it is believed."""
FLAT = 20.0
"""Percentile of the ankle's heights in contact at which the foot stands flat."""


@dataclass(frozen=True, eq=False)
class Placement:
    """Takes places of the source's hip joints and ankles to those of the target.

    Attributes
    ----------
    travel, rise : float
        Growth over the ground, and upwards.
    start : shape (3,), metres
        The ground under the first place of the hips, which stays.
    ankles : (float, float), metres
        Heights of source's and target's ankles when they stand.
    floors : (float, float), metres, or None
        Heights of the ground of source and target; None where no legs tell.
    """

    travel: float
    rise: float
    start: Array
    ankles: tuple[float, float]
    floors: tuple[float, float] | None

    def points(self, points: Array) -> Array:
        """Return where points, shape (..., 3), of the source lie for the target."""
        growth = np.array([self.travel, self.travel, self.rise])
        before = self.start + self.ankles[0] * UP
        after = self.start + self.ankles[1] * UP
        return np.asarray(after + growth * (points - before))


def find_placement(
    source: Body,
    target: Body,
    positions: Array,
    height: float | None,
    *,
    travel: float,
    to_ground: bool,
) -> Placement:
    """Compare the bodies' legs and how high their ankles stand.

    Parameters
    ----------
    source, target : Body
    positions : shape (n_frames, n_source_joints, 3), metres
    height : float, metres
        Of the source's ankles that stand; None where none do.
    travel : float
        Growth over the ground; 0 for that of the legs.
    to_ground : bool
        Whether the ground comes to height 0, wherever it is in the source.
    """
    growth = _growth(source, target)
    hips = positions[0, source.hip_joints()].mean(axis=0)
    start = hips * (1.0, 1.0, 0.0)
    if not (leg_length(source) and leg_length(target)):
        return Placement(travel or growth, growth, start, (0.0, 0.0), None)
    source_ankle, target_ankle = standing_ankle(source), standing_ankle(target)
    height = source_ankle if height is None else height
    ground = height - source_ankle
    misread = abs(ground) < FLOOR_MISREAD * leg_length(source)
    floor = 0.0 if to_ground or misread else ground
    if misread and not rests_on_ground(source):
        ground = 0.0
    ankles = height, floor + target_ankle
    return Placement(travel or growth, growth, start, ankles, (ground, floor))


def ankle_height(source: Body, positions: Array, contacts: Flags | None) -> float | None:
    """Return at which height the ankles stand, metres; None where none do.

    Parameters
    ----------
    source : Body
    positions : shape (n_frames, n_source_joints, 3), metres
    contacts : bool, shape (n_frames, 2), or None for bodies without feet
    """
    if contacts is None or not contacts.any():
        return None
    ankles = np.stack([positions[:, source.joints[f"{side}Foot"], 2] for side in SIDES], 1)
    return float(np.percentile(ankles[contacts], FLAT))


def leg_length(body: Body) -> float:
    """Return the mean length of the legs, metres; 0 without legs."""
    legs = [limb for side in SIDES if (limb := body.limb(side, "Leg"))]
    return float(np.mean([body.limb_length(leg) for leg in legs])) if legs else 0.0


def standing_ankle(body: Body) -> float:
    """Return how high the ankles of a body that stands flat are above the ground, metres.

    Rigs that rest on height 0 show it. Of others, the lowest joint of the foot is above the
    sole by an unknown height: their ankles are at least as high as a human's.
    """
    feet, leg = _feet(body), leg_length(body)
    if not feet or leg == 0.0:
        return 0.0
    ankle = float(body.rest[feet, 2].mean())
    if rests_on_ground(body):
        return ankle
    return max(ankle - _lowest(body, feet), ANKLE_HEIGHT * leg)


def rests_on_ground(body: Body) -> bool:
    """Tell whether the rest pose stands on height 0, or nearly."""
    feet, leg = _feet(body), leg_length(body)
    if not feet or leg == 0.0:
        return False
    ankle = float(body.rest[feet, 2].mean())
    return _lowest(body, feet) > -STANDS_LOW * leg and 0.0 < ankle < STANDS_HIGH * leg


def trunk_length(body: Body) -> float:
    """Return the way from the hips to the head, or to the neck, metres; 0 without either."""
    top = body.joints.get("head", body.joints.get("neck"))
    if top is None:
        return 0.0
    return float(np.linalg.norm(body.rest[top] - body.rest[body.joints["hips"]]))


def _feet(body: Body) -> list[int]:
    return [body.joints[f"{side}Foot"] for side in SIDES if f"{side}Foot" in body.joints]


def _lowest(body: Body, feet: list[int]) -> float:
    """Return the height of the lowest joint of the feet in the rest pose, metres."""
    return float(min(body.rest[body.skeleton.subtree(foot), 2].min() for foot in feet))


def _growth(source: Body, target: Body) -> float:
    """Return the ratio of the legs; of the trunks where one has no legs; 1 without either."""
    for measure in (leg_length, trunk_length):
        theirs, ours = measure(source), measure(target)
        if theirs > 0.0 and ours > 0.0:
            return ours / theirs
    return 1.0
