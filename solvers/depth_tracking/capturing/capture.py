"""Capture motion from a depth recording automatically."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Integers
from ...depth_scene import DepthRecording, FloorPlane
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
from ..terms import DEFAULT_TRACKER, TrackerSettings
from ..tracking import PoseCallback, TrackedMotion, assemble_motion, ignore_pose
from .capture_method import CaptureMethod, published_system
from .choose_poses import choose_poses, nearest_tracked
from .find_body import find_body
from .passes import Pass, TrackingContext, track_with_restarts
from .restart_policies import RecoverySettings
from .smooth_pass import smooth_poses


@dataclass(frozen=True, kw_only=True)
class CaptureSettings(RecoverySettings):
    """Settings of the capture of a take."""

    method: CaptureMethod = setting(
        CaptureMethod.DEFAULT, "Tracking method; the default performed best in tests",
        research=True,
    )  # fmt: skip
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
    low_confidence: float = setting(
        0.3, "Flag joints with a confidence below this; higher flags more",
        minimum=0.0, maximum=1.0, label="Min Confidence",
    )  # fmt: skip


DEFAULT_CAPTURE = CaptureSettings()
_MOVEMENT_SCALE_M = 0.253
"""Mean movement of the joints in one frame that costs as much as a score of 0. Half and twice
are no better (`make sensitivity`)."""


@dataclass(frozen=True, eq=False)
class Capture:
    """The captured motion.

    Attributes
    ----------
    motion : Motion
        Z up, on the skeleton of `body`; joints have humanoid roles as their names.
    joints : Tracks
        The same joints in the camera frame, with the confidence of each joint and frame.
    residual : shape (n_frames,), meters
        Mean distance in depth where body and actor overlap; NaN without a visible actor.
    coverage : shape (n_frames,)
        Intersection over union of the pixels of body and actor.
    restarts : tuple of int
        Frames where the detector restarted the tracker, after the first.
    body : BodyModel
    poses : shape (n_frames, 36)
    low_confidence : bool, shape (n_frames, n_joints)
        Joints with low confidence: occluded or poorly fitted. Their positions are interpolated
        from the frames before and after.
    """

    motion: Motion
    joints: Tracks
    residual: Array
    coverage: Array
    restarts: tuple[int, ...]
    body: BodyModel
    poses: Array
    low_confidence: NDArray[np.bool_]

    @property
    def mean_coverage(self) -> float:
        """Mean coverage of the frames that show the actor; 0 without any."""
        shown = self.coverage[np.isfinite(self.residual)]
        return float(shown.mean()) if len(shown) else 0.0


def capture(
    depth: DepthRecording,
    body: BodyModel | None = None,
    forest: PixelForest | None = None,
    motion_prior: MotionPrior | None = None,
    *,
    floor: FloorPlane | None = None,
    settings: CaptureSettings = DEFAULT_CAPTURE,
    tracker: TrackerSettings = DEFAULT_TRACKER,
    on_pose: PoseCallback = ignore_pose,
    progress: Progress = unwatched,
) -> Capture:
    """Capture the motion of the actor in a depth recording.

    The detector finds the first pose, and the tracker follows the body. The detector restarts
    the tracker after failures [WZC12]_, section 5. A second pass tracks the take backward from
    its end. Each frame keeps the pose with the best fit and the smoothest continuation.
    Finally the take is smoothed, weighted by the information of each image about each joint.
    Occluded limbs are interpolated between their observations before and after. The published
    methods only track forward; their confidence and fit are measured like those of the default.

    Parameters
    ----------
    depth : DepthRecording
        Contains only the actor (see `solvers.depth_scene.foreground`).
    body : BodyModel, optional
        Default: an adult of default proportions, fitted to the recording.
    forest : PixelForest, optional
        Default: the shipped forest.
    motion_prior : MotionPrior, optional
        Recorded motions similar to this one; the tracker pulls poses toward them. Default:
        the shipped motions if `settings.recorded`, otherwise none.
    floor : FloorPlane, optional
        Becomes z = 0. Default: a level camera.
    settings : CaptureSettings
    tracker : TrackerSettings
    on_pose : PoseCallback
        Called with each pose as soon as it is tracked.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        No person is detected in any frame.
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
    body_fraction = 0.0
    if body is None:
        body_fraction = 0.4
        body = find_body(
            depth, forest, refine=settings.refine, tracker=tracker,
            on_pose=on_pose, progress=within(progress, 0.0, body_fraction),
        )  # fmt: skip
    actor = TrackingContext(depth, body, forest, tracker, settings, motion_prior, on_pose)
    passes = _passes(actor, settings, within(progress, body_fraction, 0.9))
    frames, pass_indices = best_of_passes(body, passes)
    poses = np.stack([one.poses for one in passes])[pass_indices, frames]
    smoothing = settings.smoothing if settings.method is CaptureMethod.DEFAULT else 0.0
    poses, qualities = smooth_poses(actor, poses, smoothing, within(progress, 0.9, 1.0))
    tracked = assemble_motion(body, poses, qualities, depth.frame_rate)
    return assemble_capture(body, tracked, passes[0].restarts, floor, settings)


