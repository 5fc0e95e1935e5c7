"""Let a body with mass and muscles make a captured motion: physics as a filter."""

from dataclasses import dataclass
from enum import Enum
from types import ModuleType

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..motion import HumanoidMap, Motion, find_humanoid_map, forward_kinematics
from ..motion.rotations import inverse, multiply, rotate, slerp
from ..progress import Progress, unwatched, within
from ..settings import Settings, setting
from .physics_body import PhysicsBody, physics_body
from .physics_control import controller
from .physics_engine import load_engine
from .physics_feet import find_ground, with_soles
from .physics_run import Course, follow
from .physics_surface import penetration, raising, slide, sole_speeds
from .physics_target import calmed_target, filled
from .physics_world import build_world

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
LONGEST_STEP = 1.0 / 239.0
"""Seconds. 30, 60 and 120 frames a second are then simulated in the same steps, 1/240 s."""

SLOWEST = 5.0
"""Hertz, of a take that tells how its body moved."""

SMALLEST, LARGEST = 0.05, 20.0
"""Of a body, by the length of its legs over 0.9 m: others have a wrong unit."""

EASE = 0.3
"""Seconds in which the result eases to the input where it could not be followed."""

JUMP, FASTEST = 0.3, 12.0
"""Metres, and metres per second: who goes farther from frame to frame is in another place."""

TOO_OFTEN = 1.0
"""Seconds of take for each time that the body may be lost."""


class Ground(Enum):
    """Where the ground is."""

    HEIGHT = "height"
    FEET = "auto"


@dataclass(frozen=True, kw_only=True)
class SimulateSettings(Settings):
    """How a motion is simulated. Lengths and times are for any size of body."""

    strength: float = setting(
        1.0, "How much of the simulation the result takes over; 0 leaves the take as it is",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    ground: Ground = setting(
        Ground.HEIGHT, "Where the ground is: at a given height, or under the feet of the take"
    )
    ground_height: float = setting(
        0.0, "Height of the ground, where it is given", unit="m", minimum=-1e4, maximum=1e4,
    )  # fmt: skip
    response: float = setting(
        5.0, "How quickly joints are pulled to the captured pose; higher follows it closer,"
        " lower is softer and lags behind",
        unit="Hz", minimum=0.5, maximum=15.0,
    )  # fmt: skip
    smoothing: float = setting(
        0.02, "Standard deviation of the Gaussian that calms the take first; higher is calmer"
        " but blurs quick moves",
        unit="s", minimum=0.0, maximum=0.5,
    )  # fmt: skip
    friction: float = setting(
        1.0, "Friction between feet and ground; higher holds feet that are pulled aside",
        minimum=0.0, maximum=5.0,
    )  # fmt: skip
    support: float = setting(
        0.4, "Force from outside that may keep the body from falling, as a share of its weight;"
        " lower leaves more to its own legs",
        minimum=0.0, maximum=3.0, advanced=True,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Simulated:
    """A motion as a body with mass can make it.

    Attributes
    ----------
    motion : Motion
        Same skeleton and frames as the input.
    followed : bool, shape (n_frames,)
        Where the body could follow; elsewhere the motion is the input's.
    contacts : bool, shape (n_frames, 2), left and right
        Where the simulated feet touch the ground.
    help : float array, shape (n_frames,)
        Share, 0 to 1, of the outside support that was used.
    ground : float, metres
        Height of the ground.
    penetration_before, penetration_after : float, metres
        How deep the body is under the ground where it is deepest.
    slide_before, slide_after : float, metres
        Way of both feet over the ground during `contacts`.
    distance : float, metres
        Mean distance of the simulated joints from where they were captured.
    message : str
        What there is to say, in a sentence or two.
    """

    motion: Motion
    followed: Flags
    contacts: Flags
    help: Array
    ground: float
    penetration_before: float
    penetration_after: float
    slide_before: float
    slide_after: float
    distance: float
    message: str


def simulate(
    motion: Motion,
    *,
    humanoid_map: HumanoidMap | None = None,
    settings: SimulateSettings = SimulateSettings(),
    progress: Progress = unwatched,
) -> Simulated:
    engine = load_engine()
    humanoid = humanoid_map or find_humanoid_map(motion.skeleton)
    whole = filled(motion)
    body = physics_body(whole, humanoid)
    ground = settings.ground_height
    if settings.ground is Ground.FEET:
        ground = find_ground(whole, humanoid, body.size)
    body = with_soles(body, whole, humanoid, ground)
    raised = raising(penetration(body, whole, ground), motion.frame_rate)
    places, rotations = _base_first(body, whole)
    places[:, 2] += raised
    target = calmed_target(places, rotations, motion.frame_rate, settings.smoothing)
    grips = grips_of(sole_speeds(body, _as_motion(body, whole, target.at_frames())), body.size)
    n_steps = int(np.ceil(motion.dt / LONGEST_STEP))
    control = controller(body, settings.response, settings.support, settings.friction)
    world = build_world(engine, body, ground, settings.friction, motion.dt / n_steps)
    course = follow(engine, world, control, target, grips, n_steps, tell=lambda frame: progress(frame / motion.n_frames, "Simulating"))
    result = _as_motion(body, whole, course.places)
    return result, course, body, ground


def _base_first(body, motion):
    poses = forward_kinematics(motion)
    base = body.joints[0]
    rotations = motion.rotations[:, list(body.joints)]
    rotations[:, 0] = poses.rotations[:, base]
    return poses.positions[:, base].copy(), rotations


def grips_of(speeds, size):
    return np.clip((0.8 - speeds/size)/0.5, 0.05, 1.0)


def _as_motion(body, motion, places):
    base = body.joints[0]
    n = motion.n_frames
    turns = places[:, 3:].reshape(n, -1, 4)
    rotations = motion.rotations.copy()
    rotations[:, list(body.joints)] = turns
    if base:
        above = forward_kinematics(motion).rotations[:, motion.skeleton.parents[base]]
        rotations[:, base] = multiply(inverse(above), turns[:, 0])
    result = motion.with_poses(rotations)
    shift = places[:, :3] - forward_kinematics(result).positions[:, base]
    return result.with_poses(root_positions=result.root_positions + shift)
