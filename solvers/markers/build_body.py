"""Measure a first body from joint centres: its build, its bones and where its markers sit."""

from collections.abc import Collection, Mapping

import numpy as np
from numpy.typing import NDArray

from .body import Body, local_turns
from .body_tables import (
    CENTRE,
    CENTRE_MARKERS,
    NEEDED,
    SIDE,
    SIDE_MARKERS,
    SIDES,
    JointOf,
    MarkerOf,
    Triple,
)
from .centres import Centres
from .first_poses import bone_frames
from .vectors import median

Array = NDArray[np.float64]
TOES_END, HAND_END, HEAD_END = 0.06, 0.17, 0.17
"""Metres from the last joint of a usual body to the end of it."""
TOE_ABOVE_SOLE = 0.02
SOLE_BELOW_ANKLE = 0.07


def joints_with(spots: Collection[str]) -> tuple[JointOf, ...]:
    """Return the joints of a body of which these spots have markers; parents first."""
    without = set()
    for bone, needed in NEEDED:
        if bone in {"chest", "head"}:
            without |= set() if set(needed) <= set(spots) else {bone}
            continue
        for side, (letter, _) in SIDES.items():
            if not {letter + spot for spot in needed} <= set(spots):
                without.add(side + bone)
    if "chest" in without:
        without.add("spine")
    kept: dict[str, JointOf] = {}
    for joint in (*CENTRE, *_mirrored()):
        if joint.name not in without and (not joint.parent or joint.parent in kept):
            kept[joint.name] = joint
    return tuple(kept.values())


def _mirrored() -> list[JointOf]:
    names = {joint.name for joint in SIDE}
    return [
        joint._replace(
            name=side + joint.name,
            parent=side + joint.parent if joint.parent in names else joint.parent,
        )
        for side in SIDES
        for joint in SIDE
    ]


def markers_with(spots: Collection[str], joints: Collection[str]) -> tuple[MarkerOf, ...]:
    """Return the markers of these spots that sit on these joints."""
    sided = [
        marker._replace(
            spot=letter + marker.spot,
            bone=side + marker.bone,
            anchor=side + marker.anchor,
            offset=None if marker.offset is None else _to_side(marker.offset, sign),
        )
        for side, (letter, sign) in SIDES.items()
        for marker in SIDE_MARKERS
    ]
    return tuple(
        marker
        for marker in (*CENTRE_MARKERS, *sided)
        if marker.spot in spots and {marker.bone, marker.anchor} <= set(joints)
    )


def _to_side(offset: Triple, sign: float) -> Triple:
    return (sign * offset[0], offset[1], offset[2])


def build_body(centres: Centres, spots: Mapping[str, Array]) -> tuple[Body, Array]:
    """Return a first body, and the local rotations of its bones in all frames.

    Lengths are medians over frames and sides. The rotations have shape (n_frames, n_joints,
    3, 3); bones that a frame does not show go with their parents.
    """
    joints = joints_with(spots)
    names = [joint.name for joint in joints]
    markers = markers_with(spots, names)
    frames = bone_frames(centres, spots, names)
    offsets = np.array([_offset(joint, centres, frames) for joint in joints])
    offsets = _symmetric(offsets, names)
    offsets[0] = [0.0, 0.0, _hips_height(offsets, names)]
    seats = [_seat(marker, centres, frames, spots) for marker in markers]
    body = Body(joints, markers, offsets, np.array(seats))
    return body, local_turns(frames, joints, len(spots["LASI"]))


def _offset(joint: JointOf, centres: Centres, frames: Mapping[str, Array]) -> Array:
    """Return where a joint usually is from its parent, in the T-pose."""
    side = next((side for side in SIDES if joint.name.startswith(side)), "")
    sign = SIDES[side][1] if side else 1.0
    part, scale = joint.name.removeprefix(side), centres.scale
    fixed = {
        "hips": np.zeros(3),
        "head_end": np.array([0.0, 0.0, HEAD_END]),
        "Hand_end": np.array([sign * HAND_END, 0.0, 0.0]),
        "Toes_end": np.array([0.0, -TOES_END, -TOE_ABOVE_SOLE / 2]),
    }
    if part in fixed:
        return scale * fixed[part]
    start, stop = centres.places[joint.parent], centres.places[joint.name]
    axis = {"chest": 2, "neck": 2, "LowerArm": 0, "Hand": 0}.get(part)
    axis = 2 if part in {"LowerLeg", "Foot"} else axis
    if axis is None:
        parent = "chest" if part == "UpperArm" else joint.parent  # The collar bone's own rest.
        local = np.einsum("fji,fj->fi", frames[parent], stop - start)
        return median(local)  # of toes: their markers
    length = float(median(np.linalg.norm(stop - start, axis=-1)[:, None])[0])
    down = -1.0 if part in {"LowerLeg", "Foot"} else sign
    return np.asarray(down * length * np.eye(3)[axis])


def _symmetric(offsets: Array, names: list[str]) -> Array:
    """Return the mean of both sides, and nothing aside for what lies in the middle."""
    result = offsets.copy()
    for index, name in enumerate(names):
        if name.startswith("left"):
            other = "right" + name.removeprefix("left")
            if other in names:
                twin = names.index(other)
                mean = (offsets[index] + offsets[twin] * (-1.0, 1.0, 1.0)) / 2
                result[index], result[twin] = mean, mean * (-1.0, 1.0, 1.0)
        elif not name.startswith("right"):
            result[index, 0] = 0.0
    return result


def _hips_height(offsets: Array, names: list[str]) -> float:
    """Return how high the hips are when the soles stand on the floor."""
    down = [name for name in ("leftUpperLeg", "leftLowerLeg", "leftFoot") if name in names]
    return float(SOLE_BELOW_ANKLE - sum(offsets[names.index(name), 2] for name in down))


def _seat(
    marker: MarkerOf, centres: Centres, frames: Mapping[str, Array], spots: Mapping[str, Array]
) -> Array:
    """Return where a marker sits: as is usual, or as the first poses have it."""
    if marker.offset is not None:
        return centres.scale * np.array(marker.offset)
    away = spots[marker.spot] - centres.places[marker.anchor]
    return median(np.einsum("fji,fj->fi", frames[marker.bone], away))
