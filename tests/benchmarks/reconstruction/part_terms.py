"""Terms of the published correction alone and together, reliability terms, and confidence."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from solvers.arrays import Array
from solvers.motion.humanoid.posture_joints import (
    N_JOINTS,
    POSTURE_JOINTS,
    posture_joint_indices,
    posture_positions,
)
from solvers.reconstruction import (
    PostureSettings,
    Reconstruction,
    ReconstructMethod,
    Reliability,
    measure_reliability,
    reconstruct_postures,
)
from solvers.reconstruction.published.residual_reconstruction import ThreeTermSettings

from ..shared.tables import number, table
from .kinect_damage import shaken, swapped
from .kinect_folds import SUBJECTS, posture_library, takes_of, truth_of
from .kinect_methods import (
    SIGNS_PUBLISHED,
    Method,
    by_published_residuals,
    by_reconstruct,
    joints,
    raw,
)
from .kinect_pairs import Pair
from .part_energy import classes, energy_weights
from .part_kinect import WORST_FRACTION, Errors, errors_of
from .part_losses import Found, errors_table
from .part_losses import errors_of as damage_errors

SPATIAL, TEMPORAL, RELIABILITY = 0.6, 0.2, 0.2
TERMS = {
    "spatial": (SPATIAL, 0.0, 0.0),
    "temporal": (0.0, TEMPORAL, 0.0),
    "reliability": (0.0, 0.0, RELIABILITY),
    "spatial, temporal": (SPATIAL, TEMPORAL, 0.0),
    "spatial, reliability": (SPATIAL, 0.0, RELIABILITY),
    "temporal, reliability": (0.0, TEMPORAL, RELIABILITY),
    "all three": (SPATIAL, TEMPORAL, RELIABILITY),
}
SIGNS = {
    "no reliability": (),
    "behavior": ("behavior",),
    "kinematics": ("kinematics",),
    "both, published": ("behavior", "kinematics"),
}
BINS = (0.0, 0.3, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0)
MAX_GOOD_ERROR_M = 0.05
"""Meters: distance of which confidence is the probability."""


def terms(n_repetitions: int) -> list[str]:
    """Return table 5.3 of [ZH14]; energy, table IV and reliability terms of [SHJT13]."""
    few = max(n_repetitions // 2, 1)
    before = errors_of(raw, few)
    worst = before.free >= np.nanquantile(before.free, 1.0 - WORST_FRACTION)
    rows = {"raw": _cells(before, worst)}
    for name, weights in TERMS.items():
        rows[name] = _cells(errors_of(_published(*weights), few), worst)
    columns = ["absolute, cm", "offset-free, cm", "worst tenth, cm", "jerk, m/s³"]
    head = "**Terms of [ZH14], as published, used alone and together** (table 5.3)\n\n"
    return [
        head + table(["terms", *columns], rows) + "\n",
        energy_weights(),
        classes(),
        *signs(),
    ]


def _published(spatial: float, temporal: float, reliability: float) -> Method:
    settings = ThreeTermSettings(spatial=spatial, temporal=temporal, reliable=reliability)
    return joints(by_published_residuals, settings=settings)


def _cells(found: Errors, worst: NDArray[np.bool_]) -> list[str]:
    means = (found.absolute, found.free, found.free[worst])
    return [*(number(100.0 * float(np.nanmean(one))) for one in means), number(found.jerk)]


def signs() -> list[str]:
    """Return errors of poses by reliability term."""
    methods: dict[str, Method] = {"raw": raw}
    for name, used in SIGNS.items():
        methods[name] = joints(_trusting, used=used)
    methods["ours"] = joints(_trusting, used=None)
    return [
        errors_table(f"Poses by reliability term, {what}", damage_errors(damage, methods), by)
        for what, damage, by in (
            ("vibrating joints", shaken, _seconds),
            ("swapped limbs", swapped, _what),
        )
    ]


def _seconds(found: Found) -> str:
    return found.seconds


def _what(found: Found) -> str:
    return found.what


def _trusting(pair: Pair, subject: str, used: tuple[str, ...] | None) -> Reconstruction:
    """Reconstruct poses with some reliability terms only; None uses the default."""
    reliability = measure_reliability(pair.kinect)
    if used is not None:
        reliability = _only(measure_reliability(pair.kinect, settings=SIGNS_PUBLISHED), used)
    return reconstruct_postures(
        pair.kinect,
        posture_library(subject),
        reliability=reliability,
        settings=PostureSettings(),
    )


def _only(reliability: Reliability, used: tuple[str, ...]) -> Reliability:
    combined = np.ones_like(reliability.combined)
    for name in used:
        combined = np.minimum(combined, getattr(reliability, name))
    return replace(reliability, combined=combined)


def confidence(n_repetitions: int) -> list[str]:
    """Return the confidence of joints, and the fraction of them within 5 cm."""
    plain, residuals, both = "prior alone", "residuals", "ours (both)"
    methods = {
        plain: partial(by_reconstruct, method=ReconstructMethod.RESIDUALS),
        residuals: partial(by_reconstruct, method=ReconstructMethod.RESIDUALS, confident=True),
        both: partial(by_reconstruct, method=ReconstructMethod.BOTH, confident=True),
    }
    relative = {name: partial(methods[name], shift=False) for name in (plain, both)}
    return [
        _confidence_table(
            "**Confidence**, subject left out: predicted probability that a joint is within"
            " 5 cm of the truth, and fraction of joints that are. The last two rows hold all"
            " joints and the mean of -log(probability of the outcome)",
            {name: _confidences(solve, n_repetitions) for name, solve in methods.items()},
        ),
        _confidence_table(
            "**The same relative to the mean offset of joint and take**, which is not removed"
            " here (without *Sensor Offset*)",
            {
                name: _confidences(solve, n_repetitions, True)
                for name, solve in relative.items()
            },
        ),
    ]


def _confidence_table(title: str, found: dict[str, tuple[Array, Array]]) -> str:
    rows: dict[str, list[str]] = {}
    columns: list[str] = []
    for name, (confidences, correct) in found.items():
        columns += [f"{word}, {name}" for word in ("fraction", "predicted", "actual")]
        for low, high in [*pairwise(BINS), (0.0, 1.0 + 1e-9)]:
            here = (confidences >= low) & (confidences < high)
            label = f"{low:g} to {min(high, 1.0):g}"
            figures = [f"{here.mean():.1%}", "-", "-"]
            if here.any():
                figures[1:] = [f"{confidences[here].mean():.3f}", f"{correct[here].mean():.3f}"]
            rows.setdefault(label, []).extend(figures)
        rows.setdefault("log-loss", []).extend([
            "-",
            f"{_log_loss(confidences, correct):.3f}",
            "-",
        ])
    return f"{title}\n\n" + table(["predicted", *columns], rows) + "\n"


def _log_loss(confidences: Array, correct: Array) -> float:
    chance = np.clip(np.where(correct, confidences, 1.0 - confidences), 1e-3, 1.0)
    return float(-np.log(chance).mean())


def _confidences(
    solve: Callable[..., Reconstruction], n_repetitions: int, relative_to_offset: bool = False
) -> tuple[Array, Array]:
    confidences, correct = [], []
    for subject in SUBJECTS:
        for pair in takes_of(subject, n_repetitions):
            result = solve(pair, subject)
            methods = posture_positions(result.tracks) - truth_of(pair)
            if relative_to_offset:
                is_known = np.isfinite(methods).any(axis=(0, 2))
                methods[:, is_known] -= np.nanmean(methods[:, is_known], axis=0)
            off = np.linalg.norm(methods, axis=-1)
            observed = np.isfinite(off)
            confidence_values = np.zeros((len(off), N_JOINTS))
            for role, index in posture_joint_indices(pair.kinect.names).items():
                confidence_values[:, POSTURE_JOINTS.index(role)] = result.confidence[:, index]
            confidences.append(confidence_values[observed])
            correct.append(off[observed] < MAX_GOOD_ERROR_M)
    return np.concatenate(confidences), np.concatenate(correct)
