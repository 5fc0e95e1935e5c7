"""How far joints are off on UI-PRMD, with the prior and libraries of the other subjects."""

from dataclasses import dataclass, replace
from functools import partial
from time import process_time

import numpy as np
from numpy.typing import NDArray

from solvers.arrays import Array
from solvers.motion import JointRecording
from solvers.reconstruction import (
    CorrectionSettings,
    ResidualMethod,
    measure_reliability,
    reconstruct,
    reconstruct_postures,
)
from solvers.reconstruction.reliability.scores import posture_reliability
from solvers.reconstruction.residual_correction.correct_postures import predict_postures

from ..shared.tables import number, table
from .kinect_errors import bone_direction_errors, compared, jerk
from .kinect_folds import SUBJECTS, posture_library, residual_prior, takes_of, truth_of
from .kinect_methods import METHODS, Method, raw
from .kinect_pairs import Pair

LENGTHS = (3.0, 10.0, 30.0)
"""Seconds."""
WORST_FRACTION = 0.1
"""Fraction of the joint-frames: those with the largest raw errors."""
COLUMNS = (
    "absolute, cm", "vector from the parent, cm", "offset-free, cm", "worst tenth, cm",
    "jerk, m/s³", "ms per frame",
)  # fmt: skip


SLOW, FEW = (
    (
        "[SHJT13] postures, as published", "postures", "postures, of CMU alone",
        "ours (both), CMU alone",
    ),
    2,
)  # fmt: skip
"""Methods of which only the first repetitions are looked at, and how many."""
OTHERWISE = (
    "absolute, cm", "offset-free, cm", "worst tenth, cm",
    "vector from the parent, cm", "the same, offset-free", "the same, worst tenth",
)  # fmt: skip
EXERCISES = {
    "m01": "deep squat", "m02": "hurdle step", "m03": "inline lunge", "m04": "side lunge",
    "m05": "sit to stand", "m06": "leg raise", "m07": "shoulder abduction",
    "m08": "shoulder extension", "m09": "shoulder rotation", "m10": "shoulder scaption",
}  # fmt: skip
EXERCISES_TITLE = "\n**Absolute error by exercise** (cm; table 5.2 of [ZH14])\n\n"
OTHERWISE_TITLE = (
    "\n**Other measures**: the first three columns without the 40 takes whose markers show"
    " another stance, the others for all takes, by the vector from the parent joint (eq. 18 of"
    " [SHJT13])\n\n"
)


@dataclass(frozen=True, eq=False)
class Errors:
    """Errors of a method in all takes, meters; NaN where the truth is unknown."""

    absolute: Array
    relative: Array
    free: Array
    """Relative to the mean offset of each joint and take."""
    directions: Array
    """The same for the vector from the parent joint."""
    jerk: float
    seconds: float
    subjects: NDArray[np.str_]
    exercises: NDArray[np.str_]
    matched: NDArray[np.bool_]
    """Frames of takes whose markers are of what the Kinect saw."""


def errors_of(method: Method, n_repetitions: int) -> Errors:
    """Let a method rebuild the first repetitions of all exercises of all subjects."""
    found: list[tuple[Array, Array, Array]] = []
    directions = []
    jerks, whose, which, matched, taken = [], [], [], [], 0.0
    for subject in SUBJECTS:
        takes = takes_of(subject, n_repetitions)
        method(takes[0], subject)  # what is learned or read once is no time of a frame
        for pair in takes:
            started = process_time()
            made = method(pair, subject)
            taken += process_time() - started
            found.append(compared(made, truth_of(pair)))
            directions.append(bone_direction_errors(made, truth_of(pair)))
            jerks.append(jerk(made, pair))
            whose += [subject] * len(made)
            which += [pair.name[:3]] * len(made)
            matched += [pair.matched] * len(made)
    absolute, relative, free = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return Errors(
        absolute, relative, free, np.concatenate(directions),
        float(np.nanmean(np.concatenate(jerks))), taken, np.array(whose), np.array(which),
        np.array(matched),
    )  # fmt: skip


