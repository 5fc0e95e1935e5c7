"""Segment the actor in depth images."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..errors import InvalidMotionError
from ..progress import Progress, unwatched
from ..settings import Choice, Settings, setting
from ..signals import MAD_TO_SIGMA
from .bodies import LabeledBodies, find_bodies
from .camera import Camera
from .floor import FloorPlane
from .recording import DepthImage, DepthRecording

MAX_BACKGROUND_FRAMES = 60
"""Number of images, evenly spaced, from which the background is learned. It bounds the
memory."""
NOISE_FACTOR = 4.0
"""Multiple of the sensor's noise, a standard deviation, that counts as significant. It guards
noisy walls, which would be in front of themselves; more misses an actor near them
(`test_noise_of_a_wall_is_no_actor_and_an_actor_near_it_is`)."""
NOISE_WINDOW_M = 0.5
"""Readings within this distance of the background depth count as its noise. It guards an actor
who stays in place: without it he is taken for noise, and half of his pixels are lost
(`test_actor_on_the_spot_is_no_noise_of_the_wall_behind_him`)."""
BACKGROUND_QUANTILE = 0.9
"""Quantile of a pixel's depths that shows the room behind a moving actor, a fraction. It guards
pixels that he covers in most frames; more takes stray readings behind a wall for the room
(`test_room_is_found_behind_long_stays_and_before_outliers`)."""
MAX_ACTOR_DISTANCE_M = 1.2
"""A body farther from the expected position of the actor is another person. It guards images in
which only another person is visible
(`test_person_far_from_where_the_actor_is_expected_is_not_the_actor`)."""


class ForegroundMethod(Choice):
    """Method that separates the actor from the room."""

    AUTOMATIC = (
        "automatic",
        "Detect what moves and remove the floor, unless the file has a mask",
    )
    """`RECORDED` if the image holds nothing else; otherwise moving pixels above the floor."""
    RECORDED = "recorded", "Treat everything in the recording as the actor", "From File"
    """The images contain only the actor."""
    CUT = "cut", "Keep what lies between two distances and above the floor", "Depth Range"
    """Between two distances and above the floor."""
    BACKGROUND = (
        "background",
        "Keep what is nearer than a recording of the empty room",
        "Empty-Room Frame",
    )
    """In front of the empty room."""


@dataclass(frozen=True, kw_only=True)
class ForegroundSettings(Settings):
    """Settings of the segmentation of the actor."""

    actor_mask: ForegroundMethod = setting(
        ForegroundMethod.AUTOMATIC,
        "Choose how to separate the actor from the background",
        label="Actor Mask",
        former="way",
    )
    min_distance: float = setting(
        0.3,
        "Remove points nearer to the camera than this",
        unit="m",
        minimum=0.0,
        maximum=50.0,
        label="Min Distance",
        former="nearest",
    )
    max_distance: float = setting(
        6.0,
        "Remove points farther from the camera than this",
        unit="m",
        minimum=0.1,
        maximum=50.0,
        label="Max Distance",
        former="farthest",
    )
    above_floor: float = setting(
        0.03, "Remove points below this height above the floor; higher cuts off feet",
        unit="m", minimum=0.0, maximum=1.0,
    )  # fmt: skip
    before_background: float = setting(
        0.05, "Remove points less than this far in front of the empty room; higher cuts off"
        " feet",
        unit="m", minimum=0.0, maximum=1.0, label="Front Margin",
    )  # fmt: skip
    min_body_area: float = setting(
        0.08, "Minimum visible surface of a person; higher misses partly hidden people",
        unit="m²", minimum=0.001, maximum=5.0, label="Min Body Area", former="smallest_body",
    )  # fmt: skip
    max_body_area: float = setting(
        2.0, "Maximum visible surface of a person; larger bodies count as walls",
        unit="m²", minimum=0.1, maximum=50.0, label="Max Body Area", former="largest_body",
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class Background:
    """The empty room.

    Attributes
    ----------
    depth : float32 array, shape (height, width), meters
        0: no reading.
    spread : float32 array, shape (height, width), meters
        Standard deviation of one reading.
    """

    depth: DepthImage
    spread: DepthImage


def learn_background(
    recording: DepthRecording, frames: Sequence[int], *, progress: Progress = unwatched
) -> Background:
    """Learn the empty room from frames without the actor: median and noise of each pixel.

    Raises InvalidMotionError without a frame.
    """
    if not len(frames):
        raise InvalidMotionError(
            "The empty room needs at least one frame. Select frames without the actor."
        )
    return _background_depth(recording, frames, 0.5, progress)


def uncovered_background(
    recording: DepthRecording, *, progress: Progress = unwatched
) -> Background:
    """Estimate the room from frames with the actor, by a high depth quantile of each pixel.

    Pixels that the actor never uncovers are misclassified as room.
    """
    return _background_depth(
        recording, range(recording.n_frames), BACKGROUND_QUANTILE, progress
    )


def _background_depth(
    recording: DepthRecording, frames: Sequence[int], quantile: float, progress: Progress
) -> Background:
    chosen = np.linspace(0, len(frames) - 1, min(len(frames), MAX_BACKGROUND_FRAMES)).round()
    images = []
    for count, index in enumerate(chosen.astype(int).tolist()):
        images.append(recording.frame(frames[index]))
        progress((count + 1) / len(chosen), "Learning the empty room")
    readings = np.stack(images)
    is_frequent = (readings > 0.0).sum(axis=0) > (1.0 - quantile) * len(images)
    readings = np.where(is_frequent & (readings > 0.0), readings, np.nan)
    depth = _nan_quantile(readings, quantile)
    near = np.where(np.abs(readings - depth) < NOISE_WINDOW_M, readings, np.nan)
    deviations = np.abs(near - _nan_quantile(near, 0.5))
    spread = MAD_TO_SIGMA * _nan_quantile(deviations, 0.5)
    return Background(np.nan_to_num(depth), np.nan_to_num(spread))


def _nan_quantile(values: DepthImage, quantile: float) -> DepthImage:
    """Return a quantile along the first axis, ignoring NaN; NaN if all values are NaN."""
    ordered = np.sort(values, axis=0)
    last = np.maximum(np.isfinite(values).sum(axis=0) - 1, 0)
    position = quantile * last
    below = np.floor(position).astype(np.intp)[np.newaxis]
    above = np.minimum(below + 1, last)
    lower, upper = (np.take_along_axis(ordered, each, axis=0)[0] for each in (below, above))
    result: DepthImage = (lower + (position - below[0]) * (upper - lower)).astype(np.float32)
    return result


@dataclass(frozen=True, eq=False)
class ActorImages:
    """Reader of depth images of the actor alone, for `DepthRecording.read_depth`.

    Attributes
    ----------
    recording : DepthRecording
    settings : ForegroundSettings
    background : Background, or None
        Pixels that are not in front of it are removed.
    floor : FloorPlane, or None
        Pixels that are not above it are removed.
    trajectory : float array, shape (n_frames, 3), meters, or None
        Expected position of the actor; NaN while the actor is missing. Without it the body
        with the largest surface is the actor.
    """

    recording: DepthRecording
    settings: ForegroundSettings
    background: Background | None = None
    floor: FloorPlane | None = None
    trajectory: Array | None = None

    def __call__(self, index: int) -> DepthImage:
        """Return the depth of the actor in a frame, meters; 0 elsewhere."""
        if self.trajectory is not None and np.isnan(self.trajectory[index]).any():
            return np.zeros((self.recording.camera.height, self.recording.camera.width), "f4")
        depth = self.foreground(self.recording.frame(index))
        bodies = find_bodies(depth, self.recording.camera, self.settings.min_body_area)
        label = self._label(bodies, index)
        return np.where(bodies.mask(label), depth, np.float32(0.0)) if label else 0.0 * depth

    def _label(self, bodies: LabeledBodies, index: int) -> int:
        """Return the label of the actor's body, 0 for none."""
        candidates = np.flatnonzero(bodies.areas <= self._max_area)
        if not len(candidates):
            return 0
        if self.trajectory is None:
            return int(candidates[0]) + 1
        distances = np.linalg.norm(bodies.centers[candidates] - self.trajectory[index], axis=-1)
        nearest = int(np.argmin(distances))
        return int(candidates[nearest]) + 1 if distances[nearest] <= MAX_ACTOR_DISTANCE_M else 0

    @property
    def _max_area(self) -> float:
        recorded = self.settings.actor_mask is ForegroundMethod.RECORDED
        return np.inf if recorded else self.settings.max_body_area

    def foreground(self, depth: DepthImage, step: int = 1) -> DepthImage:
        """Return the depth image without background; every `step`-th column and row."""
        settings = self.settings
        if settings.actor_mask is ForegroundMethod.RECORDED:
            return depth
        mask = (depth >= settings.min_distance) & (depth <= settings.max_distance)
        if self.background is not None:
            room = Background(
                self.background.depth[::step, ::step], self.background.spread[::step, ::step]
            )
            mask &= is_in_front(depth, room, settings.before_background)
        if self.floor is not None:
            camera = self.recording.camera.every(step)
            mask &= above_floor_mask(depth, camera, self.floor, settings.above_floor)
        return np.where(mask, depth, np.float32(0.0))


