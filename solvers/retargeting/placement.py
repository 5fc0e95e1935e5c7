"""Map positions of the source to a body of another size."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Flags
from ..motion.humanoid import SIDES
from .body import HumanoidBody

UP = np.array([0.0, 0.0, 1.0])
ANKLE_HEIGHT_FRACTION = 0.08
"""Height of the ankle above the sole, in leg lengths (Winter 2009, figure 4.1)."""
MAX_DEPTH_FRACTION, MAX_ANKLE_FRACTION = 0.02, 0.25
"""Limits for a rig that stands on height 0, in leg lengths: depth of its lowest joint below the
ground, and height of its ankles above it. They guard rigs with the tips of their toes below
height 0, and rigs with height 0 at their hips or ankles
(`test_rig_with_its_origin_elsewhere_does_not_rest_on_the_ground`)."""
FLOOR_TOLERANCE_FRACTION = 0.15
"""Measured heights of the ground below this, in leg lengths, are treated as 0. It guards an
actor on a stage, who stays on it, and sensors whose ankles are off by some centimeters
(`test_ground_nearly_at_zero_is_at_zero_and_a_stage_is_not`)."""
FLAT_FOOT_PERCENTILE = 20.0
"""Percentile of the ankle heights in contact that is the height of a flat foot. It guards takes
that are mostly danced on tiptoe, and frames in which an ankle is too low
(`test_ankle_height_is_that_of_flat_feet_if_most_contacts_are_on_tiptoe`)."""


@dataclass(frozen=True, eq=False)
class HipPlacement:
    """Map of the source's hip joints and ankles to positions of the target.

    Attributes
    ----------
    travel, rise : float
        Horizontal and vertical scale.
    start : shape (3,), meters
        The ground below the first position of the hips, the fixed point of the map.
    ankles : (float, float), meters
        Heights of the ankles of source and target in contact.
    floors : (float, float), meters, or None
        Heights of the ground of source and target; None without legs.
    """

    travel: float
    rise: float
    start: Array
    ankles: tuple[float, float]
    floors: tuple[float, float] | None

    def points(self, points: Array) -> Array:
        """Return points of the source, shape (..., 3), mapped to the target."""
        scale = np.array([self.travel, self.travel, self.rise])
        before = self.start + self.ankles[0] * UP
        after = self.start + self.ankles[1] * UP
        return np.asarray(after + scale * (points - before))


def find_placement(
    source: HumanoidBody,
    target: HumanoidBody,
    positions: Array,
    height: float | None,
    *,
    travel: float,
    to_ground: bool,
) -> HipPlacement:
    """Return the placement from leg lengths and ankle heights of both bodies.

    Parameters
    ----------
    source, target : HumanoidBody
    positions : shape (n_frames, n_source_joints, 3), meters
    height : float, meters
        Height of the source's ankles in contact; None without contacts.
    travel : float
        Horizontal scale; 0 for the ratio of the legs.
    to_ground : bool
        Whether to move the ground to height 0, whatever its height in the source.
    """
    scale = _size_ratio(source, target)
    hips = positions[0, source.hip_joints()].mean(axis=0)
    start = hips * (1.0, 1.0, 0.0)
    if not (leg_length(source) and leg_length(target)):
        return HipPlacement(travel or scale, scale, start, (0.0, 0.0), None)
    source_ankle, target_ankle = standing_ankle(source), standing_ankle(target)
    height = source_ankle if height is None else height
    ground = height - source_ankle
    is_near_zero = abs(ground) < FLOOR_TOLERANCE_FRACTION * leg_length(source)
    floor = 0.0 if to_ground or is_near_zero else ground
    if is_near_zero and not rests_on_ground(source):
        ground = 0.0
    ankles = height, floor + target_ankle
    return HipPlacement(travel or scale, scale, start, ankles, (ground, floor))


def ankle_height(
    source: HumanoidBody, positions: Array, contacts: Flags | None
) -> float | None:
    """Return the height of the ankles in contact, meters; None without contacts.

    Parameters
    ----------
    source : HumanoidBody
    positions : shape (n_frames, n_source_joints, 3), meters
    contacts : bool, shape (n_frames, 2), or None for bodies without feet
    """
    if contacts is None or not contacts.any():
        return None
    ankles = np.stack([positions[:, source.joints[f"{side}Foot"], 2] for side in SIDES], 1)
    return float(np.percentile(ankles[contacts], FLAT_FOOT_PERCENTILE))


def leg_length(body: HumanoidBody) -> float:
    """Return the mean length of the legs, meters; 0 without legs."""
    legs = [limb for side in SIDES if (limb := body.limb(side, "Leg"))]
    return float(np.mean([body.limb_length(leg) for leg in legs])) if legs else 0.0


def standing_ankle(body: HumanoidBody) -> float:
    """Return the height of the ankles of a flat foot above the ground, meters.

    Rigs that rest on height 0 show it. In others, the lowest joint of the foot is above the
    sole by an unknown height: their ankles are at least as high as a human's.
    """
    feet, leg = _feet(body), leg_length(body)
    if not feet or leg == 0.0:
        return 0.0
    ankle = float(body.rest[feet, 2].mean())
    if rests_on_ground(body):
        return ankle
    return max(ankle - _lowest(body, feet), ANKLE_HEIGHT_FRACTION * leg)


def rests_on_ground(body: HumanoidBody) -> bool:
    """Return whether the rest pose stands on height 0, approximately."""
    feet, leg = _feet(body), leg_length(body)
    if not feet or leg == 0.0:
        return False
    ankle = float(body.rest[feet, 2].mean())
    return (
        _lowest(body, feet) > -MAX_DEPTH_FRACTION * leg
        and 0.0 < ankle < MAX_ANKLE_FRACTION * leg
    )


def trunk_length(body: HumanoidBody) -> float:
    """Return the distance from hips to head, or to neck, meters; 0 without either."""
    top = body.joints.get("head", body.joints.get("neck"))
    if top is None:
        return 0.0
    return float(np.linalg.norm(body.rest[top] - body.rest[body.joints["hips"]]))


def _feet(body: HumanoidBody) -> list[int]:
    return [body.joints[f"{side}Foot"] for side in SIDES if f"{side}Foot" in body.joints]


def _lowest(body: HumanoidBody, feet: list[int]) -> float:
    """Return the height of the lowest joint of the feet in the rest pose, meters."""
    return float(min(body.rest[body.skeleton.subtree(foot), 2].min() for foot in feet))


def _size_ratio(source: HumanoidBody, target: HumanoidBody) -> float:
    """Return the ratio of the legs; of the trunks if a body has no legs; 1 without either."""
    for measure in (leg_length, trunk_length):
        source_length, target_length = measure(source), measure(target)
        if source_length > 0.0 and target_length > 0.0:
            return target_length / source_length
    return 1.0
