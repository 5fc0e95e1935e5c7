"""Cut the actor out of pictures of depth."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import Enum

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..progress import Progress, unwatched
from ..settings import Settings, setting
from .camera import Camera
from .depth_bodies import find_bodies
from .depth_floor import Floor
from .depth_recording import DepthPicture, DepthRecording

MOST_EMPTY_FRAMES = 60
LEAST_SPREAD, SPREADS = 0.01, 4.0
"""Metres by which every sensor trembles, and how many spreads are no coincidence."""
FROM_DEVIATION = 1.4826
"""Of the median absolute deviation to the standard deviation, for Gaussian noise."""


class ForegroundWay(Enum):
    """How the actor is told from the room."""

    RECORDED = "recorded"
    """All that the pictures hold is the actor."""
    CUT = "cut"
    """Between two distances and above the floor."""
    BACKGROUND = "background"
    """Nearer than the empty room."""


@dataclass(frozen=True, kw_only=True)
class ForegroundSettings(Settings):
    """What may belong to the actor."""

    nearest: float = setting(
        0.3, "What is nearer to the camera is cut away", unit="m", minimum=0.0, maximum=50.0
    )
    farthest: float = setting(
        5.0, "What is farther from the camera is cut away", unit="m", minimum=0.1, maximum=50.0
    )
    above_floor: float = setting(
        0.03, "What is lower above the floor is cut away; more cuts off feet",
        unit="m", minimum=0.0, maximum=1.0,
    )  # fmt: skip
    before_background: float = setting(
        0.05, "What is less in front of the empty room is cut away; more cuts off feet",
        unit="m", minimum=0.0, maximum=1.0,
    )  # fmt: skip
    smallest_body: float = setting(
        0.08, "Seen surface of the smallest body that is taken for a person; more overlooks"
        " persons of whom little is seen", unit="m²", minimum=0.001, maximum=5.0,
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
        raise InvalidMotionError("The empty room needs at least one frame without the actor.")
    chosen = np.linspace(0, len(frames) - 1, min(len(frames), MOST_EMPTY_FRAMES)).round()
    pictures = []
    for place, index in enumerate(chosen.astype(int).tolist()):
        pictures.append(recording.frame(frames[index]))
        progress((place + 1) / len(chosen), "Learning the empty room")
    seen = np.stack(pictures)
    often = (seen > 0.0).sum(axis=0) * 2 > len(pictures)
    seen = np.where(often & (seen > 0.0), seen, np.nan)
    seen[:, ~often] = 0.0
    depth = np.nanmedian(seen, axis=0)
    spread = FROM_DEVIATION * np.nanmedian(np.abs(seen - depth), axis=0)
    return Background(depth.astype(np.float32), spread.astype(np.float32))


def cut_out_actor(
    recording: DepthRecording,
    settings: ForegroundSettings = ForegroundSettings(),
    *,
    way: ForegroundWay = ForegroundWay.CUT,
    background: Background | None = None,
    floor: Floor | None = None,
) -> DepthRecording:
    """Return the recording with nothing but the actor in it; still read frame by frame.

    Of several bodies the one with the largest surface is taken. A frame in which there is no
    body large enough becomes empty.

    Parameters
    ----------
    recording : DepthRecording
    settings : ForegroundSettings
    way : ForegroundWay
    background : Background, for ForegroundWay.BACKGROUND
    floor : Floor, optional
        Cut away too, if given.

    Raises
    ------
    InvalidMotionError
        The background is missing, or of another size.
    """
    size = (recording.camera.height, recording.camera.width)
    if way is ForegroundWay.BACKGROUND and (
        background is None or background.depth.shape != size
    ):
        raise InvalidMotionError(
            f"The actor cannot be told from the empty room without its picture of {size[1]} x"
            f" {size[0]} pixels. Name frames without the actor."
        )
    known = background if way is ForegroundWay.BACKGROUND else None
    cut = ActorPictures(recording, settings, way, known, floor)
    return replace(recording, read_depth=cut)


@dataclass(frozen=True, eq=False)
class ActorPictures:
    """Reads pictures of the actor alone; to be `DepthRecording.read_depth`."""

    recording: DepthRecording
    settings: ForegroundSettings
    way: ForegroundWay
    background: Background | None
    floor: Floor | None

    def __call__(self, index: int) -> DepthPicture:
        """Return the depth of the actor in a frame, metres; 0 elsewhere."""
        depth = self.recording.frame(index)
        if self.way is not ForegroundWay.RECORDED:
            depth = np.where(self._stands_out(depth), depth, np.float32(0.0))
        found = find_bodies(depth, self.recording.camera, self.settings.smallest_body)
        return np.where(found.labels == 1, depth, np.float32(0.0))

    def _stands_out(self, depth: DepthPicture) -> NDArray[np.bool_]:
        settings = self.settings
        kept = (depth >= settings.nearest) & (depth <= settings.farthest)
        if self.background is not None:
            kept &= in_front_of(depth, self.background, settings.before_background)
        if self.floor is not None:
            kept &= above(depth, self.recording.camera, self.floor, settings.above_floor)
        return kept


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
    return np.asarray(floor.heights(camera.back_project(depth)) > least)
