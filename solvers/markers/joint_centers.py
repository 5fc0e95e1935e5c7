"""Estimate joint centers in each frame by regressions and chord functions.

This is the initial value of the body fit; one frame is enough.
"""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from ..arrays import Array
from ..errors import InvalidMotionError
from ..rotations import normalize
from .body_tables import MARKER_SIDES
from .vectors import frame, perpendicular, swing_frames

PositionsByJoint = dict[str, Array]

HINT_WEIGHT = 0.25
"""Weight of the trunk's axis of flexion, relative to the sine of the limb's own flexion. Chosen
by hand; `make sensitivity` varies it."""
ADULT_LEG_M = 0.83
"""Length from hip to ankle of a body with the widths below. By definition."""
HALF_KNEE_M, HALF_ELBOW_M, HALF_ANKLE_M = 0.06, 0.045, 0.045
"""Distance of a joint center from the marker next to it. Chosen by hand; `make sensitivity`
varies them."""
SHOULDER_DEPTH_M, WRIST_DEPTH_M = 0.05, 0.03
"""Distances, in meters, from the shoulder marker down to the joint and from the wrist markers
back to it. Chosen by hand; `make sensitivity` varies them."""
HIPS_ABOVE_JOINTS_M = 0.05
"""Height of the hips joint above the hip joints in meters. By definition of this skeleton: in
rigs it is 0.02 to 0.07."""
HEADBAND_HEIGHT_M = 0.07
"""Height of a headband above the head joint in meters. Half and twice gain less than 1 %
(`make sensitivity`)."""
CHEST_FRACTION = 0.4
"""Position of the chest joint between the lowest and the highest spine joint. Half and twice
are no better (`make sensitivity`)."""


@dataclass(frozen=True, eq=False)
class JointCenters:
    """Joint centers, and the axes of bones with three or more markers."""

    positions: PositionsByJoint
    """By joint, each of shape (n_frames, 3), meters; NaN where a marker is missing."""
    frames: PositionsByJoint
    """Axes of pelvis ("hips"), "chest" and "head", each of shape (n_frames, 3, 3)."""
    scale: float
    """Size of the body relative to an adult."""


def joint_centers(landmarks: Mapping[str, Array]) -> JointCenters:
    """Estimate the joint centers of every frame.

    Hips: Harrington et al. 2007 [1]_. Knees and elbows: chord function [2]_ in the
    plane of flexion. The others have mean distances from the markers around them.

    Parameters
    ----------
    landmarks : mapping of landmark to positions of shape (n_frames, 3), meters

    Raises
    ------
    InvalidMotionError
        The markers of the pelvis are in one position or on one line.

    References
    ----------
    .. [1] Harrington, Zavatsky, Lawson, Yuan, Theologis (2007). Prediction of the hip joint
       centre. J Biomech 40(3). doi:10.1016/j.jbiomech.2006.02.003
    .. [2] Davis, Ounpuu, Tyburski, Gage (1991). A gait analysis data collection and reduction
       technique. Human Movement Science 10(5). doi:10.1016/0167-9457(91)90046-Z
    """
    positions: PositionsByJoint = {}
    frames = {"hips": _pelvis(landmarks, positions)}
    legs = [
        np.linalg.norm(positions[f"{side}UpperLeg"] - landmarks[f"{letter}ANK"], axis=-1)
        for side, (letter, _) in MARKER_SIDES.items()
    ]
    if not np.isfinite(legs).any():
        raise InvalidMotionError(
            "The markers of the pelvis lie at one point or on one line in every frame. Check"
            " their labels and the scale."
        )
    scale = float(np.nanmedian(legs) / ADULT_LEG_M)
    for side in MARKER_SIDES:
        _leg(landmarks, positions, frames["hips"], side, scale)
    if {"C7", "CLAV", "T10", "STRN"} <= set(landmarks):
        frames["chest"] = _trunk(landmarks, positions, frames["hips"], scale)
        for side in MARKER_SIDES:
            _arm(landmarks, positions, frames["chest"], side, scale)
    if {"LFHD", "RFHD", "LBHD", "RBHD"} <= set(landmarks):
        frames["head"] = _head(landmarks, positions, scale)
    return JointCenters(positions, frames, scale)


def _pelvis(landmarks: Mapping[str, Array], positions: PositionsByJoint) -> Array:
    """Add the hip joints; return the axes of the pelvis."""
    left, right = landmarks["LASI"], landmarks["RASI"]
    back_point = (
        (landmarks["LPSI"] + landmarks["RPSI"]) / 2
        if {"LPSI", "RPSI"} <= set(landmarks)
        else landmarks["SACR"]
    )
    front = (left + right) / 2
    axes = frame(0, left - right, 1, back_point - front)
    width = float(np.nanmedian(np.linalg.norm(left - right, axis=-1)))
    depth = float(np.nanmedian(np.linalg.norm(back_point - front, axis=-1)))
    # Meters, after Harrington et al. 2007; the paper prints millimeters.
    lateral_offset = 0.33 * width + 7.3e-3
    backward_offset = 0.24 * depth + 9.9e-3
    down = 0.30 * width + 10.9e-3
    for side, (_, sign) in MARKER_SIDES.items():
        positions[f"{side}UpperLeg"] = front + axes @ np.array([
            sign * lateral_offset,
            backward_offset,
            -down,
        ])
    positions["hips"] = front + axes @ np.array([
        0.0,
        backward_offset,
        HIPS_ABOVE_JOINTS_M - down,
    ])
    positions["spine"] = (
        0.35 * front + 0.65 * back_point + axes @ np.array([0.0, 0.0, 0.02])
    )  # the lowest lumbar vertebra
    return axes


