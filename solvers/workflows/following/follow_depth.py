"""Track a depth recording while a recorder writes it."""

from collections import deque
from collections.abc import Callable, Iterator

import numpy as np

from ...denoising import PlantSettings
from ...depth_scene import DepthImage, ForegroundSettings
from ...depth_tracking.body import BodyModel, MotionPrior, load_motion_prior
from ...depth_tracking.capturing import CaptureSettings, check_default_method
from ...depth_tracking.following import PoseDetector
from ...depth_tracking.tracking import PoseCallback, ignore_pose
from ...errors import InvalidMotionError
from ...progress import Progress, unwatched
from ...recordings.growing import GrowingDepth
from ..depth_capture import capture_remarks
from ..planting import plant_feet_if_possible
from .clock import SYSTEM_CLOCK, Clock
from .follow_settings import FollowSettings
from .follow_state import FollowState, StateCallback, ignore_state
from .followed_motion import FollowedMotion
from .followed_take import TOO_EARLY, FollowedTake, TakeSettings, WaitingImage

MIN_SILENCE_S = 1.0
"""Seconds without an image from which the progress says so. It guards the numbers of what is
tracked, which would flicker between two images."""
POLL_INTERVAL_S = 0.004
"""Seconds between two looks at the recording. It bounds the delay, and the processor's load."""
COUNT_CYCLE = 100
"""Number of images after which the progress begins again: how many come is unknown."""
FOLLOW_SETTINGS, CAPTURE_SETTINGS = FollowSettings(), CaptureSettings()
FOREGROUND_SETTINGS = ForegroundSettings()


def never() -> bool:
    """Return that following should not end yet."""
    return False


def follow_depth(
    source: GrowingDepth,
    detector: PoseDetector,
    body: BodyModel | None = None,
    *,
    motion_prior: MotionPrior | None = None,
    empty: range = range(0),
    settings: FollowSettings = FOLLOW_SETTINGS,
    capture: CaptureSettings = CAPTURE_SETTINGS,
    foreground: ForegroundSettings = FOREGROUND_SETTINGS,
    planting: PlantSettings | None = None,
    on_pose: PoseCallback = ignore_pose,
    on_state: StateCallback = ignore_state,
    is_ended: Callable[[], bool] = never,
    clock: Clock = SYSTEM_CLOCK,
    progress: Progress = unwatched,
) -> FollowedMotion:
    """Track the actor of a depth recording while it is written, until nothing more comes.

    The actor is measured in the first images. Then each image is tracked when it is there,
    from those before it alone. Images that wait too long are dropped while newer ones come.
    Poses between tracked ones are interpolated, with confidence 0.

    Parameters
    ----------
    source : GrowingDepth
    detector : PoseDetector
    body : BodyModel, optional
        By default it is fitted to the first images.
    motion_prior : MotionPrior, optional
        Default: the shipped motions if `capture.recorded`, otherwise none.
    empty : range
        Images of the empty room.
    settings : FollowSettings
    capture : CaptureSettings
        `backward` and `smoothing` need later images and have no effect.
    foreground : ForegroundSettings
    planting : PlantSettings, optional
        None skips planting; so does a depth image that ends above the feet.
    on_pose : PoseCallback
        Called with each pose as soon as it is tracked.
    on_state : StateCallback
        Called after each image, also before the actor is measured.
    is_ended : callable
        Returns whether to end now; the motion so far is kept.
    clock : Clock
    progress : Progress
        While images come, the fraction does not rise.

    Raises
    ------
    InvalidMotionError
        No image came, or no person was detected.
    InvalidFileError
        The images are no depth, or the camera or scale is unknown.
    InvalidSettingError
        A published method is chosen.
    SolveCancelled
        Raised by `progress`.
    """
    check_default_method(capture.method)
    if motion_prior is None and capture.recorded:
        motion_prior = load_motion_prior()
    wanted = TakeSettings(settings.calibration, capture, foreground, body, motion_prior, empty)
    following = _Following(
        source, detector, settings, wanted, on_pose, on_state, is_ended, clock, progress
    )  # fmt: skip
    while following.step():
        continue
    return following.result(planting)


