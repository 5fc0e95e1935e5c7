"""Where joints are by what is usual: regressions and chords, frame by frame.

This is the first guess that the body is fitted from; it needs no more than one frame.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from .body_tables import SIDES
from .vectors import across, frame, swung, unit

Array = NDArray[np.float64]
Named = dict[str, Array]

MILLIMETRE = 0.001
STRAIGHT = 0.25
"""Sine of a limb's bend up to which its plane is mixed with that of the trunk."""
USUAL_LEG = 0.83
"""Metres from hip to ankle of a body with the widths below."""
HALF_KNEE, HALF_ELBOW, HALF_ANKLE = 0.06, 0.045, 0.045
"""Metres from the middle of a joint to the middle of the marker beside it."""
BELOW_SHOULDER, BELOW_WRIST = 0.05, 0.03
HIPS_ABOVE = 0.05
BELOW_HEADBAND = 0.07
CHEST = 0.4
"""Of the way from the lowest to the highest joint of the spine."""


@dataclass(frozen=True, eq=False)
class Centres:
    """Joint centres and the axes of bones that carry three markers or more."""

    places: Named
    """By joint, each of shape (n_frames, 3), metres; NaN where a marker is missing."""
    frames: Named
    """Axes of pelvis ("hips"), "chest" and "head", each of shape (n_frames, 3, 3)."""
    scale: float
    """Size of the body, 1 for a usual one."""


def joint_centres(spots: Mapping[str, Array]) -> Centres:
    """Guess the joint centres of every frame.

    Hips: Harrington et al. 2007 [1]_. Knees and elbows: chords [2]_ in the plane in which the
    limb bends. The others lie at usual distances from the markers about them.

    Parameters
    ----------
    spots : mapping of spot to positions of shape (n_frames, 3), metres

    Raises
    ------
    InvalidMotionError
        The pelvis has no size.

    References
    ----------
    .. [1] Harrington, Zavatsky, Lawson, Yuan, Theologis (2007). Prediction of the hip joint
       centre. J Biomech 40(3). doi:10.1016/j.jbiomech.2006.02.003
    .. [2] Davis, Ounpuu, Tyburski, Gage (1991). A gait analysis data collection and reduction
       technique. Human Movement Science 10(5). doi:10.1016/0167-9457(91)90046-Z
    """
    places: Named = {}
    frames = {"hips": _pelvis(spots, places)}
    legs = [
        np.linalg.norm(places[f"{side}UpperLeg"] - spots[f"{letter}ANK"], axis=-1)
        for side, (letter, _) in SIDES.items()
    ]
    if not np.isfinite(legs).any():
        raise InvalidMotionError(
            "The markers of the pelvis lie in one place or on one line in every frame, which no"
            " pelvis does. Check their labels and the scale."
        )
    scale = float(np.nanmedian(legs) / USUAL_LEG)
    for side in SIDES:
        _leg(spots, places, frames["hips"], side, scale)
    if {"C7", "CLAV", "T10", "STRN"} <= set(spots):
        frames["chest"] = _trunk(spots, places, frames["hips"], scale)
        for side in SIDES:
            _arm(spots, places, frames["chest"], side, scale)
    if {"LFHD", "RFHD", "LBHD", "RBHD"} <= set(spots):
        frames["head"] = _head(spots, places, scale)
    return Centres(places, frames, scale)


def _pelvis(spots: Mapping[str, Array], places: Named) -> Array:
    """Place the hips; return the axes of the pelvis."""
    left, right = spots["LASI"], spots["RASI"]
    behind = (
        (spots["LPSI"] + spots["RPSI"]) / 2 if {"LPSI", "RPSI"} <= set(spots) else spots["SACR"]
    )
    front = (left + right) / 2
    axes = frame(0, left - right, 1, behind - front)
    width = float(np.nanmedian(np.linalg.norm(left - right, axis=-1)))
    depth = float(np.nanmedian(np.linalg.norm(behind - front, axis=-1)))
    aside = 0.33 * width + 7.3 * MILLIMETRE
    back = 0.24 * depth + 9.9 * MILLIMETRE
    down = 0.30 * width + 10.9 * MILLIMETRE
    for side, (_, sign) in SIDES.items():
        places[f"{side}UpperLeg"] = front + axes @ np.array([sign * aside, back, -down])
    places["hips"] = front + axes @ np.array([0.0, back, HIPS_ABOVE - down])
    places["spine"] = (
        0.35 * front + 0.65 * behind + axes @ np.array([0.0, 0.0, 0.02])
    )  # the lowest lumbar vertebra
    return axes


