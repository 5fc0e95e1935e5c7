"""Track again from a frame that an animator has corrected, in both directions."""

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import DepthRecording, Floor
from ...errors import InvalidMotionError
from ...motion import Motion, Tracks
from ...progress import Progress, unwatched, within
from ...rotations import IDENTITY, inverse, multiply, slerp
from ..body import JOINTS, N_SEGMENTS, BodyModel, body_motion, motion_frames, pose_from_frames
from ..forest import load_pixel_forest
from ..terms import DEFAULT_TRACKER, TrackerSettings
from ..tracking import FitQuality, PoseCallback, PosePreview, assemble_motion, ignore_pose
from .passes import RecoverySettings, TrackingContext
from .retracked_path import RetrackSettings, track_from_correction
from .smooth_pass import measure_fit, smoothed_piece

Array = NDArray[np.float64]
USUAL_RETRACK = RetrackSettings()
_BORDER = 2
"""Frames on both sides that tell where the old motion is, and how fast."""


@dataclass(frozen=True, eq=False)
class Retracked:
    """A motion that was tracked again around a corrected frame.

    Attributes
    ----------
    motion : Motion
        All frames; outside of `first` to `last` it is what it was.
    frame : int
        The one that was corrected.
    first, last : int
        Frames between which something has changed; both count.
    met : tuple of bool
        Whether the old course was met again before, and after, the corrected frame.
    joints : Tracks
        Of the changed frames, in the camera's frame, with the confidence of each joint.
    residual : shape (last - first + 1,), metres
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
    floor: Floor | None = None,
    fixed: Collection[int] = (),
    settings: RetrackSettings = USUAL_RETRACK,
    tracker: TrackerSettings = DEFAULT_TRACKER,
    on_pose: PoseCallback = ignore_pose,
    progress: Progress = unwatched,
) -> Retracked:
    """Track again from a frame that was corrected by hand, forwards and backwards.

    From the corrected pose the tracker follows the pictures in both directions until it meets
    the motion that was there before, another frame that is fixed, or the end of its reach. The
    detector is not asked: the animator knows better. What was tracked is smoothed with the
    corrected pose held, and goes over into the old motion.

    Parameters
    ----------
    depth : DepthRecording
        Of nothing but the actor.
    body : BodyModel
        The one that was tracked.
    motion : Motion
        On the skeleton of the body, one frame for each of the recording; the pose of `frame`
        is the corrected one.
    frame : int
    floor : Floor, optional
        The one that is z = 0 in the motion.
    fixed : collection of int
        Other frames that are right, such as those that were corrected before.
    settings : RetrackSettings
    tracker : TrackerSettings
    on_pose : PoseCallback
        Is shown each pose that is found, as soon as it is.
    progress : Progress

    Returns
    -------
    Retracked
        The pose of `frame` is unchanged, whether the body's coordinates can reach it or not.

    Raises
    ------
    InvalidMotionError
        Motion and recording do not fit, or there is no such frame.
    SolveCancelled
        Raised by `progress`.
    """
    _check(depth, motion, frame)
    actor = TrackingContext(
        depth, body, load_pixel_forest(), tracker, RecoverySettings(), on_pose=on_pose
    )
    frames = motion_frames(body, motion, floor)
    start = pose_from_frames(body, frames[frame])
    most = round(settings.reach * depth.frame_rate)
    courses = []
    for turn, way in enumerate((-1, 1)):
        ahead = _way(frame, way, most, depth.n_frames, fixed)
        share = within(progress, 0.4 * turn, 0.4 * (turn + 1))
        before = _OldPoses(body, frames, start)
        courses.append(track_from_correction(actor, start, ahead, before, settings, share))
    back, forth = courses
    first, last = frame - len(back.poses), frame + len(forth.poses)
    poses = np.concatenate([back.poses[::-1], start[np.newaxis], forth.poses])
    if settings.smoothing > 0.0:
        poses = _smoothed(actor, poses, first, frame, settings.smoothing, frames)
    figures = _figures(actor, poses, first, within(progress, 0.8, 1.0))
    tracked = assemble_motion(body, poses, figures, depth.frame_rate)
    new = body_motion(body, poses, motion.frame_rate, floor)
    n_blend = round(settings.blend * depth.frame_rate)
    blended = _blended(motion, new, first, frame, n_blend)
    met = back.met, forth.met
    return Retracked(blended, frame, first, last, met, tracked.joints, tracked.residual)


def _check(depth: DepthRecording, motion: Motion, frame: int) -> None:
    if motion.skeleton.names != JOINTS or motion.n_frames != depth.n_frames:
        raise InvalidMotionError(
            f"The motion has {motion.n_frames} frames and {motion.skeleton.n_joints} joints;"
            f" to track it again it needs the recording's {depth.n_frames} frames, and the"
            f" {len(JOINTS)} joints of the body that was tracked."
        )
    if not 0 <= frame < motion.n_frames:
        raise InvalidMotionError(
            f"There is no frame {frame} to start from; the motion has 0 to"
            f" {motion.n_frames - 1}."
        )
    if not (np.isfinite(motion.rotations).all() and np.isfinite(motion.root_positions).all()):
        raise InvalidMotionError("The motion has gaps. Fill them, then track again.")


def _way(frame: int, way: int, most: int, n_frames: int, fixed: Collection[int]) -> range:
    """Return the frames to be tracked in one direction."""
    stops = [other for other in fixed if (other - frame) * way > 0]
    stop = min([n_frames if way > 0 else -1, *stops], key=lambda one: (one - frame) * way)
    reach = frame + way * (most + 1)
    return range(frame + way, min(stop, reach) if way > 0 else max(stop, reach), way)


class _OldPoses:
    """The poses of before, each found from the one that was asked for last."""

    def __init__(self, body: BodyModel, frames: Array, start: Array) -> None:
        self._body, self._frames, self._last = body, frames, start

    def __call__(self, frame: int) -> Array:
        """Return the pose (36,) of a frame."""
        self._last = pose_from_frames(self._body, self._frames[frame], start=self._last)
        return self._last


def _smoothed(
    actor: TrackingContext, poses: Array, first: int, frame: int, smoothing: float, old: Array
) -> Array:
    """Smooth what was tracked, between the corrected pose and what was there before.

    So limbs out of sight go on to where they were seen before and after.
    """
    stop, n_frames = first + len(poses), len(old)
    before = _OldPoses(actor.body, old, poses[0])
    around = [before(one) for one in range(first - 1, max(0, first - _BORDER) - 1, -1)][::-1]
    after = _OldPoses(actor.body, old, poses[-1])
    piece = np.array([
        *around,
        *poses,
        *(after(one) for one in range(stop, min(n_frames, stop + _BORDER))),
    ])
    inside = slice(len(around), len(around) + len(poses))
    held = {*range(len(piece))} - {*range(len(piece))[inside]} | {frame - first + len(around)}
    if len(piece) < 3:
        return poses
    return smoothed_piece(actor, piece, first - len(around), smoothing, held)[inside]


def _figures(
    actor: TrackingContext, poses: Array, first: int, progress: Progress
) -> list[FitQuality]:
    figures = []
    for place, pose in enumerate(poses):
        quality = measure_fit(actor, pose, first + place)
        figures.append(quality)
        actor.on_pose(PosePreview(actor.body, first + place, pose, quality))
        progress((place + 1) / len(poses), "Judging")
    return figures


def _blended(old: Motion, new: Motion, first: int, frame: int, n_blend: int) -> Motion:
    """Return the old motion with the new one in it, which goes over into the old.

    What the corrected pose has and no coordinates can reach fades out around it.
    """
    stop = first + new.n_frames
    places = np.arange(float(first), stop)
    share = np.minimum(
        _ramp(places - first, frame - first, n_blend, first > 0),
        _ramp(stop - 1 - places, stop - 1 - frame, n_blend, stop < old.n_frames),
    )
    near = _smooth(1.0 - np.abs(places - frame) / (n_blend + 1.0))
    fitted = new.rotations[frame - first, :N_SEGMENTS]
    rest = multiply(inverse(fitted), old.rotations[frame, :N_SEGMENTS])
    turned = multiply(
        new.rotations[:, :N_SEGMENTS], slerp(np.array(IDENTITY), rest, near[:, np.newaxis])
    )
    shift = old.root_positions[frame] - new.root_positions[frame - first]
    shifted = new.root_positions + near[:, np.newaxis] * shift
    rotations, roots = old.rotations.copy(), old.root_positions.copy()
    rotations[first:stop, :N_SEGMENTS] = slerp(
        rotations[first:stop, :N_SEGMENTS], turned, share[:, np.newaxis]
    )
    roots[first:stop] += share[:, np.newaxis] * (shifted - roots[first:stop])
    rotations[frame], roots[frame] = old.rotations[frame], old.root_positions[frame]
    return replace(old, rotations=rotations, root_positions=roots)


def _ramp(from_end: Array, length: int, n_blend: int, joins: bool) -> Array:
    """Return the share of the new course: little at its end, if it joins the old one there."""
    if not joins:
        return np.ones(len(from_end))
    return _smooth((from_end + 1.0) / (min(n_blend, length) + 1.0))


def _smooth(share: Array) -> Array:
    share = np.clip(share, 0.0, 1.0)
    smooth: Array = share * share * (3.0 - 2.0 * share)
    return smooth