class _Following:
    """The state of `follow_depth`."""

    def __init__(
        self,
        source: GrowingDepth,
        detector: PoseDetector,
        settings: FollowSettings,
        wanted: TakeSettings,
        on_pose: PoseCallback,
        on_state: StateCallback,
        is_ended: Callable[[], bool],
        clock: Clock,
        progress: Progress,
    ) -> None:
        self._source, self._detector, self._settings = source, detector, settings
        self._wanted, self._on_pose, self._on_state = wanted, on_pose, on_state
        self._is_ended, self._progress, self._clock = is_ended, progress, clock
        self._take: FollowedTake | None = None
        self._waiting: deque[WaitingImage] = deque()
        self._last_image, self._began_at = self._clock.now(), self._clock.written()
        self._measured_at: float | None = None
        """When images came for the first time after the measurement."""
        self._n_dropped = 0
        self._delays: list[float] = []

    def step(self) -> bool:
        """Take the next image, or wait for it; return whether more may come."""
        if new := self._source.poll():
            self._drop()
            self._last_image = self._clock.now()
            self._waiting.extend(WaitingImage(each, self._last_image) for each in new)
        if not self._waiting:
            return self._wait()
        waiting = self._waiting.popleft()
        if self._take is None:
            self._take = FollowedTake(
                self._source, self._detector, self._wanted, now=self._clock.now
            )
        waiting = self._read(self._take, waiting)
        if self._take.is_measured:
            self._track(self._take, waiting)
        elif (fraction := self._take.collect(waiting)) >= 1.0:
            self._measure(self._take)
        else:
            self._progress(fraction, "Waiting until the actor can be measured")
        self._on_state(self._state(self._take, waiting.depth))
        return not self._is_ended()

    def _state(self, take: FollowedTake, depth: DepthImage | None) -> FollowState:
        actor = take.actor if take.is_measured else None
        delay_s = self._delays[-1] if self._delays else 0.0
        n_tracked = len(self._delays)
        return FollowState(take.camera, depth, actor, n_tracked, self._n_dropped, delay_s)

    def _read(self, take: FollowedTake, waiting: WaitingImage) -> WaitingImage:
        """Return an image with its depth, or left out if it is damaged."""
        if waiting.depth is not None or waiting.is_left_out:
            return waiting
        full = self._source.read(waiting.image)
        return waiting.left_out() if full is None else waiting._replace(depth=take.coarse(full))

    def _track(self, take: FollowedTake, waiting: WaitingImage) -> None:
        image, _, depth, _ = waiting
        if depth is None:
            take.skip(image)
            return
        pose = take.add(image, depth)
        if pose is not None:
            written = max(image.written, self._began_at)
            self._delays.append(self._clock.written() - written)
            self._on_pose(pose)
        fraction = len(self._delays) % COUNT_CYCLE / COUNT_CYCLE
        self._progress(fraction, self._state(take, depth).sentence)

    def _drop(self) -> None:
        """Drop images that have waited too long, as newer ones come.

        Those that came during the measurement wait until more come: it may have been the end.
        """
        take, now, max_delay = self._take, self._clock.now(), self._settings.max_delay
        if take is None or not take.is_measured or not max_delay:
            return
        if self._measured_at is None:
            self._measured_at = now
            return
        n_late, begins_again = 0, False
        while self._waiting and now - self._waiting[0].came_at > max_delay:
            late = self._waiting.popleft()
            begins_again |= late.came_at <= self._measured_at
            n_late += 1
            take.skip(late.image)
        if begins_again:
            self._delays.clear()
            take.begin_again()
        self._n_dropped = self._n_dropped + n_late if self._delays else 0

    def _wait(self) -> bool:
        """Wait a moment for an image; return False once none is expected any more."""
        silence_s, settings = self._clock.now() - self._last_image, self._settings
        limit_s = settings.max_wait if self._take is None else settings.max_silence
        if self._source.is_gone or silence_s > limit_s:
            take = self._take
            return take is not None and not take.is_measured and self._measure(take)
        if self._take is None or silence_s > MIN_SILENCE_S:
            self._progress(0.0, "Waiting for images")
        self._clock.sleep(POLL_INTERVAL_S)
        return not self._is_ended()

    def _measure(self, take: FollowedTake) -> bool:
        """Measure the actor; return whether the first images wait to be tracked."""
        self._waiting.extendleft(reversed(take.measure(self._measuring)))
        return take.is_measured

    def _measuring(self, fraction: float, message: str = "") -> None:
        self._progress(fraction, message)
        if self._is_ended():
            raise InvalidMotionError(TOO_EARLY)

    def result(self, planting: PlantSettings | None) -> FollowedMotion:
        """Return the motion so far."""
        take = self._take
        if take is None:
            raise InvalidMotionError(self._why_no_image())
        first, captured = take.finish()
        planted = plant_feet_if_possible(
            captured.motion, planting if take.actor.feet_visible else None
        )
        fitted = self._wanted.body is None
        remarks = (
            *capture_remarks(take.actor, captured, fitted=fitted, live=True),
            *self._dropped(first, captured.motion.frame_rate),
            *self._source.remarks(),
            *planted.remarks,
        )
        return FollowedMotion(
            planted.motion, captured, planted.planted, first, self._n_dropped,
            np.array(self._delays), take.detection_delays, remarks,
        )  # fmt: skip

    def _dropped(self, first: int, frame_rate: float) -> Iterator[str]:
        if self._detector.issue:
            yield self._detector.issue
        if first:
            yield (
                f"The motion begins with frame {first} ({first / frame_rate:.1f} s) of the"
                " recording."
            )
        if self._n_dropped:
            yield f"{self._n_dropped} later images were dropped, as newer ones waited."

    def _why_no_image(self) -> str:
        return self._source.remarks()[-1] if self._source.is_gone else self._source.issue
