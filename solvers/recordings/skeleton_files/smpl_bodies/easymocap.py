"""Convert the global rotation and translation of EasyMocap to those of SMPL."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from ....arrays import Array
from ....errors import InvalidFileError
from ....rotations import (
    multiply,
    quaternion_from_rotation_vector,
    rotate,
    rotation_vector_from_quaternion,
)

ROTATION, TRANSLATION, SCALE = "Rh", "Th", "scale"
MIN_SIZE, MAX_SIZE = 0.1, 10.0
"""Size of a body relative to that of the model. It guards damaged files."""
N_WITHOUT_ROOT = {63, 69}
"""Numbers of a pose without its root, which newer versions leave out."""
N_OF_SMPL_X = {87}
"""Numbers of a pose of its SMPL-X."""
PELVIS_M = np.array([0.0, -0.226, 0.028])
"""Pelvis of the model without pose and shape, meters, Y up. By definition of the model, the
mean of its male and female body: 0.241 and 0.211 below the origin."""
PELVIS_OF_SMPL_X_M = np.array([0.003, -0.351, 0.012])
"""The same of SMPL-X, by definition of its neutral body."""


def with_root_at_pelvis(path: Path | str, arrays: Mapping[str, Array]) -> dict[str, Array]:
    """Return the arrays of one person with the root rotation in `poses`, and `transl`.

    EasyMocap rotates the posed body by `Rh` about the origin of the model, and moves it by `Th`
    [1]_. SMPL rotates it about the pelvis. `scale` is the size of the body relative to that of
    the model; other programs call something else so, and it is left out.

    Raises
    ------
    InvalidFileError
        The rotation or translation has another shape than one of each pose, or the size is not
        that of a body.

    References
    ----------
    .. [1] https://github.com/zju3dv/EasyMocap/blob/master/doc/02_output.md
    """
    arrays = dict(arrays)
    if not {ROTATION, TRANSLATION} & arrays.keys() or "poses" not in arrays:
        arrays.pop(SCALE, None)
        return arrays
    poses = arrays["poses"]
    n_frames = len(poses)
    poses = poses.reshape(n_frames, -1)
    vectors = _of_frames(path, arrays.pop(ROTATION, None), n_frames)
    translation = _of_frames(path, arrays.pop(TRANSLATION, None), n_frames)
    if poses.shape[1] in N_WITHOUT_ROOT:
        poses = np.concatenate([np.zeros((n_frames, 3)), poses], axis=1)
    pelvis = PELVIS_OF_SMPL_X_M if poses.shape[1] in N_OF_SMPL_X else PELVIS_M
    if SCALE in arrays and arrays[SCALE].size:
        size = float(arrays[SCALE].flat[0])
        if not MIN_SIZE <= size <= MAX_SIZE:
            raise InvalidFileError(
                f"{path} has a body of {size:g} times the size of the model. Export it again."
            )
        pelvis = pelvis * size
    turns = quaternion_from_rotation_vector(vectors)
    roots = multiply(turns, quaternion_from_rotation_vector(poses[:, :3]))
    arrays["poses"] = np.concatenate(
        [rotation_vector_from_quaternion(roots), poses[:, 3:]], axis=1
    )
    arrays["transl"] = translation + rotate(turns, pelvis) - pelvis
    return arrays


def _of_frames(path: Path | str, array: Array | None, n_frames: int) -> Array:
    """Return three numbers of each frame, 0 where the file has none."""
    if array is None:
        return np.zeros((n_frames, 3))
    if array.shape not in {(n_frames, 3), (n_frames, 1, 3), (1, n_frames, 3)}:
        raise InvalidFileError(
            f"{path} has {n_frames} poses but positions of shape {array.shape}."
        )
    return array.reshape(n_frames, 3)
