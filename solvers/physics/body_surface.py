"""Measure the surface of a simulated body relative to the ground."""

import numpy as np
import scipy
from numpy.typing import NDArray

from ..arrays import Array
from ..motion import Motion, forward_kinematics
from ..motion.humanoid import SIDES
from ..rotations import rotate
from ..signals import smooth_gaussian
from .body import PhysicsBody

LEG = ("UpperLeg", "LowerLeg", "Foot")
MAX_CONTACT_M = 0.005
"""Meters, for legs of 0.9 m: a sole this near to the ground touches it. Half and twice are no
better (`make sensitivity`)."""

ERROR_WINDOW_S = 1.0
"""Seconds: heights above or below the ground that last longer are capture errors. Chosen by
hand; `make sensitivity` varies it."""

MAX_SINK_M = 0.02
"""Meters, for legs of 0.9 m, of tolerated lasting depth: one foot is often a little lower than
the other, and legs that press on it stand more firmly. Chosen by hand; `make sensitivity`
varies it."""

MAX_HOVER_M = 0.25
"""Meters, for legs of 0.9 m: a body that stays higher is not on this ground. It guards takes on
a platform or in camera space (`test_body_far_above_the_ground_is_unchanged_and_reported`)."""


def joints_of_ends(body: PhysicsBody) -> NDArray[np.intp]:
    """Return the joint of each end of `PhysicsBody.ground_capsules`, (n_ends,)."""
    return np.repeat(np.array([each.joint for each in body.ground_capsules], dtype=np.intp), 2)


def lowest_points(body: PhysicsBody, motion: Motion) -> Array:
    """Return the lowest points of the ends of `PhysicsBody.ground_capsules`.

    Shape (n_frames, n_ends, 3), meters.
    """
    poses, joints = forward_kinematics(motion), joints_of_ends(body)
    ends = np.concatenate([each.ends for each in body.ground_capsules])
    points = poses.positions[:, joints] + rotate(poses.rotations[:, joints], ends)
    points[..., 2] -= np.repeat([each.radius for each in body.ground_capsules], 2)
    return np.asarray(points)


def measure_clearance(body: PhysicsBody, motion: Motion, ground: float) -> Array:
    """Return the height of the body's lowest point above the ground, (n_frames,), meters."""
    return np.asarray(lowest_points(body, motion)[..., 2].min(axis=1) - ground)


def measure_penetration(body: PhysicsBody, motion: Motion, ground: float) -> float:
    """Return the maximum depth of the body below the ground, meters; 0 above it."""
    return float(max(0.0, -measure_clearance(body, motion, ground).min()))


def height_correction(heights: Array, frame_rate: float, size: float) -> Array:
    """Return how far to raise a target that lastingly sinks into the ground or hovers.

    Short penetration is left to the legs, and a body that leaves the ground briefly jumps. A
    body that hovers higher than `MAX_HOVER_M` is not on this ground at all.

    Parameters
    ----------
    heights : shape (n_frames,), meters
        Of the body's lowest point above the ground.
    frame_rate : float, hertz
    size : float
        Of the body: its legs over 0.9 m.

    Returns
    -------
    Array
        Shape (n_frames,), meters; negative lowers the target.
    """
    window = min(2 * int(ERROR_WINDOW_S * frame_rate / 2) + 1, 2 * len(heights) - 1)
    depth = np.maximum(-heights - MAX_SINK_M * size, 0.0)
    sink = scipy.ndimage.median_filter(depth, size=window, mode="nearest")
    hover = scipy.ndimage.grey_opening(np.maximum(heights, 0.0), size=window, mode="nearest")
    hover = np.where(hover > MAX_HOVER_M * size, 0.0, hover)
    return smooth_gaussian(sink - hover, ERROR_WINDOW_S / 4 * frame_rate)


def detect_touching_feet(body: PhysicsBody, motion: Motion, ground: float) -> NDArray[np.bool_]:
    """Return whether the left and the right foot touch the ground, shape (n_frames, 2)."""
    near = lowest_points(body, motion)[..., 2] < ground + MAX_CONTACT_M * body.size
    return np.stack(
        [near[:, select_foot_ends(body, side)].any(axis=1) for side in SIDES], axis=-1
    )


def measure_sole_speeds(body: PhysicsBody, motion: Motion) -> Array:
    """Return the horizontal speed of each foot, shape (n_frames, 2), m/s.

    For a rolling foot it is the speed of its slowest point.
    """
    points = lowest_points(body, motion)
    speeds = np.zeros((motion.n_frames, 2))
    for column, side in enumerate(SIDES):
        ends = select_foot_ends(body, side)
        if ends.any() and motion.n_frames > 1:
            steps = np.linalg.norm(np.diff(points[:, ends, :2], axis=0), axis=-1)
            speeds[1:, column] = steps.min(axis=1) * motion.frame_rate
            speeds[0, column] = speeds[1, column]
    return speeds


def select_foot_ends(body: PhysicsBody, side: str) -> NDArray[np.bool_]:
    """Return which ends of `PhysicsBody.ground_capsules` belong to a foot, (n_ends,)."""
    roles = {f"{side}Foot", f"{side}Toes"}
    joints = joints_of_ends(body)
    return np.array([body.roles.get(int(joint)) in roles for joint in joints], dtype=np.bool_)


def find_leg_chain(body: PhysicsBody, side: str) -> tuple[int, int, int] | None:
    """Return hip, knee and ankle of a leg; None if they are not one chain."""
    joints = {role: joint for joint, role in body.roles.items()}
    joints_of_leg = [joints.get(side + part) for part in LEG]
    if None in joints_of_leg:
        return None
    hip, knee, ankle = (joint for joint in joints_of_leg if joint is not None)
    skeleton = body.skeleton
    follows = hip in skeleton.ancestors(knee) and knee in skeleton.ancestors(ankle)
    return (hip, knee, ankle) if follows else None


def measure_foot_slide(body: PhysicsBody, motion: Motion, contacts: NDArray[np.bool_]) -> float:
    """Return the distance, meters, that both feet cover during contacts (n_frames, 2)."""
    standing = contacts[1:] & contacts[:-1]
    return float(measure_sole_speeds(body, motion)[1:][standing].sum() / motion.frame_rate)
