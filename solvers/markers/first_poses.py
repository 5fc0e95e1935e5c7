"""Poses from joint centres: the axes of every bone, before anything is fitted."""

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

from ..rotations import (
    matrix_from_quaternion,
    quaternion_from_matrix,
    quaternion_from_rotation_vector,
    rotation_vector_from_quaternion,
)
from .body_tables import SIDES
from .centres import Centres
from .vectors import frame, median, swung, unit

Array = NDArray[np.float64]
SHORTEST_FOOT = 0.05
"""Metres between heel and toe markers."""
STEEPEST = 0.4
"""Sine of the angle between the way from heel to toe marker and the sole, at most."""


def bone_frames(
    centres: Centres, spots: Mapping[str, Array], names: Sequence[str]
) -> dict[str, Array]:
    """Return the axes of the bones named, each of shape (n_frames, 3, 3).

    Collar bones swing from where they are on average. The spine shares the turn from pelvis to
    thorax, the neck that from thorax to head.
    """
    frames = dict(centres.frames)
    if "chest" in frames:
        frames["spine"] = _between(frames["hips"], frames["chest"])
        frames["neck"] = _between(frames["chest"], frames.get("head", frames["chest"]))
    for side, (letter, sign) in SIDES.items():
        _leg(centres, spots, frames, side, letter)
        if f"{side}UpperArm" in names:
            _arm(centres, spots, frames, side, letter, sign)
    return frames


def _between(start: Array, stop: Array) -> Array:
    """Return the rotations half way."""
    turn = quaternion_from_matrix(np.swapaxes(start, -1, -2) @ stop)
    half = quaternion_from_rotation_vector(0.5 * rotation_vector_from_quaternion(turn))
    return np.asarray(start @ matrix_from_quaternion(half))


def _leg(
    centres: Centres,
    spots: Mapping[str, Array],
    frames: dict[str, Array],
    side: str,
    letter: str,
) -> None:
    hip, knee, ankle = (
        centres.places[side + joint] for joint in ("UpperLeg", "LowerLeg", "Foot")
    )
    aside = SIDES[side][1] * (spots[f"{letter}KNE"] - knee)
    frames[f"{side}UpperLeg"] = frame(2, hip - knee, 0, aside)
    frames[f"{side}LowerLeg"] = frame(2, knee - ankle, 0, aside)
    if f"{letter}HEE" in spots:
        heel, toe = spots[f"{letter}HEE"], spots[f"{letter}TOE"]
        level = _levelled(heel, toe)
        frames[f"{side}Foot"] = (
            frame(0, frames[f"{side}LowerLeg"][..., 0], 1, heel - toe) @ level
        )


def _levelled(heel: Array, toe: Array) -> Array:
    """Return the turn from the way between two markers to the sole, which stands level.

    How much higher the heel's marker is than that of the toes shows when both are lowest.
    """
    low_heel, low_toe = (
        np.nanpercentile(marker[..., 2], 5.0) if np.isfinite(marker).any() else 0.0
        for marker in (heel, toe)
    )
    length = float(median(np.linalg.norm(heel - toe, axis=-1)[:, None])[0])
    sine = np.clip((low_heel - low_toe) / max(length, SHORTEST_FOOT), -STEEPEST, STEEPEST)
    cosine = np.sqrt(1.0 - sine**2)
    return np.array([[1.0, 0.0, 0.0], [0.0, cosine, sine], [0.0, -sine, cosine]])


def _arm(
    centres: Centres,
    spots: Mapping[str, Array],
    frames: dict[str, Array],
    side: str,
    letter: str,
    sign: float,
) -> None:
    places, thorax = centres.places, frames["chest"]
    collar, shoulder, elbow = (
        places[side + joint] for joint in ("Shoulder", "UpperArm", "LowerArm")
    )
    local = np.einsum("fji,fj->fi", thorax, shoulder - collar)
    frames[f"{side}Shoulder"] = swung(thorax, unit(median(local)), shoulder - collar)
    upward = spots[f"{letter}ELB"] - elbow
    frames[f"{side}UpperArm"] = frame(0, sign * (elbow - shoulder), 2, upward)
    if f"{side}Hand" not in places:
        return
    wrist = places[f"{side}Hand"]
    back = spots[f"{letter}WRB"] - spots[f"{letter}WRA"]
    frames[f"{side}LowerArm"] = frame(0, sign * (wrist - elbow), 1, back)
    if f"{letter}FIN" in spots:
        knuckle = spots[f"{letter}FIN"]
        frames[f"{side}Hand"] = frame(0, sign * (knuckle - wrist), 1, back)
