"""Track in one direction from a corrected frame, until the path rejoins the motion."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ...arrays import Array
from ...progress import Progress
from ...settings import Settings, setting
from ..body import joint_positions, segment_frames
from ..terms import observe
from ..tracking import FitQuality, PosePreview, next_pose_prior, track_frame
from .passes import TrackingContext
from .smooth_pass import measure_fit

_MIN_CONFIDENCE = 0.2
"""Minimum confidence of a joint in the comparison. It guards corrections of an occluded limb:
old and new motion would agree at once, wherever it is
(`test_motions_do_not_agree_where_an_occluded_arm_differs`)."""
_MIN_AGREEING_FRAMES = 4
"""Minimum number of consecutive frames where both motions agree. It guards a blend of less than
this many frames, a setting: motions that only cross in a frame are not the same
(`test_path_may_fit_a_little_worse_than_the_old_motion`)."""
_SCORE_TOLERANCE = 0.015
"""Fraction by which the score of the new path may be lower than that of the previous motion. It
guards corrections that the images hardly show: the path would end at the first frame that fits
worse by chance (`test_path_may_fit_a_little_worse_than_the_old_motion`)."""


@dataclass(frozen=True, kw_only=True)
class RetrackSettings(Settings):
    """Settings of the extent of a correction."""

    reach: float = setting(
        5.0, "Time before and after the corrected frame that may change; higher takes longer",
        unit="s", minimum=0.0, maximum=3600.0,
    )  # fmt: skip
    agreement: float = setting(
        0.03,
        "Distance at which a visible joint agrees with the old motion; higher stops sooner",
        unit="m", minimum=1e-3, maximum=1.0,
    )  # fmt: skip
    blend: float = setting(
        0.25, "Time to blend from the new to the old motion", unit="s",
        minimum=0.0, maximum=10.0,
    )  # fmt: skip
    smoothing: float = setting(
        1.0, "Amount of smoothing of the new motion; 0 leaves every frame as tracked",
        minimum=0.0, maximum=1000.0,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class RetrackedPath:
    """Poses after a corrected frame, in the order of tracking.

    Attributes
    ----------
    poses : shape (n_frames, 36)
        Without the corrected frame.
    met : bool
        Whether the path rejoined the previous motion.
    """

    poses: Array
    met: bool


def track_from_correction(
    actor: TrackingContext,
    start: Array,
    frames: Sequence[int],
    previous_pose: Callable[[int], Array],
    settings: RetrackSettings,
    progress: Progress,
) -> RetrackedPath:
    """Track frames from a pose until the path rejoins the previous motion.

    The motions agree if every joint is close to its previous position for several frames;
    occluded joints count less. If they never agree, the new path ends where its cumulative
    score gain over the previous motion is largest, plus the duration of the blend.

    Parameters
    ----------
    actor : TrackingContext
    start : shape (36,)
        The pose before the first of the frames.
    frames : sequence of int
        Ascending or descending.
    previous_pose : callable
        Maps a frame to the pose (36,) of the previous motion.
    settings : RetrackSettings
    progress : Progress
    """
    n_required = max(_MIN_AGREEING_FRAMES, round(settings.blend * actor.depth.frame_rate))
    trajectory, cumulative_gains, n_agreeing = [start], [0.0], 0
    for done, frame in enumerate(frames, start=1):
        observation = observe(actor.depth, frame, actor.tracker.image_width)
        prior = next_pose_prior(trajectory[-2:], actor.tracker, actor.motion_prior)
        pose, quality = track_frame(actor.body, prior, observation, actor.tracker)
        previous = previous_pose(frame)
        gain = quality.score - measure_fit(actor, previous, frame).score + _SCORE_TOLERANCE
        trajectory.append(pose)
        cumulative_gains.append(cumulative_gains[-1] + gain)
        actor.on_pose(PosePreview(actor.body, frame, pose, quality))
        progress(done / len(frames), "Tracking")
        agrees = _largest_distance(actor, pose, previous, quality) < settings.agreement
        n_agreeing = n_agreeing + 1 if agrees else 0
        if n_agreeing == n_required:
            return RetrackedPath(np.array(trajectory[1:]), met=True)
    n_reused = int(np.argmax(cumulative_gains)) + n_required
    return RetrackedPath(
        np.array(trajectory[1 : n_reused + 1]).reshape(-1, len(start)), met=False
    )


def _largest_distance(
    actor: TrackingContext, pose: Array, previous: Array, quality: FitQuality
) -> float:
    """Return the largest joint distance, weighted by confidence, meters."""
    joints = joint_positions(actor.body, segment_frames(actor.body, np.stack([pose, previous])))
    distances = np.linalg.norm(joints[1] - joints[0], axis=-1)
    return float((distances * np.maximum(quality.confidence, _MIN_CONFIDENCE)).max())
