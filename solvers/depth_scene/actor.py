"""Find the actor in a recording of depth, and tell who else was there."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..progress import Progress, unwatched, within
from .bodies import Bodies, find_bodies
from .camera_checks import check_intrinsics
from .floor import LEVEL, Floor, find_floor
from .foreground import (
    ActorImages,
    Background,
    ForegroundMethod,
    ForegroundSettings,
    cut_out_actor,
    in_front_of,
    learn_background,
    uncovered_background,
)
from .people import People, follow_people
from .recording import DepthRecording

USUAL = ForegroundSettings()
LOOKS_PER_SECOND, MOST_LOOKS = 6.0, 12_000
COARSE_WIDTH = 160
FULL, WHOLE = 0.5, 0.75
"""Share of the picture above which it shows a room; and of what is seen that is the actor."""
MOVING = 0.1
"""Share of a body's pixels that see it in front of the room, or it is furniture."""
TALL = (0.6, 2.6)
"""Metres that an actor whose feet are seen may measure from the lowest point to the highest."""
CUT_OFF = 0.05
"""Share of the lowest row that is the actor, where the picture ends above the feet."""


@dataclass(frozen=True, eq=False)
class Actor:
    """The actor, and what is known of the place.

    Attributes
    ----------
    recording : DepthRecording
        With nothing but the actor in it; still read frame by frame.
    floor : Floor, or None
        None where none is seen.
    way : ForegroundMethod
        How the actor was told from the room.
    seen : bool array, shape (n_frames,)
        Whether the actor is there.
    feet_seen : bool
        False where the lower edge of the picture usually cuts the actor off.
    remarks : tuple of str
        What the animator should know: more than one person, nobody, only a part.
    """

    recording: DepthRecording
    floor: Floor | None
    way: ForegroundMethod
    seen: NDArray[np.bool_]
    feet_seen: bool
    remarks: tuple[str, ...]


def find_actor(
    recording: DepthRecording,
    settings: ForegroundSettings = USUAL,
    *,
    empty: Sequence[int] = (),
    progress: Progress = unwatched,
) -> Actor:
    """Tell the actor from the room and from other people, over the whole recording.

    Where the pictures hold nothing but a body, that is the actor. Else the floor is found and
    cut away, and the room is known from the frames without the actor, if some are named, or
    guessed from what was uncovered when the actor moved. What hangs together in space is a
    body; of several people the one of whom most is seen over the recording is the actor, and
    is followed.

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
        Nobody is seen, or a background is wanted without frames of the empty room.
    SolveCancelled
        Raised by `progress`.
    """
    frames = _looks(recording)
    way = _way(recording, settings, empty, frames)
    settings = replace(settings, way=way)
    floor, background = None, None
    if way is not ForegroundMethod.RECORDED:
        floor = find_floor(recording, progress=within(progress, 0.0, 0.1))
    if way is ForegroundMethod.BACKGROUND:
        background = learn_background(recording, empty, progress=within(progress, 0.1, 0.2))
    room = None
    if way is ForegroundMethod.AUTOMATIC:
        room = uncovered_background(recording, progress=within(progress, 0.1, 0.2))
    survey = _Survey(ActorImages(recording, settings, background, floor), room)
    people = _followed(survey, frames, recording, within(progress, 0.2, 1.0))
    seen = np.isfinite(people.course).all(axis=-1)
    if not seen.any():
        raise InvalidMotionError(_NOBODY)
    alone = cut_out_actor(
        recording, settings, background=background, floor=floor, course=people.course
    )
    remarks = (
        *check_intrinsics(recording.camera),
        *_remarks(people, seen, recording),
        *survey.remarks(),
    )
    return Actor(alone, floor, way, seen, not survey.cut_off(), remarks)


_NOBODY = (
    "Nobody is seen in this recording. Check scale and distances, name frames of the empty"
    " room, or let the actor move."
)


def _looks(recording: DepthRecording) -> NDArray[np.intp]:
    wanted = recording.n_frames / recording.frame_rate * LOOKS_PER_SECOND
    n_looks = int(np.clip(np.ceil(wanted), min(recording.n_frames, 12), MOST_LOOKS))
    n_looks = min(n_looks, recording.n_frames)
    return np.unique(np.linspace(0, recording.n_frames - 1, n_looks).round().astype(np.intp))


