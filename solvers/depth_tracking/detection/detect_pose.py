"""Detect the pose of a body in one depth image, without a previous pose."""

from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Array
from ...depth_scene import Camera, DepthImage
from ...errors import InvalidMotionError
from ...settings import setting
from ..body import N_COORDINATES, N_ROOT, BodyModel, PoseEquations, joint_positions, stay_near
from ..forest import PixelForest, PixelParts, classify_pixels
from ..terms import DEFAULT_TRACKER, Hypothesis, Observation, render_hypothesis
from ..tracking import register_pose
from .pose_score import pose_score
from .pose_trials import trial_poses
from .robust_parts import FoundParts, RobustPartsSettings, find_parts


@dataclass(frozen=True, kw_only=True)
class DetectorSettings(RobustPartsSettings):
    """Settings of the pose detector."""

    max_pixels: int = setting(
        2500, "Maximum pixels of the body after subsampling; higher is slower",
        minimum=100, maximum=1_000_000, former="most_pixels",
    )  # fmt: skip
    min_pixels: int = setting(
        60,
        "Minimum pixels of a person",
        minimum=10,
        maximum=1_000_000,
        former="fewest_pixels",
    )
    n_refined: int = setting(
        3, "Number of candidate poses refined by the tracker; higher is more robust and slower",
        minimum=1, maximum=8,
    )  # fmt: skip
    iterations: int = setting(10, "Steps of the tracker's refinement", minimum=0, maximum=200)
    label_weight: float = setting(
        1.0, "Weight of the classified parts in the pose score; depth has weight 1",
        minimum=0.0, maximum=10.0,
    )  # fmt: skip
    seed: int = setting(0, "Seed of the random samples", minimum=0)


@dataclass(frozen=True, eq=False)
class DetectedPose:
    """A pose detected in one image.

    Attributes
    ----------
    pose : shape (36,)
        Coordinates of the body model, camera frame.
    joints : shape (21, 3), meters
        The `JOINTS` of the body model.
    score : float
        Fit of the body in this pose to the image, 0 to 1.
    overlap : float
        Fraction of the union of pixels where depths agree within 10 cm.
    pixels : PixelParts
        Classified pixels of the subsampled image.
    parts : FoundParts
        Parts after outlier rejection.
    step : int
        Subsampling step of columns and rows.
    """

    pose: Array
    joints: Array
    score: float
    overlap: float
    pixels: PixelParts
    parts: FoundParts
    step: int


