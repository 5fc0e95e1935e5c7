"""Find the joints that the markers of a frame determine."""

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array, row_blocks
from .body import MarkerBody, Poses
from .fit_poses import compute_residuals

MAX_ROTATION_STD_RAD = 0.8
"""Standard deviation above which a joint's rotation is undetermined. Chosen by hand;
`make sensitivity` varies it."""
MAX_POSITION_STD_M = 0.05
"""Standard deviation above which the position of the hips is undetermined. It guards frames
without markers of the pelvis: legs determine the hips, shanks alone do not."""
REGULARIZATION = 1e-9
"""Weight that is added to the diagonal of the normal equations. It guards a factorization."""


def find_determined_joints(
    body: MarkerBody, observed: Array, poses: Poses
) -> NDArray[np.bool_]:
    """Return whether each joint is determined in each frame, shape (n_frames, n_joints).

    A joint is determined if a marker on its bone or a descendant is observed, and if markers
    and joint priors leave a small uncertainty of its rotation. Joints without rotations have
    the state of their parents.
    """
    determined = np.zeros(poses.rotations.shape[:2], dtype=bool)
    has_marker = np.isfinite(observed).all(axis=-1)
    for joint in range(len(body.joints)):
        below = [
            marker for marker, bone in enumerate(body.bones) if joint in body.path(int(bone))
        ]
        determined[:, joint] = has_marker[:, below].any(axis=1)
    for block in row_blocks(len(observed), observed[:1].size * 3 * poses.rotations.shape[1]):
        deviation = _standard_deviations(
            body, observed[block], Poses(poses.rotations[block], poses.roots[block])
        )
        determined[block, body.rotating_joints] &= deviation[:, 1:] < MAX_ROTATION_STD_RAD
        determined[block, 0] &= deviation[:, 0] < MAX_POSITION_STD_M
    for joint, parent in enumerate(body.parents):
        if not body.joints[joint].rotates:
            determined[:, joint] = determined[:, parent]
    return determined


def _standard_deviations(body: MarkerBody, observed: Array, poses: Poses) -> Array:
    """Return standard deviations of the root position, meters, and all rotations, radians.

    Shape (n_frames, 1 + n_rotating_joints); the largest of three coordinates.
    """
    slopes = compute_residuals(body, observed, poses).slopes
    normal = np.swapaxes(slopes, 1, 2) @ slopes
    np.einsum("fuu->fu", normal)[:] += REGULARIZATION
    variance = np.einsum("fuu->fu", np.linalg.inv(normal)).clip(min=0.0)
    return np.asarray(np.sqrt(variance.reshape(len(observed), -1, 3).max(axis=-1)))
