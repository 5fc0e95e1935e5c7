"""Track again in both directions from a frame that an animator corrected."""

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Array
from ...depth_scene import DepthRecording, FloorPlane
from ...errors import InvalidMotionError
from ...motion import Motion, Tracks
from ...progress import Progress, unwatched, within
from ...rotations import IDENTITY, inverse, multiply, slerp
from ...signals import smoothstep
from ..body import JOINTS, N_SEGMENTS, BodyModel, body_motion, motion_frames, pose_from_frames
from ..forest import load_pixel_forest
from ..terms import DEFAULT_TRACKER, TrackerSettings
from ..tracking import FitQuality, PoseCallback, PosePreview, assemble_motion, ignore_pose
from .passes import TrackingContext
from .restart_policies import RecoverySettings
from .retracked_path import RetrackSettings, track_from_correction
from .smooth_pass import measure_fit, smooth_window

DEFAULT_RETRACK = RetrackSettings()
_N_CONTEXT_FRAMES = 2
"""Frames on both sides that give position and velocity of the previous motion. By definition: a
velocity needs two."""


@dataclass(frozen=True, eq=False)
class Retracked:
    """A motion that was tracked again around a corrected frame.

    Attributes
    ----------
    motion : Motion
        All frames; unchanged outside of `first` to `last`.
    frame : int
        The corrected frame.
    first, last : int
        First and last changed frame, inclusive.
    met : tuple of bool
        Whether the path rejoined the previous motion before and after the corrected frame.
    joints : Tracks
        Of the changed frames, in the camera's frame, with the confidence of each joint.
    residual : shape (last - first + 1,), meters
    """

    motion: Motion
    frame: int
    first: int
    last: int
    met: tuple[bool, bool]
    joints: Tracks
    residual: Array


def retrack(
    depth: DepthRecording,
    body: BodyModel,
    motion: Motion,
    frame: int,
    *,
    floor: FloorPlane | None = None,
    fixed: Collection[int] = (),
    settings: RetrackSettings = DEFAULT_RETRACK,
    tracker: TrackerSettings = DEFAULT_TRACKER,
    on_pose: PoseCallback = ignore_pose,
    progress: Progress = unwatched,
) -> Retracked:
    """Track again forward and backward from a manually corrected frame.

    The tracker follows the images from the corrected pose in both directions. It stops when it
    rejoins the previous motion, at another fixed frame, or at the end of its reach. The
    detector does not run, because the animator's pose takes precedence. The new path is
    smoothed with the corrected pose as a constraint, and blends into the previous motion.

    Parameters
    ----------
    depth : DepthRecording
        Contains only the actor.
    body : BodyModel
        The tracked body.
    motion : Motion
        On the skeleton of the body, one frame for each of the recording; the pose of `frame`
        is the corrected one.
    frame : int
    floor : FloorPlane, optional
        The plane z = 0 of the motion.
    fixed : collection of int
        Other frames to keep, such as frames corrected earlier.
    settings : RetrackSettings
    tracker : TrackerSettings
    on_pose : PoseCallback
        Called with each pose as soon as it is tracked.
    progress : Progress

    Returns
    -------
    Retracked
        The pose of `frame` is unchanged, even if the body's coordinates cannot reach it.

    Raises
    ------
    InvalidMotionError
        Motion and recording do not match, or there is no such frame.
    SolveCancelled
        Raised by `progress`.
    """
    _check(depth, motion, frame)
    actor = TrackingContext(
        depth, body, load_pixel_forest(), tracker, RecoverySettings(), on_pose=on_pose
    )
    frames = motion_frames(body, motion, floor)
    start = pose_from_frames(body, frames[frame])
    max_frames = round(settings.reach * depth.frame_rate)
    paths = []
    for index, direction in enumerate((-1, 1)):
        path_frames = _path_frames(frame, direction, max_frames, depth.n_frames, fixed)
        path_progress = within(progress, 0.4 * index, 0.4 * (index + 1))
        previous_poses = _PreviousPoses(body, frames, start)
        paths.append(
            track_from_correction(
                actor, start, path_frames, previous_poses, settings, path_progress
            )
        )
    backward, forward = paths
    first, last = frame - len(backward.poses), frame + len(forward.poses)
    poses = np.concatenate([backward.poses[::-1], start[np.newaxis], forward.poses])
    if settings.smoothing > 0.0:
        poses = _smooth_path(actor, poses, first, frame, settings.smoothing, frames)
    qualities = _measure_quality(actor, poses, first, within(progress, 0.8, 1.0))
    tracked = assemble_motion(body, poses, qualities, depth.frame_rate)
    new = body_motion(body, poses, motion.frame_rate, floor)
    n_blend = round(settings.blend * depth.frame_rate)
    blended = _blend_motion(motion, new, first, frame, n_blend)
    met = backward.met, forward.met
    return Retracked(blended, frame, first, last, met, tracked.joints, tracked.residual)


