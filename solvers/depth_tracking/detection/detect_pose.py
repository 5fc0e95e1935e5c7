"""Find the pose of a body in one depth picture, without knowing any pose before it."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import Camera, DepthImage
from ...errors import InvalidMotionError
from ...settings import setting
from ..body import N_COORDINATES, N_ROOT, BodyModel, PoseEquations, joint_positions, stay_near
from ..forest import PARTS, PixelForest, PixelParts, classify_pixels
from ..terms import DEFAULT_TRACKER, Hypothesis, Observation, render_hypothesis
from ..tracking import register_pose
from .pose_score import pose_score
from .pose_trials import trial_poses
from .robust_parts import FoundParts, RobustPartsSettings, find_parts

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class DetectorSettings(RobustPartsSettings):
    """How a pose is looked for in one picture."""

    most_pixels: int = setting(
        2500, "The picture is thinned until a body has no more pixels; more is slower",
        minimum=100, maximum=1_000_000,
    )  # fmt: skip
    fewest_pixels: int = setting(
        60, "A picture of fewer pixels shows nobody", minimum=10, maximum=1_000_000
    )
    n_refined: int = setting(
        3, "How many of the poses found are refined by the tracker; more is surer and slower",
        minimum=1, maximum=8,
    )  # fmt: skip
    iterations: int = setting(10, "Steps of the tracker's refinement", minimum=0, maximum=200)
    label_weight: float = setting(
        1.0, "How much the parts told by the forest count in choosing among poses",
        minimum=0.0, maximum=10.0,
    )  # fmt: skip
    seed: int = setting(0, "Another seed draws other samples", minimum=0)


@dataclass(frozen=True, eq=False)
class DetectedPose:
    """A pose found in one picture.

    Attributes
    ----------
    pose : shape (36,)
        Coordinates of the body model, camera frame.
    joints : shape (21, 3), metres
        The `JOINTS` of the body model.
    score : float
        0 to 1: how well the body in this pose explains the picture.
    overlap : float
        Share of the pixels of body or picture that both cover within 10 cm.
    pixels : PixelParts
        What the forest told, in the thinned picture.
    parts : FoundParts
        What was left of it.
    step : int
        Every so manieth column and row was looked at.
    """

    pose: Array
    joints: Array
    score: float
    overlap: float
    pixels: PixelParts
    parts: FoundParts
    step: int

    @property
    def unseen(self) -> tuple[str, ...]:
        """The `PARTS` of which no pixels were found; their pose is a guess."""
        return tuple(
            part for part, weight in zip(PARTS, self.parts.weights, strict=True) if weight == 0
        )


def detect_pose(
    depth_frame: DepthImage,
    camera: Camera,
    body: BodyModel,
    forest: PixelForest,
    settings: DetectorSettings = DetectorSettings(),
) -> DetectedPose:
    """Find the pose of a body in a depth picture.

    The forest tells the part that each pixel sees; random sampling leaves out what it told
    wrong; the body is fitted to the rest from several starts, since left and right are often
    told wrong (`trial_poses`).
    The poses that explain the picture best are refined by the tracker, and the best one is
    returned [1]_.

    Parameters
    ----------
    depth_frame : float32, shape (height, width), metres
        Of nothing but one body; 0: no reading.
    camera : Camera
    body : BodyModel
    forest : PixelForest
    settings : DetectorSettings

    Raises
    ------
    InvalidMotionError
        The picture shows nobody.

    References
    ----------
    .. [1] Wei, Zhang, Chai (2012), section 4.
    """
    observation, step = subsample_image(depth_frame, camera, settings.most_pixels)
    pixels = classify_pixels(observation.depth.astype(np.float32), observation.camera, forest)
    if len(pixels.rows) < settings.fewest_pixels:
        raise InvalidMotionError(
            f"Nobody is seen: {len(pixels.rows)} pixels have a depth. Go to a frame with a"
            " person, or mend what is taken for background."
        )
    rng = np.random.default_rng(settings.seed)
    parts = find_parts(observation.points, pixels.labels, body, rng, settings)
    if not parts.weights.any():
        raise InvalidMotionError(
            f"Nobody is seen: no part of a body is told apart in {len(pixels.rows)} pixels. Go"
            " to a frame with a person, or mend what is taken for background."
        )
    each = -(-len(observation.points) // settings.n_pixels)
    trials = trial_poses(body, parts, observation.points[::each], pixels.shares[::each])
    found = [
        _judged(
            render_hypothesis(body, pose, observation.camera), pixels, observation, settings
        )
        for pose in trials
    ]
    found.sort(key=lambda one: one.score, reverse=True)
    refined = [
        _refined(one, pixels, observation, settings) for one in found[: settings.n_refined]
    ]
    best = max(refined, key=lambda one: one.score)
    joints = joint_positions(body, best.hypothesis.frames)
    return DetectedPose(
        best.hypothesis.pose, joints, best.score, best.overlap, pixels, parts, step
    )


@dataclass(frozen=True, eq=False)
class _Found:
    """One pose that may be it."""

    hypothesis: Hypothesis
    score: float
    overlap: float


def subsample_image(
    depth: DepthImage, camera: Camera, most_pixels: int
) -> tuple[Observation, int]:
    """Return every so manieth column and row of a picture, so that few enough see the body."""
    step = max(1, int(np.ceil(np.sqrt(np.count_nonzero(depth) / most_pixels))))
    return Observation(camera, np.asarray(depth, dtype=np.float64)).every(step), step


def _judged(
    hypothesis: Hypothesis,
    pixels: PixelParts,
    observation: Observation,
    settings: DetectorSettings,
) -> _Found:
    score, overlap = pose_score(hypothesis, observation, pixels, settings.label_weight)
    return _Found(hypothesis, score, overlap)


def _refined(
    found: _Found, pixels: PixelParts, observation: Observation, settings: DetectorSettings
) -> _Found:
    """Let the tracker refine a pose; what it cannot see stays as it was."""
    if not settings.iterations:
        return found
    start = found.hypothesis.pose

    def prior(pose: Array) -> PoseEquations:
        return stay_near(pose, start, _STAY_WEIGHTS)

    better = register_pose(
        found.hypothesis.body,
        start,
        observation,
        prior,
        replace(DEFAULT_TRACKER, iterations=settings.iterations),
    )
    return _judged(better.hypothesis, pixels, observation, settings)


STAY_WEIGHT = 2.0
"""Per square radian: as much as a few pixels."""
_STAY_WEIGHTS = np.array([0.0] * N_ROOT + [STAY_WEIGHT] * (N_COORDINATES - N_ROOT))
