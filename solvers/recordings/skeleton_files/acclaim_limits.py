"""Read the joint limits of an Acclaim skeleton."""

from pathlib import Path

import numpy as np

from ...motion import JointLimits
from ...rotations import multiply, quaternion_from_euler
from .acclaim import find_skeleton
from .acclaim_skeleton import ROOT, AcclaimBone, read_acclaim_skeleton

Z_UP_FROM_Y_UP = quaternion_from_euler([np.pi / 2], "X")


def read_acclaim_limits(path: Path | str) -> JointLimits | None:
    """Read the rotation limits of the joints that `read_acclaim` returns.

    An angle without degree of freedom is fixed at 0; one without limits is free. The root has
    no limits.

    Parameters
    ----------
    path : Path or str
        The ASF file, or an AMC file next to it.

    Returns
    -------
    JointLimits or None
        None if the file has no limits.

    Raises
    ------
    InvalidFileError
        The file is missing or damaged, or has no ASF file next to it.
    """
    path = Path(path)
    skeleton = read_acclaim_skeleton(
        path if path.suffix.lower() == ".asf" else find_skeleton(path)
    )
    bones = [bone for bone in skeleton.bones if bone.limits and bone.name != ROOT]
    if not bones:
        return None
    bounds = skeleton.angle_unit * np.array([_bounds(bone) for bone in bones])
    axes = multiply(Z_UP_FROM_Y_UP, np.array([bone.frame for bone in bones]))
    return JointLimits(
        tuple(bone.name for bone in bones),
        np.zeros(len(bones), dtype=np.bool_),
        axes,
        axes,
        tuple(bone.order[::-1] for bone in bones),
        bounds[..., 0],
        bounds[..., 1],
    )


def _bounds(bone: AcclaimBone) -> list[tuple[float, float]]:
    """Return lower and upper limit of each angle; the rotation applied last comes first."""
    ranges = dict.fromkeys(bone.channels, (-np.inf, np.inf)) | dict(bone.limits)
    return [ranges.get(f"r{axis.lower()}", (0.0, 0.0)) for axis in bone.order[::-1]]
