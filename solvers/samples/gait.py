"""A walk that convinces: feet that roll and stay planted, hips that sway, arms that swing.

Angles and their timing follow what every gait laboratory measures on healthy adults (Perry and
Burnfield 2010, Gait Analysis). The feet are laid out first, the hips move over them, the legs
are solved to join both, and the trunk and arms swing against the legs.
"""

from dataclasses import dataclass
from functools import reduce

import numpy as np
from numpy.typing import NDArray

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
from .course import Course, plan_course
from .footsteps import UNDER_HIP
from .walker import walker_skeleton

Array = NDArray[np.float64]

LONGEST_STEP = 0.85
"""Metres: beyond, the legs of the sample's skeleton do not reach."""
NATURAL_STEP = 0.7
"""Metres: the step for which the angles below are given; longer steps swing more."""
STRETCH = 0.998
"""Share of its length that a leg may span, so that the knee never locks."""
TURNING = np.radians(12.0)


@dataclass(frozen=True, kw_only=True)
class GaitSettings(Settings):
    """How the sample walks."""

    duration: float = setting(8.0, "Length of the take", unit="s", minimum=0.1, maximum=600.0)
    frame_rate: float = setting(60.0, "Frames per second", unit="Hz", minimum=10, maximum=480)
    speed: float = setting(1.3, "Walking speed", unit="m/s", minimum=0.4, maximum=1.8)
    cadence: float = setting(
        116.0, "Steps per minute; more makes shorter steps", minimum=60.0, maximum=160.0
    )
    seed: int = setting(0, "Another seed is another walker", minimum=0, maximum=2**31 - 1)


def walking_gait(settings: GaitSettings = GaitSettings()) -> Motion:
    """Return a person walking towards -Y in gentle bends, from the first frame on.

    Steps differ in time, place and size as those of a person do; the same seed walks the same
    way at every frame rate. While a foot stands flat its ankle does not move at all,
    and the joint of its toes rests until the foot leaves the floor.

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
        The speed asks for longer steps than the legs can make.
    """
    step = 60.0 * settings.speed / settings.cadence
    size = step / NATURAL_STEP
    if step > LONGEST_STEP:
        raise InvalidSettingError(
            f"{settings.speed:g} m/s at {settings.cadence:g} steps per minute needs steps of"
            f" {step:.2f} m, and the sample's legs make {LONGEST_STEP} m; raise cadence."
        )
    n_frames = max(1, round(settings.duration * settings.frame_rate))
    time = np.arange(n_frames) / settings.frame_rate
    course = plan_course(
        time, settings.duration, settings.speed, 60.0 / settings.cadence, TURNING, settings.seed
    )
    skeleton = walker_skeleton()
    hips = _hips(course, size)
    world = np.repeat(hips[:, None], skeleton.n_joints, axis=1)
    root = _root(course, skeleton, hips, size)
    _pose_legs(world, course, skeleton, root)
    rotations = local_rotations(skeleton, world)
    _pose_trunk(rotations, course, skeleton)
    for side in ("Left", "Right"):
        _pose_arm(rotations, course, skeleton, side, size)
    return Motion(skeleton, rotations, root, settings.frame_rate)


# Angles below are degrees. Positive x leans forward, y lowers the left side, z turns left.
# `_cycle(course, p)` is 1 when the left foot is at phase p of its stride.


def _cycle(course: Course, peak: float, per_stride: int = 1) -> Array:
    """Cosine over the stride of the left foot, 1 at phase `peak`, shape (n_frames,)."""
    phase = course.steps / 2.0 + UNDER_HIP
    return np.asarray(np.cos(2.0 * np.pi * per_stride * (phase - peak)))


def _hips(course: Course, size: float) -> Array:
    """World rotation of the hips: the forward hip leads, the swinging side drops."""
    tilt = 5.0 + course.wander(0.5) + 1.2 * _cycle(course, 0.05, 2)
    drop = -3.5 * _cycle(course, 0.12) * (1.0 + course.wander(0.1)) + course.wander(0.4)
    turn = -5.0 * size * _cycle(course, 0.0) * (1.0 + course.wander(0.1)) + course.wander(0.5)
    heading = quaternion_from_rotation_vector(course.heading[:, None] * [0.0, 0.0, 1.0])
    return _compose(heading, _turn(z=turn), _turn(y=drop), _turn(x=tilt))


