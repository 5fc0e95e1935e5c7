"""Track a body as published in [LOU12]."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

from ...arrays import Array, Integers
from ...depth_scene import DepthRecording
from ...progress import Progress, unwatched
from ..body import (
    BodyModel,
    MotionPrior,
    SurfaceRows,
    concatenate_rows,
    segment_frames,
)
from ..terms import (
    REFERENCE_AREA_M2,
    Hypothesis,
    Observation,
    TrackerSettings,
    observe,
    pixel_area,
)
from ..tracking import Likelihood, TrackedMotion, track_pose
from .depth_edges import edge_pixels
from .edges import edge_term
from .registration_tracker import NO_ANKLES, PER_DEGREE
from .surface import ColoredFrame, PreviousFrame, read_intensities, surface_term

SURFACE_WEIGHT, EDGE_WEIGHT = 4.0, 40.0
"""Weights of the terms, per square meter. Those of [LOU12], times 4: a pixel covers a quarter
of the reference area."""
EDGE_TRACKER = TrackerSettings(
    image_width=320, iterations=10, coarse_iterations=0,
    closest_weight=0.0, off_actor_weight=0.0, too_near_weight=0.0,
    depth_weight=0.0, extra_weight=0.0, silhouette_weight=0.0,
    similar_weight=0.001 * PER_DEGREE,
    shift_weight=1e-5, rotation_weight=1e-5 * PER_DEGREE, prediction=0.0,
    limit_weight=0.0, natural_weight=0.0, ankle_weight=NO_ANKLES, damping=1e-6,
    max_step=10.0, accept_only_better=False,
)  # fmt: skip
"""Weights of [LOU12] sections 3.4 to 3.6: surface 1, edges 10, motion prior 0.001, smoothness
0.00001 (a pixel of 320 columns covers about a quarter of the reference area).

The paper gives no units. Angles are interpreted in degrees, as in its training motions. With
weights per square radian, prior and smoothness have no effect, and tracking fails within a
second."""


def track_pose_by_edges(
    depth: DepthRecording,
    body: BodyModel,
    initial_pose: Array,
    motion_prior: MotionPrior | None = None,
    *,
    progress: Progress = unwatched,
) -> TrackedMotion:
    """Track a body with the surface and edge terms of [LOU12]_, sections 3.4 to 3.6.

    Parameters, result and errors are those of `track_pose`, which loses the actor less often.
    Colors of the recording, if any, are compared from frame to frame.

    Parameters
    ----------
    depth : DepthRecording
    body : BodyModel
    initial_pose : shape (36,)
    motion_prior : MotionPrior, optional
    progress : Progress

    References
    ----------
    .. [LOU12] Lou (2012). Acquiring 3D full-body motion from noisy and ambiguous input. PhD
       dissertation, Texas A&M University.
    """
    return track_pose(
        depth, body, initial_pose, motion_prior, settings=EDGE_TRACKER,
        likelihood=EdgeLikelihood(depth), progress=progress,
    )  # fmt: skip


class EdgeLikelihood:
    """The image terms of [LOU12] for each frame of a recording.

    Parameters
    ----------
    depth : DepthRecording
    has_color, has_edges : bool
        Whether colors are compared, and whether edges are matched.
    """

    def __init__(
        self, depth: DepthRecording, *, has_color: bool = True, has_edges: bool = True
    ) -> None:
        self._depth = depth if has_color else replace(depth, read_color=None)
        self._edge_weight = EDGE_WEIGHT if has_edges else 0.0
        self._read: dict[int, ColoredFrame] = {}

    def __call__(
        self, frame: int, observation: Observation, body: BodyModel, poses: Sequence[Array]
    ) -> Likelihood:
        """Return the image terms of a frame; `poses` ends with that of the frame before."""
        colored, previous = self._colored(frame, observation), None
        if poses and frame:
            before = self._colored(frame - 1)
            if not before.observation.empty:
                previous = PreviousFrame(segment_frames(body, poses[-1]), before)
        edges = edge_pixels(observation.depth, observation.nearest_pixel)
        return _FrameTerms(colored, edges, previous, self._edge_weight)

    def _colored(self, frame: int, observation: Observation | None = None) -> ColoredFrame:
        """Return a frame with its colors; the last two that were read are kept."""
        if frame not in self._read:
            width = EDGE_TRACKER.image_width
            observation = observation or observe(self._depth, frame, width)
            intensities = read_intensities(self._depth, frame, width)
            last = list(self._read.items())[-1:]
            self._read = dict([*last, (frame, ColoredFrame(observation, intensities))])
        return self._read[frame]


@dataclass(frozen=True, eq=False)
class _FrameTerms:
    """The image terms of one frame."""

    colored: ColoredFrame
    edges: Integers
    previous: PreviousFrame | None
    edge_weight: float

    def __call__(
        self, hypothesis: Hypothesis, observation: Observation, settings: TrackerSettings
    ) -> SurfaceRows:
        """Return the rows of both terms."""
        area = pixel_area(observation) / REFERENCE_AREA_M2
        return concatenate_rows([
            surface_term(hypothesis, self.colored, self.previous, area * SURFACE_WEIGHT),
            edge_term(hypothesis, observation, self.edges, area * self.edge_weight),
        ])
