"""Find the actor in a depth recording, and report other people."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..progress import Progress, unwatched, within
from .bodies import LabeledBodies, find_bodies
from .camera_checks import check_intrinsics
from .floor import LEVEL, FloorPlane, find_floor
from .foreground import (
    ActorImages,
    Background,
    ForegroundMethod,
    ForegroundSettings,
    cut_out_actor,
    is_in_front,
    learn_background,
    uncovered_background,
)
from .people import People, follow_people
from .recording import DepthRecording

DEFAULT_FOREGROUND = ForegroundSettings()
SAMPLES_PER_SECOND, MAX_SAMPLES = 6.0, 12_000
"""Frames a second, in hertz, from which the scene is learned, and their maximum number. They
bound the run time and the memory of long recordings."""
COARSE_WIDTH = 160
"""Columns of the image in which bodies are detected, pixels. It bounds the run time. Chosen by
hand; `make sensitivity` varies it."""
MAJORITY = 0.5
"""By definition, the fraction of most images, and of most pixels: an image is actor-only if
less of it has depth, and more of that belongs to a body."""
MIN_MOVING_FRACTION = 0.1
"""A body with fewer pixels in front of the room counts as furniture. It guards rooms with
furniture as large as a person (`test_find_actor_works_in_a_room_with_default_settings`)."""
STATURE_RANGE_M = (0.6, 2.6)
"""Plausible height of an actor whose feet are visible. It guards against wrong units
(`test_find_actor_reports_the_height_from_a_wrong_focal_length`)."""
MIN_CROPPED_FRACTION = 0.05
"""Minimum fraction of the actor in the lowest image row if the feet are outside the image. It
guards actors too near to the camera for their feet
(`test_find_actor_works_in_a_room_with_default_settings`)."""


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
    frames = _sample_frames(recording)
    method = _choose_method(recording, settings, empty, frames)
    settings = replace(settings, actor_mask=method)
    floor, background = None, None
    if method is not ForegroundMethod.RECORDED:
        floor = find_floor(recording, progress=within(progress, 0.0, 0.1))
    if method is ForegroundMethod.BACKGROUND:
        background = learn_background(recording, empty, progress=within(progress, 0.1, 0.2))
    room = None
    if method is ForegroundMethod.AUTOMATIC:
        room = uncovered_background(recording, progress=within(progress, 0.1, 0.2))
    finder = _PersonFinder(ActorImages(recording, settings, background, floor), room)
    people = _track_people(finder, frames, recording, within(progress, 0.2, 1.0))
    visible = np.isfinite(people.trajectory).all(axis=-1)
    if not visible.any():
        raise InvalidMotionError(_NO_PERSON)
    actor_only = cut_out_actor(
        recording, settings, background=background, floor=floor, trajectory=people.trajectory
    )
    warnings = (
        *check_intrinsics(recording.camera),
        *_warnings(people, visible, recording),
        *finder.warnings(),
    )
    return Actor(actor_only, floor, method, visible, not finder.is_cropped(), warnings)


_NO_PERSON = (
    "No person is visible in this recording. Check scale and distances, select frames of the"
    " empty room, or let the actor move."
)


def _sample_frames(recording: DepthRecording) -> NDArray[np.intp]:
    wanted = recording.n_frames / recording.frame_rate * SAMPLES_PER_SECOND
    n_samples = int(np.clip(np.ceil(wanted), min(recording.n_frames, 12), MAX_SAMPLES))
    n_samples = min(n_samples, recording.n_frames)
    return np.unique(np.linspace(0, recording.n_frames - 1, n_samples).round().astype(np.intp))


def _choose_method(
    recording: DepthRecording,
    settings: ForegroundSettings,
    empty: Sequence[int],
    frames: NDArray[np.intp],
) -> ForegroundMethod:
    """Choose the method: `RECORDED` if one body fills a small part of the images."""
    if settings.actor_mask is not ForegroundMethod.AUTOMATIC:
        return settings.actor_mask
    if len(empty):
        return ForegroundMethod.BACKGROUND
    is_only_body, step = [], _coarse_step(recording)
    for frame in frames[:: max(1, len(frames) // 12)].tolist():
        depth = recording.frame(frame)[::step, ::step]
        if not (depth > 0.0).any():
            continue
        bodies = find_bodies(
            depth, recording.camera.every(step), settings.min_body_area, step=1
        )
        is_body = bodies.labels[depth > 0.0] > 0
        is_only_body.append((depth > 0.0).mean() < MAJORITY < is_body.mean())
    recorded = bool(is_only_body) and np.mean(is_only_body) > MAJORITY
    recorded = recorded and find_floor(recording) is None
    return ForegroundMethod.RECORDED if recorded else ForegroundMethod.AUTOMATIC


def _coarse_step(recording: DepthRecording) -> int:
    """Return the subsampling step of columns and rows for the detection of bodies."""
    return max(1, recording.camera.width // COARSE_WIDTH)


class _PersonFinder:
    """Detector of people in single, subsampled frames."""

    def __init__(self, actor: ActorImages, room: Background | None) -> None:
        self._actor, self._room = actor, room
        self._step = _coarse_step(actor.recording)
        self._camera = actor.recording.camera.every(self._step)
        self._is_cropped: list[bool] = []
        self._heights: list[float] = []

    def __call__(self, frame: int) -> LabeledBodies:
        """Return the people in a frame: bodies of plausible size, without furniture."""
        step, settings = self._step, self._actor.settings
        depth = self._actor.recording.frame(frame)[::step, ::step]
        depth = self._actor.foreground(depth, step)
        bodies = find_bodies(depth, self._camera, settings.min_body_area, step=1)
        is_person = np.ones(len(bodies.areas), dtype=bool)
        if settings.actor_mask is not ForegroundMethod.RECORDED:
            is_person &= bodies.areas <= settings.max_body_area
        if self._room is not None:
            room = Background(
                self._room.depth[::step, ::step], self._room.spread[::step, ::step]
            )
            in_front = is_in_front(depth, room, settings.before_background)
            for index in np.flatnonzero(is_person):
                is_person[index] = (
                    in_front[bodies.labels == index + 1].mean() >= MIN_MOVING_FRACTION
                )
        if is_person.any():
            label = int(np.argmax(is_person)) + 1
            self._is_cropped.append(
                bool((bodies.labels[-1] == label).mean() >= MIN_CROPPED_FRACTION)
            )
            points = self._camera.back_project(depth)[bodies.labels == label]
            heights = (self._actor.floor or LEVEL).heights(points)
            self._heights.append(float(np.ptp(np.quantile(heights, [0.01, 0.99]))))
        return replace(bodies, areas=bodies.areas[is_person], centers=bodies.centers[is_person])

    def height(self) -> float:
        """Return the 0.9 quantile of the largest body's height, meters."""
        return float(np.quantile(self._heights, 0.9)) if self._heights else np.nan

    def is_cropped(self) -> bool:
        """Whether the lower image edge cuts the largest body in most frames."""
        return bool(self._is_cropped) and float(np.mean(self._is_cropped)) > MAJORITY

    def warnings(self) -> list[str]:
        """Return warnings about the actor's body."""
        if self.is_cropped():
            return ["The image ends above the feet: legs are estimated or omitted."]
        if STATURE_RANGE_M[0] <= self.height() <= STATURE_RANGE_M[1]:
            return []
        return [
            f"The actor would be {self.height():.1f} m tall: check the scale, and the focal"
            " length of the camera."
        ]


def _track_people(
    finder: _PersonFinder,
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
