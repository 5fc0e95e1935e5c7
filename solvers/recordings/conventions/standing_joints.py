"""Measure along which axis a body stands."""

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...motion import AxisName, Motion, world_poses
from .contact import measure_contact, sampled_steps

N_SAMPLED_FRAMES = 60
"""Number of frames, evenly spaced, that are evaluated. It bounds the run time."""

AXES: dict[AxisName, Array] = {
    "Y": np.array([0.0, 0.0, 1.0]), "-Y": np.array([0.0, 0.0, -1.0]),
    "Z": np.array([0.0, -1.0, 0.0]), "-Z": np.array([0.0, 1.0, 0.0]),
    "X": np.array([1.0, 0.0, 0.0]), "-X": np.array([-1.0, 0.0, 0.0]),
}  # fmt: skip
"""Axes of a file as directions of a motion that was read with Y up."""
MIN_STANDING = -0.5
"""Evidence, a ratio, of a body that is upside down. It guards handstands, which must not
outvote the rest pose (`test_a_handstand_stays_one`)."""
MIN_HIPS_MOTION = 0.01
"""Mean step of the hips, relative to that of all joints, below which they are the origin of the
file rather than in the room. It guards rounding of numbers."""
MAX_FLOOR_FRACTION = 0.4
"""Distance of the lowest joint from zero, relative to the height, that is no evidence. Chosen
by hand: x0.5 fails `test_a_lying_actor_is_left_lying_and_reported`, x2
`test_any_axis_may_be_up`."""
MIN_HIPS_FRACTION = 0.03
"""Height of the hips of an actor who lies on a floor, relative to the body. Chosen by hand: 5
cm of an adult, whose hips are 8 cm and more above the floor."""
MIN_SPREAD_FRACTION = 0.06
"""Distance between the feet, relative to the size, below which a rest pose is folded. Measured:
in the rest poses of these takes it is 0.09 to 0.88, in a folded one 0."""


TOP_ROLES = ("head", "neck", "chest", "leftUpperArm", "rightUpperArm")
"""Roles above the hips of a standing actor, the clear ones first."""


class StandingJoints(NamedTuple):
    """The joints that show where a body stands."""

    hips: int
    head: int
    feet: list[int]
    joints: list[int]
    """All with a role."""

    @classmethod
    def from_roles(cls, roles: Mapping[str, int]) -> "StandingJoints | None":
        """Return the joints by role; None where they do not show a body."""
        feet = [roles[role] for role in ("leftFoot", "rightFoot") if role in roles]
        top = next((roles[role] for role in TOP_ROLES if role in roles), None)
        if top is None or "hips" not in roles or not feet:
            return None
        return cls(roles["hips"], top, feet, sorted(roles.values()))


def sampled_positions(motion: Motion) -> Array:
    """Return the joints in some frames without gaps, shape (n_frames, n_joints, 3)."""
    step = max(1, motion.n_frames // N_SAMPLED_FRAMES)
    positions = _positions(motion, np.arange(0, motion.n_frames, step))
    return np.asarray(positions[np.isfinite(positions).all(axis=(1, 2))])


def sampled_pairs(motion: Motion) -> tuple[Array, Array]:
    """Return the joints, (n, n_joints, 3), in some frames, and in those that follow them."""
    steps = sampled_steps(np.ones(motion.n_frames, dtype=np.bool_))
    return _positions(motion, steps), _positions(motion, steps + 1)


def _positions(motion: Motion, frames: NDArray[np.intp]) -> Array:
    return np.asarray(
        world_poses(
            motion.skeleton, motion.rotations[frames], motion.root_positions[frames]
        ).positions
    )


def is_unfolded(rest: Array, body: StandingJoints) -> bool:
    """Whether a rest pose, (n_joints, 3), shows separate legs, not all joints at one point."""
    spread = np.linalg.norm(rest[body.feet[0]] - rest[body.feet[-1]])
    return len(body.feet) < 2 or bool(
        spread > MIN_SPREAD_FRACTION * np.ptp(rest[body.joints], axis=0).max()
    )


def measure_standing(positions: Array, body: StandingJoints) -> dict[AxisName, float]:
    """Return how far each axis points from feet to hips to head in most frames, -1 to 1.

    Here and below, positions have the shape (n_frames, n_joints, 3), in any unit.
    """
    trunk = positions[:, body.head] - positions[:, body.hips]
    legs = positions[:, body.hips] - positions[:, body.feet].mean(axis=1)
    directions = [
        part / np.maximum(np.linalg.norm(part, axis=1, keepdims=True), 1e-9)
        for part in (trunk, legs)
    ]
    along = np.median(np.mean(directions, axis=0), axis=0)
    return {
        axis: max(MIN_STANDING, float(along @ direction)) for axis, direction in AXES.items()
    }


def measure_floor(positions: Array, body: StandingJoints) -> dict[AxisName, float]:
    """Return how near the lowest joint of (F, n_joints, 3) is to zero along axes, 0 to 1."""
    return {
        axis: max(
            0.0,
            1.0
            - abs(
                float(
                    np.percentile(np.nanmin(positions[:, body.joints] @ direction, axis=1), 5)
                )
            )
            / (MAX_FLOOR_FRACTION * height_of(positions, body)),
        )
        for axis, direction in AXES.items()
    }


def measure_rest(
    positions: Array, body: StandingJoints, floor: Mapping[AxisName, float]
) -> dict[AxisName, float]:
    """Return evidence of the floor along axes, 0 if the hips of (F, n, 3) are the origin."""
    least = MIN_HIPS_FRACTION * height_of(positions, body)
    hips = {
        axis: abs(float(np.median(positions[:, body.hips] @ direction)))
        for axis, direction in AXES.items()
    }
    return {axis: floor[axis] if hips[axis] >= least else 0.0 for axis in AXES}


@np.errstate(over="ignore", invalid="ignore")  # numbers that are refused later
def measure_joint_contact(
    before: Array, after: Array, body: StandingJoints
) -> dict[AxisName, float]:
    """Return how still the lowest joints along each axis are, 0 to 1 (`measure_contact`).

    It is 0 along all axes where the hips are the origin.

    Parameters
    ----------
    before, after : shape (n_steps, n_joints, 3)
        Joints in frames, and in those that follow them; NaN where missing.
    """
    steps = np.linalg.norm(after - before, axis=2)
    hips, joints = steps[:, body.hips], steps[:, body.joints]
    if not np.nansum(hips) > MIN_HIPS_MOTION * np.nansum(joints) / len(body.joints):
        return dict.fromkeys(AXES, 0.0)
    evidence = measure_contact(
        before[:, body.joints], after[:, body.joints], np.stack([*AXES.values()])
    )
    return dict(zip(AXES, evidence.tolist(), strict=True))


def height_of(positions: Array, body: StandingJoints) -> float:
    """Return the size of a body, (F, n_joints, 3), along the axis on which it is longest."""
    joints = positions[:, body.joints]
    extents = (np.nanmax(joints, axis=1) - np.nanmin(joints, axis=1)).max(axis=1)
    return max(float(np.median(extents)), 1e-9)
