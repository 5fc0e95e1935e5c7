"""Let a body with mass and muscles make a captured motion: physics as a filter."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..motion import HumanoidMap, Motion, find_humanoid_map
from ..progress import Progress, unwatched, within
from .body import PhysicsBody, build_physics_body, check_size
from .engine import load_engine
from .feet import add_soles, find_ground, stands_for_long
from .measures import about_ground, mean_distance, stands_on, told
from .segment import EASE, Conditions, Piece, find_pieces, simulated_piece
from .settings import Ground, SimulateSettings
from .stance import carried
from .surface import measure_foot_slide, penetration
from .target import away_from, blended, fill_gaps

Array = NDArray[np.float64]
Flags = NDArray[np.bool_]
USUAL = SimulateSettings()
TOO_OFTEN = 1.0
"""Seconds of a take for each time that its body may be lost before all is given up."""

TOO_MANY = 0.3
"""Share of the frames that may not be followed, likewise."""


@dataclass(frozen=True, eq=False)
class Simulated:
    """A motion as a body with mass can make it.

    `contacts`, `carried` and `support` are the simulated body's also in frames that it did not
    follow, and where all was given up, though the motion there is the input's. Of a single
    frame, in which nothing moves, `carried` and `support` are 0.

    Attributes
    ----------
    motion : Motion
        Same skeleton and frames as the input.
    followed : bool, shape (n_frames,)
        Where the body could follow; elsewhere the motion is the input's.
    contacts : bool, shape (n_frames, 2), left and right
        Where the simulated feet touch the ground.
    carried : float array, shape (n_frames, 2), left and right
        Share of the weight that each foot carries.
    support : float array, shape (n_frames,)
        Force from outside that kept the body up, as a share of its weight.
    ground : float, metres
        Height of the ground.
    penetration_before, penetration_after : float, metres
        How deep the body is under the ground where it is deepest.
    slide_before, slide_after : float, metres
        Way that both feet cover over the ground during `contacts`.
    smoothing : float, seconds
        How much the target was calmed where it was calmed most.
    distance : float, metres
        Mean distance of the result's joints from where they were captured.
    message : str
        What there is to say about it, in a sentence or two.
    """

    motion: Motion
    followed: Flags
    contacts: Flags
    carried: Array
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
    settings: SimulateSettings = USUAL,
    progress: Progress = unwatched,
) -> Simulated:
    """Return the motion that a body with mass and muscles makes when it tries to follow.

    The skeleton becomes a body of capsules with a human's masses [2]_ on level ground, under
    gravity, in the engine MuJoCo; its joints are pulled towards the captured rotations by
    bounded proportional-derivative control, equations 16 and 17 of [1]_. So segments keep
    their lengths, nothing sinks into the ground, feet that stand are held by friction, and
    nothing moves faster than muscles can make it.

    Where it departs from the paper: there, an outside force pulls every part of the body to its
    target. Here joints turn by torques of their own, reckoned by inverse dynamics, and only the
    hips are helped from outside, by `support` times the weight at most; the rest must come from
    the ground. There, the body lags behind its target; here the target is calmed over time in
    both directions first, and its acceleration is known, so that it does not. Feet of the
    target that stand are put onto the ground, and those that swing are drawn up over it; one
    that touches it all the same slips instead of tripping. With `plant`, what friction lets
    creep is kept at rest afterwards, where the simulation says that a foot carries weight.

    Parameters
    ----------
    motion : Motion
        Gaps are bridged first.
    humanoid_map : HumanoidMap
        Says which joints are which segments; found by name and structure where it is not given.
        A skeleton without legs is simulated bone by bone.
    settings : SimulateSettings
        A take that shakes so that the body cannot follow is calmed more than they say.
    progress : Progress

    Returns
    -------
    Simulated
        Where the body is lost, for the engine gives up or it is far off its target, it is put
        back there, and the result eases to the input and back. If that happens too often, the
        motion is the input, bit for bit; so it is at strength 0. Joints that are not simulated,
        such as fingers, are left as they are. The same input gives the same bits.

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
    whole = fill_gaps(motion)
    bare = build_physics_body(whole, humanoid)
    check_size(bare, motion.frame_rate)
    under_feet = find_ground(whole, humanoid, bare.size)
    ground = _height(settings, whole, humanoid, under_feet, bare.size)
    body = add_soles(bare, whole, humanoid, ground)
    conditions = Conditions(
        ground,
        settings.response,
        settings.smoothing,
        settings.friction,
        settings.support,
        settings.plant,
    )
    pieces = []
    for start, stop in find_pieces(body, whole):
        step = within(progress, start / motion.n_frames, stop / motion.n_frames)
        piece = simulated_piece(engine, body, whole.slice(start, stop), conditions, step)
        pieces.append(piece)
    progress(1.0, "Simulated")
    return _put_together(motion, whole, body, pieces, settings, ground, under_feet)


