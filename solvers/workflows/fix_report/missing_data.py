"""Find what a take lacks: markers that are never observed, and frames without any data."""

from collections.abc import Sequence

import numpy as np

from ...arrays import Flags
from ...depth_scene import DepthRecording
from ...motion import JointRecording, Motion, Tracks
from ...signals import find_runs
from .take_origin import MotionFromJoints, Take

MAX_NAMES = 5
"""Number of markers that a sentence names. It bounds the sentence to two lines of a default
sidebar."""


def drop_missing_points(take: Take) -> tuple[Take, tuple[str, ...]]:
    """Return the take without the points that are never observed, and their names.

    If none is ever observed, and for motions and joints, the take is returned as it is.
    """
    if not isinstance(take, Tracks):
        return take, ()
    observed = take.visible.any(axis=0)
    if observed.all() or not observed.any():
        return take, ()
    names = np.array(take.names)
    confidence = None if take.confidence is None else take.confidence[:, observed]
    kept = Tracks(
        tuple(map(str, names[observed])),
        take.positions[:, observed],
        take.frame_rate,
        confidence,
    )
    return kept, tuple(map(str, names[~observed]))


def describe_missing_points(names: Sequence[str]) -> str:
    """Return a sentence about markers that were left out, or an empty text."""
    if not names:
        return ""
    if len(names) == 1:
        return f"{names[0]} was never observed and is left out."
    listed = ", ".join(names[:MAX_NAMES])
    if more := names[MAX_NAMES:]:
        return f"{listed} and {len(more)} more were never observed and are left out."
    return f"{listed} were never observed and are left out."


def describe_empty_frames(take: Take) -> str:
    """Return a sentence about the frames without any data and what fills them, or nothing.

    Track itself reports images without an actor.
    """
    if isinstance(take, DepthRecording):
        return ""
    empty = ~_find_observed(take).any(axis=1)
    runs = find_runs(empty)
    if not runs or empty.all():
        return ""
    n_frames, longest = int(empty.sum()), max(stop - start for start, stop in runs)
    rate = take.motion.frame_rate if isinstance(take, MotionFromJoints) else take.frame_rate
    if n_frames == 1:
        return "1 frame has no data at all; it is filled from the frames before and after."
    return (
        f"{n_frames} frames have no data at all, up to {longest / rate:.1f} s in a row; they"
        " are filled from the frames before and after."
    )


def observed_samples(recording: Motion | Tracks) -> Flags:
    """Return what was observed, (n_frames, n), of points or of joints that can rotate."""
    if isinstance(recording, Tracks):
        return recording.visible
    skeleton = recording.skeleton
    rotating = [not skeleton.is_end_site(joint) for joint in range(recording.n_joints)]
    return np.asarray(recording.observed[:, rotating])


def _find_observed(take: Motion | Tracks | JointRecording | MotionFromJoints) -> Flags:
    match take:
        case MotionFromJoints():
            return observed_samples(take.motion)
        case JointRecording():
            return observed_samples(take.tracks)
        case _:
            return observed_samples(take)
