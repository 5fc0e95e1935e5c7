"""Read the archives of Kimodo: joints and world rotations of the SOMA skeleton."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from ...errors import InvalidFileError
from ...motion import Motion
from ...progress import Progress, Remark, unwatched
from ...rotations import quaternion_from_matrix
from ..containers import read_archive_members
from ..conventions import (
    DEFAULT_FRAME_RATE,
    check_scale,
    file_conventions,
    rotations_z_up_from_y_up,
    stand_upright,
    z_up_from_y_up,
)
from .world_poses import motion_from_world_poses

JOINTS: tuple[tuple[str, str], ...] = (
    ("Hips", ""), ("Spine1", "Hips"), ("Spine2", "Spine1"), ("Chest", "Spine2"),
    ("Neck1", "Chest"), ("Neck2", "Neck1"), ("Head", "Neck2"), ("Jaw", "Head"),
    ("LeftEye", "Head"), ("RightEye", "Head"),
    ("LeftShoulder", "Chest"), ("LeftArm", "LeftShoulder"), ("LeftForeArm", "LeftArm"),
    ("LeftHand", "LeftForeArm"), ("LeftHandThumbEnd", "LeftHand"),
    ("LeftHandMiddleEnd", "LeftHand"),
    ("RightShoulder", "Chest"), ("RightArm", "RightShoulder"), ("RightForeArm", "RightArm"),
    ("RightHand", "RightForeArm"), ("RightHandThumbEnd", "RightHand"),
    ("RightHandMiddleEnd", "RightHand"),
    ("LeftLeg", "Hips"), ("LeftShin", "LeftLeg"), ("LeftFoot", "LeftShin"),
    ("LeftToeBase", "LeftFoot"),
    ("RightLeg", "Hips"), ("RightShin", "RightLeg"), ("RightFoot", "RightShin"),
    ("RightToeBase", "RightFoot"),
)  # fmt: skip
"""Names and parents of the 30 joints, in the order of the archives, which name none."""
MIN_DETERMINANT = 0.5
"""Determinant, a ratio, of a matrix that rounding has changed. By definition 1 of a rotation,
-1 of a mirror image."""
MEMBERS = ("posed_joints", "global_rot_mats", "fps")
NAMES = frozenset({"posed_joints", "global_rot_mats", "local_rot_mats", "foot_contacts"})


def is_kimodo(head: bytes) -> bool:
    """Return whether the first bytes are an archive that begins with a member of Kimodo."""
    name = head[30 : 30 + int.from_bytes(head[26:28], "little")].decode("ascii", "replace")
    return head[:4] == b"PK\x03\x04" and name.removesuffix(".npy") in NAMES


def read_kimodo(
    path: Path | str, *, scale: float | None = None, progress: Progress = unwatched
) -> Motion:
    """Read a motion of Kimodo, in meters, Z up.

    The archives hold positions and world rotations of 30 joints, without names, parents or
    frame rate. Parents are those of the SOMA skeleton; its bones are the mean of the joints
    seen from their parents; 30 Hz is assumed where no rate is given.

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
    arrays = read_archive_members(path, MEMBERS)
    joints, matrices = (arrays.get(name) for name in MEMBERS[:2])
    if joints is None or matrices is None or joints.ndim != 3 or not len(joints):
        raise InvalidFileError(
            f"{path} has no posed_joints and global_rot_mats. Save both from Kimodo."
        )
    expected = (len(joints), len(JOINTS), 3)
    if joints.shape != expected or matrices.shape != (*expected, 3):
        raise InvalidFileError(
            f"{path} has joints of shape {joints.shape}; the SOMA skeleton of Kimodo has"
            f" {len(JOINTS)}. Export it as BVH."
        )
    names = tuple(name for name, _ in JOINTS)
    parents = np.array([names.index(parent) if parent else -1 for _, parent in JOINTS])
    finite = np.isfinite(joints).all(axis=(1, 2)) & np.isfinite(matrices).all(axis=(1, 2, 3))
    if (np.linalg.det(matrices[finite]) < MIN_DETERMINANT).any():
        raise InvalidFileError(
            f"{path} has matrices in global_rot_mats that are not rotations. Export it as BVH."
        )
    rotations = np.full((*joints.shape[:2], 4), np.nan)
    rotations[finite] = quaternion_from_matrix(matrices[finite])
    rate = arrays.get("fps")
    if rate is None:
        progress(
            0.5, Remark(f"The file has no frame rate; {DEFAULT_FRAME_RATE:g} Hz is assumed")
        )
    try:
        motion = motion_from_world_poses(
            names,
            parents.tolist(),
            z_up_from_y_up(joints * (1.0 if scale is None else scale)),
            rotations_z_up_from_y_up(rotations),
            DEFAULT_FRAME_RATE if rate is None or rate.size != 1 else float(rate.ravel()[0]),
        )
    except InvalidFileError as error:
        raise InvalidFileError(f"{path}: {error}. Export it as BVH.") from None
    unit = 1.0 if scale is None else scale
    noted = replace(file_conventions("Y", unit=unit), has_floor=False)
    return stand_upright(replace(motion, conventions=noted), progress)
