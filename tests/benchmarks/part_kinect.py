"""How far joints are off on UI-PRMD, with the prior and libraries of the other subjects."""

from dataclasses import dataclass
from time import process_time

import numpy as np
from numpy.typing import NDArray

from .kinect_errors import compared, jerk
from .kinect_folds import SUBJECTS, takes_of, truth_of
from .kinect_methods import METHODS, Method
from .tables import number, table

Array = NDArray[np.float64]

WORST = 0.1
"""Share of the joint-frames, those in which raw is most off."""
COLUMNS = (
    "absolute, cm", "to the joint above, cm", "offset-free, cm", "worst tenth, cm",
    "jerk, m/s³", "ms per frame",
)  # fmt: skip


@dataclass(frozen=True, eq=False)
class Errors:
    """What a method made of all takes, metres; NaN where the truth is not known."""

    absolute: Array
    relative: Array
    free: Array
    """Beside the mean offset of each joint and take."""
    jerk: float
    seconds: float
    subjects: NDArray[np.str_]
    matched: NDArray[np.bool_]
    """Frames of takes whose markers are of what the Kinect saw."""


def errors_of(method: Method, n_repetitions: int) -> Errors:
    """Let a method rebuild the first repetitions of all exercises of all subjects."""
    found: list[tuple[Array, Array, Array]] = []
    jerks, whose, matched, taken = [], [], [], 0.0
    for subject in SUBJECTS:
        takes = takes_of(subject, n_repetitions)
        method(takes[0], subject)  # what is learned or read once is no time of a frame
        for pair in takes:
            started = process_time()
            made = method(pair, subject)
            taken += process_time() - started
            found.append(compared(made, truth_of(pair)))
            jerks.append(jerk(made, pair))
            whose += [subject] * len(made)
            matched += [pair.matched] * len(made)
    absolute, relative, free = (np.concatenate(parts) for parts in zip(*found, strict=True))
    return Errors(
        absolute, relative, free, float(np.nanmean(np.concatenate(jerks))), taken,
        np.array(whose), np.array(matched),
    )  # fmt: skip


def accuracy(n_repetitions: int) -> list[str]:
    """Return the main table, and the offset-free error subject by subject."""
    rows: dict[str, list[str]] = {}
    by_subject: dict[str, list[str]] = {}
    before = errors_of(METHODS["raw"], n_repetitions)
    worst = before.free >= np.nanquantile(before.free, 1.0 - WORST)
    for name, method in METHODS.items():
        found = before if name == "raw" else errors_of(method, n_repetitions)
        means = [found.absolute, found.relative, found.free, found.free[worst]]
        cells = [f"{100.0 * np.nanmean(one):.2f}" for one in means]
        rows[name] = [*cells, number(found.jerk), f"{1e3 * found.seconds / len(worst):.2f}"]
        by_subject[name] = [
            f"{100.0 * np.nanmean(found.free[found.subjects == one]):.2f}" for one in SUBJECTS
        ]
        print(name, *rows[name], flush=True)
    takes = [pair for one in SUBJECTS for pair in takes_of(one, n_repetitions)]
    truth = np.concatenate([jerk(truth_of(pair), pair) for pair in takes])
    rows["markers"] = ["0", "0", "0", "0", number(float(np.nanmean(truth))), "-"]
    head = f"**Accuracy, subject left out**, {len(takes)} takes, {len(worst)} frames\n\n"
    tail = "\n**Offset-free error of each subject left out** (cm)\n\n"
    return [
        head + table(["method", *COLUMNS], rows) + "\n",
        tail + table(["method", *SUBJECTS], by_subject) + "\n",
    ]
