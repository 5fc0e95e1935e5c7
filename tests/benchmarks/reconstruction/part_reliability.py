"""How well reliability indicates wrong joints: on UI-PRMD, next to an optical system."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np
from scipy.stats import rankdata

from solvers.arrays import Array, Flags
from solvers.motion import JointRecording
from solvers.reconstruction import ReliabilityMethod, ReliabilitySettings, measure_reliability
from solvers.reconstruction.reliability.error_model import (
    ONE_CENTIMETER,
    ErrorIndicators,
    ErrorModel,
    measure_error_indicators,
)
from solvers.reconstruction.reliability.reference import parent_distances, reference_lengths

from . import kinect_pairs

LIMITS = (0.05, 0.10)
"""Meters from the truth at which a joint is wrong."""
MIN_SAMPLES = 20
"""Wrong and right ones that there must be for a curve."""
FRACTIONS = (0.1, 0.15, 0.2, 0.3, 0.5)
FLOORS = (0.0002, 0.0003, 0.0005, 0.001, 0.002)


@dataclass(frozen=True, eq=False)
class Pair:
    """A take of a Kinect, and how far each joint was off."""

    name: str
    recording: JointRecording
    error: Array
    """Distance from the median offset of each joint in meters, (n_frames, n_joints)."""

    @property
    def subject(self) -> str:
        """Who moved."""
        return self.name.split("_")[1]


def read_pairs(folder: Path) -> list[Pair]:
    """Read all takes that are paired rightly."""
    pairs = []
    for pair in kinect_pairs.read_pairs(folder):
        off = pair.kinect.tracks.positions - pair.truth.positions
        is_observed = np.isfinite(off).any(axis=(0, 2))
        off[:, is_observed] -= np.nanmedian(off[:, is_observed], axis=0)
        pairs.append(Pair(pair.name, pair.kinect, np.linalg.norm(off, axis=-1)))
    return pairs


def area_under_curve(score: Array, wrong: Flags) -> float:
    """Return the probability that a wrong one has the higher score than a right one."""
    n_wrong, n_right = int(wrong.sum()), int((~wrong).sum())
    if min(n_wrong, n_right) < MIN_SAMPLES:
        return float("nan")
    ranks = rankdata(score)[wrong].sum() - n_wrong * (n_wrong + 1) / 2.0
    return float(ranks / (n_wrong * n_right))


def areas_by_subject(pairs: list[Pair], scores: list[Array], limit: float) -> list[float]:
    """Return for each subject how well the scores detect errors above a limit."""
    areas = []
    for subject in sorted({pair.subject for pair in pairs}):
        mine = [index for index, pair in enumerate(pairs) if pair.subject == subject]
        error = np.concatenate([pairs[index].error.ravel() for index in mine])
        score = np.concatenate([scores[index].ravel() for index in mine])
        is_known = np.isfinite(error)
        areas.append(area_under_curve(score[is_known], error[is_known] > limit))
    return areas


def error_scores(pairs: list[Pair], causal: bool) -> Iterator[tuple[str, list[Array]]]:
    """Yield each measure's name and 1 less reliability of every take."""
    by_method = {method: [] for method in ReliabilityMethod}
    for pair, method in product(pairs, by_method):
        settings = ReliabilitySettings(method=method, causal=causal)
        by_method[method].append(measure_reliability(pair.recording, settings=settings))
    published = by_method[ReliabilityMethod.PUBLISHED]
    yield "behavior term", [1.0 - found.behavior for found in published]
    yield "kinematics term", [1.0 - found.kinematics for found in published]
    yield (
        "published: minimum of the terms, window",
        [1.0 - found.combined for found in published],
    )
    yield (
        "default as it ships",
        [1.0 - found.combined for found in by_method[ReliabilityMethod.DEFAULT]],
    )


def signs_of(recording: JointRecording, causal: bool) -> ErrorIndicators:
    """Return what betrays errors in a take without tracking states."""
    positions, parents = recording.tracks.positions, np.array(recording.parents)
    lengths = parent_distances(positions, parents)
    visible = recording.tracks.visible.astype(float)
    reference = reference_lengths(lengths, np.zeros(len(positions), bool), visible)
    return measure_error_indicators(
        positions, lengths - reference, parents, recording.frame_rate, causal
    )


def fit_model(signs: Iterable[ErrorIndicators], errors: Iterable[Array]) -> ErrorModel:
    """Fit a line to logarithms of errors, by least squares."""
    error = np.concatenate([each.ravel() for each in errors])
    is_known = np.isfinite(error)
    aim = np.log(error[is_known] + ONE_CENTIMETER)
    both = list(signs)
    every = ErrorIndicators(
        np.concatenate([each.deviation.ravel() for each in both])[is_known],
        np.concatenate([each.length_error.ravel() for each in both])[is_known],
        np.concatenate([each.jumps.ravel() for each in both])[is_known],
    )
    fits = []
    for fraction, floor in product(FRACTIONS, FLOORS):
        sign = ErrorModel(fraction, floor, 0.0, 1.0, 1.0).combine(every)
        slope, level = np.polyfit(sign, aim, 1)
        spread = float(np.std(aim - level - slope * sign))
        fits.append(ErrorModel(fraction, floor, float(level), float(slope), spread))
    return min(fits, key=lambda fit: fit.spread)


def error_scores_by_subject(
    pairs: list[Pair], signs: list[ErrorIndicators], limit: float
) -> list[Array]:
    """Return 1 less the chance to be right, from models that know nothing of the subject."""
    found: dict[int, Array] = {}
    for subject in sorted({pair.subject for pair in pairs}):
        training = [index for index, pair in enumerate(pairs) if pair.subject != subject]
        model = fit_model(
            [signs[index] for index in training], [pairs[index].error for index in training]
        )
        for index, pair in enumerate(pairs):
            if pair.subject == subject:
                found[index] = 1.0 - model.probability_within(signs[index], limit)
    return [found[index] for index in range(len(pairs))]