def _root(course: Course, skeleton: Skeleton, hips: Array, size: float) -> Array:
    """Hips over the standing foot, highest in mid-stance, as high as the legs allow."""
    left = rotate(_turn(z=np.degrees(course.heading)), [1.0, 0.0, 0.0])
    root = course.ground + left * (0.022 * _cycle(course, 0.3) + course.wander(0.004))[:, None]
    root[:, 2] = -0.015 * size**2 * _cycle(course, 0.05, 2) + course.wander(0.002)
    heights = []
    for foot, side in zip(course.feet, ("Left", "Right"), strict=True):
        hip = root + rotate(hips, skeleton.offsets[skeleton.index(f"{side}UpLeg")])
        across = np.linalg.norm((foot.ankles - hip)[:, :2], axis=1)
        reach = STRETCH * sum(_leg_lengths(skeleton, side))
        heights.append(foot.ankles[:, 2] + np.sqrt(reach**2 - across**2) - hip[:, 2])
    root[:, 2] += np.min(heights)
    return root


def _pose_legs(world: Array, course: Course, skeleton: Skeleton, root: Array) -> None:
    """Write both legs' world rotations: the law of cosines puts the ankles on their paths."""
    for foot, side in zip(course.feet, ("Left", "Right"), strict=True):
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


def _pose_trunk(rotations: Array, course: Course, skeleton: Skeleton) -> None:
    """Turn the chest against the hips and keep the head on the way ahead."""
    heading = _turn(z=np.degrees(course.heading))
    hips = rotations[:, 0]
    chest = _compose(
        heading,
        _turn(z=4.0 * _cycle(course, 0.04) + course.wander(0.7)),
        _turn(y=1.0 * _cycle(course, 0.15) + course.wander(0.5)),
        _turn(x=4.0 + course.wander(0.6) - 0.8 * _cycle(course, 0.1, 2)),
    )
    look = _compose(
        heading,
        _turn(z=course.wander(4.0, 5.0)),
        _turn(x=2.0 + course.wander(1.5, 4.0) + 0.7 * _cycle(course, 0.1, 2)),
    )
    for joints, start, stop in (
        (("Spine", "Spine1", "Spine2"), hips, chest),
        (("Neck", "Head"), chest, look),
    ):
        bend = rotation_vector_from_quaternion(multiply(inverse(start), stop))
        share = quaternion_from_rotation_vector(bend / len(joints))
        rotations[:, [skeleton.index(joint) for joint in joints]] = share[:, None]


def _pose_arm(
    rotations: Array, course: Course, skeleton: Skeleton, side: str, size: float
) -> None:
    """Swing the arm with the leg of the other side, the elbow closing as it comes forward.

    Written for the left arm; the right one is its mirror image, half a stride later.
    """
    peak, mirror = (0.5, 1.0) if side == "Left" else (0.0, -1.0)
    eager = size * (1.0 + course.wander(0.1))
    forward = 3.0 + 19.0 * eager * _cycle(course, peak + 0.03) + course.wander(1.0)
    elbow = 20.0 + 9.0 * eager * _cycle(course, peak + 0.08) + course.wander(1.5)
    parts = {
        "Shoulder": _turn(y=5.0 * mirror, z=-2.5 * mirror * _cycle(course, peak + 0.02)),
        "Arm": _compose(
            _turn(x=-forward), _turn(y=(74.0 + course.wander(1.0)) * mirror), _turn(x=12.0)
        ),
        "ForeArm": multiply(
            _turn(z=-elbow * mirror), _turn(x=-6.0 + 4.0 * _cycle(course, peak + 0.1))
        ),
        "Hand": _turn(
            y=(6.0 + course.wander(2.0)) * mirror,
            z=(-4.0 + 4.0 * _cycle(course, peak - 0.08) + course.wander(1.0)) * mirror,
        ),
    }
    for joint, local in parts.items():
        rotations[:, skeleton.index(side + joint)] = local


def _compose(*turns: Array) -> Array:
    """The last turn happens first, in the frame that those before it turn."""
    return reduce(multiply, turns)


def _turn(x: float | Array = 0.0, y: float | Array = 0.0, z: float | Array = 0.0) -> Array:
    """Rotation by a vector in degrees; single numbers count for all frames."""
    vector = np.stack(np.broadcast_arrays(x, y, z), axis=-1)
    return quaternion_from_rotation_vector(np.radians(vector))