def _check(depth: DepthRecording, motion: Motion, frame: int) -> None:
    if motion.skeleton.names != JOINTS or motion.n_frames != depth.n_frames:
        raise InvalidMotionError(
            f"The motion has {motion.n_frames} frames and {motion.skeleton.n_joints} joints;"
            f" tracking again needs the recording's {depth.n_frames} frames and the"
            f" {len(JOINTS)} joints of the tracked body."
        )
    if not 0 <= frame < motion.n_frames:
        raise InvalidMotionError(
            f"There is no frame {frame} to start from; the motion has 0 to"
            f" {motion.n_frames - 1}."
        )
    if not (np.isfinite(motion.rotations).all() and np.isfinite(motion.root_positions).all()):
        raise InvalidMotionError("The motion has gaps. Fill them, then track again.")


def _path_frames(
    frame: int, direction: int, max_frames: int, n_frames: int, fixed: Collection[int]
) -> range:
    """Return the frames to track in one direction."""
    stops = [other for other in fixed if (other - frame) * direction > 0]
    stop = min(
        [n_frames if direction > 0 else -1, *stops], key=lambda one: (one - frame) * direction
    )
    reach = frame + direction * (max_frames + 1)
    return range(
        frame + direction, min(stop, reach) if direction > 0 else max(stop, reach), direction
    )


class _PreviousPoses:
    """The poses of the previous motion, each fitted from the pose requested last."""

    def __init__(self, body: BodyModel, frames: Array, start: Array) -> None:
        self._body, self._frames, self._last = body, frames, start

    def __call__(self, frame: int) -> Array:
        """Return the pose (36,) of a frame."""
        self._last = pose_from_frames(self._body, self._frames[frame], start=self._last)
        return self._last


def _smooth_path(
    actor: TrackingContext, poses: Array, first: int, frame: int, smoothing: float, old: Array
) -> Array:
    """Smooth the new path between the corrected pose and the previous motion.

    Occluded limbs are interpolated between their observations before and after.
    """
    stop, n_frames = first + len(poses), len(old)
    previous_poses = _PreviousPoses(actor.body, old, poses[0])
    context = [
        previous_poses(one)
        for one in range(first - 1, max(0, first - _N_CONTEXT_FRAMES) - 1, -1)
    ][::-1]
    after = _PreviousPoses(actor.body, old, poses[-1])
    window = np.array([
        *context,
        *poses,
        *(after(one) for one in range(stop, min(n_frames, stop + _N_CONTEXT_FRAMES))),
    ])
    inside = slice(len(context), len(context) + len(poses))
    constrained = {*range(len(window))} - {*range(len(window))[inside]} | {
        frame - first + len(context)
    }
    if len(window) < 3:
        return poses
    return smooth_window(actor, window, first - len(context), smoothing, constrained)[inside]


def _measure_quality(
    actor: TrackingContext, poses: Array, first: int, progress: Progress
) -> list[FitQuality]:
    qualities = []
    for index, pose in enumerate(poses):
        quality = measure_fit(actor, pose, first + index)
        qualities.append(quality)
        actor.on_pose(PosePreview(actor.body, first + index, pose, quality))
        progress((index + 1) / len(poses), "Measuring the fit")
    return qualities


def _blend_motion(old: Motion, new: Motion, first: int, frame: int, n_blend: int) -> Motion:
    """Return the previous motion with the new path blended in.

    The part of the corrected pose that no coordinates can reach fades out around it.
    """
    stop = first + new.n_frames
    frames = np.arange(float(first), stop)
    weight = np.minimum(
        _ramp_weight(frames - first, frame - first, n_blend, first > 0),
        _ramp_weight(stop - 1 - frames, stop - 1 - frame, n_blend, stop < old.n_frames),
    )
    proximity = smoothstep(1.0 - np.abs(frames - frame) / (n_blend + 1.0))
    fitted = new.rotations[frame - first, :N_SEGMENTS]
    residual_rotation = multiply(inverse(fitted), old.rotations[frame, :N_SEGMENTS])
    rotated = multiply(
        new.rotations[:, :N_SEGMENTS],
        slerp(np.array(IDENTITY), residual_rotation, proximity[:, np.newaxis]),
    )
    offset = old.root_positions[frame] - new.root_positions[frame - first]
    shifted = new.root_positions + proximity[:, np.newaxis] * offset
    rotations, roots = old.rotations.copy(), old.root_positions.copy()
    rotations[first:stop, :N_SEGMENTS] = slerp(
        rotations[first:stop, :N_SEGMENTS], rotated, weight[:, np.newaxis]
    )
    roots[first:stop] += weight[:, np.newaxis] * (shifted - roots[first:stop])
    rotations[frame], roots[frame] = old.rotations[frame], old.root_positions[frame]
    return replace(old, rotations=rotations, root_positions=roots)


def _ramp_weight(from_end: Array, length: int, n_blend: int, joins: bool) -> Array:
    """Return the weight of the new path: small at its end if it joins the previous motion."""
    if not joins:
        return np.ones(len(from_end))
    return smoothstep((from_end + 1.0) / (min(n_blend, length) + 1.0))
