"""[SHJT13] on UI-PRMD: what each term of its energy is good for, and its table IV."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from solvers.arrays import Array
from solvers.motion.humanoid.body_size import estimate_bone_lengths, segment_lengths
from solvers.motion.humanoid.bone_directions import rates_from_directions
from solvers.motion.humanoid.posture_heading import NormalizedPostures, normalize_postures
from solvers.reconstruction import ReconstructMethod
from solvers.reconstruction.joint_rotations.library_body import build_body_postures
from solvers.reconstruction.pose_library.neighbors import (
    PostureQuery,
    index_postures,
    nearest_postures,
)
from solvers.reconstruction.pose_space.posture_energy import EnergyTargets, EnergyWeights
from solvers.reconstruction.pose_space.posture_space import PostureSpaces, local_pca
from tests.benchmarks.reconstruction.posture_synthesis import solve_sequentially

from ..peers.gap_fillers import linear
from ..shared.tables import number, table
from .kinect_damage import Damaged, hidden, with_missing_joints
from .kinect_errors import compared, jerk
from .kinect_folds import SUBJECTS, observed_postures, posture_library, takes_of, truth_of
from .kinect_methods import Method, by_postures, by_published_postures, by_reconstruct, joints
from .part_losses import REPETITIONS, bridged_by, error

PUBLISHED = EnergyWeights()
VARIANTS = {
    "all four, as published": PUBLISHED,
    "without control": PUBLISHED._replace(control=0.0),
    "without style": PUBLISHED._replace(style=0.0),
    "without kinematics": PUBLISHED._replace(kinematics=0.0),
    "without continuity": PUBLISHED._replace(continuity=0.0),
    "control alone": EnergyWeights(1.0, 0.0, 0.0, 0.0),
    "twice the control": PUBLISHED._replace(control=2.0),
    "twice the style": PUBLISHED._replace(style=1.0),
    "twice the kinematics": PUBLISHED._replace(kinematics=3.0),
    "ten times the continuity": PUBLISHED._replace(continuity=2.5),
}
EXERCISE_STEP = 10
"""Exercises from one that is solved to the next: frames are solved one after the other."""
SECONDS = "1 s"
CLASSES: dict[str, Method] = {
    "raw, gaps bridged by lines": lambda pair, subject: bridged_by(linear, pair, subject),
    "[SHJT13] postures, as published": joints(by_published_postures),
    "postures": joints(by_postures),
    "ours (both)": joints(by_reconstruct, method=ReconstructMethod.BOTH),
}


class EnergyCase(NamedTuple):
    """A damaged take, and what any weights of the energy are to solve."""

    damaged: Damaged
    plain: NormalizedPostures
    spaces: PostureSpaces
    demands: EnergyTargets


def energy_weights() -> str:
    """Return the error without each term of the energy, in the same natural posture spaces."""
    cases = list(_all_cases())
    rows = {}
    for name, weights in VARIANTS.items():
        found = [_measured(one, weights) for one in cases]
        missing, directions, lengths, jerks = (
            np.concatenate(each) for each in zip(*found, strict=True)
        )
        cells = [f"{100.0 * np.nanmean(one):.2f}" for one in (missing, directions, lengths)]
        rows[name] = [*cells, number(float(np.nanmean(jerks)))]
    columns = [
        "missing joints, cm",
        "vector from the parent, cm",
        "length deviation, cm",
        "jerk, m/s³",
    ]
    head = (
        "**Weights of the energy of [SHJT13]** (eq. 10 to 15; published 1, .5, 1.5, .25;"
        f" Gauss-Newton), joints missing for {SECONDS}, {len(cases)} cases, subject left"
        " out\n\n"
    )
    return head + table(["terms", *columns], rows) + "\n"


def _all_cases() -> Iterator[EnergyCase]:
    for subject in SUBJECTS:
        library = posture_library(subject)
        for count, pair in enumerate(takes_of(subject, *REPETITIONS)[::EXERCISE_STEP]):
            for damaged in with_missing_joints(pair, np.random.default_rng(count)):
                if damaged.seconds == SECONDS and damaged.what in {"4", "arm", "leg"}:
                    observed, rate = observed_postures(damaged.pair), pair.kinect.frame_rate
                    reliability = np.isfinite(observed).all(axis=-1).astype(np.float64)
                    plain = normalize_postures(observed, rate, reliability)
                    lengths = estimate_bone_lengths(plain.postures, reliability)
                    body = build_body_postures(library.directions, library.changes, lengths)
                    index = index_postures(body, library.groups)
                    speeds = rates_from_directions(plain.postures, rate)
                    query = PostureQuery(plain.postures, speeds, reliability, 0.0)
                    indices, _ = nearest_postures(index, query)
                    spaces = local_pca(body.positions[indices].astype(np.float64))
                    demands = EnergyTargets(
                        plain.postures, reliability, spaces.neighbors, lengths
                    )
                    yield EnergyCase(damaged, plain, spaces, demands)


def _measured(case: EnergyCase, weights: EnergyWeights) -> tuple[Array, Array, Array, Array]:
    """Return errors of missing joints, of vectors from parent joints, of lengths, and jerks."""
    demands = EnergyTargets(
        case.demands.observed, case.demands.reliability, case.demands.neighbors,
        case.demands.lengths, weights=weights,
    )  # fmt: skip
    made = case.plain.to_world(solve_sequentially(case.spaces, demands)[0])
    pair = case.damaged.pair
    _, directions, _ = compared(made, truth_of(pair))
    return (
        error(made, case.damaged),
        directions.ravel(),
        segment_lengths(made)[:, 1:].std(axis=0),
        jerk(made, pair).ravel(),
    )


def classes() -> str:
    """Return table IV of [SHJT13]: eq. 18, for worse and worse views of the body."""
    errors: dict[str, dict[str, list[Array]]] = {name: {} for name in CLASSES}
    for subject in SUBJECTS:
        for pair in takes_of(subject, *REPETITIONS)[::EXERCISE_STEP]:
            nothing = np.zeros(observed_postures(pair).shape[:2], bool)
            cases = [("(a) unchanged", Damaged("", "", pair, nothing))]
            cases += [(f"(b) hidden, {one.what}", one) for one in hidden(pair)]
            cases += [
                (f"(c) 8 joints missing, {one.seconds}", one)
                for one in with_missing_joints(pair, np.random.default_rng(0))
                if one.what == "8"
            ]
            for what, damaged in cases:
                for name, method in CLASSES.items():
                    made = method(damaged.pair, subject)
                    _, directions, _ = compared(made, truth_of(pair))
                    errors[name].setdefault(what, []).append(directions.ravel())
    columns = sorted(dict.fromkeys(what for each in errors.values() for what in each))
    rows = {
        name: [f"{100.0 * np.nanmean(np.concatenate(each[what])):.2f}" for what in columns]
        for name, each in errors.items()
    }
    head = "**Table IV of [SHJT13]**: cm to the joint above (eq. 18), all joints and frames\n\n"
    return head + table(["method", *columns], rows) + "\n"
