"""Refuse tables of angles and other quantities whose titles do not say what they are."""

import re
from collections.abc import Sequence
from functools import cache
from pathlib import Path

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import Tracks
from ...motion.humanoid import (
    ADULT_BONE_LENGTHS_M,
    POSTURE_JOINTS,
    positions_from_directions,
    posture_positions,
)
from .unnamed_joints import N_SAMPLED_FRAMES, length_misfit, limb_lengths

MAX_BODY_MISFIT = 1.15
"""Misfit, a ratio, from which the numbers of named joints are no positions. Measured: of 501
takes of six sensors the worst has 0.8, and 1.13 with noise of 0.12 m; three of four tables of
angles, made from 42 BVH files, have more, up to 2.1."""
WINDOW_FRAMES = 15
"""Frames whose median is measured for that. Chosen by hand: with 1, a tenth of wrong points and
noise of 0.08 m are as large as angles."""
MIN_FRAMES, MIN_BONES = 25, 4
"""Frames, and bones on both sides, from which that is decided. They guard single poses and
files of a limb."""
MIN_AGREEMENT = 0.45
"""Correlation of the logarithms of the distances between joints with those of an adult, from
which the numbers are positions. Measured: of 240 takes of HDM05, CMU, other makers and 140 of
six sensors all have more than 0.65, and more than 0.61 with two fifths of the joints and noise
of 0.12 m; of 395 tables of local rotations, of 79 skeletons, all have less than 0.15."""
MIN_JOINTS = 12
"""Joints, those of the legs among them, from which that is decided. Chosen by hand: of legs
alone in a crouch the correlation is 0.57, and of arms it may be anything."""
DIRECTIONS = {
    "spine": (0, 0, 1), "chest": (0, 0, 1), "head": (0, 0, 1), "UpperArm": (1, 0, 0),
    "LowerArm": (1, 0, -1), "Hand": (1, 0, -1), "HandEnd": (1, 0, -1), "UpperLeg": (1, 0, 0),
    "LowerLeg": (0, 0, -1), "Foot": (0, 0, -1), "Toes": (0, -1, 0),
}  # fmt: skip
"""Of the bones of an adult who stands with arms half raised, those of the left side."""


def refuse_angles(path: Path | str, names: Sequence[str], positions: Array) -> None:
    """Raise InvalidFileError if named joints, (F, n, 3), are not where those of a body are.

    So it is where a table holds the angles or velocities of joints. Joints at zero are
    missing; single frames that are wrong, and noise, do not count.
    """
    if len(positions) < MIN_FRAMES:
        return
    posture = _window_medians(posture_positions(Tracks(tuple(names), positions, 1.0)))
    if _has_rigid_bones(posture) and _is_arranged_as_a_body(posture):
        return
    raise InvalidFileError(
        f"{path} holds angles or other numbers instead of positions: joints are not where"
        " those of a body are. Export positions of joints, or BVH, FBX or GLB."
    )


def _has_rigid_bones(posture: Array) -> bool:
    """Return whether bones on both sides have equal and constant lengths, or are missing."""
    lengths, is_known = limb_lengths(posture)
    if is_known.sum() < MIN_BONES:
        return True
    return length_misfit(lengths[:, np.tile(is_known, 2)], is_known) <= MAX_BODY_MISFIT


def _is_arranged_as_a_body(posture: Array) -> bool:
    """Return whether joints that are far apart in a body are so here, or most are missing.

    Angles are small wherever a joint hardly turns: their distances have nothing to do with
    those of the joints. Poses change the distances in a body, but not their order of size.
    """
    is_known = np.isfinite(posture).all(axis=2).any(axis=0)
    legs = [POSTURE_JOINTS.index(f"{side}LowerLeg") for side in ("left", "right")]
    if is_known.sum() < MIN_JOINTS or not is_known[legs].all():
        return True
    known, adult = posture[:, is_known], _standing_adult()[is_known]
    pairs = np.triu_indices(known.shape[1], 1)
    distances, of_adult = (
        np.linalg.norm(points[..., pairs[0], :] - points[..., pairs[1], :], axis=-1)
        for points in (known, adult)
    )
    is_seen = np.isfinite(distances).any(axis=0)
    typical = np.nanmedian(distances[:, is_seen], axis=0)
    has_distance = typical > 0.0
    if has_distance.sum() < MIN_JOINTS:
        return True
    together = np.log([typical[has_distance], of_adult[is_seen][has_distance]])
    return bool(np.corrcoef(together)[0, 1] >= MIN_AGREEMENT)


@cache
def _standing_adult() -> Array:
    """Return the joints of an adult who stands, relative to the hips, shape (20, 3), meters."""
    directions = np.zeros((len(POSTURE_JOINTS), 3))
    for at, name in enumerate(POSTURE_JOINTS[1:], start=1):
        x, y, z = DIRECTIONS[re.sub("^(left|right)", "", name)]
        directions[at] = -x if name.startswith("right") else x, y, z
        directions[at] /= np.linalg.norm(directions[at])
    return positions_from_directions(directions, ADULT_BONE_LENGTHS_M)


def _window_medians(posture: Array) -> Array:
    """Return the median positions in evenly spaced windows; NaN where joints stay at zero."""
    observed = np.where((posture != 0.0).any(axis=2, keepdims=True), posture, np.nan)
    windows = np.lib.stride_tricks.sliding_window_view(observed, WINDOW_FRAMES, axis=0)
    chosen = windows[:: max(1, len(windows) // N_SAMPLED_FRAMES)]
    is_seen = np.isfinite(chosen).any(axis=3)
    medians = np.full(is_seen.shape, np.nan)
    medians[is_seen] = np.nanmedian(chosen[is_seen], axis=1)
    return medians
