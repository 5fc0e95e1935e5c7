"""Follow a body from a corrected frame in one direction, until the old course is met again."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...progress import Progress
from ...settings import Settings, setting
from ..body import joint_positions, segment_frames
from ..terms import observe
from ..tracking import FitQuality, FoundPose, follow, next_pose_prior
from .passes import Actor
from .smooth_pass import judged

Array = NDArray[np.float64]

_LEAST_SURE = 0.2
"""Confidence that no joint is taken to fall below: else what is hidden would never matter."""
_MEETING = 4
"""Frames on end in which both courses must be the same, and more to blend them."""
_PATIENCE = 0.015
"""How much worse than the old course the new one may fit and still be followed."""


@dataclass(frozen=True, kw_only=True)
class RetrackSettings(Settings):
    """How far a correction reaches."""

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
class Course:
    """Poses after a corrected frame, in the order of tracking.

    Attributes
    ----------
    poses : shape (n_frames, 36)
        Without the corrected frame's.
    met : bool
        Whether the last ones are those of before.
    """

    poses: Array
    met: bool


def course_from(
    actor: Actor,
    start: Array,
    frames: Sequence[int],
    old_pose: Callable[[int], Array],
    settings: RetrackSettings,
    progress: Progress,
) -> Course:
    """Track the frames from a pose until the old course is met, and drop what got lost.

    The courses have met where for some frames every joint is nearly where it was; of joints
    out of sight less is asked. Where they never meet, the new course is kept up to the frame
    to which it fits best, compared with the old one, and as long again as blending takes.

    Parameters
    ----------
    actor : Actor
    start : shape (36,)
        The pose before the first of the frames.
    frames : sequence of int
        Ascending or descending.
    old_pose : callable
        Gives the pose (36,) of before, frame after frame.
    settings : RetrackSettings
    progress : Progress
    """
    needed = max(_MEETING, round(settings.blend * actor.depth.frame_rate))
    course, gains, meeting, memory = [start], [0.0], 0, None
    for done, frame in enumerate(frames, start=1):
        observation = observe(actor.depth, frame, actor.tracker.picture_width)
        prior = next_pose_prior(course[-2:], actor.tracker, actor.motion_prior)
        pose, quality, memory = follow(actor.body, prior, observation, actor.tracker, memory)
        old = old_pose(frame)
        gain = quality.score - judged(actor, old, frame).score + _PATIENCE
        course.append(pose)
        gains.append(gains[-1] + gain)
        actor.on_pose(FoundPose(actor.body, frame, pose, quality))
        progress(done / len(frames), "Tracking")
        same = _largest_distance(actor, pose, old, quality) < settings.agreement
        meeting = meeting + 1 if same else 0
        if meeting == needed:
            return Course(np.array(course[1:]), met=True)
    kept = int(np.argmax(gains)) + needed
    return Course(np.array(course[1 : kept + 1]).reshape(-1, len(start)), met=False)


def _largest_distance(actor: Actor, pose: Array, old: Array, quality: FitQuality) -> float:
    """Return how far the joint that differs most has moved, less if it is unsure, metres."""
    both = joint_positions(actor.body, segment_frames(actor.body, np.stack([pose, old])))
    moved = np.linalg.norm(both[1] - both[0], axis=-1)
    return float((moved * np.maximum(quality.confidence, _LEAST_SURE)).max())
