"""Detection of wrong poses: the learned failure test against published thresholds."""

import numpy as np
from numpy.typing import NDArray

from solvers.arrays import Array
from solvers.depth_tracking.tracking.failure_test import (
    FEATURES,
    LEARNED_BIAS,
    LEARNED_WEIGHTS,
    PUBLISHED_MAX_RESIDUAL_M,
    PUBLISHED_MIN_OVERLAP,
)

from ..shared.tables import number, table
from .depth_sequences import SCORED, sequence
from .failures import MIN_FAILURE_ERROR_M, RESIDUAL_UNIT, area_under_roc, failure_cases


def failures() -> list[str]:
    """Compare tests on depth/truth, with trackers of which some lose the actor."""
    found = failure_cases(sequence(name) for name in SCORED)
    failed = found.errors > MIN_FAILURE_ERROR_M
    columns = dict(zip(FEATURES, found.features.T, strict=True))
    chance = found.features @ LEARNED_WEIGHTS + LEARNED_BIAS
    residual, overlap = columns["residual"] * RESIDUAL_UNIT, columns["overlap"]
    rows = {
        "learned, probability over 50 %": _row(chance, chance >= 0.0, failed),
        "depth, published: over 2.5 cm": _row(
            residual, residual > PUBLISHED_MAX_RESIDUAL_M, failed
        ),
        "overlap, published: under 90 %": _row(
            -overlap, overlap < PUBLISHED_MIN_OVERLAP, failed
        ),
        "either of both, published": ["-", *_rates(found.published, failed)],
        "score under 0.5": _row(-columns["score"], columns["score"] < 0.5, failed),
    }
    head = (
        f"**Failure detection** (mean joint error above 10 cm: {failed.sum()} of {len(failed)}"
        " held-out poses of four trackers with the mean body)\n\n"
    )
    names = ["test", "area under ROC", "failures detected, %", "false alarms, %"]
    return [head + table(names, rows) + "\n"]


def _row(values: Array, detected: NDArray[np.bool_], failed: NDArray[np.bool_]) -> list[str]:
    return [number(area_under_roc(values, failed)), *_rates(detected, failed)]


def _rates(detected: NDArray[np.bool_], failed: NDArray[np.bool_]) -> list[str]:
    return [number(100.0 * detected[failed].mean()), number(100.0 * detected[~failed].mean())]
