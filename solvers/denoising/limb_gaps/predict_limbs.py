"""Predict joints that are missing for long from the joints that are not."""

from collections import defaultdict
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array
from ...progress import Progress, unwatched
from ...rotations import IDENTITY, inverse, matrix_from_quaternion, rotate
from ...signals import find_runs
from ..channels import BODY_POSITION, Channels, Estimate
from .adapt_relation import (
    MIN_GAP_S,
    AdaptedRelation,
    adapt_relation,
    describe_gap,
    try_gaps,
)
from .body_relation import GAP_S, BodyRelation
from .bridges import Bridge

GENERAL_WEIGHT = 0.5
"""Fraction of other people's relation that a take starts from. Sweep on the development takes
of the first press: 0 costs 5 %, 0.25 costs 1.5 %, 1 gains 0.7 % but makes more takes worse than
interpolation."""
OWN_PATTERNS_WEIGHT = 0.2
"""Weight of the estimate by the take's own patterns in the mean with the prediction. Sweep on
the development takes of the first press: x0.5 gains 0.4 %, x2 costs 3 %."""
BOW_VARIANCE = 15.0 / 8.0
"""Ratio of the variance in the middle of a gap to the mean over the gap. By definition of a
squared parabola."""


class JointGap(NamedTuple):
    """Joints that are missing in the same frames."""

    start: int
    stop: int
    parts: tuple[int, ...]


def predict_limbs(
    channels: Channels,
    estimate: Estimate,
    frame_rate: float,
    relation: BodyRelation,
    progress: Progress = unwatched,
) -> tuple[Estimate, int]:
    """Predict long gaps of joints from the other joints of the body.

    A missing joint is a straight line across its gap, plus a linear regression of its deviation
    from the line on the deviations of the observed joints. The regression is a Gaussian
    posterior: it starts from the relation of other people and adapts to the take, where the
    same joints are hidden for as long. These trials also weigh it against the straight line and
    show the variance of its error. The result is averaged with the estimate. Observed samples
    do not change. A gap at either end of the take, of the hips, or of a rig that is no humanoid
    keeps its estimate.

    Parameters
    ----------
    channels : Channels
        About the take's own means; NaN where missing.
    estimate : Estimate
        Of these channels.
    frame_rate : float, Hz
    relation : BodyRelation
    progress : Progress

    Returns
    -------
    Estimate
    n_joints : int
        Number of joints that were predicted.
    """
    gaps = find_joint_gaps(channels, frame_rate)
    is_humanoid = channels.moving_references is not None and relation.knows(channels.keys)
    if not gaps or not is_humanoid:
        return estimate, 0
    alignments = np.stack([
        IDENTITY if key == BODY_POSITION else channels.references[key][8:12]
        for key in channels.keys
    ])
    shape = channels.values.shape
    canonical = rotate(inverse(alignments), estimate.values.reshape(shape))
    values = estimate.values.reshape(shape).copy()
    deviation = estimate.deviation.reshape(shape).copy()
    missing = np.isnan(channels.values).any(axis=2)
    groups = _group_by_joints(gaps, missing, channels, relation)
    for index, ((parts, body), group) in enumerate(groups.items()):
        progress(index / len(groups), "Predicting limbs")
        limb_values = canonical[:, parts].reshape(len(values), -1)
        body_values = canonical[:, body].reshape(len(values), -1)
        known = ~missing[:, parts].any(axis=1)
        length = int(np.median([gap.stop - gap.start for gap in group]))
        missing_keys, body_keys = (
            [channels.keys[part] for part in each] for each in (parts, body)
        )
        general = GENERAL_WEIGHT * relation.regress(missing_keys, body_keys)
        adapted = adapt_relation(
            try_gaps(limb_values, body_values, known, length, frame_rate),
            general,
            relation.error_variance(missing_keys, body_keys, general) / (GAP_S * frame_rate),
        )
        for gap in group:
            bridge = Bridge(gap.start, gap.stop, frame_rate)
            block = np.ix_(bridge.frames, np.array(parts))
            predicted = _predict(bridge, limb_values, body_values, adapted)
            axes = matrix_from_quaternion(alignments[list(parts)])
            predicted = np.einsum("pac,fpc->fpa", axes, predicted)
            values[block] += (1.0 - OWN_PATTERNS_WEIGHT) * (predicted - values[block])
            variance = _variance(bridge, adapted.variance)
            deviation[block] = np.sqrt(np.einsum("pac,fpc->fpa", axes**2, variance))
    n_joints = len({part for gap in gaps for part in gap.parts})
    flat = estimate.values.shape
    return (
        replace(estimate, values=values.reshape(flat), deviation=deviation.reshape(flat)),
        n_joints,
    )


def find_joint_gaps(channels: Channels, frame_rate: float) -> list[JointGap]:
    """Return long gaps of joints with observed frames on both sides.

    The body's position and the joint that it turns with are left out: where these are missing,
    no heading is known.
    """
    missing = np.isnan(channels.values).any(axis=2)
    missing[:, channels.joints == channels.joints[-1]] = False
    found: dict[tuple[int, int], list[int]] = defaultdict(list)
    for part in np.flatnonzero(missing.any(axis=0)).tolist():
        for start, stop in find_runs(missing[:, part]):
            is_inside = start > 0 and stop < len(missing)
            if is_inside and stop - start >= MIN_GAP_S * frame_rate:
                found[start, stop].append(part)
    return [JointGap(*frames, tuple(parts)) for frames, parts in found.items()]


def _group_by_joints(
    gaps: list[JointGap],
    missing: NDArray[np.bool_],
    channels: Channels,
    relation: BodyRelation,
) -> dict[tuple[tuple[int, ...], tuple[int, ...]], list[JointGap]]:
    """Group gaps by their joints and by the parts of the body that are known meanwhile."""
    groups = defaultdict(list)
    for gap in gaps:
        known = ~missing[gap.start : gap.stop].any(axis=0)
        body = (part for part, key in enumerate(channels.keys) if key in relation.keys)
        groups[gap.parts, tuple(part for part in body if known[part])].append(gap)
    return dict(groups)


def _predict(bridge: Bridge, limb: Array, body: Array, adapted: AdaptedRelation) -> Array:
    """Return the limb in the gap, shape (n_missing_frames, n_parts, 3)."""
    deviation = describe_gap(bridge, limb, body) @ adapted.regression
    return (bridge.line(limb) + adapted.weight * deviation).reshape(len(deviation), -1, 3)


def _variance(bridge: Bridge, variance: Array) -> Array:
    """Return the variance of the error (n_missing_frames, n_parts, 3), least near both ends.

    The error is a parabola across the gap. Its mean square rises with the length of the gap, as
    that of a random walk.
    """
    length = bridge.stop - bridge.start
    result = BOW_VARIANCE * length * bridge.bow[:, None] ** 2 * variance
    return np.asarray(result.reshape(len(result), -1, 3))
