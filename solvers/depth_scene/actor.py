"""Find the actor in a depth recording, and report other people."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..progress import Progress, unwatched, within
from .bodies import LabeledBodies
from .camera_checks import check_intrinsics
from .floor import FloorPlane
from .foreground import (
    ForegroundMethod,
    ForegroundSettings,
    cut_out_actor,
)
from .people import People, follow_people
from .person_finder import PersonFinder, person_finder, sample_frames
from .recording import DepthRecording

DEFAULT_FOREGROUND = ForegroundSettings()


@dataclass(frozen=True, eq=False)
class Actor:
    """The actor and the scene.

    Attributes
    ----------
    recording : DepthRecording
        Contains only the actor; still read frame by frame.
    floor : FloorPlane, or None
        None if no floor is visible.
    method : ForegroundMethod
        Method that separated the actor from the room.
    visible : bool array, shape (n_frames,)
        Whether the actor is visible.
    feet_visible : bool
        False if the lower image edge usually cuts the actor off.
    remarks : tuple of str
        Warnings for the animator: several people, missing frames, implausible size.
    """

    recording: DepthRecording
    floor: FloorPlane | None
    method: ForegroundMethod
    visible: NDArray[np.bool_]
    feet_visible: bool
    remarks: tuple[str, ...]


def find_actor(
    recording: DepthRecording,
    settings: ForegroundSettings = DEFAULT_FOREGROUND,
    *,
    empty: Sequence[int] = (),
    progress: Progress = unwatched,
) -> Actor:
    """Separate the actor from the room and from other people, in all frames.

    If the images contain one body only, it is the actor. Otherwise the floor is detected and
    removed. The room is learned from the `empty` frames, or estimated from the background
    that the moving actor uncovers. Connected pixels in space form a body. Of several people,
    the one with the largest visible surface over the recording is the actor.

    Parameters
    ----------
    recording : DepthRecording
    settings : ForegroundSettings
    empty : sequence of int
        Frames without the actor; then the background is subtracted.
    progress : Progress

    Returns
    -------
    Actor

    Raises
    ------
    InvalidMotionError
        No person is visible, or the background method has no frames of the empty room.
    SolveCancelled
        Raised by `progress`.
    """
    frames = sample_frames(recording)
    finder = person_finder(recording, settings, empty, frames, within(progress, 0.0, 0.2))
    images = finder.images
    people = _track_people(finder, frames, recording, within(progress, 0.2, 1.0))
    visible = np.isfinite(people.trajectory).all(axis=-1)
    if not visible.any():
        raise InvalidMotionError(NO_PERSON)
    actor_only = cut_out_actor(
        recording, images.settings, background=images.background, floor=images.floor,
        trajectory=people.trajectory,
    )  # fmt: skip
    warnings = (
        *check_intrinsics(recording.camera),
        *_warnings(people, visible, recording),
        *finder.warnings(),
    )
    method = images.settings.actor_mask
    return Actor(actor_only, images.floor, method, visible, not finder.is_cropped(), warnings)


NO_PERSON = (
    "No person is visible in this recording. Check scale and distances, select frames of the"
    " empty room, or let the actor move."
)


def _track_people(
    finder: PersonFinder,
    frames: NDArray[np.intp],
    recording: DepthRecording,
    progress: Progress,
) -> People:
    n_observed = 0

    def observe(frame: int) -> LabeledBodies:
        nonlocal n_observed
        n_observed += 1
        progress(n_observed / len(frames), "Finding the actor")
        return finder(frame)

    return follow_people(observe, frames, recording.n_frames, recording.frame_rate)


def _warnings(
    people: People, visible: NDArray[np.bool_], recording: DepthRecording
) -> tuple[str, ...]:
    warnings = []
    crowded = np.flatnonzero(people.n_bodies > 1)
    if len(crowded):
        start = people.frames[crowded[0]] / recording.frame_rate
        warnings.append(
            f"Up to {people.n_bodies.max()} people are visible, from {start:.1f} s on; the most"
            " visible one is tracked."
        )
    if not visible.all():
        start = int(np.argmin(visible)) / recording.frame_rate
        warnings.append(
            f"No person is visible in {(~visible).sum()} of {len(visible)} frames,"
            f" from {start:.1f} s on."
        )
    return tuple(warnings)
