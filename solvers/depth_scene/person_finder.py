"""Detect people in single frames of a depth recording, after learning the scene."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..progress import Progress, within
from .bodies import LabeledBodies, find_bodies
from .floor import LEVEL, find_floor
from .foreground import (
    ActorImages,
    Background,
    ForegroundMethod,
    ForegroundSettings,
    is_in_front,
    learn_background,
    uncovered_background,
)
from .recording import DepthImage, DepthRecording

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


def person_finder(
    recording: DepthRecording,
    settings: ForegroundSettings,
    empty: Sequence[int],
    frames: NDArray[np.intp],
    progress: Progress,
) -> "PersonFinder":
    """Learn the scene from frames, (n_samples,); return the detector of people in it.

    The indices in `empty` are of frames without people.
    """
    method = _choose_method(recording, settings, empty, frames)
    settings = replace(settings, actor_mask=method)
    floor, background = None, None
    if method is not ForegroundMethod.RECORDED:
        floor = find_floor(recording, progress=within(progress, 0.0, 0.5))
    if method is ForegroundMethod.BACKGROUND:
        background = learn_background(recording, empty, progress=within(progress, 0.5, 1.0))
    room = None
    if method is ForegroundMethod.AUTOMATIC:
        room = uncovered_background(recording, progress=within(progress, 0.5, 1.0))
    return PersonFinder(ActorImages(recording, settings, background, floor), room)


def sample_frames(recording: DepthRecording) -> NDArray[np.intp]:
    """Return the indices, (n_samples,), of the frames from which the scene is learned."""
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


class PersonFinder:
    """Detector of people in single, subsampled frames.

    Parameters
    ----------
    images : ActorImages
    room : Background, or None
        Estimate of the room, where none was recorded.
    """

    def __init__(self, images: ActorImages, room: Background | None) -> None:
        self.images = images
        self.camera = images.recording.camera.every(_coarse_step(images.recording))
        self._room = room
        self._is_cropped: list[bool] = []
        self._heights: list[float] = []

    def __call__(self, frame: int) -> LabeledBodies:
        """Return the people in a frame: bodies of plausible size, without furniture."""
        bodies, is_person = self.classify(frame)
        return replace(bodies, areas=bodies.areas[is_person], centers=bodies.centers[is_person])

    def classify(self, frame: int) -> tuple[LabeledBodies, NDArray[np.bool_]]:
        """Return the bodies in a frame, and for each whether it may be a person."""
        step, settings = _coarse_step(self.images.recording), self.images.settings
        depth = self.images.recording.frame(frame)[::step, ::step]
        depth = self.images.foreground(depth, step)
        bodies = find_bodies(depth, self.camera, settings.min_body_area, step=1)
        is_person = self.may_be_people(bodies, depth, step)
        if is_person.any():
            label = int(np.argmax(is_person)) + 1
            self._is_cropped.append(
                bool((bodies.labels[-1] == label).mean() >= MIN_CROPPED_FRACTION)
            )
            points = self.camera.back_project(depth)[bodies.labels == label]
            heights = (self.images.floor or LEVEL).heights(points)
            self._heights.append(float(np.ptp(np.quantile(heights, [0.01, 0.99]))))
        return bodies, is_person

    def may_be_people(
        self, bodies: LabeledBodies, depth: DepthImage, step: int
    ) -> NDArray[np.bool_]:
        """Return for each body whether it has a plausible size, and is no furniture.

        `depth` has the shape of the labels: every `step`-th column and row of the images.
        """
        settings = self.images.settings
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
        return is_person

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
