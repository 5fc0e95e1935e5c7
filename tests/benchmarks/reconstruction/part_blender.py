"""What reaches Blender by default: the motion of an armature, compared with peers, on UI-PRMD.

Joints of every method are fitted with a skeleton of constant bone lengths in the same way. Lost
joints are split by whether they truly rested.
"""

from collections.abc import Callable
from functools import cache, partial

import numpy as np
from numpy.typing import NDArray

from solvers.arrays import Array
from solvers.motion import Motion, Tracks, forward_kinematics, motion_from_points
from solvers.motion.humanoid.posture_joints import posture_positions
from solvers.reconstruction import (
    ReconstructMethod,
    Reliability,
    ResidualMethod,
    measure_reliability,
)
from solvers.reconstruction.joint_rotations import (
    Reconstruction,
    motion_from_positions,
    positions_from_postures,
    resize_skeleton,
)
from solvers.reconstruction.published.residual_reconstruction import (
    reconstruct_published_residuals,
)
from solvers.workflows import reconstruct_motion

from ..peers import posture_regression
from ..peers.gap_fillers import linear, pchip
from ..shared.tables import number, table
from .kinect_damage import Damaged, with_missing_joints
from .kinect_errors import compared, jerk
from .kinect_folds import SUBJECTS, posture_library, residual_prior, takes_of, truth_of
from .kinect_methods import Method, by_reconstruct, joints, raw, regressed
from .kinect_pairs import Pair
from .part_losses import bridged_by

REST_M = 0.05
"""Diagonal (m) of the box around a true joint that rests while it is lost."""
IN_BLENDER = "ours, default, in Blender"
EXERCISE_STEP = 10
"""Lost joints are those of every tenth exercise, of each person."""
ACCURACY = (
    "joints, cm", "skeleton, cm", "in Blender, cm", "in Blender, offset-free, cm",
    "in Blender, jerk, m/s³", *SUBJECTS,
)  # fmt: skip
MISSING = (
    "at rest, cm", "moving, cm", "all, cm", "at rest: worse than lines by 1 cm",
)  # fmt: skip


def ours(pair: Pair, subject: str) -> Reconstruction:
    """Return what Reconstruct makes with its default settings."""
    return by_reconstruct(pair, subject, method=ReconstructMethod.BOTH)


def ours_in_blender(pair: Pair, subject: str) -> Motion:
    """Return the motion of the imported armature, as the button makes it."""
    imported = motion_from_points(pair.kinect.tracks, pair.kinect.parents)
    return reconstruct_motion(
        imported, posture_library(subject),
        residual_prior(subject, ResidualMethod.HIERARCHICAL), source=pair.kinect, resize=True,
    ).motion  # fmt: skip


def published(pair: Pair, subject: str) -> Reconstruction:
    """[ZH14] with the prior that Reconstruct has."""
    prior = residual_prior(subject, ResidualMethod.HIERARCHICAL)
    return reconstruct_published_residuals(pair.kinect, prior)


PEERS: dict[str, Method] = {
    "raw": raw,
    "constant offset": partial(regressed, posture_regression.constant),
    "ridge, complete pose": partial(regressed, posture_regression.ridge),
}
MADE: dict[str, Callable[..., Reconstruction]] = {
    "[ZH14] terms": published,
    "ours, default": ours,
}


def blender(n_repetitions: int) -> list[str]:
    """Return the table of whole takes."""
    rows: dict[str, list[str]] = {}
    for name in (*PEERS, *MADE):
        kinds: list[list[Array]] = [[], [], [], []]
        jerks, whose = [], []
        for subject in SUBJECTS:
            for pair in takes_of(subject, n_repetitions):
                made = _all_kinds(name, pair, subject)
                truth = truth_of(pair)
                errors = [compared(each, truth) for each in made]
                for kind, found in enumerate(errors):
                    kinds[kind].append(found[0])
                kinds[3].append(errors[2][2])
                jerks.append(jerk(made[2], pair))
                whose += [subject] * len(truth)
        together = [np.concatenate(each) for each in kinds]
        subjects = np.array(whose)
        rows[name] = [
            *map(_centimeters, together),
            number(float(np.nanmean(np.concatenate(jerks)))),
            *(_centimeters(together[2][subjects == one]) for one in SUBJECTS),
        ]
        print(name, *rows[name], flush=True)
    head = (
        f"**What reaches Blender**, subject left out, {n_repetitions} repetitions of each"
        " exercise, absolute errors: joints, the skeleton of a written file, and the imported"
        " armature; the last columns are of the armature\n\n"
    )
    return [head + table(["method", *ACCURACY], rows) + "\n"]


