"""Read from a motion how its feet stand, where the rest pose does not show it."""

from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ..motion import Skeleton, WorldPoses
from ..rotations import (
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
    rotation_vector_from_quaternion,
)
from .body import SIDES, Body
from .placement import leg_length, rests_on_ground

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]

CALM = 0.05
"""Standard deviation of the blur of the turning speed, seconds."""
STILLEST = 0.5
"""Part of the frames in contact in which the foot turns least, which tell how it stands."""
UNEVEN = np.radians(4.0)
"""By how much a foot may be off the mean of both: one may stand on its ball throughout."""
MOST_HIGHER = 0.02
"""Part of the leg by which one ankle may stand higher than the mean of both."""
UPRIGHT = np.cos(np.radians(30.0))
"""A foot whose sole is tilted more does not stand on it."""
MOST = np.radians(15.0)
"""By how much a foot in the rest pose may be off a standing one."""
ASIDE = np.array([1.0, 0.0, 0.0])
UP = np.array([0.0, 0.0, 1.0])


class Stance(NamedTuple):
    """How a foot stands in a motion."""

    pitch: float
    """By how much it points farther down than in the rest pose, radians."""
    ankle: float
    """Height of its ankle, metres."""


def find_stances(
    source: Body, target: Body, seen: WorldPoses, contacts: Flags | None, frame_rate: float
) -> tuple[Stance, Stance] | None:
    """Return how the source's left and right foot stand, if only the motion tells.

    A rig that rests on height 0 stands there with level soles. Skeletons that rest around their
    hips (Acclaim) have feet as they happened to be drawn: on the target, soles would slope
    wherever they stand level in the source. There the least sloping of the feet that stand
    still tell.
    """
    if contacts is None or rests_on_ground(source) or not rests_on_ground(target):
        return None
    found = [
        _stance(source, seen, side, stands, frame_rate)
        for side, stands in zip(SIDES, contacts.T, strict=True)
    ]
    known = [stance for stance in found if stance]
    if not known:
        return None
    pitch, ankle = np.mean(known, axis=0)
    most = MOST_HIGHER * leg_length(source)
    left, right = (
        Stance(
            float(np.clip(np.clip(one.pitch, pitch - UNEVEN, pitch + UNEVEN), -MOST, MOST)),
            float(np.clip(one.ankle, ankle - most, ankle + most)),
        )
        for one in (stance or Stance(pitch, ankle) for stance in found)
    )
    return left, right


def with_level_soles(source: Body, stances: tuple[Stance, Stance]) -> Body:
    """Return the source with its feet aligned as if they rested the way they stand."""
    alignment = source.alignment.copy()
    for side, stance in zip(SIDES, stances, strict=True):
        below = source.skeleton.subtree(source.joints[f"{side}Foot"])
        turn = quaternion_from_rotation_vector(-stance.pitch * ASIDE)
        alignment[below] = multiply(alignment[below], turn)
    return replace(source, alignment=alignment)


def _stance(
    source: Body, seen: WorldPoses, side: str, stands: Flags, frame_rate: float
) -> Stance | None:
    foot, ball = foot_bone(source, side)
    bone = source.rest[ball] - source.rest[foot]
    rotations = seen.rotations[:, foot]
    upright = rotate(multiply(rotations, source.alignment[foot]), UP)[:, 2] > UPRIGHT
    stands = stands & upright
    if not (bone.any() and stands.any()):
        return None
    turning = _turning(rotations, frame_rate)
    rests = stands & (turning <= np.quantile(turning[stands], STILLEST))
    slopes = _slope(rotate(rotations[rests], bone))
    flat = slopes <= np.median(slopes)
    ankle = np.median(seen.positions[rests, foot, 2][flat])
    return Stance(float(np.median(slopes[flat]) - _slope(bone)), float(ankle))


def foot_bone(body: Body, side: str) -> tuple[int, int]:
    """Return ankle and ball; without toes, the end of the foot; without that, the ankle."""
    foot = body.joints[f"{side}Foot"]
    skeleton: Skeleton = body.skeleton
    toes = body.joints.get(f"{side}Toes")
    return foot, toes if toes in skeleton.subtree(foot) else (*skeleton.children[foot], foot)[0]


def _slope(ways: Array) -> Array:
    """Return how steeply vectors point down, radians."""
    return np.asarray(np.arctan2(-ways[..., 2], np.linalg.norm(ways[..., :2], axis=-1)))


def _turning(rotations: Array, frame_rate: float) -> Array:
    """Return how fast rotations change, shape (n_frames,), radians per second."""
    if len(rotations) < 2:
        return np.zeros(len(rotations))
    steps = rotation_vector_from_quaternion(multiply(rotations[1:], inverse(rotations[:-1])))
    steps = gaussian_filter1d(steps * frame_rate, CALM * frame_rate, axis=0, mode="nearest")
    speeds = np.linalg.norm(steps, axis=1)
    return np.asarray(np.maximum(np.append(speeds, 0.0), np.append(0.0, speeds)))
