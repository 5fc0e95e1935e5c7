"""Tracked poses: figures of how they fit, and how wrong they are, to learn failures from."""

from collections.abc import Iterable
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from solvers.arrays import Array
from solvers.depth_tracking.body.model import BodyModel
from solvers.depth_tracking.body.segment_kinematics import joint_positions, segment_frames
from solvers.depth_tracking.published.registration_tracker import REGISTRATION_TRACKER
from solvers.depth_tracking.terms.observation import observe
from solvers.depth_tracking.terms.tracker_settings import DEFAULT_TRACKER, TrackerSettings
from solvers.depth_tracking.tracking.failure_test import (
    PUBLISHED_MAX_RESIDUAL_M,
    PUBLISHED_MIN_OVERLAP,
    failure_features,
)
from solvers.depth_tracking.tracking.track_pose import next_pose_prior, track_frame

from .depth_sequences import Sequence

MIN_FAILURE_ERROR_M = 0.1
"""Meters that the joints of a failed pose are off, on average."""
TRACKERS: dict[str, tuple[TrackerSettings, int]] = {
    "ours": (DEFAULT_TRACKER, 1),
    "ours, every third frame": (DEFAULT_TRACKER, 3),
    "ours, no prediction": (replace(DEFAULT_TRACKER, prediction=0.0), 2),
    "WZC12 preset": (REGISTRATION_TRACKER, 1),
}
"""Settings, and the step between evaluated frames: some of them fail often."""


class FailureCases(NamedTuple):
    """Poses of several trackers."""

    features: Array
    """`FEATURES` of each, shape (n, 6)."""
    errors: Array
    """Mean distance of its joints to the true ones, meters, shape (n,)."""
    published: NDArray[np.bool_]
    """Whether each has failed by the thresholds of [WZC12]."""


def failure_cases(sequences: Iterable[Sequence]) -> FailureCases:
    """Track with all `TRACKERS`, with scaled default bodies."""
    features, errors = [], []
    for one in sequences:
        for settings, step in TRACKERS.values():
            for feature, error in _tracked(one, one.typical_body, settings, step):
                features.append(feature)
                errors.append(error)
    table = np.array(features)
    far = table[:, 0] > PUBLISHED_MAX_RESIDUAL_M / RESIDUAL_UNIT
    return FailureCases(table, np.array(errors), far | (table[:, 1] < PUBLISHED_MIN_OVERLAP))


RESIDUAL_UNIT = 0.1


def _tracked(
    one: Sequence, body: BodyModel, settings: TrackerSettings, step: int
) -> Iterable[tuple[Array, float]]:
    poses = [one.first_pose(body)]
    for frame in range(0, one.depth.n_frames, step):
        observation = observe(one.depth, frame, settings.image_width)
        prior = next_pose_prior(poses[1:] or poses, settings)
        with np.errstate(all="ignore"):
            pose, quality = track_frame(body, prior, observation, settings)
        poses.append(pose)
        found = joint_positions(body, segment_frames(body, pose))
        error = float(np.linalg.norm(found - one.joints[frame], axis=1).mean())
        yield failure_features(quality), error


def learned(features: Array, failed: NDArray[np.bool_], ridge: float = 1e-3) -> Array:
    """Return weights and bias (n + 1,) of a logistic regression, by Newton's method.

    Both kinds count the same.
    """
    rows = np.hstack([features, np.ones((len(features), 1))])
    class_weights = np.where(failed, 0.5 / failed.mean(), 0.5 / (~failed).mean())
    weights = np.zeros(rows.shape[1])
    resistance = ridge * len(rows) * np.eye(rows.shape[1])
    resistance[-1, -1] = 0.0
    for _ in range(50):
        chance = 1.0 / (1.0 + np.exp(-rows @ weights))
        slope = rows.T @ (class_weights * (failed - chance)) - resistance @ weights
        curve = (rows * (class_weights * chance * (1.0 - chance))[:, np.newaxis]).T @ rows
        weights += np.linalg.solve(curve + resistance, slope)
    return weights


def area_under_roc(values: Array, failed: NDArray[np.bool_]) -> float:
    """Return how often a failed pose has a higher value than a good one [HM82]_.

    References
    ----------
    .. [HM82] Hanley, McNeil (1982). The meaning and use of the area under a receiver operating
       characteristic (ROC) curve. Radiology 143(1).
    """
    bad, good = values[failed], np.sort(values[~failed])
    below = np.searchsorted(good, bad, side="left") + np.searchsorted(good, bad, side="right")
    return float(0.5 * below.mean() / len(good))
