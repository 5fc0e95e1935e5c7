"""Mirror skeletons whose left side is on the right, as in left-handed axes."""

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ...arrays import Array
from ...motion import Motion, Skeleton, find_humanoid_map
from .body_unit import MIN_MAP_SCORE
from .file_axes import MIRRORED, conventions_of
from .standing_joints import sampled_positions

SWAPPED = "Left and right are swapped in the file; the take is mirrored"
MAX_TOES_AHEAD = -0.3
"""Direction of the toes, the cosine with forward, below which they point backward. Chosen by
hand: of 490 BVH files of 40 makers the 481 with the right sides have -0.1 and more, apart from
two whose feet end at the heel; six mirrored ones have -0.5 and less."""
MIN_FLEXION = 0.1
"""Distance of a bent knee from the middle of hip and ankle, relative to the leg. Chosen by
hand: straight knees of captured skeletons are up to 0.05 behind it."""


def mirror_motion(motion: Motion) -> Motion:
    """Return the mirror image of a motion, with the same names."""
    across = np.array([-1.0, 1.0, 1.0])
    return replace(
        motion,
        skeleton=replace(motion.skeleton, offsets=motion.skeleton.offsets * across),
        rotations=motion.rotations * MIRRORED,
        root_positions=motion.root_positions * across,
        conventions=replace(conventions_of(motion), is_mirrored=True),
    )


def has_swapped_sides(motion: Motion) -> bool:
    """Whether the front of a body shows that its left side is on the right.

    Forward follows from hip joints and shanks, so that the pose does not matter. Toes have to
    point backward, and bent knees too. What counts as toes without a joint of them, such as the
    end of the foot, counts only with bent knees.
    """
    humanoid = find_humanoid_map(motion.skeleton)
    roles = humanoid.indices(motion.skeleton)
    hips = [f"{side}UpperLeg" for side in ("left", "right")]
    if humanoid.score < MIN_MAP_SCORE or not set(hips) <= roles.keys():
        return False
    positions = sampled_positions(motion)
    left = positions[:, roles[hips[0]]] - positions[:, roles[hips[1]]]
    toes, knees, has_toes = [], [], False
    for side in ("left", "right"):
        if not {f"{side}LowerLeg", f"{side}Foot"} <= roles.keys():
            continue
        leg = [roles[side + part] for part in ("UpperLeg", "LowerLeg", "Foot")]
        hip, knee, ankle = np.moveaxis(positions[:, leg], 1, 0)
        knees.append(_ahead_of_bent(hip, knee, ankle, left))
        has_toes |= f"{side}Toes" in roles
        if (tip := _tip(motion.skeleton, roles, side)) is not None:
            toes.append(_cosine(positions[:, tip] - ankle, np.cross(left, knee - ankle)))
    ahead, bent = (_median(parts) for parts in (toes, knees))
    return bool(ahead < MAX_TOES_AHEAD and (has_toes if np.isnan(bent) else bent < 0.0))


def _tip(skeleton: Skeleton, roles: Mapping[str, int], side: str) -> int | None:
    """Return the toes, or where the foot ends."""
    below = skeleton.children[roles[f"{side}Foot"]]
    lengths = np.linalg.norm(skeleton.offsets, axis=1)
    return roles.get(f"{side}Toes", max(below, key=lambda each: lengths[each], default=None))


def _ahead_of_bent(hip: Array, knee: Array, ankle: Array, left: Array) -> Array:
    """Return the cosine between the flexion of a knee and forward, in frames where it bends."""
    flexion = knee - (hip + ankle) / 2.0
    length = np.linalg.norm(hip - knee, axis=1) + np.linalg.norm(knee - ankle, axis=1)
    is_bent = np.linalg.norm(flexion, axis=1) > MIN_FLEXION * length
    return _cosine(flexion[is_bent], np.cross(left, hip - ankle)[is_bent])


def _cosine(one: Array, other: Array) -> Array:
    norms = np.linalg.norm(one, axis=1) * np.linalg.norm(other, axis=1)
    return np.asarray((one * other).sum(axis=1) / np.maximum(norms, 1e-9))


def _median(parts: list[Array]) -> float:
    values = np.concatenate(parts) if parts else np.empty(0)
    return float(np.median(values)) if len(values) else np.nan
