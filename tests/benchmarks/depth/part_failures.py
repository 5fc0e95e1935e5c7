"""How well wrong poses are told: the learned failure test against published thresholds."""

import numpy as np
from numpy.typing import NDArray

from solvers.depth_tracking.tracking.failure_test import (
    FEATURES,
    LEARNED_BIAS,
    LEARNED_WEIGHTS,
    PUBLISHED_MAX_RESIDUAL_M,
    PUBLISHED_MIN_OVERLAP,
)

from ..shared.tables import number, table
from .depth_sequences import SCORED, sequence
from .failures import RESIDUAL_UNIT, WRONG, area_under_roc, judged

Array = NDArray[np.float64]


def failures() -> list[str]:
    """Compare tests on depth/truth, with trackers of which some lose the actor."""
    found = judged(sequence(name) for name in SCORED)
    failed = found.errors > WRONG
    columns = dict(zip(FEATURES, found.features.T, strict=True))
    chance = found.features @ LEARNED_WEIGHTS + LEARNED_BIAS
    residual, overlap = columns["residual"] * RESIDUAL_UNIT, columns["overlap"]
    rows = {
        "learned, chance over 50 %": _row(chance, chance >= 0.0, failed),
        "depth, published: over 2.5 cm": _row(
            residual, residual > PUBLISHED_MAX_RESIDUAL_M, failed
        ),
        "overlap, published: under 90 %": _row(
            -overlap, overlap < PUBLISHED_MIN_OVERLAP, failed
        ),
        "either of both, published": ["-", *_shares(found.published, failed)],
        "score under 0.5": _row(-columns["score"], columns["score"] < 0.5, failed),
    }
    head = (
        f"**Telling failures** (joints off by more than 10 cm on average: {failed.sum()} of"
        f" {len(failed)} poses of four trackers with usual bodies, not those learned from)\n\n"
    )
    names = ["test", "area under ROC", "failures told, %", "false alarms, %"]
    return [head + table(names, rows) + "\n"]


def _row(values: Array, told: NDArray[np.bool_], failed: NDArray[np.bool_]) -> list[str]:
    return [number(area_under_roc(values, failed)), *_shares(told, failed)]


def _shares(told: NDArray[np.bool_], failed: NDArray[np.bool_]) -> list[str]:
    return [number(100.0 * told[failed].mean()), number(100.0 * told[~failed].mean())]
