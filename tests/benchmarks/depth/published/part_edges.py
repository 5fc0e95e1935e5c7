"""[LOU12]: its figures 3.6 (components and databases), 3.11 and 3.12 (real takes)."""

import numpy as np

from solvers.depth_tracking.body.model import BodyModel
from solvers.depth_tracking.body.motion_prior import MotionPrior, load_motion_prior
from solvers.depth_tracking.capturing.capture import CaptureSettings
from solvers.depth_tracking.capturing.passes import TrackingContext
from solvers.depth_tracking.forest.pixel_forest import load_pixel_forest
from solvers.depth_tracking.published.edge_tracker import EDGE_TRACKER, EdgeLikelihood
from solvers.depth_tracking.terms.tracker_settings import DEFAULT_TRACKER
from solvers.depth_tracking.tracking.track_pose import TrackedMotion, track_pose

from ...shared.tables import Scores
from ..colored_sequences import HOPS, WALKS, colored, motions_of, others_motions
from ..depth_sequences import MAX_FOUND_ERROR_M, SCORED, Sequence, errors
from ..depth_takes import ACTIONS, HANDS, STABLE, KinectTake, kinect_take
from .part_registration import UNIT, kinect_body

COMPONENTS = {
    "depth": (False, False),
    "depth and color": (True, False),
    "depth and edges": (False, True),
    "depth, color and edges": (True, True),
}
"""Whether colors are compared and edges matched."""
OCCLUDED = ("cross arms", "bowling", "pick up and throw", "walk", "stand to sit", "squat")
"""Actions of UTD-MHAD in which limbs hide each other: the closest to those of the figures."""


def components() -> list[str]:
    """Return figure 3.6: the terms, and the databases of the motion prior."""
    terms = Scores("[LOU12] by component, figure 3.6 (a), without a motion prior", UNIT, "")
    priors = Scores("[LOU12] by database, figure 3.6 (b), all terms", UNIT, "")
    for name in SCORED:
        one = colored(name)
        for label, (has_color, has_edges) in COMPONENTS.items():
            _note(terms, label, one, None, has_color, has_edges)
        behavior = WALKS if name.startswith("walk") else HOPS
        databases: dict[str, MotionPrior | None] = {
            "none": None,
            "the same behavior by others": motions_of(behavior),
            "walks and hops by others": others_motions(),
            "walks, exercises, dance (shipped)": load_motion_prior(),
        }
        for label, prior in databases.items():
            _note(priors, label, one, prior, True, True)
    return [terms.markdown(), priors.markdown()]


def _note(
    scores: Scores, label: str, one: Sequence, prior: MotionPrior | None,
    has_color: bool, has_edges: bool,
) -> None:  # fmt: skip
    likelihood = EdgeLikelihood(one.depth, has_color=has_color, has_edges=has_edges)
    with np.errstate(all="ignore"):
        found = track_pose(
            one.depth, one.body, one.first_pose(one.body), prior,
            settings=EDGE_TRACKER, likelihood=likelihood,
        )  # fmt: skip
    off = errors(found.joints.positions, one.joints)
    for column, figure in off.figures().items():
        scores.add(label, column, one.name, figure)


def real_takes(subject: int = 1) -> list[str]:
    """Return figures 3.11 and 3.12: takes of a Kinect with and without edges and prior."""
    title = "[LOU12] on a real Kinect, figures 3.11 and 3.12"
    scores = Scores(title, f"{len(OCCLUDED)} actions of UTD-MHAD as clips", "")
    body, shipped = kinect_body(subject), load_motion_prior()
    for action in OCCLUDED:
        take = kinect_take(ACTIONS.index(action) + 1, subject)
        if take is None:
            continue
        start = _first_pose(take, body)
        for label, has_edges, prior in (
            ("depth", False, None), ("depth and edges", True, None),
            ("depth, edges and motion prior", True, shipped),
        ):  # fmt: skip
            with np.errstate(all="ignore"):
                found = track_pose(
                    take.depth, body, start, prior, settings=EDGE_TRACKER,
                    likelihood=EdgeLikelihood(take.depth, has_edges=has_edges),
                )  # fmt: skip
            _note_take(scores, label, take, found)
    return [scores.markdown()]


def _first_pose(take: KinectTake, body: BodyModel) -> np.ndarray:
    actor = TrackingContext(
        take.depth, body, load_pixel_forest(), DEFAULT_TRACKER, CaptureSettings()
    )
    found = actor.detected(0)
    assert found is not None
    return found[0]


def _note_take(scores: Scores, label: str, take: KinectTake, found: TrackedMotion) -> None:
    distances = take.distances(found.joints.positions)
    off = distances[np.isfinite(distances).all(axis=1)]
    scores.add(label, "cm, stable joints", take.name, 100.0 * off[:, STABLE].mean())
    near = 100.0 * float((off[:, STABLE] < MAX_FOUND_ERROR_M).mean())
    scores.add(label, "% < 10 cm", take.name, near)
    scores.add(label, "cm, hands", take.name, 100.0 * off[:, HANDS].mean())
    scores.add(label, "coverage", take.name, float(found.coverage.mean()))