def cut_out_actor(
    recording: DepthRecording,
    settings: ForegroundSettings = ForegroundSettings(actor_mask=ForegroundMethod.CUT),
    *,
    background: Background | None = None,
    floor: FloorPlane | None = None,
    trajectory: Array | None = None,
) -> DepthRecording:
    """Return the recording with only the actor in it, still read frame by frame.

    Frames without a sufficiently large body become empty. `find_actor` chooses the arguments
    automatically and reports its observations.

    The parameters are the attributes of `ActorImages`.

    Raises
    ------
    InvalidMotionError
        The background is missing, or of another size.
    """
    size = (recording.camera.height, recording.camera.width)
    needs_background = settings.actor_mask is ForegroundMethod.BACKGROUND
    if (needs_background and background is None) or (
        background is not None and background.depth.shape != size
    ):
        raise InvalidMotionError(
            f"The background method needs an image of the empty room of {size[1]} x {size[0]}"
            " pixels. Select frames without the actor."
        )
    return replace(
        recording, read_depth=ActorImages(recording, settings, background, floor, trajectory)
    )


def is_in_front(depth: DepthImage, background: Background, margin: float) -> NDArray[np.bool_]:
    """Return the pixels, (height, width), before the empty room by `margin`, m, and noise."""
    spread = NOISE_FACTOR * background.spread
    is_unknown = background.depth == 0.0
    is_nearer = depth < background.depth - np.maximum(margin, spread)
    return np.asarray((depth > 0.0) & (is_unknown | is_nearer))


def above_floor_mask(
    depth: DepthImage, camera: Camera, floor: FloorPlane, min_height: float
) -> NDArray[np.bool_]:
    """Return the pixels, (height, width), more than `min_height` meters above the floor."""
    return np.asarray(depth * _upward_rays(camera, tuple(floor.up)) + floor.height > min_height)


@lru_cache(maxsize=4)
def _upward_rays(camera: Camera, up: tuple[float, ...]) -> DepthImage:
    """Return the rise of each pixel's ray per meter of depth, meters."""
    upward: DepthImage = (camera.rays() @ np.array(up)).astype(np.float32)
    return upward
