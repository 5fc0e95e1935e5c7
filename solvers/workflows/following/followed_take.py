"""Measure an actor in the first images of a recording, and then track each image."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from time import monotonic
from typing import NamedTuple

import numpy as np

from ...depth_scene import Actor, CausalActor, DepthImage, ForegroundSettings
from ...depth_tracking.body import BodyModel, MotionPrior
from ...depth_tracking.capturing import Capture, CaptureSettings
from ...depth_tracking.following import LiveTracker, PoseDetector, assemble_followed
from ...depth_tracking.terms import DEFAULT_TRACKER, subsampling_step
from ...depth_tracking.tracking import PosePreview
from ...errors import InvalidMotionError
from ...progress import Progress, unwatched
from ...recordings.growing import GrowingDepth, ImagePositions, NewImage
from ..live import TimeSlots
from .measure_followed import measure_followed

TOO_EARLY = "The recording ended before the actor was measured. Track it when it is complete."


@dataclass(frozen=True, eq=False)
class TakeSettings:
    """What a take depends on, next to its images.

    Attributes
    ----------
    calibration_s : float, seconds
    capture : CaptureSettings
    foreground : ForegroundSettings
    body : BodyModel, optional
        By default it is fitted to the first images.
    motion_prior : MotionPrior, optional
    empty : range
        Images of the empty room.
    """

    calibration_s: float
    capture: CaptureSettings
    foreground: ForegroundSettings
    body: BodyModel | None = None
    motion_prior: MotionPrior | None = None
    empty: range = range(0)


class WaitingImage(NamedTuple):
    """An image that waits to be tracked."""

    image: NewImage
    came_at: float
    """Time at which it was found, seconds."""
    depth: DepthImage | None = None
    """Coarse; None if it was not read yet, or is not to be tracked."""
    is_left_out: bool = False
    """Whether it only has its time: it is damaged, or forgotten until the actor comes."""

    def left_out(self) -> "WaitingImage":
        """Return the image without its depth."""
        return self._replace(depth=None, is_left_out=True)


class FollowedTake:
    """Collects the first images, measures the actor in them, and tracks those after.

    Parameters
    ----------
    source : GrowingDepth
        Its first image is there.
    detector : PoseDetector
    settings : TakeSettings
    now : callable
        Returns seconds.
    """

    def __init__(
        self,
        source: GrowingDepth,
        detector: PoseDetector,
        settings: TakeSettings,
        *,
        now: Callable[[], float] = monotonic,
    ) -> None:
        assert source.camera is not None
        self._source, self._settings, self._detector = source, settings, detector
        self._now = now
        self._step = subsampling_step(source.camera, DEFAULT_TRACKER.image_width)
        self.camera = source.camera.every(self._step)
        """Of coarse images."""
        self._first: list[WaitingImage] = []
        self._started: _StartedFollowing | None = None
        self.fault = ""
        """Why the actor could not be measured yet."""

    @property
    def is_measured(self) -> bool:
        """Whether the actor is measured, so that images are tracked."""
        return self._started is not None

    @property
    def frame_rate(self) -> float:
        """Hertz; 0 before the actor is measured."""
        return 0.0 if self._started is None else self._started.frame_rate

    @property
    def actor(self) -> Actor:
        """The actor in the first images, which is measured."""
        assert self._started is not None
        return self._started.actor

    @property
    def detection_delays(self) -> tuple[int, ...]:
        """Number of frames from each request of a detection to its pose."""
        return () if self._started is None else tuple(self._started.tracker.delays)

    def coarse(self, image: DepthImage) -> DepthImage:
        """Return an image with about as many columns as the tracker uses."""
        return np.ascontiguousarray(image[:: self._step, :: self._step])

    def collect(self, image: WaitingImage) -> float:
        """Keep one of the first images, coarse; return which fraction of them is there."""
        self._first.append(image)
        wanted = self._settings.calibration_s * self._positions().frame_rate
        n_wanted = max(round(wanted), 2) + self._settings.empty.stop
        return len(self._with_depth()) / n_wanted

    def measure(self, progress: Progress = unwatched) -> list[WaitingImage]:
        """Return the first images, which are to be tracked, once the actor is measured in them.

        Without an actor none is returned, and more are needed; half of them are forgotten.
        """
        given, positions, there = self._settings, self._positions(), self._with_depth()
        try:
            actor, body = measure_followed(
                [each for _, each in there], self.camera, positions.frame_rate, given.body,
                empty=[index for index, (n, _) in enumerate(there) if n in given.empty],
                foreground=given.foreground, refine=given.capture.refine, progress=progress,
            )  # fmt: skip
        except InvalidMotionError as error:
            self.fault = str(error)
            self._forget([n for n, _ in there if n >= given.empty.stop])
            return []
        new_tracker = partial(
            LiveTracker, self.camera, positions.frame_rate, body, self._detector,
            given.motion_prior, recovery=given.capture,
        )  # fmt: skip
        first, self._first = self._first, []
        self._started = _StartedFollowing(
            actor, new_tracker, positions, first[0].image.position, self._now
        )
        return first

    def _with_depth(self) -> list[tuple[int, DepthImage]]:
        """Return the images to measure the actor in, with their numbers in the recording."""
        return [(n, each.depth) for n, each in enumerate(self._first) if each.depth is not None]

    def _forget(self, numbers: list[int]) -> None:
        """Forget the first half of these images; they keep their time."""
        for number in numbers[: max(len(numbers) // 2, 1)]:
            self._first[number] = self._first[number].left_out()

    def _positions(self) -> ImagePositions:
        there = [each for each in self._first if not each.is_left_out]
        return self._source.positions([each.image.position for each in there])

    def add(self, image: NewImage, depth: DepthImage) -> PosePreview | None:
        """Track the next image, coarse; return None before the first pose is detected."""
        assert self._started is not None
        return self._started.add(image, depth)

    def skip(self, image: NewImage) -> None:
        """Leave out the next image; the later ones keep their time."""
        assert self._started is not None
        self._started.number(image)

    def begin_again(self) -> None:
        """Forget the motion so far: it begins with the next image."""
        assert self._started is not None
        self._started.begin_again()

    def finish(self) -> tuple[int, Capture]:
        """Return the motion so far, and the frame of the recording at which it begins.

        Raises
        ------
        InvalidMotionError
            The actor was not measured, or no pose was tracked.
        """
        if self._started is None:
            raise InvalidMotionError(self.fault or TOO_EARLY)
        return self._started.finish(self._settings.capture)


class _StartedFollowing:
    """A take whose actor is measured."""

    def __init__(
        self,
        actor: Actor,
        new_tracker: Callable[..., LiveTracker],
        positions: ImagePositions,
        first_position: float,
        now: Callable[[], float],
    ) -> None:
        self.actor, self.frame_rate = actor, positions.frame_rate
        self._new_tracker = new_tracker
        self.tracker, self._causal_actor = new_tracker(), CausalActor(actor, from_start=True)
        self._seconds = positions.seconds_per_unit
        start = first_position * self._seconds - 1.0 / self.frame_rate
        self._slots = TimeSlots(start, self.frame_rate, now=now)
        self._n_images = 0
        self._previews: list[PosePreview] = []
        self._is_tracking = True

    def number(self, image: NewImage) -> int | None:
        """Return the number of the image's frame; None if another image has its time."""
        self._n_images += 1
        if not self._seconds:
            return self._n_images
        return self._slots.next(image.position * self._seconds)

    def begin_again(self) -> None:
        self.tracker = self._new_tracker(waits=False)
        self._causal_actor = CausalActor(self.actor)
        self._previews.clear()
        self._is_tracking = False

    def add(self, image: NewImage, depth: DepthImage) -> PosePreview | None:
        slot = self.number(image)
        if slot is None:
            return None
        self._is_tracking = True
        preview = self.tracker.update(slot - 1, self._causal_actor.cut_out(depth))
        if preview is not None:
            self._previews.append(preview)
        return preview

    def finish(self, settings: CaptureSettings) -> tuple[int, Capture]:
        if not self._is_tracking:
            raise InvalidMotionError(TOO_EARLY)
        return assemble_followed(
            self._previews, self.frame_rate, restarts=self.tracker.restarts,
            floor=self.actor.floor, settings=settings,
        )  # fmt: skip