def _leg(
    landmarks: Mapping[str, Array],
    positions: PositionsByJoint,
    pelvis: Array,
    side: str,
    scale: float,
) -> None:
    letter, sign = MARKER_SIDES[side]
    hip, knee, ankle = (
        positions[f"{side}UpperLeg"], landmarks[f"{letter}KNE"], landmarks[f"{letter}ANK"],
    )  # fmt: skip
    down, lateral_offset = np.array([0.0, 0.0, -1.0]), np.array([1.0, 0.0, 0.0])
    outward = sign * _flexion_axis((hip, knee, ankle), 1.0, pelvis, down, lateral_offset)
    positions[f"{side}LowerLeg"] = chord(hip, knee, outward, scale * HALF_KNEE_M)
    lateral = normalize(perpendicular(outward, normalize(ankle - positions[f"{side}LowerLeg"])))
    positions[f"{side}Foot"] = ankle - scale * HALF_ANKLE_M * lateral
    toes = [
        landmarks[letter + landmark]
        for landmark in ("TOE", "MT5")
        if letter + landmark in landmarks
    ]
    positions[f"{side}Toes"] = np.mean(toes, axis=0)


def _flexion_axis(
    limb: tuple[Array, Array, Array],
    sign_of_flexion: float,
    trunk: Array,
    rest: Array,
    axis: Array,
) -> Array:
    """Return the axis of flexion of a limb, from its flexion and, if straight, its trunk.

    Parameters
    ----------
    limb : its start, middle and end, each of shape (n_frames, 3)
    sign_of_flexion : float
        1 if the flexion is positive about the axis, -1 if negative.
    trunk : shape (n_frames, 3, 3)
    rest, axis : shape (3,)
        The limb's direction, and the axis, in the axes of the trunk in the T-pose.
    """
    upper, lower = normalize(limb[1] - limb[0]), normalize(limb[2] - limb[1])
    hint = swing_frames(trunk, rest, upper) @ axis
    return normalize(sign_of_flexion * np.cross(upper, lower) + HINT_WEIGHT * hint)


def chord(start: Array, marker: Array, outward: Array, half_width: float) -> Array:
    """Return the joint center for which the marker is perpendicular to the bone.

    The marker is `half_width` from it, on the side of `outward`, and the bone starts at `start`
    (the chord function of [2]_ in `joint_centers`). All have the shape (n_frames, 3), meters.
    """
    arm = marker - start
    length = np.linalg.norm(arm, axis=-1, keepdims=True)
    along = arm / length
    lateral_offset = normalize(perpendicular(outward, along))
    sine = np.minimum(half_width / length, 0.9)
    bone = length * np.sqrt(1.0 - sine**2)
    return np.asarray(start + bone * (np.sqrt(1.0 - sine**2) * along - sine * lateral_offset))


def _trunk(
    landmarks: Mapping[str, Array], positions: PositionsByJoint, pelvis: Array, scale: float
) -> Array:
    """Add the spine and neck joints; return the axes of the thorax."""
    top, bottom = landmarks["C7"] + landmarks["CLAV"], landmarks["T10"] + landmarks["STRN"]
    back_point, front = (
        landmarks["C7"] + landmarks["T10"],
        landmarks["CLAV"] + landmarks["STRN"],
    )
    axes = frame(2, top - bottom, 1, back_point - front)
    positions["neck"] = 0.65 * landmarks["C7"] + 0.35 * landmarks["CLAV"]
    positions["chest"] = positions["spine"] + CHEST_FRACTION * (
        positions["neck"] - positions["spine"]
    )
    return axes


def _head(landmarks: Mapping[str, Array], positions: PositionsByJoint, scale: float) -> Array:
    left, right = landmarks["LFHD"] + landmarks["LBHD"], landmarks["RFHD"] + landmarks["RBHD"]
    front, back_point = (
        landmarks["LFHD"] + landmarks["RFHD"],
        landmarks["LBHD"] + landmarks["RBHD"],
    )
    axes = frame(0, left - right, 1, back_point - front)
    positions["head"] = (front + back_point) / 4 + axes @ np.array([
        0.0,
        0.02,
        -HEADBAND_HEIGHT_M,
    ])
    return axes


def _arm(
    landmarks: Mapping[str, Array],
    positions: PositionsByJoint,
    thorax: Array,
    side: str,
    scale: float,
) -> None:
    letter, sign = MARKER_SIDES[side]
    if not {f"{letter}SHO", f"{letter}ELB"} <= set(landmarks):
        return
    shoulder = landmarks[f"{letter}SHO"] - scale * SHOULDER_DEPTH_M * thorax[..., 2]
    collar = 0.25 * landmarks["C7"] + 0.75 * landmarks["CLAV"]
    positions[f"{side}Shoulder"] = collar + thorax @ np.array([sign * 0.025 * scale, 0.0, 0.0])
    positions[f"{side}UpperArm"] = shoulder
    elbow = landmarks[f"{letter}ELB"]
    if not {f"{letter}WRA", f"{letter}WRB"} <= set(landmarks):
        positions[f"{side}LowerArm"] = elbow
        return
    inner, outer = landmarks[f"{letter}WRA"], landmarks[f"{letter}WRB"]
    backward_offset = normalize(sign * np.cross(elbow - (inner + outer) / 2, inner - outer))
    wrist = (inner + outer) / 2 - scale * WRIST_DEPTH_M * backward_offset
    out, up = np.array([sign, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    upward = _flexion_axis((shoulder, elbow, wrist), -sign, thorax, out, up)
    positions[f"{side}LowerArm"] = chord(shoulder, elbow, upward, scale * HALF_ELBOW_M)
    positions[f"{side}Hand"] = wrist
