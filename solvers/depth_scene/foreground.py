"""Cut the actor out of pictures of depth."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..progress import Progress, unwatched
from ..settings import Choice, Settings, setting
from .bodies import Bodies, find_bodies
from .camera import Camera
from .floor import Floor
from .recording import DepthPicture, DepthRecording

Array = NDArray[np.float64]

MOST_EMPTY_FRAMES = 60
LEAST_SPREAD, SPREADS = 0.01, 4.0
"""Metres by which every sensor trembles, and how many spreads are no coincidence."""
FROM_DEVIATION = 1.4826
"""Of the median absolute deviation to the standard deviation, for Gaussian noise."""
AROUND = 0.5
"""Metres around the usual depth in which a reading trembles; farther off it is another one."""
FARTHER = 0.9
"""Quantile of a pixel's depths at which it usually saw the room behind a moving actor."""
ASTRAY = 1.2
"""Metres from where the actor was expected, beyond which a body is someone else."""


class ForegroundWay(Choice):
    """How the actor is told from the room."""

    AUTOMATIC = (
        "automatic",
        "Detect what moves and remove the floor, unless the file has a mask",
    )
    """As recorded where nothing else is in the picture; else what moves, without the floor."""
    RECORDED = "recorded", "Treat everything in the recording as the actor", "From File"
    """All that the pictures hold is the actor."""
    CUT = "cut", "Keep what lies between two distances and above the floor", "Depth Range"
    """Between two distances and above the floor."""
    BACKGROUND = (
        "background",
        "Keep what is nearer than a recording of the empty room",
        "Empty-Room Frame",
    )
    """Nearer than the empty room."""