def _height(
    settings: SimulateSettings,
    take: Motion,
    humanoid: HumanoidMap,
    under_feet: float,
    size: float,
) -> float:
    """Return the height of the ground in metres.

    Who is far above the given height may be in the middle of a leap; nobody is far below it.
    """
    given = settings.ground_height
    if settings.ground is Ground.HEIGHT:
        return given
    if settings.ground is Ground.FEET:
        return under_feet
    leaps = under_feet > given and not stands_for_long(take, humanoid)
    return given if leaps or stands_on(given, under_feet, size) else under_feet


def apply_strength(motion: Motion, simulated: Simulated, strength: float) -> Motion:
    """Return a motion gone by a share, 0 to 1, towards what was simulated of it in full.

    The same as `simulate` with that strength, to rounding, but at once.
    """
    if strength in {0.0, 1.0}:
        return (simulated.motion if strength else motion).with_poses()
    share = np.full(motion.n_frames, strength)
    return blended(
        fill_gaps(motion), fill_gaps(simulated.motion), range(motion.n_joints), share
    )


def _put_together(
    motion: Motion,
    whole: Motion,
    body: PhysicsBody,
    pieces: list[Piece],
    settings: SimulateSettings,
    ground: float,
    under_feet: float,
) -> Simulated:
    """Blend what was simulated with the take, and measure the result."""
    followed = np.concatenate([piece.followed for piece in pieces])
    n_lost = sum(piece.n_lost for piece in pieces)
    too_often = n_lost > 1 + motion.n_frames * motion.dt / TOO_OFTEN
    given_up = too_often or float((~followed).mean()) > TOO_MANY
    if given_up:
        followed[:] = False
    rotations = np.concatenate([piece.motion.rotations for piece in pieces])
    roots = np.concatenate([piece.motion.root_positions for piece in pieces])
    share = settings.strength * _ease(pieces, motion.frame_rate) * (not given_up)
    result = motion
    if share.any():
        result = blended(whole, whole.with_poses(rotations, roots), body.joints, share)
    smoothing = max(piece.smoothing for piece in pieces)
    given = settings.ground_height if settings.ground is Ground.LIKELY else None
    contacts = np.concatenate([piece.contacts for piece in pieces])
    return Simulated(
        motion=result.with_poses(),
        followed=followed,
        contacts=contacts,
        carried=carried(body, np.concatenate([piece.loads for piece in pieces])),
        support=np.concatenate([piece.support for piece in pieces]),
        ground=ground,
        penetration_before=penetration(body, whole, ground),
        penetration_after=penetration(body, fill_gaps(result), ground),
        slide_before=measure_foot_slide(body, whole, contacts),
        slide_after=measure_foot_slide(body, fill_gaps(result), contacts),
        smoothing=smoothing,
        distance=mean_distance(whole, fill_gaps(result), body.joints),
        message=told(followed, given_up, smoothing if smoothing > settings.smoothing else 0.0)
        + about_ground(ground, under_feet, body.size, given),
    )


def _ease(pieces: list[Piece], frame_rate: float) -> Array:
    """Return a share that rises from 0 where the body was lost to 1, shape (n_frames,)."""
    return np.concatenate([away_from(~piece.followed, EASE * frame_rate) for piece in pieces])
