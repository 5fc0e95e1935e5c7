"""Generate a natural walk: rolling planted feet, swaying hips, swinging arms.

Angles and their timing follow measurements on healthy adults (Perry and Burnfield 2010, Gait
Analysis). The feet are planned first, the hips move over them, inverse kinematics joins both,
and trunk and arms swing against the legs.
"""

from dataclasses import dataclass
from functools import reduce

import numpy as np

from ..arrays import Array
from ..errors import InvalidSettingError
from ..motion import Motion, Skeleton, local_rotations
from ..rotations import (
    inverse,
    multiply,
    quaternion_from_matrix,
    quaternion_from_rotation_vector,
    rotate,
    rotation_vector_from_quaternion,
)
from ..settings import Settings, setting
from .footsteps import MID_STANCE
from .walk_plan import WalkPlan, plan_walk
from .walker import walker_skeleton

MAX_STEP_M = 0.85
"""Meters: the legs of the sample's skeleton reach no farther."""
NATURAL_STEP_M = 0.7
"""Meters: the step for which the angles below are given; longer steps swing more."""
MAX_LEG_EXTENSION = 0.998
"""Maximum fraction of its length that a leg spans, so that the knee never locks."""
HEADING_STD_RAD = np.radians(12.0)


@dataclass(frozen=True, kw_only=True)
class GaitSettings(Settings):
    """Parameters of the sample walk."""

    duration: float = setting(8.0, "Length of the take", unit="s", minimum=0.1, maximum=600.0)
    frame_rate: float = setting(60.0, "Frames per second", unit="Hz", minimum=10, maximum=480)
    speed: float = setting(1.3, "Walking speed", unit="m/s", minimum=0.4, maximum=1.8)
    cadence: float = setting(
        116.0, "Steps per minute; more makes shorter steps", minimum=60.0, maximum=160.0
    )
    seed: int = setting(
        0,
        "Random seed; a different seed gives a different walker",
        minimum=0,
        maximum=2**31 - 1,
    )


def walking_gait(settings: GaitSettings = GaitSettings()) -> Motion:
    """Return a person who walks toward -Y in gentle curves, from the first frame on.

    Steps vary in time, position and size as a person's do. The same seed gives the same walk at
    every frame rate. While a foot stands flat its ankle is fixed, and the joint of its toes
    rests until toe-off.

    Parameters
    ----------
    settings : GaitSettings

    Returns
    -------
    Motion
        On `walker_skeleton`; the floor is z = 0; nothing is missing.

    Raises
    ------
    InvalidSettingError
        The speed requires longer steps than the legs can make.
    """
    step = 60.0 * settings.speed / settings.cadence
    size = step / NATURAL_STEP_M
    if step > MAX_STEP_M:
        raise InvalidSettingError(
            f"{settings.speed:g} m/s at {settings.cadence:g} steps per minute needs steps of"
            f" {step:.2f} m, and the sample's legs make {MAX_STEP_M} m; raise cadence."
        )
    n_frames = max(1, round(settings.duration * settings.frame_rate))
    time = np.arange(n_frames) / settings.frame_rate
    plan = plan_walk(
        time,
        settings.duration,
        settings.speed,
        60.0 / settings.cadence,
        HEADING_STD_RAD,
        settings.seed,
    )
    skeleton = walker_skeleton()
    hips = _hips(plan, size)
    world = np.repeat(hips[:, None], skeleton.n_joints, axis=1)
    root = _root(plan, skeleton, hips, size)
    _pose_legs(world, plan, skeleton, root)
    rotations = local_rotations(skeleton, world)
    _pose_trunk(rotations, plan, skeleton)
    for side in ("Left", "Right"):
        _pose_arm(rotations, plan, skeleton, side, size)
    return Motion(skeleton, rotations, root, settings.frame_rate)


# Angles below are degrees. Positive x leans forward, y lowers the left side, z turns left.
# `_cycle(plan, p)` is 1 when the left foot is at phase p of its stride.


