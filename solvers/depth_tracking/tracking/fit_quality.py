"""How well a pose explains a picture, and how sure each joint is."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..body import END_SEGMENTS, N_SEGMENTS, BodyModel, Integers
from ..terms import Observation, group_pixels
from .register_pose import Registered

Array = NDArray[np.float64]

JOINT_SEGMENTS: Integers = np.array([*range(N_SEGMENTS), *END_SEGMENTS])
"""Segment that carries each of `JOINTS`."""
MAX_DEPTH_ERROR_M = 0.1
"""Metres in depth from which on a pixel does not fit at all."""
_UNSURE = 0.06
"""Standard deviation, metres, at which a joint's confidence is halved twice."""
_ENOUGH_PIXELS = 8.0
_VARIANCE = 30.0
"""How many pixels of a part err together: their number tells less than the weights say."""


class FitQuality(NamedTuple):
    """Figures of one frame."""

    residual: float
    """Mean distance in depth where body and actor overlap, metres; NaN where nowhere."""
    coverage: float
    """Share of the pixels of body or actor that show both [WZC12] section 5."""
    score: float
    """Share of the pixels of body or actor that fit, each by how near its depths are."""
    off_actor: float
    """Share of the body's pixels that show no actor."""
    too_near: float
    """Share of the body's pixels that show the actor far behind: space that was seen free."""
    unexplained: float
    """Share of the actor's pixels that show no body."""
    confidence: Array
    """Of each of `JOINTS`, 0 to 1, shape (21,)."""


def quality_without_actor() -> FitQuality:
    """Return the figures of a frame without an actor."""
    return FitQuality(np.nan, 0.0, 0.0, 1.0, 0.0, 1.0, np.zeros(len(JOINT_SEGMENTS)))


def fit_quality(
    body: BodyModel, found: Registered, observation: Observation, limit: float
) -> FitQuality:
    """Judge a registered pose.

    A joint is sure where the normal equations leave it little room to move, and where most of
    what is visible of its segment was observed at nearly the same depth, closer than `limit`.

    Parameters
    ----------
    body : BodyModel
    found : Registered
    observation : Observation
    limit : float, metres
    """
    picture = found.hypothesis.picture
    observed = observation.flat[picture.pixels]
    both = observed > 0.0
    overlap = int(both.sum())
    if not overlap:
        return quality_without_actor()
    behind = observed[both] - picture.depths[both]
    apart = np.abs(behind)
    either = len(picture.pixels) + len(observation.pixels) - overlap
    score = float(np.maximum(0.0, 1.0 - apart / MAX_DEPTH_ERROR_M).sum()) / either
    agreeing = _agreement(found, observation, limit)[JOINT_SEGMENTS]
    room = np.sqrt(_joint_variances(body, found))
    confidence = agreeing / (1.0 + (room / _UNSURE) ** 2)
    n_drawn, n_seen = len(picture.pixels), len(observation.pixels)
    return FitQuality(
        float(apart.mean()), overlap / either, score, 1.0 - overlap / n_drawn,
        float((behind > limit).sum()) / n_drawn, 1.0 - overlap / n_seen, confidence,
    )  # fmt: skip


def _agreement(found: Registered, observation: Observation, limit: float) -> Array:
    """Return the share of each segment's visible pixels that fit; few pixels tell little."""
    segments = found.hypothesis.segments
    groups = group_pixels(found.hypothesis, observation, limit)
    visible = np.bincount(segments, minlength=N_SEGMENTS)
    fitting = np.bincount(segments[groups.comparable], minlength=N_SEGMENTS)
    share: Array = fitting / (visible + _ENOUGH_PIXELS)
    return share


def _joint_variances(body: BodyModel, found: Registered) -> Array:
    """Return the variance of each joint's place, square metres, that the equations leave."""
    hypothesis = found.hypothesis
    carriers = hypothesis.frames[JOINT_SEGMENTS]
    places = carriers[:, :3, 3].copy()
    rotations = carriers[N_SEGMENTS:, :3, :3]
    places[N_SEGMENTS:] += np.einsum("nij,nj->ni", rotations, body.offsets[N_SEGMENTS:])
    twists = hypothesis.twists[JOINT_SEGMENTS]
    moves = np.cross(twists[:, :3], places[:, :, np.newaxis], axis=1) + twists[:, 3:]
    matrix = found.equations.matrix + 1e-6 * np.eye(len(found.pose))
    covariance = np.linalg.inv(matrix) * _VARIANCE
    variances: Array = np.einsum("nik,kl,nil->n", moves, covariance, moves, optimize=True)
    return variances
