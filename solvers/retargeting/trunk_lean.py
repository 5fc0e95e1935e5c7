"""Lean trunks as far as the source's, wherever the joints of the spine lie."""

import numpy as np
from numpy.typing import NDArray

from ..motion import WorldPoses
from ..rotations import (
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
    rotation_between,
    rotation_vector_from_quaternion,
)
from .body import Body

Array = NDArray[np.float64]

TOPS = ("neck", "head")
TOP = 0.5
"""How much of the swing the chest takes, which is turned as the source's but for that."""
STRAIGHT, BENT = np.cos(np.radians([10.0, 30.0]))
"""Cosines of how far the trunk is bent from its rest: up to the first it is left as it is, as
rest poses are drawn differently; from the second on it leans fully as the source's."""
SMALL = np.radians(5.0)
"""Half of a swing of this size is left out, and most of smaller ones: they are noise."""
ROUNDS = 6
"""Fixed-point steps; each leaves less than half of the error."""


def leaning_swings(
    source: Body,
    target: Body,
    seen: WorldPoses,
    hips: Array,
    turned: dict[int, Array],
    trunk: list[int],
) -> dict[int, Array]:
    """Return world rotations, (n_frames, 4), to add to those of the trunk's joints.

    Vertebrae of another body sit elsewhere: turned as the source's, they lead the neck
    elsewhere, in deep bows by 10 to 20 degrees. A swing of all of them is added with which the
    line from hips to neck points as the source's does, apart from how the two differ at rest;
    trunks that are hardly bent stay as they are. Whatever hangs on the trunk keeps its turn.

    Parameters
    ----------
    source, target : Body
    seen : WorldPoses
        Of the source.
    hips : shape (n_frames, 4)
        How the hips are turned, from the canonical T-pose.
    turned : dict of the target's joint to shape (n_frames, 4)
        World rotations from its rest pose.
    trunk : list of int
        The target's joints of the spine, from below.
    """
    top = next((r for r in ("neck", "head") if r in source.joints and r in target.joints), None)
    if (
        top is None
        or not trunk
        or trunk[-1] not in target.skeleton.ancestors(target.joints[top])
    ):
        return {}
    wanted = _wanted_way(source, target, seen, hips, top)
    shares = dict.fromkeys(trunk[:-1], 1.0) | {trunk[-1]: TOP}
    swing = np.zeros_like(wanted)
    for _ in range(ROUNDS):
        swung = turned | {
            joint: multiply(quaternion_from_rotation_vector(share * swing), turned[joint])
            for joint, share in shares.items()
        }
        way = _way(target, swung, target.joints[top])
        swing = swing + rotation_vector_from_quaternion(rotation_between(way, wanted))
    swing = swing * _bent(hips, wanted, _rest_way(target, top))
    square = (swing * swing).sum(axis=1, keepdims=True)
    swing = swing * square / (square + SMALL**2)
    return {
        joint: quaternion_from_rotation_vector(share * swing) for joint, share in shares.items()
    }


def _bent(hips: Array, way: Array, rest: Array) -> Array:
    """Return 0 for straight trunks, 1 for bent ones, smoothly, shape (n_frames, 1).

    It looks at one frame alone, so that a cut of a take leans as within it.
    """
    length = np.linalg.norm(way, axis=1) * np.linalg.norm(rest)
    straight = (rotate(inverse(hips), way) @ rest) / np.maximum(length, 1e-9)
    share = np.clip((straight - STRAIGHT) / (BENT - STRAIGHT), 0.0, 1.0)[:, None]
    return np.asarray(share * share * (3.0 - 2.0 * share))


def _wanted_way(source: Body, target: Body, seen: WorldPoses, hips: Array, top: str) -> Array:
    """Return where the target's neck should be from its hips, but for the distance."""
    rests = [_rest_way(body, top) for body in (source, target)]
    places = seen.positions
    way = places[:, source.joints[top]] - places[:, source.joints["hips"]]
    upright = rotate(inverse(hips), way)
    return np.asarray(rotate(hips, rotate(rotation_between(*rests), upright)))


def _rest_way(body: Body, top: str) -> Array:
    """Return the way from hips to neck in the canonical T-pose, shape (3,), metres."""
    low, high = body.joints["hips"], body.joints[top]
    return np.asarray(rotate(inverse(body.alignment[low]), body.rest[high] - body.rest[low]))


def _way(target: Body, turned: dict[int, Array], top: int) -> Array:
    """Return the way from hips to neck, shape (n_frames, 3), metres."""
    skeleton, hips = target.skeleton, target.joints["hips"]
    chain = [top, *skeleton.ancestors(top)]
    chain = chain[: chain.index(hips) + 1][::-1]
    above, way = turned[hips], np.zeros((len(turned[hips]), 3))
    for joint in chain[1:]:
        way = way + rotate(above, skeleton.offsets[joint])
        above = turned.get(joint, above)
    return np.asarray(way)