def _cycle(plan: WalkPlan, peak: float, per_stride: int = 1) -> Array:
    """Cosine over the stride of the left foot, 1 at phase `peak`, shape (n_frames,)."""
    phase = plan.steps / 2.0 + MID_STANCE
    return np.asarray(np.cos(2.0 * np.pi * per_stride * (phase - peak)))


def _hips(plan: WalkPlan, size: float) -> Array:
    """World rotation of the hips: the forward hip leads, the swinging side drops."""
    tilt = 5.0 + plan.random_curve(0.5) + 1.2 * _cycle(plan, 0.05, 2)
    drop = -3.5 * _cycle(plan, 0.12) * (1.0 + plan.random_curve(0.1)) + plan.random_curve(0.4)
    hip_rotation = -5.0 * size * _cycle(plan, 0.0) * (
        1.0 + plan.random_curve(0.1)
    ) + plan.random_curve(0.5)
    heading = quaternion_from_rotation_vector(plan.heading[:, None] * [0.0, 0.0, 1.0])
    return _compose(
        heading,
        _rotation_from_degrees(z=hip_rotation),
        _rotation_from_degrees(y=drop),
        _rotation_from_degrees(x=tilt),
    )


def _root(plan: WalkPlan, skeleton: Skeleton, hips: Array, size: float) -> Array:
    """Hips over the standing foot, highest in mid-stance, as high as the legs allow."""
    left = rotate(_rotation_from_degrees(z=np.degrees(plan.heading)), [1.0, 0.0, 0.0])
    root = plan.ground + left * (0.022 * _cycle(plan, 0.3) + plan.random_curve(0.004))[:, None]
    root[:, 2] = -0.015 * size**2 * _cycle(plan, 0.05, 2) + plan.random_curve(0.002)
    heights = []
    for foot, side in zip(plan.feet, ("Left", "Right"), strict=True):
        hip = root + rotate(hips, skeleton.offsets[skeleton.index(f"{side}UpLeg")])
        across = np.linalg.norm((foot.ankles - hip)[:, :2], axis=1)
        reach = MAX_LEG_EXTENSION * sum(_leg_lengths(skeleton, side))
        heights.append(foot.ankles[:, 2] + np.sqrt(reach**2 - across**2) - hip[:, 2])
    root[:, 2] += np.min(heights)
    return root


def _pose_legs(world: Array, plan: WalkPlan, skeleton: Skeleton, root: Array) -> None:
    """Write both legs' world rotations: the law of cosines puts the ankles on their paths."""
    for foot, side in zip(plan.feet, ("Left", "Right"), strict=True):
        thigh, shin = _leg_lengths(skeleton, side)
        hip = root + rotate(world[:, 0], skeleton.offsets[skeleton.index(f"{side}UpLeg")])
        line = foot.ankles - hip
        span = np.linalg.norm(line, axis=1, keepdims=True)
        down = line / span
        axis = rotate(world[:, 0], [1.0, 0.0, 0.0]) + rotate(foot.foot, [1.0, 0.0, 0.0])
        axis -= down * (axis * down).sum(axis=1, keepdims=True)
        axis /= np.linalg.norm(axis, axis=1, keepdims=True)
        at_hip = np.arccos((thigh**2 + span**2 - shin**2) / (2.0 * thigh * span))
        at_ankle = np.arccos((shin**2 + span**2 - thigh**2) / (2.0 * shin * span))
        straight = quaternion_from_matrix(
            np.stack([axis, np.cross(-down, axis), -down], axis=-1)
        )
        forward = quaternion_from_rotation_vector(at_hip * [-1.0, 0.0, 0.0])
        back = quaternion_from_rotation_vector(at_ankle * [1.0, 0.0, 0.0])
        world[:, skeleton.index(f"{side}UpLeg")] = multiply(straight, forward)
        world[:, skeleton.index(f"{side}Leg")] = multiply(straight, back)
        world[:, skeleton.index(f"{side}Foot")] = foot.foot
        world[:, skeleton.index(f"{side}ToeBase")] = foot.toes
        world[:, skeleton.index(f"{side}ToeBase_end")] = foot.toes


