"""Where the soles of a body are, and how deep below the ground they may be."""

from typing import NamedTuple

import numpy as np

from ..arrays import Array
from ..feet import HEEL_FRACTION
from ..motion import WorldPoses
from ..motion_fitting.goals import BonePoint
from .body import HumanoidBody
from .placement import HipPlacement, rests_on_ground
from .stances import foot_bone

ANKLE_FRACTION = 0.8
"""Height of the ankle of a foot in any pose, relative to that of a flat foot. It guards actors
who kneel down, whose heels are behind their ankles."""


class SolePoint(NamedTuple):
    """A point of a foot that may not sink into the ground."""

    point: BonePoint
    height: float
    """Least height above the ground, meters."""


def sole_points(body: HumanoidBody, side: str) -> list[SolePoint]:
    """Return ankle, heel and, if the body has them, ball and tip of a foot.

    No rig has a heel joint: the heel is below and slightly behind the ankle.
    """
    foot, ball = foot_bone(body, side)
    rest, at_joint = body.rest, np.zeros(3)
    forward = (rest[ball] - rest[foot]) * (1.0, 1.0, 0.0)
    heel = np.array([0.0, 0.0, -rest[foot, 2]]) - HEEL_FRACTION * forward
    points = [
        SolePoint(BonePoint(foot, at_joint), ANKLE_FRACTION * rest[foot, 2]),
        SolePoint(BonePoint(foot, heel), 0.0),
    ]
    ends = [] if ball == foot else [ball]
    tip = tip_of(body, ball)
    ends += [] if tip is None else [tip]
    return points + [SolePoint(BonePoint(end, at_joint), rest[end, 2]) for end in ends]


def tip_of(body: HumanoidBody, ball: int) -> int | None:
    """Return the end of the toes; None without one."""
    return next(iter(body.skeleton.children[ball]), None)


def allowed_depths(
    source: HumanoidBody, source_poses: WorldPoses, side: str, placement: HipPlacement, n: int
) -> list[Array]:
    """Return the allowed depths, (n_frames,) in meters, of `n` points of a foot.

    They are those of the source, if its ground is known. It is for sources that rest on height
    0, so that a motion retargeted to its own body is unchanged. A point that the source lacks,
    such as the tips of toes of a sensor, gets the depth of the point before it.
    """
    if not placement.floors or not rests_on_ground(source):
        return [np.zeros(len(source_poses.positions))] * n
    depths = [
        placement.rise
        * np.maximum(placement.floors[0] + height - point.position(source_poses)[:, 2], 0.0)
        for point, height in sole_points(source, side)
    ]
    return (depths + n * depths[-1:])[:n]
