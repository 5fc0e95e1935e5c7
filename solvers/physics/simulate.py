"""Simulate a body with mass and muscles that tracks a captured motion: physics as a filter."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Flags
from ..motion import HumanoidMap, Motion, find_humanoid_map
from ..progress import Progress, unwatched, within
from .body import PhysicsBody, build_physics_body, check_size
from .body_surface import measure_foot_slide, measure_penetration
from .engine import load_engine
from .foot_support import sum_foot_loads
from .plant_target import BLEND_S
from .report import describe_ground, describe_result, is_near_ground, mean_distance
from .settings import Ground, SimulateSettings
from .simulate_segment import (
    SimulatedSegment,
    SimulationConditions,
    find_segments,
    simulate_segment,
)
from .soles_and_ground import add_soles, find_ground, has_long_contact
from .target import blend_motions, fade_around, fill_motion_gaps

DEFAULT_SETTINGS = SimulateSettings()
MAX_MISSED_FRACTION = 0.3
"""Fraction of frames that the body may fail to follow; with more, the result is the take. It
guards takes that no body can follow
(`test_body_far_above_the_ground_is_unchanged_and_reported`)."""


@dataclass(frozen=True, eq=False)
class Simulated:
    """A motion that a body with mass can perform.

    `contacts`, `foot_loads` and `support` describe the simulated body, also in frames that it
    did not follow, and where the result is the input. For a single frame, `foot_loads` and
    `support` are 0.

    Attributes
    ----------
    motion : Motion
        Same skeleton and frames as the input.
    followed : bool, shape (n_frames,)
        Frames in which the body followed its target; elsewhere the motion is the input's.
    contacts : bool, shape (n_frames, 2), left and right
        Frames in which the simulated feet touch the ground.
    foot_loads : float array, shape (n_frames, 2), left and right
        Fraction of the weight that each foot carries.
    support : float array, shape (n_frames,)
        External force that kept the body up, as a fraction of its weight.
    ground : float, meters
        Height of the ground.
    penetration_before, penetration_after : float, meters
        Maximum depth of the body below the ground.
    slide_before, slide_after : float, meters
        Distance that both feet cover over the ground during `contacts`.
    smoothing : float, seconds
        Maximum smoothing of the target over the segments.
    distance : float, meters
        Mean distance of the result's joints from the captured ones.
    message : str
        Summary in a sentence or two.
    """

    motion: Motion
    followed: Flags
    contacts: Flags
    foot_loads: Array
    support: Array
    ground: float
    penetration_before: float
    penetration_after: float
    slide_before: float
    slide_after: float
    smoothing: float
    distance: float
    message: str


def simulate(
    motion: Motion,
    *,
    humanoid_map: HumanoidMap | None = None,
    settings: SimulateSettings = DEFAULT_SETTINGS,
    progress: Progress = unwatched,
) -> Simulated:
    """Simulate a body with mass and muscles that tracks a motion, and return its motion.

    The skeleton becomes a body of capsules with a human's masses [2]_ on level ground, under
    gravity, in the engine MuJoCo. Bounded proportional-derivative control, equations 16 and 17
    of [1]_, pulls its joints toward the captured rotations. So segments keep their lengths,
    nothing sinks into the ground, friction holds standing feet, and nothing moves faster than
    muscles can move it.

    Departures from the paper: there, an external force pulls every part of the body to its
    target. Here joint torques from inverse dynamics move the joints. An external force helps
    only the hips, by `support` times the weight at most; the rest comes from the ground. There,
    the body lags behind its target. Here the target is smoothed in both directions of time
    first and its acceleration is known, so there is no lag. Standing feet of the target are
    placed on the ground, and swinging feet are lifted above it; one that touches the ground
    slips instead of tripping. With `plant`, feet that carry weight in the simulation are
    afterwards kept from creeping.

    Parameters
    ----------
    motion : Motion
        Gaps are bridged first.
    humanoid_map : HumanoidMap
        Joints of the body's segments; found by name and structure by default. A skeleton
        without legs is simulated bone by bone.
    settings : SimulateSettings
        A take that shakes too fast for the body to follow gets more smoothing than they say.
    progress : Progress

    Returns
    -------
    Simulated
        Where the body is lost, because the engine fails or it is far from its target, it is
        reset to the target, and the result blends to the input and back. If that happens too
        often, the motion is the input, bit for bit; likewise at strength 0. Joints that are not
        simulated, such as fingers, stay unchanged. The same input gives the same bits.

    Raises
    ------
    InvalidMotionError
        The root is never observed, or the body's size or the frame rate are not plausible.
    NoPhysicsError
        The engine is not installed.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [1] Shum, Ho, Jiang, Takagi (2013). Real-time posture reconstruction for Microsoft
       Kinect, section VII. IEEE Transactions on Cybernetics 43(5).
    .. [2] De Leva (1996). Adjustments to Zatsiorsky-Seluyanov's segment inertia parameters.
       Journal of Biomechanics 29(9). doi:10.1016/0021-9290(95)00178-6
    """
    engine = load_engine()
    humanoid = humanoid_map or find_humanoid_map(motion.skeleton)
    complete = fill_motion_gaps(motion)
    bare = build_physics_body(complete, humanoid)
    check_size(bare, motion.frame_rate)
    foot_height = find_ground(complete, humanoid, bare.size)
    ground = _choose_ground_height(settings, complete, humanoid, foot_height, bare.size)
    body = add_soles(bare, complete, humanoid, ground)
    conditions = SimulationConditions(
        ground,
        settings.response,
        settings.smoothing,
        settings.friction,
        settings.support,
        settings.plant,
    )
    segments = []
    for start, stop in find_segments(body, complete):
        step = within(progress, start / motion.n_frames, stop / motion.n_frames)
        segment = simulate_segment(engine, body, complete.slice(start, stop), conditions, step)
        segments.append(segment)
    progress(1.0, "Simulated")
    return _assemble_result(motion, complete, body, segments, settings, ground, foot_height)


def _choose_ground_height(
    settings: SimulateSettings,
    motion: Motion,
    humanoid: HumanoidMap,
    foot_height: float,
    size: float,
) -> float:
    """Return the height of the ground in meters.

    A body far above the given height may be in the middle of a leap; none is far below it.
    """
    given_height = settings.ground_height
    if settings.ground is Ground.HEIGHT:
        return given_height
    if settings.ground is Ground.FEET:
        return foot_height
    is_leaping = foot_height > given_height and not has_long_contact(motion, humanoid)
    return (
        given_height
        if is_leaping or is_near_ground(given_height, foot_height, size)
        else foot_height
    )


def apply_strength(motion: Motion, simulated: Simulated, strength: float) -> Motion:
    """Blend a motion, by a strength from 0 to 1, with its simulation at full strength.

    Equals `simulate` with that strength, to rounding, without a new simulation.
    """
    if strength in {0.0, 1.0}:
        return (simulated.motion if strength else motion).with_poses()
    weights = np.full(motion.n_frames, strength)
    target = fill_motion_gaps(simulated.motion)
    return blend_motions(fill_motion_gaps(motion), target, range(motion.n_joints), weights)


def _assemble_result(
    motion: Motion,
    complete: Motion,
    body: PhysicsBody,
    segments: list[SimulatedSegment],
    settings: SimulateSettings,
    ground: float,
    foot_height: float,
) -> Simulated:
    """Blend the simulated segments with the take, and measure the result."""
    followed = np.concatenate([segment.followed for segment in segments])
    given_up = float((~followed).mean()) > MAX_MISSED_FRACTION
    if given_up:
        followed[:] = False
    rotations = np.concatenate([segment.motion.rotations for segment in segments])
    roots = np.concatenate([segment.motion.root_positions for segment in segments])
    weights = settings.strength * _fade_weights(segments, motion.frame_rate) * (not given_up)
    result = motion
    if weights.any():
        result = blend_motions(
            complete, complete.with_poses(rotations, roots), body.joints, weights
        )
    smoothing = max(segment.smoothing for segment in segments)
    given_height = settings.ground_height if settings.ground is Ground.LIKELY else None
    contacts = np.concatenate([segment.contacts for segment in segments])
    return Simulated(
        motion=result.with_poses(),
        followed=followed,
        contacts=contacts,
        foot_loads=sum_foot_loads(
            body, np.concatenate([segment.loads for segment in segments])
        ),
        support=np.concatenate([segment.support for segment in segments]),
        ground=ground,
        penetration_before=measure_penetration(body, complete, ground),
        penetration_after=measure_penetration(body, fill_motion_gaps(result), ground),
        slide_before=measure_foot_slide(body, complete, contacts),
        slide_after=measure_foot_slide(body, fill_motion_gaps(result), contacts),
        smoothing=smoothing,
        distance=mean_distance(complete, fill_motion_gaps(result), body.joints),
        message=describe_result(followed, smoothing if smoothing > settings.smoothing else 0.0)
        + describe_ground(ground, foot_height, body.size, given_height),
    )


def _fade_weights(segments: list[SimulatedSegment], frame_rate: float) -> Array:
    """Return weights that rise from 0, where the body was lost, to 1, shape (n_frames,)."""
    return np.concatenate([
        fade_around(~segment.followed, BLEND_S * frame_rate) for segment in segments
    ])
