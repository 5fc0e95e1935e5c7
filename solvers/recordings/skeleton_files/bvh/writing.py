"""Write BVH files that Blender, MotionBuilder and Maya read."""

import re
from collections.abc import Collection, Iterator
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ....errors import InvalidMotionError, InvalidSettingError
from ....files import write_atomically
from ....motion import Motion, Skeleton
from ....progress import Progress, unwatched
from ....rotations import euler_from_quaternion, unwrap_euler
from ...conventions import CENTIMETER, rotations_y_up_from_z_up, y_up_from_z_up
from .channels import vote_for_offset

ORDERS = ("XYZ", "XZY", "YXZ", "YZX", "ZXY", "ZYX")
FRAMES_AT_ONCE = 500
ROTATION_TOLERANCE = 1e-9
"""Components of a rotation, a ratio, that are only rounding."""
TAB = "\t"


def write_bvh(
    motion: Motion,
    path: Path | str,
    *,
    scale: float = CENTIMETER,
    order: str = "ZXY",
    progress: Progress = unwatched,
) -> None:
    """Write a motion as a BVH file atomically, Y up, facing +Z.

    Angles are continuous in time and have six decimals. The OFFSET of a root that stays nearer
    to the origin than to it is 0, since readers would add it to the positions. Joints that are
    called `<parent>_end` and never rotate become end sites; spaces in names become underscores.

    Parameters
    ----------
    motion : Motion
        Without gaps: BVH cannot store missing values, and other programs fail on NaN.
    path : Path or str
    scale : float, meters per unit of the file
    order : str
        Order of the rotation channels.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        The motion has gaps.
    InvalidSettingError
        The scale is not positive, or the order of axes is invalid.
    InvalidFileError
        The file cannot be written.
    SolveCancelled
        Raised by `progress`; the file is unchanged.
    """
    if order not in ORDERS or not (np.isfinite(scale) and scale > 0.0):
        raise InvalidSettingError(
            f"BVH needs a positive scale (not {scale}) and one of the orders"
            f" {', '.join(ORDERS)} (not {order})."
        )
    _refuse_gaps(motion)
    rotating = [joint for joint in _depth_first(motion.skeleton) if not _is_end(motion, joint)]
    rotations = rotations_y_up_from_z_up(motion.rotations[:, rotating])
    angles = np.degrees(unwrap_euler(euler_from_quaternion(rotations, order)))
    positions = y_up_from_z_up(motion.root_positions) / scale
    offsets = y_up_from_z_up(motion.skeleton.offsets) / scale
    if vote_for_offset(offsets[0, 1:2], np.median(positions[:, 1:2], axis=0)) > 0:
        offsets[0] = 0.0
    rows = np.concatenate([positions, angles.reshape(motion.n_frames, -1)], axis=1)
    rows = np.round(rows, 6) + 0.0  # No "-0.000000".
    row_format = " ".join(["%.6f"] * rows.shape[1]) + "\n"
    with write_atomically(path) as part, part.open("w", encoding="utf-8", newline="\n") as file:
        file.write("HIERARCHY\n")
        file.writelines(_hierarchy(motion.skeleton, rotating, offsets + 0.0, order))
        file.write(f"MOTION\nFrames: {motion.n_frames}\nFrame Time: {motion.dt:.10f}\n")
        for start in range(0, len(rows), FRAMES_AT_ONCE):
            block = rows[start : start + FRAMES_AT_ONCE]
            file.write("".join([row_format % tuple(row) for row in block.tolist()]))
            progress(min(1.0, (start + FRAMES_AT_ONCE) / len(rows)), "Writing")


def _refuse_gaps(motion: Motion) -> None:
    gaps = ~motion.observed
    if gaps.any():
        joints = [motion.skeleton.names[joint] for joint in np.flatnonzero(gaps.any(axis=0))]
        named = ", ".join(joints[:5]) + (", ..." if len(joints) > 5 else "")
        raise InvalidMotionError(
            f"{len(joints)} joints have gaps ({named}; the first at frame"
            f" {np.flatnonzero(gaps.any(axis=1))[0]}), and BVH cannot store gaps. Fill them"
            " first with Clean (denoise)."
        )


def _is_end(motion: Motion, joint: int) -> bool:
    """Return whether the joint can be written as an end site without loss."""
    skeleton = motion.skeleton
    return (
        joint > 0
        and skeleton.is_end_site(joint)
        and skeleton.names[joint] == f"{skeleton.names[skeleton.parents[joint]]}_end"
        and bool((np.abs(motion.rotations[:, joint, 1:]) < ROTATION_TOLERANCE).all())
        and bool(skeleton.offsets[joint].any())
    )


def _depth_first(skeleton: Skeleton) -> list[int]:
    """Return all joints in depth-first order, as BVH lists them."""
    order, waiting = [], [0]
    while waiting:
        order.append(waiting.pop())
        waiting.extend(reversed(skeleton.children[order[-1]]))
    return order


def _hierarchy(
    skeleton: Skeleton, rotating: Collection[int], offsets: NDArray[np.float64], order: str
) -> Iterator[str]:
    """Yield the lines of the hierarchy, with `rotating` joints and the others as end sites."""
    rotations = " ".join(f"{axis}rotation" for axis in order)
    position_channels = "Xposition Yposition Zposition"
    level = 0
    for joint in _depth_first(skeleton):
        for above in range(level, int(skeleton.depths[joint]), -1):
            yield TAB * (above - 1) + "}\n"
        level = int(skeleton.depths[joint])
        name = re.sub(r"[\s{}]+", "_", skeleton.names[joint]) or "joint"
        title = f"JOINT {name}" if joint else f"ROOT {name}"
        x, y, z = offsets[joint]
        lines = [
            title if joint in rotating else "End Site",
            "{",
            f"\tOFFSET {x:.6f} {y:.6f} {z:.6f}",
        ]
        if joint in rotating:
            lines.append(
                f"\tCHANNELS 3 {rotations}"
                if joint
                else f"\tCHANNELS 6 {position_channels} {rotations}"
            )
            if not skeleton.children[
                joint
            ]:  # Many programs require an end site in every branch.
                lines += ["\tEnd Site", "\t{", "\t\tOFFSET 0 0 0", "\t}"]
        yield "".join(f"{TAB * level}{line}\n" for line in lines)
        level += 1
    for above in range(level, 0, -1):
        yield TAB * (above - 1) + "}\n"
