"""Fit quality of a pose in an image, and the confidence of each joint."""

from typing import NamedTuple

import numpy as np

from ...arrays import Array, Integers
from ..body import END_SEGMENTS, N_SEGMENTS, BodyModel
from ..terms import Observation, group_pixels
from .register_pose import Registered

JOINT_SEGMENTS: Integers = np.array([*range(N_SEGMENTS), *END_SEGMENTS])
"""Segment that carries each of `JOINTS`."""
MAX_DEPTH_ERROR_M = 0.1
"""A pixel with a larger depth error does not count as fitting. It guards images in which
something stands in front of the actor (`test_offset_pose_has_failed_and_true_pose_has_not`)."""
_CONFIDENCE_STD_M = 0.06
"""Standard deviation of a joint position that halves its confidence. Half and twice are no
better (`make sensitivity`)."""
_REFERENCE_PIXELS = 8.0
"""Number of visible pixels at which the agreement of a segment is halved. Half and twice are no
better (`make sensitivity`)."""
_CORRELATED_PIXELS = 30.0
"""Number of neighboring pixels with correlated errors; it scales the covariance. Half and twice
gain less than 1 % (`make sensitivity`)."""


class FitQuality(NamedTuple):
    """Measures of the fit in one frame."""

    residual: float
    """Mean distance in depth where body and actor overlap, meters; NaN without overlap."""
    coverage: float
    """Intersection over union of body and actor [WZC12] section 5."""
    score: float
    """Fraction of the union of pixels that fit, each weighted by its depth error."""
    off_actor: float
    """Fraction of the body's pixels off the actor."""
    too_near: float
    """Fraction of the body's pixels far in front of the actor: observed free space."""
    unexplained: float
    """Fraction of the actor's pixels off the body."""
    confidence: Array
    """Confidence of each of the `JOINTS`, 0 to 1, shape (21,)."""


def quality_without_actor() -> FitQuality:
    """Return the fit quality of a frame without an actor."""
    return FitQuality(np.nan, 0.0, 0.0, 1.0, 0.0, 1.0, np.zeros(len(JOINT_SEGMENTS)))


def fit_quality(
    body: BodyModel, registered: Registered, observation: Observation, limit: float
) -> FitQuality:
    """Compare a registered pose with a depth image of the actor.

    The confidence of a joint is a product of two factors. The first is the fraction of the
    visible pixels of its segment where the depths differ by at most `limit`. The second falls
    from 1 as the standard deviation of its position rises; at 6 cm it is one half.

    Parameters
    ----------
    body : BodyModel
    registered : Registered
        The pose, its rendered image, and the normal equations that give the variances.
    observation : Observation
        The depth image.
    limit : float, meters
        Difference in depth above which body and image do not agree.
    """
    image = registered.hypothesis.image
    observed = observation.flat[image.pixels]
    both = observed > 0.0
    n_both, n_drawn, n_observed = int(both.sum()), len(image.pixels), len(observation.pixels)
    if not n_both:
        return quality_without_actor()
    n_union = n_drawn + n_observed - n_both
    depths_behind = observed[both] - image.depths[both]
    depth_errors = np.abs(depths_behind)
    fits = np.maximum(0.0, 1.0 - depth_errors / MAX_DEPTH_ERROR_M)
    agreement = _agreement(registered, observation, limit)[JOINT_SEGMENTS]
    deviations = np.sqrt(_joint_variances(body, registered))
    return FitQuality(
        residual=float(depth_errors.mean()),
        coverage=n_both / n_union,
        score=float(fits.sum()) / n_union,
        off_actor=1.0 - n_both / n_drawn,
        too_near=float((depths_behind > limit).sum()) / n_drawn,
        unexplained=1.0 - n_both / n_observed,
        confidence=agreement / (1.0 + (deviations / _CONFIDENCE_STD_M) ** 2),
    )


def _agreement(registered: Registered, observation: Observation, limit: float) -> Array:
    """Return the fraction of visible pixels that agree with the image, for each segment.

    The fraction is lower for segments with few pixels (`_REFERENCE_PIXELS`).
    """
    segments = registered.hypothesis.segments
    groups = group_pixels(registered.hypothesis, observation, limit)
    visible = np.bincount(segments, minlength=N_SEGMENTS)
    agreeing = np.bincount(segments[groups.comparable], minlength=N_SEGMENTS)
    fraction: Array = agreeing / (visible + _REFERENCE_PIXELS)
    return fraction


def _joint_variances(body: BodyModel, registered: Registered) -> Array:
    """Return the variance of each joint position, square meters, from the normal equations."""
    hypothesis = registered.hypothesis
    segment_frames = hypothesis.frames[JOINT_SEGMENTS]
    positions = segment_frames[:, :3, 3].copy()
    rotations = segment_frames[N_SEGMENTS:, :3, :3]
    positions[N_SEGMENTS:] += np.einsum("nij,nj->ni", rotations, body.offsets[N_SEGMENTS:])
    twists = hypothesis.twists[JOINT_SEGMENTS]
    derivatives = np.cross(twists[:, :3], positions[:, :, np.newaxis], axis=1) + twists[:, 3:]
    matrix = registered.equations.matrix + 1e-6 * np.eye(len(registered.pose))
    covariance = np.linalg.inv(matrix) * _CORRELATED_PIXELS
    variances: Array = np.einsum(
        "nik,kl,nil->n", derivatives, covariance, derivatives, optimize=True
    )
    return variances
