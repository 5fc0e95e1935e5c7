"""From a depth recording to motion, with nothing asked of the animator."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import DepthRecording, Floor
from ...errors import InvalidMotionError
from ...motion import Motion, Tracks
from ...progress import Progress, unwatched, within
from ...settings import setting
from ..body import (
    BodyModel,
    MotionPrior,
    body_motion,
    joint_positions,
    load_motion_prior,
    segment_frames,
)
from ..forest import PixelForest, load_pixel_forest
from ..terms import USUAL, TrackerSettings
from ..tracking import OnPose, TrackedMotion, tracked_motion, unobserved
from .choose_poses import choose_poses, nearest_known
from .find_body import find_body
from .passes import Actor, Pass, RecoverySettings, track_with_restarts
from .smooth_pass import smoothed_poses

Array = NDArray[np.float64]
Integers = NDArray[np.intp]


@dataclass(frozen=True, kw_only=True)
class CaptureSettings(RecoverySettings):
    """How a whole take is captured."""

    backward: bool = setting(
        True,
        "Also track from the end to the start and keep the better fit; takes longer",
        label="Also Track Backward",
    )
    smoothing: float = setting(
        1.0, "Amount of smoothing over time; 0 leaves every frame as tracked",
        minimum=0.0, maximum=1000.0,
    )  # fmt: skip
    refine: bool = setting(
        True,
        "Fit bone lengths and thickness of the body to the recording",
        label="Fit Body Size",
    )
    recorded: bool = setting(
        False,
        "Pull poses toward recorded walks, exercises and dances; turn off for fast motion",
        label="Use Motion Prior",
    )  # fmt: skip
    doubtful: float = setting(
        0.3, "Flag joints with a confidence below this; higher flags more",
        minimum=0.0, maximum=1.0, label="Min Confidence",
    )  # fmt: skip


USUAL_CAPTURE = CaptureSettings()
_SHARPNESS, _REACH = 40.0, 0.04
"""A score 0.025 worse costs as much as joints that move by 4 cm more within a frame."""


@dataclass(frozen=True, eq=False)
class Capture:
    """What was captured.

    Attributes
    ----------
    motion : Motion
        Z up, on the skeleton of `body`; joints have humanoid roles as their names.
    joints : Tracks
        The same joints in the camera's frame, with the confidence of each joint and frame.
    residual : shape (n_frames,), metres
        Mean distance in depth where body and actor overlap; NaN where nobody was seen.
    coverage : shape (n_frames,)
        Share of the pixels of body or actor that show both.
    restarts : tuple of int
        Frames in which the detector had to help the tracker, after the first.
    body : BodyModel
    poses : shape (n_frames, 36)
    doubtful : bool, shape (n_frames, n_joints)
        Joints out of sight or badly explained; where they are was filled in from the frames
        before and after.
    """

    motion: Motion
    joints: Tracks
    residual: Array
    coverage: Array
    restarts: tuple[int, ...]
    body: BodyModel
    poses: Array
    doubtful: NDArray[np.bool_]


def capture(
    depth: DepthRecording,
    body: BodyModel | None = None,
    forest: PixelForest | None = None,
    motion_prior: MotionPrior | None = None,
    *,
    floor: Floor | None = None,
    settings: CaptureSettings = USUAL_CAPTURE,
    tracker: TrackerSettings = USUAL,
    on_pose: OnPose = unobserved,
    progress: Progress = unwatched,
) -> Capture:
    """Capture the motion of the actor whom a depth recording shows.

    The detector finds the first pose, the tracker follows, and the detector helps where the
    tracker fails [WZC12]_, section 5. Since all frames are at hand, the take is also tracked
    backward from its end, each frame takes the pose that fits and goes on smoothly, and the
    whole take is smoothed by how surely each picture tells each joint, so that limbs out of
    sight go on from where they were last seen to where they are seen next.

    Parameters
    ----------
    depth : DepthRecording
        Of nothing but the actor (see `solvers.depth_scene.foreground`).
    body : BodyModel, optional
        Without it, a usual adult is fitted to the recording.
    forest : PixelForest, optional
        Without it, the one that is shipped.
    motion_prior : MotionPrior, optional
        Recorded motions that this one is like, to which the tracker draws poses; without
        it, those that are shipped if `settings.recorded`.
    floor : Floor, optional
        Becomes z = 0; without it the camera is taken to be level.
    settings : CaptureSettings
    tracker : TrackerSettings
    on_pose : OnPose
        Is shown each pose that is found, as soon as it is.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        No frame shows anybody.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [WZC12] Wei, Zhang, Chai (2012). Accurate realtime full-body motion capture using a
       single depth camera. ACM Transactions on Graphics 31(6).
    """
    forest = load_pixel_forest() if forest is None else forest
    if motion_prior is None and settings.recorded:
        motion_prior = load_motion_prior()
    share = 0.0
    if body is None:
        share = 0.4
        body = find_body(
            depth, forest, refine=settings.refine, tracker=tracker,
            on_pose=on_pose, progress=within(progress, 0.0, share),
        )  # fmt: skip
    actor = Actor(depth, body, forest, tracker, settings, motion_prior, on_pose)
    passes = _passes(actor, settings, within(progress, share, 0.9))
    frames, which = best_of_passes(body, passes)
    poses = np.stack([one.poses for one in passes])[which, frames]
    poses, figures = smoothed_poses(
        actor, poses, settings.smoothing, within(progress, 0.9, 1.0)
    )
    tracked = tracked_motion(body, poses, figures, depth.frame_rate)
    return put_together(body, tracked, passes[0].restarts, floor, settings)


def _passes(actor: Actor, settings: CaptureSettings, progress: Progress) -> list[Pass]:
    n_frames = actor.depth.n_frames
    middle = 0.5 if settings.backward else 1.0
    forward = track_with_restarts(actor, range(n_frames), None, within(progress, 0.0, middle))
    if not np.isfinite(forward.scores).any():
        raise InvalidMotionError(
            "Nobody was found in any frame; check what is taken for background, and that the"
            " depth is in metres."
        )
    if not settings.backward:
        return [forward]
    start = forward.poses[np.flatnonzero(np.isfinite(forward.scores))[-1]]
    backward = track_with_restarts(
        actor, range(n_frames - 1, -1, -1), start, within(progress, middle, 1.0)
    )
    return [forward, backward]


def best_of_passes(body: BodyModel, passes: Sequence[Pass]) -> tuple[Integers, Integers]:
    """Return which frame of which pass to take for every frame, two of shape (n_frames,).

    It is the frame itself, or the nearest one in which somebody was found.
    """
    poses = np.stack([one.poses for one in passes], axis=1)
    scores = np.stack([one.scores for one in passes], axis=1)
    known = np.isfinite(poses).all(axis=-1)
    scores = np.where(known, np.nan_to_num(scores), np.nan)
    some = np.flatnonzero(known.any(axis=1))
    joints = joint_positions(body, segment_frames(body, np.nan_to_num(poses[some])))
    chosen = choose_poses(scores[some], joints, _SHARPNESS, _REACH)
    nearest = nearest_known(some, len(poses))
    return nearest, chosen[np.searchsorted(some, nearest)]


def put_together(
    body: BodyModel,
    tracked: TrackedMotion,
    restarts: tuple[int, ...],
    floor: Floor | None,
    settings: CaptureSettings,
) -> Capture:
    """Return the capture that a body's poses make."""
    confidence = tracked.joints.confidence
    doubtful = np.zeros(tracked.joints.positions.shape[:2], dtype=bool)
    if confidence is not None:
        doubtful = confidence < settings.doubtful
    return Capture(
        body_motion(body, tracked.poses, tracked.joints.frame_rate, floor),
        tracked.joints, tracked.residual, tracked.coverage, restarts, body, tracked.poses,
        doubtful,
    )  # fmt: skip