def detect_pose(
    depth_frame: DepthImage,
    camera: Camera,
    body: BodyModel,
    forest: PixelForest,
    settings: DetectorSettings = DetectorSettings(),
    *,
    occluders: DepthImage | None = None,
) -> DetectedPose:
    """Detect the pose of a body in a depth image.

    The forest classifies the part of each pixel. Random sampling rejects misclassified pixels.
    The body is fitted to the rest from several initial poses, because left and right are often
    confused (`trial_poses`). The tracker refines the poses with the best scores, and the best
    one is returned [1]_.

    Parameters
    ----------
    depth_frame : float32, shape (height, width), meters
        Contains only one body; 0: no reading.
    camera : Camera
    body : BodyModel
    forest : PixelForest
    settings : DetectorSettings
    occluders : float32, shape (height, width), meters, optional
        Depth of what may hide the body; 0 elsewhere.

    Raises
    ------
    InvalidMotionError
        The image shows no person.

    References
    ----------
    .. [1] Wei, Zhang, Chai (2012), section 4.
    """
    observation, step = subsample_image(depth_frame, camera, settings.max_pixels, occluders)
    pixels = classify_pixels(observation.depth.astype(np.float32), observation.camera, forest)
    if len(pixels.rows) < settings.min_pixels:
        raise InvalidMotionError(
            f"No person is detected: {len(pixels.rows)} pixels have a depth. Go to a frame with"
            " a person, or correct the background settings."
        )
    rng = np.random.default_rng(settings.seed)
    parts = find_parts(observation.points, pixels.labels, body, rng, settings)
    if not parts.weights.any():
        raise InvalidMotionError(
            f"No person is detected: the {len(pixels.rows)} pixels show no body part. Go to a"
            " frame with a person, or correct the background settings."
        )
    step_between = -(-len(observation.points) // settings.n_pixels)
    trials = trial_poses(
        body, parts, observation.points[::step_between], pixels.probabilities[::step_between]
    )
    candidates = [
        _score_candidate(
            render_hypothesis(body, pose, observation.camera, observation.occluders),
            pixels,
            observation,
            settings,
        )
        for pose in trials
    ]
    candidates.sort(key=lambda candidate: candidate.score, reverse=True)
    refined = [
        _refine_candidate(candidate, pixels, observation, settings)
        for candidate in candidates[: settings.n_refined]
    ]
    best = max(refined, key=lambda candidate: candidate.score)
    joints = joint_positions(body, best.hypothesis.frames)
    return DetectedPose(
        best.hypothesis.pose, joints, best.score, best.overlap, pixels, parts, step
    )


def score_body(
    body: BodyModel,
    detected: DetectedPose,
    depth_frame: DepthImage,
    camera: Camera,
    settings: DetectorSettings = DetectorSettings(),
    *,
    occluders: DepthImage | None = None,
) -> float:
    """Return how well another body explains an image, 0 to 1, near the pose of the first.

    Parameters
    ----------
    body : BodyModel
    detected : DetectedPose
        What `detect_pose` returned for this image.
    depth_frame, camera, settings, occluders
        Those of `detect_pose`.
    """
    observation, _ = subsample_image(depth_frame, camera, settings.max_pixels, occluders)
    hypothesis = render_hypothesis(
        body, detected.pose, observation.camera, observation.occluders
    )
    start = _score_candidate(hypothesis, detected.pixels, observation, settings)
    return _refine_candidate(start, detected.pixels, observation, settings).score


@dataclass(frozen=True, eq=False)
class _Candidate:
    """A candidate pose with its score."""

    hypothesis: Hypothesis
    score: float
    overlap: float


def subsample_image(
    depth: DepthImage, camera: Camera, max_pixels: int, occluders: DepthImage | None = None
) -> tuple[Observation, int]:
    """Subsample an image to at most about `max_pixels` pixels of the body; return the step."""
    step = max(1, int(np.ceil(np.sqrt(np.count_nonzero(depth) / max_pixels))))
    full = Observation(camera, np.asarray(depth, dtype=np.float64), occluders)
    return full.every(step), step


def _score_candidate(
    hypothesis: Hypothesis,
    pixels: PixelParts,
    observation: Observation,
    settings: DetectorSettings,
) -> _Candidate:
    score, overlap = pose_score(hypothesis, observation, pixels, settings.label_weight)
    return _Candidate(hypothesis, score, overlap)


def _refine_candidate(
    candidate: _Candidate,
    pixels: PixelParts,
    observation: Observation,
    settings: DetectorSettings,
) -> _Candidate:
    """Refine a pose with the tracker; unobserved coordinates stay unchanged."""
    if not settings.iterations:
        return candidate
    start = candidate.hypothesis.pose

    def prior(pose: Array) -> PoseEquations:
        return stay_near(pose, start, _START_WEIGHTS)

    registered = register_pose(
        candidate.hypothesis.body,
        start,
        observation,
        prior,
        replace(DEFAULT_TRACKER, iterations=settings.iterations),
    )
    return _score_candidate(registered.hypothesis, pixels, observation, settings)


START_WEIGHT = 2.0
"""Weight per square radian: as much as a few pixels. Half and twice are no better
(`make sensitivity`)."""
_START_WEIGHTS = np.array([0.0] * N_ROOT + [START_WEIGHT] * (N_COORDINATES - N_ROOT))
