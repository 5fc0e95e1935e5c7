"""Read the archives of Kimodo: joints and world rotations of SOMA, SMPL-X or Unitree's G1."""

from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np

from ...arrays import Array
from ...errors import InvalidFileError
from ...motion import Motion
from ...progress import Progress, Remark, unwatched
from ...rotations import quaternion_from_matrix
from ..containers import archive_names, read_archive_members
from ..conventions import (
    DEFAULT_FRAME_RATE,
    Bodies,
    check_scale,
    common_rate,
    file_conventions,
    observed_body,
    rotations_z_up_from_y_up,
    stand_upright,
    z_up_from_y_up,
)
from .smpl_bodies import BODY, split_people
from .world_poses import motion_from_world_poses

Tree = tuple[tuple[str, str], ...]
"""Names and parents of joints, parents first; the parent of the first is empty."""

FINGERS = (("Thumb", 3), ("Index", 4), ("Middle", 4), ("Ring", 4), ("Pinky", 4))
"""Fingers of SOMA, with their number of joints."""


def _soma(has_fingers: bool) -> Tree:
    """Return the joints of the SOMA skeleton, 77 with fingers and ends, otherwise 30."""
    head = ("HeadEnd", "Jaw", "LeftEye", "RightEye")[0 if has_fingers else 1 :]
    return (
        ("Hips", ""), ("Spine1", "Hips"), ("Spine2", "Spine1"), ("Chest", "Spine2"),
        ("Neck1", "Chest"), ("Neck2", "Neck1"), ("Head", "Neck2"),
        *((end, "Head") for end in head),
        *_arm("Left", has_fingers), *_arm("Right", has_fingers),
        *_leg("Left", has_fingers), *_leg("Right", has_fingers),
    )  # fmt: skip


def _arm(side: str, has_fingers: bool) -> Tree:
    parts = ("Chest", *(side + part for part in ("Shoulder", "Arm", "ForeArm", "Hand")))
    arm = tuple(zip(parts[1:], parts[:-1], strict=True))
    hand = parts[-1]
    if not has_fingers:
        return (*arm, (f"{hand}ThumbEnd", hand), (f"{hand}MiddleEnd", hand))
    for finger, n_joints in FINGERS:
        chain = (hand, *(f"{hand}{finger}{end}" for end in (*range(1, n_joints + 1), "End")))
        arm += tuple(zip(chain[1:], chain[:-1], strict=True))
    return arm


def _leg(side: str, has_toe_end: bool) -> Tree:
    parts = ("Leg", "Shin", "Foot", "ToeBase", "ToeEnd")[: 5 if has_toe_end else 4]
    chain = ("Hips", *(side + part for part in parts))
    return tuple(zip(chain[1:], chain[:-1], strict=True))


def _robot() -> Tree:
    """Return the joints of Unitree's G1, a robot, each with one axis; ends are Kimodo's."""
    legs = (
        _chain(f"{side}_", "pelvis", "hip_pitch", "hip_roll", "hip_yaw", "knee", "ankle_pitch",
               "ankle_roll", "toe_base")
        for side in ("left", "right")
    )  # fmt: skip
    arms = (
        _chain(f"{side}_", "waist_pitch", "shoulder_pitch", "shoulder_roll", "shoulder_yaw",
               "elbow", "wrist_roll", "wrist_pitch", "wrist_yaw", "hand_roll")
        for side in ("left", "right")
    )  # fmt: skip
    waist = _chain("", "pelvis", "waist_yaw", "waist_roll", "waist_pitch")
    return (("pelvis", ""), *(pair for chain in (*legs, waist, *arms) for pair in chain))


def _chain(side: str, first: str, *parts: str) -> Tree:
    names = (first, *(side + part for part in parts))
    return tuple(zip(names[1:], names[:-1], strict=True))


JOINTS = _soma(has_fingers=False)
TREES: dict[int, Tree] = {
    len(tree): tree
    for tree in (
        JOINTS,
        _soma(has_fingers=True),
        _robot(),
        tuple((name, parent) for name, parent, _ in BODY),
    )
}
"""Joints by their number, in the order of the archives, which name none."""
MIN_DETERMINANT = 0.5
"""Determinant, a ratio, of a matrix that rounding has changed. By definition 1 of a rotation,
-1 of a mirror image."""
MEMBERS = ("posed_joints", "global_rot_mats", "fps")
NAMES = frozenset({"posed_joints", "global_rot_mats", "local_rot_mats", "foot_contacts"})


