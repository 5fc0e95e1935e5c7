"""Build the initial body from joint centers: joints, bone lengths and marker offsets."""

from collections.abc import Collection, Mapping

import numpy as np

from ..arrays import Array
from .body import MarkerBody, local_rotations
from .body_tables import (
    CENTRAL_JOINTS,
    CENTRAL_MARKERS,
    MARKER_SIDES,
    REQUIRED_MARKERS,
    SIDE,
    SIDE_MARKERS,
    JointPrior,
    MarkerPrior,
    Triple,
)
from .initial_poses import bone_frames
from .joint_centers import JointCenters
from .vectors import median_or_zero

TOES_END_M, HAND_END_M, HEAD_END_M = 0.06, 0.17, 0.17
"""Distances from the last joint to the end site in an adult body, by definition: end sites show
the last bone of a limb, and no marker is placed by them."""
TOES_DROP_M = 0.01
"""Drop from the toe joint to its end site in meters, in an adult body. By definition."""
SOLE_BELOW_ANKLE_M = 0.07
"""Height of the ankle above the sole in meters, in an adult body: 0.039 of the stature, as in
Winter 2009, figure 4.1. The rest pose stands on the floor with it."""


def joints_with(landmarks: Collection[str]) -> tuple[JointPrior, ...]:
    """Return the joints that these marker positions determine; parents first."""
    excluded = set()
    for bone, required in REQUIRED_MARKERS:
        if bone in {"chest", "head"}:
            excluded |= set() if set(required) <= set(landmarks) else {bone}
            continue
        for side, (letter, _) in MARKER_SIDES.items():
            if not {letter + landmark for landmark in required} <= set(landmarks):
                excluded.add(side + bone)
    if "chest" in excluded:
        excluded.add("spine")
    selected: dict[str, JointPrior] = {}
    for joint in (*CENTRAL_JOINTS, *_joints_of_both_sides()):
        if joint.name not in excluded and (not joint.parent or joint.parent in selected):
            selected[joint.name] = joint
    return tuple(selected.values())


def _joints_of_both_sides() -> list[JointPrior]:
    names = {joint.name for joint in SIDE}
    return [
        joint._replace(
            name=side + joint.name,
            parent=side + joint.parent if joint.parent in names else joint.parent,
        )
        for side in MARKER_SIDES
        for joint in SIDE
    ]


def markers_with(
    landmarks: Collection[str], joints: Collection[str]
) -> tuple[MarkerPrior, ...]:
    """Return the markers at these positions that belong to these joints."""
    side_markers = [
        marker._replace(
            landmark=letter + marker.landmark,
            bone=side + marker.bone,
            anchor=side + marker.anchor,
            offset=None if marker.offset is None else _to_side(marker.offset, sign),
        )
        for side, (letter, sign) in MARKER_SIDES.items()
        for marker in SIDE_MARKERS
    ]
    return tuple(
        marker
        for marker in (*CENTRAL_MARKERS, *side_markers)
        if marker.landmark in landmarks and {marker.bone, marker.anchor} <= set(joints)
    )


def _to_side(offset: Triple, sign: float) -> Triple:
    return (sign * offset[0], offset[1], offset[2])


def build_body(
    centers: JointCenters, landmarks: Mapping[str, Array]
) -> tuple[MarkerBody, Array]:
    """Return the initial body, and the local rotations of its bones in all frames.

    Lengths are medians over frames and sides. The rotations have shape (n_frames, n_joints,
    3, 3); bones that are missing in a frame follow their parents.
    """
    joints = joints_with(landmarks)
    names = [joint.name for joint in joints]
    markers = markers_with(landmarks, names)
    frames = bone_frames(centers, landmarks, names)
    offsets = np.array([_offset(joint, centers, frames) for joint in joints])
    offsets = _average_sides(offsets, names)
    offsets[0] = [0.0, 0.0, _hips_height(offsets, names, centers.scale)]
    marker_offsets = [_marker_offset(marker, centers, frames, landmarks) for marker in markers]
    body = MarkerBody(joints, markers, offsets, np.array(marker_offsets))
    return body, local_rotations(frames, joints, len(landmarks["LASI"]))


def _offset(joint: JointPrior, centers: JointCenters, frames: Mapping[str, Array]) -> Array:
    """Return the initial offset of a joint from its parent, in the T-pose."""
    side = next((side for side in MARKER_SIDES if joint.name.startswith(side)), "")
    sign = MARKER_SIDES[side][1] if side else 1.0
    part, scale = joint.name.removeprefix(side), centers.scale
    fixed = {
        "hips": np.zeros(3),
        "head_end": np.array([0.0, 0.0, HEAD_END_M]),
        "Hand_end": np.array([sign * HAND_END_M, 0.0, 0.0]),
        "Toes_end": np.array([0.0, -TOES_END_M, -TOES_DROP_M]),
    }
    if part in fixed:
        return scale * fixed[part]
    start, stop = centers.positions[joint.parent], centers.positions[joint.name]
    axis = {"chest": 2, "neck": 2, "LowerArm": 0, "Hand": 0}.get(part)
    axis = 2 if part in {"LowerLeg", "Foot"} else axis
    if axis is None:
        parent = (
            "chest" if part == "UpperArm" else joint.parent
        )  # relative to the thorax, as the collar bone rests
        local = np.einsum("fji,fj->fi", frames[parent], stop - start)
        return median_or_zero(local)  # for toes: the mean of their markers
    length = float(median_or_zero(np.linalg.norm(stop - start, axis=-1)[:, None])[0])
    sign_of_axis = -1.0 if part in {"LowerLeg", "Foot"} else sign
    return np.asarray(sign_of_axis * length * np.eye(3)[axis])


def _average_sides(offsets: Array, names: list[str]) -> Array:
    """Return offsets averaged over both sides, with X = 0 for central joints."""
    result = offsets.copy()
    for index, name in enumerate(names):
        if name.startswith("left"):
            other = "right" + name.removeprefix("left")
            if other in names:
                opposite = names.index(other)
                mean = (offsets[index] + offsets[opposite] * (-1.0, 1.0, 1.0)) / 2
                result[index], result[opposite] = mean, mean * (-1.0, 1.0, 1.0)
        elif not name.startswith("right"):
            result[index, 0] = 0.0
    return result


def _hips_height(offsets: Array, names: list[str], scale: float) -> float:
    """Return the height of the hips with the soles on the floor."""
    sign_of_axis = [
        name for name in ("leftUpperLeg", "leftLowerLeg", "leftFoot") if name in names
    ]
    return float(
        scale * SOLE_BELOW_ANKLE_M - sum(offsets[names.index(name), 2] for name in sign_of_axis)
    )


def _marker_offset(
    marker: MarkerPrior,
    centers: JointCenters,
    frames: Mapping[str, Array],
    landmarks: Mapping[str, Array],
) -> Array:
    """Return the offset of a marker: the mean one, or that in the initial poses."""
    if marker.offset is not None:
        return centers.scale * np.array(marker.offset)
    displacement = landmarks[marker.landmark] - centers.positions[marker.anchor]
    return median_or_zero(np.einsum("fji,fj->fi", frames[marker.bone], displacement))
