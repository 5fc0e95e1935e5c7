"""UI-PRMD without one subject at a time: what the others teach is kept under build/reconstruct.

Delete that folder after a change of how priors are learned.
"""

from functools import cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from solvers.motion import joint_parents, motion_from_points
from solvers.motion.posture_joints import posture_positions
from solvers.motion.straight_gaps import bridged
from solvers.reconstruction import (
    PostureLibrary,
    ResidualMethod,
    ResidualPrior,
    ResidualPriorSettings,
    build_posture_library,
    learn_residual_prior,
    load_posture_library,
    load_residual_prior,
)

from .kinect_pairs import Pair, read_pairs

Array = NDArray[np.float64]
KEPT = Path(__file__).resolve().parents[2] / "build" / "reconstruct"
SUBJECTS = ("s01", "s02", "s03", "s04", "s05")
TAUGHT = ("e01", "e04", "e07")
"""Repetitions of each exercise whose true postures a library is made of."""
PRIORS = {
    ResidualMethod.HIERARCHICAL: ResidualPriorSettings(),
    ResidualMethod.PUBLISHED: ResidualPriorSettings(
        method=ResidualMethod.PUBLISHED, calm=0.0, mirror=False
    ),
}


@cache
def pairs() -> tuple[Pair, ...]:
    """All takes."""
    return tuple(read_pairs())


def takes_of(subject: str, n_repetitions: int, after: int = 0) -> list[Pair]:
    """Takes of a subject: of each exercise some repetitions after the first few."""
    found: dict[str, list[Pair]] = {}
    for pair in pairs():
        if pair.subject == subject:
            found.setdefault(pair.name[:3], []).append(pair)
    return [pair for same in found.values() for pair in same[after : after + n_repetitions]]


def others(subject: str) -> list[Pair]:
    """Takes of everyone else."""
    return [pair for pair in pairs() if pair.subject != subject]


@cache
def residual_prior(subject: str, method: ResidualMethod) -> ResidualPrior:
    """What all takes of the others teach of the sensor's errors."""
    path = KEPT / f"{method.value}_{subject}.npz"
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        teachers = others(subject)
        learn_residual_prior(
            [(pair.kinect, pair.truth) for pair in teachers],
            actors=[pair.subject for pair in teachers],
            settings=PRIORS[method],
        ).save(path)
    return load_residual_prior(path)


@cache
def optical_library(subject: str) -> PostureLibrary:
    """Return the shipped library, and true postures of the others besides."""
    path = KEPT / f"postures_{subject}.npz"
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        motions = []
        for pair in others(subject):
            seen = np.isfinite(pair.truth.positions).any(axis=(0, 2)).all()
            if pair.name[-3:] in TAUGHT and seen:
                whole = pair.truth.with_positions(bridged(pair.truth.positions))
                motions.append(motion_from_points(whole, joint_parents(whole.names)))
        build_posture_library(motions).save(path)
    return joined(load_posture_library(), load_posture_library(path))


def joined(one: PostureLibrary, other: PostureLibrary) -> PostureLibrary:
    """Put two libraries together."""
    return PostureLibrary(
        np.concatenate([one.directions, other.directions]),
        np.concatenate([one.changes, other.changes]),
        np.concatenate([one.groups, one.groups.max() + 1 + other.groups]),
        one.n_seen + other.n_seen,
        f"{one.trained_on} and UI-PRMD",
    )


def truth_of(pair: Pair) -> Array:
    """Return the true joints of postures, (n_frames, 20, 3); NaN where not known."""
    return posture_positions(pair.truth)


def seen_of(pair: Pair) -> Array:
    """Return what the Kinect saw of them."""
    return posture_positions(pair.kinect)