def _leg_lengths(skeleton: Skeleton, side: str) -> tuple[float, float]:
    thigh, shin = (
        float(np.linalg.norm(skeleton.offsets[skeleton.index(side + part)]))
        for part in ("Leg", "Foot")
    )
    return thigh, shin


def _pose_trunk(rotations: Array, plan: WalkPlan, skeleton: Skeleton) -> None:
    """Rotate the chest against the hips and keep the head facing forward."""
    heading = _rotation_from_degrees(z=np.degrees(plan.heading))
    hips = rotations[:, 0]
    chest = _compose(
        heading,
        _rotation_from_degrees(z=4.0 * _cycle(plan, 0.04) + plan.random_curve(0.7)),
        _rotation_from_degrees(y=1.0 * _cycle(plan, 0.15) + plan.random_curve(0.5)),
        _rotation_from_degrees(x=4.0 + plan.random_curve(0.6) - 0.8 * _cycle(plan, 0.1, 2)),
    )
    gaze = _compose(
        heading,
        _rotation_from_degrees(z=plan.random_curve(4.0, 5.0)),
        _rotation_from_degrees(
            x=2.0 + plan.random_curve(1.5, 4.0) + 0.7 * _cycle(plan, 0.1, 2)
        ),
    )
    for joints, start, stop in (
        (("Spine", "Spine1", "Spine2"), hips, chest),
        (("Neck", "Head"), chest, gaze),
    ):
        bending = rotation_vector_from_quaternion(multiply(inverse(start), stop))
        fraction = quaternion_from_rotation_vector(bending / len(joints))
        rotations[:, [skeleton.index(joint) for joint in joints]] = fraction[:, None]


def _pose_arm(
    rotations: Array, plan: WalkPlan, skeleton: Skeleton, side: str, size: float
) -> None:
    """Swing the arm with the opposite leg; the elbow flexes as the arm comes forward.

    Written for the left arm; the right one is its mirror image, half a stride later.
    """
    peak, mirror = (0.5, 1.0) if side == "Left" else (0.0, -1.0)
    swing = size * (1.0 + plan.random_curve(0.1))
    forward = 3.0 + 19.0 * swing * _cycle(plan, peak + 0.03) + plan.random_curve(1.0)
    elbow = 20.0 + 9.0 * swing * _cycle(plan, peak + 0.08) + plan.random_curve(1.5)
    local_rotations_by_joint = {
        "Shoulder": _rotation_from_degrees(
            y=5.0 * mirror, z=-2.5 * mirror * _cycle(plan, peak + 0.02)
        ),
        "Arm": _compose(
            _rotation_from_degrees(x=-forward),
            _rotation_from_degrees(y=(74.0 + plan.random_curve(1.0)) * mirror),
            _rotation_from_degrees(x=12.0),
        ),
        "ForeArm": multiply(
            _rotation_from_degrees(z=-elbow * mirror),
            _rotation_from_degrees(x=-6.0 + 4.0 * _cycle(plan, peak + 0.1)),
        ),
        "Hand": _rotation_from_degrees(
            y=(6.0 + plan.random_curve(2.0)) * mirror,
            z=(-4.0 + 4.0 * _cycle(plan, peak - 0.08) + plan.random_curve(1.0)) * mirror,
        ),
    }
    for joint, local in local_rotations_by_joint.items():
        rotations[:, skeleton.index(side + joint)] = local


def _compose(*rotations: Array) -> Array:
    """Return the product of rotations; the last is applied first."""
    return reduce(multiply, rotations)


def _rotation_from_degrees(
    x: float | Array = 0.0, y: float | Array = 0.0, z: float | Array = 0.0
) -> Array:
    """Return the rotation of a vector in degrees; scalars apply to all frames."""
    vector = np.stack(np.broadcast_arrays(x, y, z), axis=-1)
    return quaternion_from_rotation_vector(np.radians(vector))