def _way(
    recording: DepthRecording,
    settings: ForegroundSettings,
    empty: Sequence[int],
    frames: NDArray[np.intp],
) -> ForegroundMethod:
    """Choose: as recorded, if little of the picture is filled, and that is one body."""
    if settings.way is not ForegroundMethod.AUTOMATIC:
        return settings.way
    if len(empty):
        return ForegroundMethod.BACKGROUND
    alone, step = [], _coarse_step(recording)
    for frame in frames[:: max(1, len(frames) // 12)].tolist():
        depth = recording.frame(frame)[::step, ::step]
        if not (depth > 0.0).any():
            continue
        found = find_bodies(depth, recording.camera.every(step), settings.smallest_body)
        shares = np.bincount(found.labels[depth > 0.0], minlength=2) / (depth > 0.0).sum()
        alone.append((depth > 0.0).mean() < FULL and 1.0 - shares[0] >= WHOLE)
    recorded = bool(alone) and np.mean(alone) > 0.5 and find_floor(recording) is None
    return ForegroundMethod.RECORDED if recorded else ForegroundMethod.AUTOMATIC


def _coarse_step(recording: DepthRecording) -> int:
    """Return of how many columns and rows one is enough to find bodies."""
    return max(1, recording.camera.width // COARSE_WIDTH)


class _Survey:
    """Looks at single frames for people, in coarse pictures."""

    def __init__(self, actor: ActorImages, room: Background | None) -> None:
        self._actor, self._room = actor, room
        self._step = _coarse_step(actor.recording)
        self._camera = actor.recording.camera.every(self._step)
        self._at_edge: list[bool] = []
        self._heights: list[float] = []

    def __call__(self, frame: int) -> Bodies:
        """Return the people in a frame: bodies of their size that are no furniture."""
        step, settings = self._step, self._actor.settings
        depth = self._actor.recording.frame(frame)[::step, ::step]
        depth = self._actor.stands_out(depth, step)
        found = find_bodies(depth, self._camera, settings.smallest_body)
        kept = np.ones(len(found.areas), dtype=bool)
        if settings.way is not ForegroundMethod.RECORDED:
            kept &= found.areas <= settings.largest_body
        if self._room is not None:
            room = Background(
                self._room.depth[::step, ::step], self._room.spread[::step, ::step]
            )
            nearer = in_front_of(depth, room, settings.before_background)
            for place in np.flatnonzero(kept):
                kept[place] = nearer[found.labels == place + 1].mean() >= MOVING
        if kept.any():
            first = int(np.argmax(kept)) + 1
            self._at_edge.append(bool((found.labels[-1] == first).mean() >= CUT_OFF))
            points = self._camera.back_project(depth)[found.labels == first]
            heights = (self._actor.floor or LEVEL).heights(points)
            self._heights.append(float(np.ptp(np.quantile(heights, [0.01, 0.99]))))
        return replace(found, areas=found.areas[kept], middles=found.middles[kept])

    def height(self) -> float:
        """Return how tall the largest body usually is where it is seen best, metres."""
        return float(np.quantile(self._heights, 0.9)) if self._heights else np.nan

    def cut_off(self) -> bool:
        """Whether the lower edge of the picture usually cut the largest body."""
        return bool(self._at_edge) and float(np.mean(self._at_edge)) > 0.5

    def remarks(self) -> list[str]:
        """Tell what is odd about the actor's body."""
        if self.cut_off():
            return ["The picture ends above the feet: legs are guessed or left out."]
        if TALL[0] <= self.height() <= TALL[1]:
            return []
        return [
            f"The actor would be {self.height():.1f} m tall: check the scale, and the focal"
            " length of the camera."
        ]


def _followed(
    survey: _Survey, frames: NDArray[np.intp], recording: DepthRecording, progress: Progress
) -> People:
    looked = 0

    def look(frame: int) -> Bodies:
        nonlocal looked
        looked += 1
        progress(looked / len(frames), "Looking for the actor")
        return survey(frame)

    return follow_people(look, frames, recording.n_frames, recording.frame_rate)


def _remarks(
    people: People, seen: NDArray[np.bool_], recording: DepthRecording
) -> tuple[str, ...]:
    remarks = []
    crowd = np.flatnonzero(people.n_bodies > 1)
    if len(crowd):
        first = people.frames[crowd[0]] / recording.frame_rate
        remarks.append(
            f"Up to {people.n_bodies.max()} people are seen, from {first:.1f} s on; the one of"
            " whom most is seen is taken."
        )
    if not seen.all():
        first = int(np.argmin(seen)) / recording.frame_rate
        remarks.append(
            f"Nobody is seen in {(~seen).sum()} of {len(seen)} frames, from {first:.1f} s on."
        )
    return tuple(remarks)
