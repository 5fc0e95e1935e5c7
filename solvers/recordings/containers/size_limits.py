"""Refuse bodies and tables that no recording has, before they take memory and time."""

from pathlib import Path

from ...errors import InvalidFileError

MAX_JOINTS = 10_000
"""Joints of all bodies in a file. It bounds the run time for damaged files: ten seconds."""
MAX_UNCHECKED_POSES = 1 << 23
"""Rotations of joints that any file may hold. It bounds the memory: 270 MB."""
MAX_POSES_PER_BYTE = 1.0
"""Rotations of joints per byte of a text file; the shortest text of one that moves takes six
bytes. It bounds the memory for files whose joints are hardly ever mentioned."""


def check_n_joints(path: Path | str, n_joints: int) -> None:
    """Raise InvalidFileError if there are more than `MAX_JOINTS`."""
    if n_joints > MAX_JOINTS:
        raise InvalidFileError(
            f"{path} has {n_joints:,} joints; {MAX_JOINTS:,} can be read. Split it, or export"
            " it again."
        )


def check_n_poses(path: Path | str, n_frames: int, n_joints: int) -> None:
    """Raise InvalidFileError if a text file has far more rotations than room for them.

    Files get there with joints at rest: a frame without any takes two bytes.
    """
    n_poses = n_frames * n_joints
    if n_poses <= MAX_UNCHECKED_POSES:
        return
    if n_poses > MAX_POSES_PER_BYTE * Path(path).stat().st_size:
        raise InvalidFileError(
            f"{path} has {n_frames:,} frames of {n_joints:,} joints, but hardly any rotations"
            " in them. Export it again."
        )