def accuracy(n_repetitions: int) -> list[str]:
    """Return the main table, errors as others may count them, and subject by subject."""
    rows: dict[str, list[str]] = {}
    otherwise: dict[str, list[str]] = {}
    by_subject: dict[str, list[str]] = {}
    by_exercise: dict[str, list[str]] = {}
    unmended = {n: errors_of(raw, n) for n in {n_repetitions, min(n_repetitions, FEW)}}
    for name, method in METHODS.items():
        n = min(n_repetitions, FEW) if name in SLOW else n_repetitions
        before = unmended[n]
        found = before if name == "raw" else errors_of(method, n)
        worst = found.free[_worst(before.free)]
        means = [found.absolute, found.relative, found.free, worst]
        taken = f"{1e3 * found.seconds / len(found.free):.2f}"
        label = f"{name} *" if name in SLOW else name
        rows[label] = [*map(_centimeters, means), number(found.jerk), taken]
        otherwise[label] = _otherwise(found, before)
        by_subject[label] = [
            _centimeters(found.free[found.subjects == one]) for one in SUBJECTS
        ]
        by_exercise[label] = [
            _centimeters(found.absolute[found.exercises == one]) for one in EXERCISES
        ]
        print(label, *rows[label], *otherwise[label], flush=True)
    takes = [pair for one in SUBJECTS for pair in takes_of(one, n_repetitions)]
    truth = np.concatenate([jerk(truth_of(pair), pair) for pair in takes])
    rows["markers"] = ["0", "0", "0", "0", number(float(np.nanmean(truth))), "-"]
    n_frames = len(unmended[n_repetitions].free)
    head = (
        f"**Accuracy, subject left out**, {len(takes)} takes, {n_frames} frames; rows that are"
        f" marked * are of {FEW} repetitions of each exercise alone, since they take long\n\n"
    )
    tail = "\n**Offset-free error of each subject left out** (cm)\n\n"
    return [
        head + table(["method", *COLUMNS], rows) + "\n" + _correction_alone(takes),
        _by_length(takes),
        OTHERWISE_TITLE + table(["method", *OTHERWISE], otherwise) + "\n",
        tail + table(["method", *SUBJECTS], by_subject) + "\n",
        EXERCISES_TITLE + table(["method", *EXERCISES.values()], by_exercise) + "\n",
    ]


def _worst(raw: Array) -> NDArray[np.bool_]:
    return np.asarray(raw >= np.nanquantile(raw, 1.0 - WORST_FRACTION))


def _centimeters(errors: Array) -> str:
    return f"{100.0 * np.nanmean(errors):.2f}"


def _otherwise(found: Errors, before: Errors) -> list[str]:
    """Return errors without takes whose markers are of another stance, and by eq. 18."""
    sound = found.matched
    worst = sound[:, None] & (
        before.free >= np.nanquantile(before.free[sound], 1.0 - WORST_FRACTION)
    )
    return [
        _centimeters(found.absolute[sound]),
        _centimeters(found.free[sound]),
        _centimeters(found.free[worst]),
        _centimeters(found.relative),
        _centimeters(found.directions),
        _centimeters(found.directions[_worst(before.directions)]),
    ]


def _by_length(takes: list[Pair]) -> str:
    """Return what a frame takes in takes of many lengths, made of some, to and fro."""
    library = posture_library(SUBJECTS[0])
    prior = residual_prior(SUBJECTS[0], ResidualMethod.HIERARCHICAL)
    some = [pair.kinect for pair in takes if pair.subject == SUBJECTS[0]][:: len(takes) // 15]
    rows: dict[str, list[str]] = {"postures": [], "ours (both)": []}
    for seconds in LENGTHS:
        taken = dict.fromkeys(rows, 0.0)
        for short in some:
            long = _to_and_fro(short, round(seconds * short.frame_rate))
            for name, solve in (
                ("postures", partial(reconstruct_postures, long, library)),
                ("ours (both)", partial(reconstruct, long, library, prior)),
            ):
                started = process_time()
                solve()
                taken[name] += (process_time() - started) / long.n_frames
        for name, total in taken.items():
            rows[name].append(f"{1e3 * total / len(some):.2f}")
    head = "\n**Processor time by length of the take**, ms per frame\n\n"
    return head + table(["method", *(f"{seconds:g} s" for seconds in LENGTHS)], rows) + "\n"


def _to_and_fro(recording: JointRecording, n_frames: int) -> JointRecording:
    """Return a take that goes on backwards, and forwards again, until it is long enough."""
    n = recording.n_frames
    order = np.arange(n_frames) % (2 * n)
    order = np.where(order < n, order, 2 * n - 1 - order)
    tracks = recording.tracks.with_positions(recording.tracks.positions[order])
    state = recording.tracking_state
    return replace(
        recording, tracks=tracks, tracking_state=None if state is None else state[order]
    )


def _correction_alone(takes: list[Pair]) -> str:
    """Return the time of prediction and smoothing, without reliability and skeleton."""
    taken, n_frames = 0.0, 0
    default = CorrectionSettings()
    for pair in takes:
        prior = residual_prior(pair.subject, ResidualMethod.HIERARCHICAL)
        reliability = measure_reliability(pair.kinect)
        weights = posture_reliability(pair.kinect, reliability.combined)
        started = process_time()
        predict_postures(pair.kinect, prior, weights, default)
        taken += process_time() - started
        n_frames += pair.kinect.n_frames
    each = 1e3 * taken / n_frames
    return (
        "\nThe correction alone (input smoothing, prediction, output smoothing) takes"
        f" {each:.2f} ms per frame; the rest of *residuals* is reliability, swapped limbs and"
        " the skeleton.\n"
    )