def is_kimodo(head: bytes) -> bool:
    """Return whether the first bytes are an archive with a member of Kimodo."""
    return not NAMES.isdisjoint(archive_names(head))


def open_kimodo(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Bodies[Motion]:
    """List the motions of an archive of Kimodo; read in meters, Z up.

    The archives hold positions and world rotations of joints, without names, parents or frame
    rate. Their number shows the skeleton: 30 or 77 of SOMA, 22 of SMPL-X, 34 of Unitree's G1.
    Bones are the mean of the joints seen from their parents; 30 Hz is assumed where no rate is
    given. Several samples of one text are bodies.

    Parameters
    ----------
    path : Path or str
    scale : float, meters per unit of the file, or None
        None: 1.
    progress : Progress

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, has other joints, or joints and rotations disagree.
    InvalidSettingError
        The scale is not positive.
    SolveCancelled
        Raised by `progress`.
    """
    check_scale(scale)
    samples = split_people(read_archive_members(path, MEMBERS), {MEMBERS[0]: ()})
    unit = 1.0 if scale is None else scale
    listed = tuple(
        observed_body(str(number), np.arange(n := _n_frames(path, each)), n, n / _rate(each))
        for number, each in enumerate(samples, start=1)
        if len(samples) > 1
    )
    return Bodies(
        str(path), listed, lambda index, progress: _motion(path, samples[index], unit, progress)
    )


def _n_frames(path: Path | str, arrays: Mapping[str, Array]) -> int:
    """Return the number of frames of one sample."""
    joints, matrices = (arrays.get(name) for name in MEMBERS[:2])
    if joints is None or matrices is None or joints.ndim != 3 or not len(joints):
        raise InvalidFileError(
            f"{path} has no posed_joints and global_rot_mats. Save both from Kimodo."
        )
    return len(joints)


def _rate(arrays: Mapping[str, Array]) -> float:
    """Return the frame rate in hertz."""
    rate = arrays.get("fps")
    if rate is None or rate.size != 1:
        return DEFAULT_FRAME_RATE
    return common_rate(float(rate.ravel()[0]))


def _motion(
    path: Path | str, arrays: Mapping[str, Array], unit: float, progress: Progress
) -> Motion:
    """Return the motion of one sample."""
    _n_frames(path, arrays)
    joints, matrices = (arrays[name] for name in MEMBERS[:2])
    tree = TREES.get(joints.shape[1])
    if tree is None or joints.shape[2] != 3 or matrices.shape != (*joints.shape, 3):
        raise InvalidFileError(
            f"{path} has joints of shape {joints.shape}; the skeletons of Kimodo have 22, 30,"
            " 34 or 77 joints with a rotation each. Export it as BVH."
        )
    names = tuple(name for name, _ in tree)
    parents = [names.index(parent) if parent else -1 for _, parent in tree]
    finite = np.isfinite(joints).all(axis=(1, 2)) & np.isfinite(matrices).all(axis=(1, 2, 3))
    if (np.linalg.det(matrices[finite]) < MIN_DETERMINANT).any():
        raise InvalidFileError(
            f"{path} has matrices in global_rot_mats that are not rotations. Export it as BVH."
        )
    rotations = np.full((*joints.shape[:2], 4), np.nan)
    rotations[finite] = quaternion_from_matrix(matrices[finite])
    if "fps" not in arrays:
        progress(
            0.5, Remark(f"The file has no frame rate; {DEFAULT_FRAME_RATE:g} Hz is assumed")
        )
    try:
        motion = motion_from_world_poses(
            names,
            parents,
            z_up_from_y_up(joints * unit),
            rotations_z_up_from_y_up(rotations),
            _rate(arrays),
        )
    except InvalidFileError as error:
        raise InvalidFileError(f"{path}: {error}. Export it as BVH.") from None
    noted = replace(file_conventions("Y", unit=unit), has_floor=False)
    return stand_upright(replace(motion, conventions=noted), progress)