def _leg(
    spots: Mapping[str, Array], places: Named, pelvis: Array, side: str, scale: float
) -> None:
    letter, sign = SIDES[side]
    hip, knee, ankle = (
        places[f"{side}UpperLeg"], spots[f"{letter}KNE"], spots[f"{letter}ANK"],
    )  # fmt: skip
    down, aside = np.array([0.0, 0.0, -1.0]), np.array([1.0, 0.0, 0.0])
    outward = sign * _bend_axis((hip, knee, ankle), 1.0, pelvis, down, aside)
    places[f"{side}LowerLeg"] = chord(hip, knee, outward, scale * HALF_KNEE)
    beside = unit(across(outward, unit(ankle - places[f"{side}LowerLeg"])))
    places[f"{side}Foot"] = ankle - scale * HALF_ANKLE * beside
    toes = [spots[letter + spot] for spot in ("TOE", "MT5") if letter + spot in spots]
    places[f"{side}Toes"] = np.mean(toes, axis=0)


def _bend_axis(
    limb: tuple[Array, Array, Array], turn: float, trunk: Array, rest: Array, axis: Array
) -> Array:
    """Return the axis about which a limb bends, as its bend and, if straight, its trunk say.

    Parameters
    ----------
    limb : its start, middle and end, each of shape (n_frames, 3)
    turn : float
        1 where the limb bends about the axis, -1 where it bends about its opposite.
    trunk : shape (n_frames, 3, 3)
    rest, axis : shape (3,)
        The limb's direction, and the axis, in the axes of the trunk in the T-pose.
    """
    upper, lower = unit(limb[1] - limb[0]), unit(limb[2] - limb[1])
    hint = swung(trunk, rest, upper) @ axis
    return unit(turn * np.cross(upper, lower) + STRAIGHT * hint)


def chord(start: Array, marker: Array, outward: Array, half_width: float) -> Array:
    """Return the joint centre from which a marker lies at a right angle to the bone.

    The marker lies `half_width` from it, on the side of `outward`, and the bone begins at
    `start` (the chord function of [2]_ of `joint_centres`).
    """
    arm = marker - start
    length = np.linalg.norm(arm, axis=-1, keepdims=True)
    along = arm / length
    aside = unit(across(outward, along))
    sine = np.minimum(half_width / length, 0.9)
    bone = length * np.sqrt(1.0 - sine**2)
    return np.asarray(start + bone * (np.sqrt(1.0 - sine**2) * along - sine * aside))


def _trunk(spots: Mapping[str, Array], places: Named, pelvis: Array, scale: float) -> Array:
    """Place spine and neck; return the axes of the thorax."""
    top, bottom = spots["C7"] + spots["CLAV"], spots["T10"] + spots["STRN"]
    behind, front = spots["C7"] + spots["T10"], spots["CLAV"] + spots["STRN"]
    axes = frame(2, top - bottom, 1, behind - front)
    places["neck"] = 0.65 * spots["C7"] + 0.35 * spots["CLAV"]
    places["chest"] = places["spine"] + CHEST * (places["neck"] - places["spine"])
    return axes


def _head(spots: Mapping[str, Array], places: Named, scale: float) -> Array:
    left, right = spots["LFHD"] + spots["LBHD"], spots["RFHD"] + spots["RBHD"]
    front, behind = spots["LFHD"] + spots["RFHD"], spots["LBHD"] + spots["RBHD"]
    axes = frame(0, left - right, 1, behind - front)
    places["head"] = (front + behind) / 4 + axes @ np.array([0.0, 0.02, -BELOW_HEADBAND])
    return axes


def _arm(
    spots: Mapping[str, Array], places: Named, thorax: Array, side: str, scale: float
) -> None:
    letter, sign = SIDES[side]
    if not {f"{letter}SHO", f"{letter}ELB"} <= set(spots):
        return
    shoulder = spots[f"{letter}SHO"] - scale * BELOW_SHOULDER * thorax[..., 2]
    collar = 0.25 * spots["C7"] + 0.75 * spots["CLAV"]
    places[f"{side}Shoulder"] = collar + thorax @ np.array([sign * 0.025 * scale, 0.0, 0.0])
    places[f"{side}UpperArm"] = shoulder
    elbow = spots[f"{letter}ELB"]
    if not {f"{letter}WRA", f"{letter}WRB"} <= set(spots):
        places[f"{side}LowerArm"] = elbow
        return
    inner, outer = spots[f"{letter}WRA"], spots[f"{letter}WRB"]
    back = unit(sign * np.cross(elbow - (inner + outer) / 2, inner - outer))
    wrist = (inner + outer) / 2 - scale * BELOW_WRIST * back
    out, up = np.array([sign, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    upward = _bend_axis((shoulder, elbow, wrist), -sign, thorax, out, up)
    places[f"{side}LowerArm"] = chord(shoulder, elbow, upward, scale * HALF_ELBOW)
    places[f"{side}Hand"] = wrist