@dataclass(frozen=True, kw_only=True)
class ForegroundSettings(Settings):
    """What may belong to the actor."""

    way: ForegroundWay = setting(
        ForegroundWay.AUTOMATIC,
        "How the actor is separated from the background",
        label="Actor Mask",
    )
    nearest: float = setting(
        0.3,
        "Remove points nearer to the camera than this",
        unit="m",
        minimum=0.0,
        maximum=50.0,
        label="Min Distance",
    )
    farthest: float = setting(
        6.0,
        "Remove points farther from the camera than this",
        unit="m",
        minimum=0.1,
        maximum=50.0,
        label="Max Distance",
    )
    above_floor: float = setting(
        0.03, "Remove points lower above the floor; higher cuts off feet",
        unit="m", minimum=0.0, maximum=1.0,
    )  # fmt: skip
    before_background: float = setting(
        0.05, "Remove points less far in front of the empty room; higher cuts off feet",
        unit="m", minimum=0.0, maximum=1.0,
    )  # fmt: skip
    smallest_body: float = setting(
        0.08, "Minimum visible surface of a person; higher misses partly hidden people",
        unit="m²", minimum=0.001, maximum=5.0, label="Min Body Area",
    )  # fmt: skip
    largest_body: float = setting(
        2.0, "Maximum visible surface of a person; larger bodies count as walls",
        unit="m²", minimum=0.1, maximum=50.0, label="Max Body Area",
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Background:
    """The empty room.

    Attributes
    ----------
    depth : float32 array, shape (height, width), metres
        0 where nothing was seen.
    spread : float32 array, shape (height, width), metres
        Standard deviation of one reading.
    """

    depth: DepthPicture
    spread: DepthPicture


def learn_background(
    recording: DepthRecording, frames: Sequence[int], *, progress: Progress = unwatched
) -> Background:
    """Learn the empty room from frames without the actor: per pixel the median and the spread.

    Raises InvalidMotionError without a frame.
    """
    if not len(frames):
        raise InvalidMotionError(
            "The empty room cannot be learned from no frame at all. Name frames without the"
            " actor."
        )
    return _usual_room(recording, frames, 0.5, progress)


def uncovered_background(
    recording: DepthRecording, *, progress: Progress = unwatched
) -> Background:
    """Guess the room from frames with the actor: each pixel as far as it was in some of them.

    Where the actor never leaves, the actor is taken for the room.
    """
    return _usual_room(recording, range(recording.n_frames), FARTHER, progress)


def _usual_room(
    recording: DepthRecording, frames: Sequence[int], quantile: float, progress: Progress
) -> Background:
    chosen = np.linspace(0, len(frames) - 1, min(len(frames), MOST_EMPTY_FRAMES)).round()
    pictures = []
    for place, index in enumerate(chosen.astype(int).tolist()):
        pictures.append(recording.frame(frames[index]))
        progress((place + 1) / len(chosen), "Learning the empty room")
    seen = np.stack(pictures)
    often = (seen > 0.0).sum(axis=0) > (1.0 - quantile) * len(pictures)
    seen = np.where(often & (seen > 0.0), seen, np.nan)
    depth = _quantile_seen(seen, quantile)
    around = np.where(np.abs(seen - depth) < AROUND, seen, np.nan)
    off = np.abs(around - _quantile_seen(around, 0.5))
    spread = FROM_DEVIATION * _quantile_seen(off, 0.5)
    return Background(np.nan_to_num(depth), np.nan_to_num(spread))


def _quantile_seen(values: DepthPicture, quantile: float) -> DepthPicture:
    """Return a quantile along the first axis of what is not NaN; NaN where all is."""
    ordered = np.sort(values, axis=0)
    last = np.maximum(np.isfinite(values).sum(axis=0) - 1, 0)
    at = quantile * last
    below = np.floor(at).astype(np.intp)[np.newaxis]
    above = np.minimum(below + 1, last)
    one, other = (np.take_along_axis(ordered, each, axis=0)[0] for each in (below, above))
    mixed: DepthPicture = (one + (at - below[0]) * (other - one)).astype(np.float32)
    return mixed


@dataclass(frozen=True, eq=False)
class ActorPictures:
    """Reads pictures of the actor alone; to be `DepthRecording.read_depth`.

    Attributes
    ----------
    recording : DepthRecording
    settings : ForegroundSettings
    background : Background, or None
        What is not in front of it is cut away.
    floor : Floor, or None
        What is not above it is cut away.
    course : float array, shape (n_frames, 3), metres, or None
        Where the actor is expected; NaN where the actor has left. Without it the body with the
        largest surface is the actor.
    """

    recording: DepthRecording
    settings: ForegroundSettings
    background: Background | None = None
    floor: Floor | None = None
    course: Array | None = None

    def __call__(self, index: int) -> DepthPicture:
        """Return the depth of the actor in a frame, metres; 0 elsewhere."""
        if self.course is not None and np.isnan(self.course[index]).any():
            return np.zeros((self.recording.camera.height, self.recording.camera.width), "f4")
        depth = self.stands_out(self.recording.frame(index))
        found = find_bodies(depth, self.recording.camera, self.settings.smallest_body)
        label = self._label(found, index)
        return np.where(found.mask(label), depth, np.float32(0.0)) if label else 0.0 * depth

    def _label(self, found: Bodies, index: int) -> int:
        """Return which of the bodies is the actor, 0 for none."""
        fitting = np.flatnonzero(found.areas <= self._largest)
        if not len(fitting):
            return 0
        if self.course is None:
            return int(fitting[0]) + 1
        apart = np.linalg.norm(found.middles[fitting] - self.course[index], axis=-1)
        nearest = int(np.argmin(apart))
        return int(fitting[nearest]) + 1 if apart[nearest] <= ASTRAY else 0

    @property
    def _largest(self) -> float:
        recorded = self.settings.way is ForegroundWay.RECORDED
        return np.inf if recorded else self.settings.largest_body

    def stands_out(self, depth: DepthPicture, step: int = 1) -> DepthPicture:
        """Return a picture without what is no actor; of every `step`-th column and row."""
        settings = self.settings
        if settings.way is ForegroundWay.RECORDED:
            return depth
        kept = (depth >= settings.nearest) & (depth <= settings.farthest)
        if self.background is not None:
            room = Background(
                self.background.depth[::step, ::step], self.background.spread[::step, ::step]
            )
            kept &= in_front_of(depth, room, settings.before_background)
        if self.floor is not None:
            camera = self.recording.camera.every(step)
            kept &= above(depth, camera, self.floor, settings.above_floor)
        return np.where(kept, depth, np.float32(0.0))


def cut_out_actor(
    recording: DepthRecording,
    settings: ForegroundSettings = ForegroundSettings(way=ForegroundWay.CUT),
    *,
    background: Background | None = None,
    floor: Floor | None = None,
    course: Array | None = None,
) -> DepthRecording:
    """Return the recording with nothing but the actor in it; still read frame by frame.

    A frame in which there is no body large enough becomes empty. `find_actor` chooses what is
    given here, and tells what it saw.

    Parameters are the attributes of `ActorPictures`.

    Raises
    ------
    InvalidMotionError
        The background is missing, or of another size.
    """
    size = (recording.camera.height, recording.camera.width)
    wanted = settings.way is ForegroundWay.BACKGROUND
    if (wanted and background is None) or (
        background is not None and background.depth.shape != size
    ):
        raise InvalidMotionError(
            f"The actor cannot be told from the empty room without its picture of {size[1]} x"
            f" {size[0]} pixels. Name frames without the actor."
        )
    return replace(
        recording, read_depth=ActorPictures(recording, settings, background, floor, course)
    )


def in_front_of(
    depth: DepthPicture, background: Background, margin: float
) -> NDArray[np.bool_]:
    """Tell which pixels see something in front of the empty room, by more than its noise."""
    spread = SPREADS * np.maximum(background.spread, LEAST_SPREAD)
    unknown = background.depth == 0.0
    nearer = depth < background.depth - np.maximum(margin, spread)
    return np.asarray((depth > 0.0) & (unknown | nearer))


def above(depth: DepthPicture, camera: Camera, floor: Floor, least: float) -> NDArray[np.bool_]:
    """Tell which pixels see something at least so high above the floor, in metres."""
    return np.asarray(depth * _rise(camera, tuple(floor.up)) + floor.height > least)


@lru_cache(maxsize=4)
def _rise(camera: Camera, up: tuple[float, ...]) -> DepthPicture:
    """Return how far each pixel's ray goes up in a metre of depth, metres."""
    rise: DepthPicture = (camera.rays() @ np.array(up)).astype(np.float32)
    return rise