def _passes(
    actor: TrackingContext, settings: CaptureSettings, progress: Progress
) -> list[Pass]:
    n_frames, policy = actor.depth.n_frames, None
    backward_too = settings.backward
    if settings.method is not CaptureMethod.DEFAULT:
        actor, policy = published_system(actor, settings.method)
        backward_too = False
    split = 0.5 if backward_too else 1.0
    forward = track_with_restarts(
        actor, range(n_frames), None, within(progress, 0.0, split), policy
    )
    if not np.isfinite(forward.scores).any():
        raise InvalidMotionError(
            "No person was detected in any frame. Check the background settings, and that the"
            " depth is in meters."
        )
    if not backward_too:
        return [forward]
    start = forward.poses[np.flatnonzero(np.isfinite(forward.scores))[-1]]
    backward = track_with_restarts(
        actor, range(n_frames - 1, -1, -1), start, within(progress, split, 1.0)
    )
    return [forward, backward]


def best_of_passes(body: BodyModel, passes: Sequence[Pass]) -> tuple[Integers, Integers]:
    """Return the source frame and the best pass of every frame, two arrays (n_frames,).

    The source is the frame itself, or the nearest frame with a tracked pose.
    """
    poses = np.stack([one.poses for one in passes], axis=1)
    scores = np.stack([one.scores for one in passes], axis=1)
    is_tracked = np.isfinite(poses).all(axis=-1)
    scores = np.where(is_tracked, np.nan_to_num(scores), np.nan)
    tracked_frames = np.flatnonzero(is_tracked.any(axis=1))
    joints = joint_positions(body, segment_frames(body, np.nan_to_num(poses[tracked_frames])))
    chosen = choose_poses(scores[tracked_frames], joints, _MOVEMENT_SCALE_M)
    nearest = nearest_tracked(tracked_frames, len(poses))
    return nearest, chosen[np.searchsorted(tracked_frames, nearest)]


def assemble_capture(
    body: BodyModel,
    tracked: TrackedMotion,
    restarts: tuple[int, ...],
    floor: FloorPlane | None,
    settings: CaptureSettings,
) -> Capture:
    """Assemble the result from tracked poses."""
    confidence = tracked.joints.confidence
    low_confidence = np.zeros(tracked.joints.positions.shape[:2], dtype=bool)
    if confidence is not None:
        low_confidence = confidence < settings.low_confidence
    return Capture(
        body_motion(body, tracked.poses, tracked.joints.frame_rate, floor),
        tracked.joints, tracked.residual, tracked.coverage, restarts, body, tracked.poses,
        low_confidence,
    )  # fmt: skip
