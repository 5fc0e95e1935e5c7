"""Detectors that are given an image and asked for the pose in it later."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from ...arrays import Array
from ...depth_scene import Camera, DepthImage, DepthRecording
from ..body import BodyModel
from ..capturing import RecoverySettings, TrackingContext
from ..forest import PixelForest
from ..terms import TrackerSettings
from ..tracking import FitQuality


@dataclass(frozen=True, eq=False)
class DetectionRequest:
    """An image in which to detect a body; picklable.

    Attributes
    ----------
    image : DepthImage
        Contains only the actor.
    camera : Camera
    body : BodyModel
    tracker : TrackerSettings
        Of the refinement.
    """

    image: DepthImage
    camera: Camera
    body: BodyModel
    tracker: TrackerSettings


class Detection(NamedTuple):
    """The answer to a request."""

    found: tuple[Array, FitQuality] | None
    """Pose (36,) and its fit quality; None without a person."""


class PoseDetector(Protocol):
    """Detects poses, one at a time."""

    @property
    def issue(self) -> str:
        """Why it does not work any more; empty if it does."""

    @property
    def is_idle(self) -> bool:
        """Whether it accepts a request."""

    def request(self, request: DetectionRequest) -> None:
        """Begin to detect a pose."""

    def wait(self) -> None:
        """Wait until it accepts a request, or its detection is ready."""

    def poll(self) -> Detection | None:
        """Return the detection once it is ready, and only once; None before."""


class DelayedDetector:
    """Detects poses in this process, and returns each after a given number of polls.

    With a delay of 0 the pose is there in the frame that requests it, as in `capture`. Delays
    that a detector of another process had give the same result again.

    Parameters
    ----------
    forest : PixelForest
    delays : sequence of int
        Number of polls without a result, for each request; the last one repeats.
    """

    def __init__(self, forest: PixelForest, delays: Sequence[int] = (0,)) -> None:
        self._forest, self._delays = forest, delays
        self._n_requests, self._n_polls = 0, 0
        self._detection: Detection | None = None
        self.issue = ""

    @property
    def is_idle(self) -> bool:
        """Whether it accepts a request."""
        return self._detection is None

    def request(self, request: DetectionRequest) -> None:
        """Detect a pose."""
        self._detection = detect_in_image(request, self._forest)
        self._n_polls = self._delays[min(self._n_requests, len(self._delays) - 1)]
        self._n_requests += 1

    def wait(self) -> None:
        """Skip the delay."""
        self._n_polls = 0

    def poll(self) -> Detection | None:
        """Return the detection once its delay is over; None before."""
        if self._detection is None:
            return None
        if self._n_polls:
            self._n_polls -= 1
            return None
        detection, self._detection = self._detection, None
        return detection


def detect_in_image(request: DetectionRequest, forest: PixelForest) -> Detection:
    """Return the detected pose in an image, refined by the tracker."""
    image = DepthRecording(request.camera, 1, 1.0, lambda _: request.image)
    context = TrackingContext(image, request.body, forest, request.tracker, RecoverySettings())
    return Detection(context.detected(0))
