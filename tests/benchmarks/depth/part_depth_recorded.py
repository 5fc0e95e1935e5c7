"""Limbs out of sight, with and without the recorded motions that ship."""

import numpy as np

from solvers.depth_tracking.body.motion_prior import load_motion_prior
from solvers.depth_tracking.body.tables import JOINTS
from solvers.depth_tracking.capturing.capture import CaptureSettings, capture
from solvers.depth_tracking.tracking.track_pose import track_pose

from ..shared.tables import Scores
from .depth_sequences import SCORED, Sequence, errors, sequence

HANDS = [JOINTS.index(f"{side}Hand") for side in ("left", "right")]
LOW_CONFIDENCE = 0.3
"""Confidence below which a joint is flagged."""


def recorded() -> list[str]:
    """Track and capture with scaled default bodies, with and without the prior."""
    scores = Scores(
        "Recorded motions, none by the actors shown", "each sequence counts as one clip", ""
    )
    for name in SCORED:
        one = sequence(name)
        for label, wanted in (("", False), (", drawn to recorded motions", True)):
            _note(scores, f"tracker{label}", one, *_tracked(one, wanted))
            found = capture(
                one.depth, one.typical_body, settings=CaptureSettings(recorded=wanted)
            )
            _note(scores, f"capture{label}", one, found.joints.positions, found.low_confidence)
    return [scores.markdown()]


def _tracked(one: Sequence, wanted: bool) -> tuple[np.ndarray, np.ndarray]:
    prior = load_motion_prior() if wanted else None
    with np.errstate(all="ignore"):
        found = track_pose(one.depth, one.typical_body, one.first_pose(one.typical_body), prior)
    assert found.joints.confidence is not None
    return found.joints.positions, found.joints.confidence < LOW_CONFIDENCE


def _note(
    scores: Scores, method: str, one: Sequence, joints: np.ndarray, flagged: np.ndarray
) -> None:
    off = errors(joints, one.joints)
    distances = 100.0 * off.offset_taken
    figures = off.figures() | {
        "cm, hands": float(distances[:, HANDS].mean()),
        "flagged %": 100.0 * float(flagged.mean()),
        "cm where flagged": float(distances[flagged].mean()),
        "cm where not": float(distances[~flagged].mean()),
    }
    for column, figure in figures.items():
        scores.add(method, column, one.name, figure)