def _all_kinds(name: str, pair: Pair, subject: str) -> tuple[Array, Array, Array]:
    """Return joints of postures: as they are, of a file's skeleton, and of the armature."""
    if name in MADE:
        result = MADE[name](pair, subject)
        positions = posture_positions(result.tracks)
        shown = (
            _motion(pair, result.tracks, _reliability(pair), blender=True)
            if name.startswith("[")
            else ours_in_blender(pair, subject)
        )
        return positions, _joints(result.motion), _joints(shown)
    positions = PEERS[name](pair, subject)
    reliability, tracks = _reliability(pair), pair.kinect.tracks
    every = positions_from_postures(
        tracks.names, tracks.positions, reliability.combined, posture_positions(pair.kinect),
        positions,
    )  # fmt: skip
    moved = tracks.with_positions(every)
    return (
        positions,
        _joints(_motion(pair, moved, reliability, blender=False)),
        _joints(_motion(pair, moved, reliability, blender=True)),
    )


def _motion(pair: Pair, tracks: Tracks, reliability: Reliability, *, blender: bool) -> Motion:
    """Fit a skeleton: of clavicles and all, or that of the import with other lengths."""
    parents, skeleton = pair.kinect.parents, None
    if blender:
        imported = motion_from_points(pair.kinect.tracks, parents)
        skeleton = resize_skeleton(imported.skeleton, tracks, parents, reliability.combined)
    return motion_from_positions(tracks, parents, reliability.combined, skeleton=skeleton)


@cache
def _reliability(pair: Pair) -> Reliability:
    return measure_reliability(pair.kinect)


def _joints(motion: Motion) -> Array:
    positions = forward_kinematics(motion).positions
    return posture_positions(Tracks(motion.skeleton.names, positions, motion.frame_rate))


def rest(n_repetitions: int) -> list[str]:
    """Return the errors of lost joints, without each joint's mean offset."""
    methods: dict[str, Method] = {
        "linear interpolation": partial(bridged_by, linear),
        "PCHIP": partial(bridged_by, pchip),
        "ours, default": joints(ours),
    }
    found: dict[str, list[float]] = {name: [] for name in (*methods, IN_BLENDER)}
    rests, lengths = [], []
    for subject in SUBJECTS:
        for index, pair in enumerate(takes_of(subject, 1, 1)[::EXERCISE_STEP]):
            for each in with_missing_joints(pair, np.random.default_rng(index)):
                made = {name: method(each.pair, subject) for name, method in methods.items()}
                made[IN_BLENDER] = _joints(ours_in_blender(each.pair, subject))
                for joint in np.flatnonzero(each.where.any(axis=0)):
                    _compare(each, joint, made, found, rests, lengths)
    rested, weights = np.array(rests), np.array(lengths)
    rows = {
        name: _missing_row(np.array(errors), found, rested, weights)
        for name, errors in found.items()
    }
    head = (
        f"**Missing joints, at rest and moving** ({rested.sum()} and {(~rested).sum()} losses"
        " of .5 to 2 s; offset-free; a joint rests if it stays within 5 cm)\n\n"
    )
    return [head + table(["method", *MISSING], rows) + "\n"]


def _compare(
    damaged: Damaged,
    joint: int,
    made: dict[str, Array],
    found: dict[str, list[float]],
    rests: list[bool],
    lengths: list[int],
) -> None:
    """Add the error of each method on one lost joint, meters."""
    missing, truth = damaged.where[:, joint], truth_of(damaged.pair)[:, joint]
    if not np.isfinite(truth[missing]).all():
        return
    rests.append(bool(np.linalg.norm(np.ptp(truth[missing], axis=0)) < REST_M))
    lengths.append(int(missing.sum()))
    for name, positions in made.items():
        off = positions[:, joint] - truth
        off = off[missing] - np.nanmean(off[~missing], axis=0)
        found[name].append(float(np.linalg.norm(off, axis=-1).mean()))


def _missing_row(
    errors: Array,
    found: dict[str, list[float]],
    rest: NDArray[np.bool_],
    weights: Array,
) -> list[str]:
    def mean(values: Array, chosen: NDArray[np.bool_]) -> str:
        return f"{100.0 * np.average(values[chosen], weights=weights[chosen]):.2f}"

    worse = (errors > np.array(found["linear interpolation"]) + 0.01)[rest].mean()
    return [
        mean(errors, rest),
        mean(errors, ~rest),
        mean(errors, np.ones_like(rest)),
        f"{worse:.0%}",
    ]


def _centimeters(errors: Array) -> str:
    return f"{100.0 * np.nanmean(errors):.2f}"
