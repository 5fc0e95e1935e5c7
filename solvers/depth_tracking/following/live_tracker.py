"""Track a body in images as they arrive; the detector works meanwhile."""

import numpy as np

from ...arrays import Array
from ...depth_scene import Camera, DepthImage
from ..body import BodyModel, MotionPrior
from ..capturing import RecoverySettings, RegularChecks, unwrap_rotation
from ..terms import DEFAULT_TRACKER, Observation, TrackerSettings, subsampling_step
from ..tracking import (
    FitQuality,
    PosePreview,
    next_pose_prior,
    quality_without_actor,
    track_frame,
)
from .pose_detectors import Detection, DetectionRequest, PoseDetector

MAX_CATCH_UP_FRAMES = 4
"""Number of images, evenly spaced, in which a detected pose is tracked from the image that was
requested to the present one. It bounds the delay."""
MAX_KEPT_FRAMES = 90
"""Number of images that are kept for a detected pose, three seconds of a depth camera; a later
one is discarded. It bounds the memory."""
DEFAULT_RECOVERY = RecoverySettings()


class LiveTracker:
    """Tracks a body from image to image, as `capture` does forward [WZC12]_.

    The tracker waits for the first detected pose, as it has nothing to go on from. Later it
    requests a detection when its pose has failed, and at intervals, and goes on meanwhile. If
    the detected pose fits its image clearly better, it is tracked through the images since
    then. It replaces the tracked pose if it still fits better in the present image.

    Parameters
    ----------
    camera : Camera
        Of the images.
    frame_rate : float, hertz
    body : BodyModel
    detector : PoseDetector
    motion_prior : MotionPrior, optional
    recovery : RecoverySettings
    tracker : TrackerSettings
    waits : bool
        Whether to wait for the first detected pose. Otherwise images without a pose go by
        until it is there, and tracking begins in the present image.

    References
    ----------
    .. [WZC12] Wei, Zhang, Chai (2012). Accurate realtime full-body motion capture using a
       single depth camera. ACM Transactions on Graphics 31(6), section 5.
    """

    def __init__(
        self,
        camera: Camera,
        frame_rate: float,
        body: BodyModel,
        detector: PoseDetector,
        motion_prior: MotionPrior | None = None,
        *,
        recovery: RecoverySettings = DEFAULT_RECOVERY,
        tracker: TrackerSettings = DEFAULT_TRACKER,
        waits: bool = True,
    ) -> None:
        self._waits = waits
        self._camera, self._body, self._detector = camera, body, detector
        self._prior, self._tracker = motion_prior, tracker
        self._policy = RegularChecks(recovery, frame_rate)
        self._trajectory: list[Array] = []
        self._kept: list[tuple[DepthImage, float]] = []
        """Images since the request, and their scores."""
        self._is_wanted = False
        self.restarts: list[int] = []
        """Frames where a detected pose replaced the tracked one."""
        self.delays: list[int] = []
        """Number of frames between each request and its detected pose."""

    def update(self, frame: int, image: DepthImage) -> PosePreview | None:
        """Return the pose in the next image, or None before the first one is detected.

        Parameters
        ----------
        frame : int
            Number of the frame, for the result.
        image : shape (height, width), meters
            Contains only the actor; 0: no reading.
        """
        observation = self._observe(image)
        pose, quality, score = self._tracked(observation)
        if not observation.empty:
            has_pose = bool(self._trajectory)
            self._is_wanted |= self._policy.should_detect(quality if has_pose else None)
        self._keep(image, score, observation)
        if not self._trajectory and self._waits:
            self._detector.wait()
        detection = self._detector.poll()
        if detection is not None and self._kept:
            self.delays.append(len(self._kept) - 1)
            replaced = self._replaced(detection, observation)
            self._kept = []
            if replaced is not None:
                if self._trajectory:
                    self.restarts.append(frame)
                pose, quality = replaced
                score, self._trajectory, self._is_wanted = quality.score, [], False
                self._policy.reset()
        self._policy.add_score(score)
        if pose is None:
            return None
        self._trajectory = [*self._trajectory[-1:], pose]
        return PosePreview(self._body, frame, pose, quality)

    def _observe(self, image: DepthImage) -> Observation:
        full = Observation(self._camera, image.astype(np.float64))
        return full.every(subsampling_step(self._camera, self._tracker.image_width))

    def _tracked(self, observation: Observation) -> tuple[Array | None, FitQuality, float]:
        """Return pose, quality and score of the next image; the last pose without an actor."""
        quality = quality_without_actor()
        if not self._trajectory:
            return None, quality, np.nan
        if observation.empty:
            return self._trajectory[-1], quality, np.nan
        pose, quality = self._register(observation, self._trajectory)
        return pose, quality, quality.score

    def _register(
        self, observation: Observation, trajectory: list[Array]
    ) -> tuple[Array, FitQuality]:
        prior = next_pose_prior(trajectory[-2:], self._tracker, self._prior)
        return track_frame(self._body, prior, observation, self._tracker)

    def _keep(self, image: DepthImage, score: float, observation: Observation) -> None:
        """Request a detection if one is wanted; keep the images since the request."""
        if self._is_wanted and not self._trajectory and self._waits:
            self._detector.wait()
        if self._is_wanted and not observation.empty and self._detector.is_idle:
            self._is_wanted = False
            self._kept = [(image, score)]
            self._detector.request(
                DetectionRequest(image, self._camera, self._body, self._tracker)
            )
        elif self._kept:
            self._kept.append((image, score))
            if len(self._kept) > MAX_KEPT_FRAMES:
                self._kept = []

    def _replaced(
        self, detection: Detection, observation: Observation
    ) -> tuple[Array, FitQuality] | None:
        """Return a detected pose, tracked up to the present image, if it fits better."""
        if detection.found is None or observation.empty:
            return None
        pose, quality = detection.found
        if not self._policy.accepts(quality.score, self._kept[0][1]):
            return None
        if self._trajectory:
            pose = unwrap_rotation(pose, self._trajectory[-1])
        trajectory, n_since = [pose], len(self._kept) - 1
        if not n_since:
            return pose, quality
        n_steps = min(n_since, MAX_CATCH_UP_FRAMES)
        for index in np.linspace(0, n_since, n_steps + 1).round().astype(int)[1:].tolist():
            pose, quality = self._register(self._observe(self._kept[index][0]), trajectory)
            trajectory.append(pose)
        is_better = self._policy.accepts(quality.score, self._kept[-1][1])
        return (pose, quality) if is_better else None
