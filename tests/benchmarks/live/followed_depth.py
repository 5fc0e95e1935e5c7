"""Depth images tracked while they are written, with the detector in another process and not.

The clock is made: it advances by the processor time of the tracker, and stands still while the
detector works in its own process, whose result is ready after the processor time that it took.
So figures do not depend on what else the machine does.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from time import process_time

import numpy as np

from solvers.depth_scene.camera import Camera
from solvers.depth_scene.recording import DepthImage, DepthRecording
from solvers.depth_tracking.capturing import CaptureSettings, capture
from solvers.depth_tracking.following import (
    DelayedDetector,
    Detection,
    DetectionRequest,
    PoseDetector,
    detect_in_image,
)
from solvers.depth_tracking.forest import PixelForest, load_pixel_forest
from solvers.processes import worker_pool
from solvers.recordings.growing import ImagePositions, NewImage
from solvers.workflows.following import Clock, FollowedMotion, FollowSettings, follow_depth

from ..depth.depth_sequences import SCORED, errors, sequence
from ..shared.tables import Scores

N_PLAYS = 2
"""Number of times that a sequence is played, forward and backward by turns: it is short."""
STEP = 2
"""Columns and rows from one pixel of the camera to the next: 160 x 120 of 320 x 240."""
NAMES = SCORED[:3]
"""Sequences: the first ones of `SCORED`, in a process each. It bounds the run time."""
SETTINGS = FollowSettings(calibration=0.5, max_silence=0.5)
READ_S = 0.0007
"""Seconds in which a PNG image of this size is read: a median of 50."""
FORWARD = CaptureSettings(backward=False, smoothing=0.0)


@dataclass
class MadeClock:
    """Seconds of processor time, and of sleep."""

    offset: float = field(default_factory=lambda: -process_time())

    def now(self) -> float:
        """Return the time."""
        return self.offset + process_time()

    def sleep(self, seconds: float) -> None:
        """Let time pass."""
        self.offset += seconds


class MadeRecorder:
    """Writes an image at each thirtieth of a second of a clock."""

    is_gone, issue = False, ""

    def __init__(self, camera: Camera, images: Sequence[DepthImage], clock: MadeClock) -> None:
        self.camera, self._images, self._clock = camera, images, clock
        self._start, self._n_read = clock.now(), 0

    def poll(self) -> list[NewImage]:
        """Return the images that were written since the last call."""
        n_written = int((self._clock.now() - self._start) * 30.0)
        new = range(self._n_read, min(n_written, len(self._images)))
        self._n_read = max(self._n_read, new.stop)
        return [NewImage(str(each), each, self._start + (each + 1) / 30.0) for each in new]

    def read(self, image: NewImage) -> DepthImage:
        """Return an image after the time that its file takes."""
        self._clock.sleep(READ_S)
        return self._images[int(image.position)]

    def positions(self, positions: Sequence[float]) -> ImagePositions:
        """Return the rate."""
        return ImagePositions(30.0, 1.0 / 30.0)

    def remarks(self) -> tuple[str, ...]:
        """Return nothing: all images are in order."""
        return ()


class DetectorNextDoor:
    """A detector in another process, by a made clock."""

    issue = ""

    def __init__(self, forest: PixelForest, clock: MadeClock) -> None:
        self._forest, self._clock = forest, clock
        self._detection: Detection | None = None
        self._ready_at = 0.0

    @property
    def is_idle(self) -> bool:
        """Whether it accepts a request."""
        return self._detection is None

    def request(self, request: DetectionRequest) -> None:
        """Detect a pose in no time, for the tracker."""
        began = process_time()
        self._detection = detect_in_image(request, self._forest)
        took = process_time() - began
        self._clock.sleep(-took)
        self._ready_at = self._clock.now() + took

    def wait(self) -> None:
        """Let time pass until the detection is ready."""
        if self._detection is not None:
            self._clock.sleep(max(self._ready_at - self._clock.now(), 0.0))

    def poll(self) -> Detection | None:
        """Return the detection once it is ready."""
        if self._detection is None or self._clock.now() < self._ready_at:
            return None
        detection, self._detection = self._detection, None
        return detection


def followed() -> Scores:
    """Follow the sequences with known lengths, and capture the same images offline."""
    scores = Scores(
        "Depth tracked while it is written, 160 x 120 at 30 Hz",
        f"{len(NAMES)} sequences as clips; lengths known",
        "",
    )
    with worker_pool(len(NAMES)) as pool:
        results = list(pool.map(_compared, NAMES))
    for name, compared in zip(NAMES, results, strict=True):
        for method, figures in compared.items():
            for column, figure in figures.items():
                scores.add(method, column, name, figure)
    return scores


def _compared(name: str) -> dict[str, dict[str, float]]:
    return dict(_compare(name))


def _compare(name: str) -> Iterator[tuple[str, dict[str, float]]]:
    one = sequence(name)
    forth = range(one.depth.n_frames)
    frames = [each for n in range(N_PLAYS) for each in (forth if n % 2 == 0 else forth[::-1])]
    images = [np.ascontiguousarray(one.depth.frame(each)[::STEP, ::STEP]) for each in forth]
    played, truth = [images[each] for each in frames], one.joints[frames]
    camera, forest = one.depth.camera.every(STEP), load_pixel_forest()
    for method in ("detector in a second process", "detector in the tracker's process"):
        clock = MadeClock()
        detector: PoseDetector = DetectorNextDoor(forest, clock)
        if "second" not in method:
            detector = DelayedDetector(forest)
        found = follow_depth(
            MadeRecorder(camera, played, clock), detector, one.body, settings=SETTINGS,
            clock=Clock(clock.now, clock.now, clock.sleep),
        )  # fmt: skip
        yield method, _figures(found, truth)
    recording = DepthRecording(camera, len(frames), 30.0, played.__getitem__)
    for method, settings in (
        ("offline, forward only", FORWARD), ("offline, complete", CaptureSettings()),
    ):  # fmt: skip
        captured = capture(recording, one.body, settings=settings)
        off = errors(captured.joints.positions, truth).figures()
        yield method, {"cm": off["cm"], "% < 10 cm": off["% < 10 cm"],
                       "restarts": float(len(captured.restarts))}  # fmt: skip


def _figures(found: FollowedMotion, truth: np.ndarray) -> dict[str, float]:
    delays = 1000.0 * found.delays
    joints = found.captured.joints.positions
    off = errors(joints, truth[found.first : found.first + len(joints)]).figures()
    n_frames, confidence = found.motion.n_frames, found.captured.joints.confidence
    assert confidence is not None
    n_tracked = int(confidence.any(axis=1).sum())
    return {
        "cm": off["cm"],
        "% < 10 cm": off["% < 10 cm"],
        "restarts": float(len(found.captured.restarts)),
        "frames tracked/s": 30.0 * n_tracked / n_frames,
        "dropped, %": 100.0 * found.n_dropped / n_frames,
        "delay, ms": float(np.median(delays)),
        "95th percentile, ms": float(np.percentile(delays, 95)),
    }
