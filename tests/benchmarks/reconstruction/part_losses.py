"""Errors of joints of UI-PRMD that are missing, hidden, shaken or swapped.

The error is the distance to the true joint, less the joint's mean offset over those
frames of the take that are not damaged.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cache, partial

import numpy as np

from solvers.arrays import Array
from solvers.motion.humanoid.posture_heading import normalize_postures
from solvers.reconstruction import ReconstructMethod
from solvers.reconstruction.residual_correction.inputs import SmoothedPostures, smooth_postures

from ..peers.gap_fillers import cubic, linear, pchip
from ..peers.one_euro import one_euro
from ..peers.smoothers import gaussian, hampel_gcv_spline
from ..shared.tables import table
from .kinect_damage import Damaged, hidden, shaken, swapped, with_missing_joints
from .kinect_folds import SUBJECTS, observed_postures, others, takes_of, truth_of
from .kinect_methods import (
    EXAMPLE_STEP_FRAMES,
    SMOOTHING_S,
    Method,
    by_postures,
    by_published_postures,
    by_reconstruct,
    filtered,
    joints,
    raw,
)
from .kinect_pairs import Pair

N_NEIGHBORS, N_COMPONENTS = 30, 20
NOISE = 0.02
"""Distance that observed joints may have from the space of components, meters."""
REPETITIONS = (1, 1)
"""How many of each exercise after how many: the second, since first ones are unreliable."""
LINEAR = "linear interpolation"


def hold(gapped: Array, frame_rate: float) -> Array:
    """Hold the last observed position of each joint."""
    observed = np.isfinite(gapped)
    last = np.maximum.accumulate(np.where(observed, np.arange(len(gapped))[:, None], 0), axis=0)
    return np.take_along_axis(gapped, last, axis=0)


def bridged_by(
    fill: Callable[[Array, float], Array], pair: Pair, subject: str, in_body: bool = False
) -> Array:
    """Fill the gaps of each coordinate, in the world or relative to hips and heading."""
    observed, rate = observed_postures(pair), pair.kinect.frame_rate
    if not in_body:
        return fill(observed.reshape(len(observed), -1), rate).reshape(observed.shape)
    plain = normalize_postures(observed, rate, np.isfinite(observed).all(axis=-1).astype(float))
    flat = plain.postures.reshape(len(observed), -1)
    return plain.to_world(fill(flat, rate).reshape(observed.shape))


def by_example(complete: Callable[..., Array], pair: Pair, subject: str) -> Array:
    """Complete postures frame by frame from what the Kinect saw of other subjects."""
    observed = observed_postures(pair)
    plain = normalize_postures(
        observed, pair.kinect.frame_rate, np.isfinite(observed).all(axis=-1).astype(float)
    )
    size = _size(smooth_postures(pair.kinect, SMOOTHING_S))
    flat = size * plain.postures.reshape(len(observed), -1)
    is_observed = np.isfinite(flat)
    examples = sensor_examples(subject)
    is_known = np.isfinite(examples).all(axis=0)
    result = flat.copy()
    patterns, which = np.unique(is_observed, axis=0, return_inverse=True)
    for number, pattern in enumerate(patterns):
        rows = np.flatnonzero(which.ravel() == number)
        result[np.ix_(rows, ~pattern & is_known)] = complete(
            examples, flat[rows][:, pattern], pattern, ~pattern & is_known
        )
    made = plain.to_world(result.reshape(observed.shape) / size)
    return np.where(np.isfinite(observed), observed, made)


def nearest_mean(examples: Array, values: Array, observed: Array, wanted: Array) -> Array:
    """Mean of the nearest examples."""
    known_examples = examples[:, observed]
    far = (known_examples**2).sum(axis=1) - 2.0 * values @ known_examples.T
    nearest = np.argpartition(far, N_NEIGHBORS, axis=1)[:, :N_NEIGHBORS]
    return examples[:, wanted][nearest].mean(axis=1)


def principal(examples: Array, values: Array, observed: Array, wanted: Array) -> Array:
    """Most probable point in the space of principal components."""
    mean, axes, spread = examples.mean(axis=0), *_components(examples)
    known_axes = axes[:, observed]
    pull = np.diag(NOISE**2 / spread)
    found = np.linalg.solve(
        known_axes @ known_axes.T + pull, known_axes @ (values - mean[observed]).T
    )
    return mean[wanted] + found.T @ axes[:, wanted]


def _components(examples: Array) -> tuple[Array, Array]:
    """Principal axes, (n, 60), and variances along them."""
    observed = np.isfinite(examples).all(axis=0)
    spread, vectors = np.linalg.eigh(np.cov(examples[:, observed].T))
    axes = np.zeros((N_COMPONENTS, examples.shape[1]))
    axes[:, observed] = vectors.T[::-1][:N_COMPONENTS]
    return axes, spread[::-1][:N_COMPONENTS]


@cache
def sensor_examples(subject: str) -> Array:
    """Postures of the others by the Kinect, normalized and of default size, (n, 60)."""
    found = [
        smooth_postures(pair.kinect, SMOOTHING_S).features[::EXAMPLE_STEP_FRAMES]
        for pair in others(subject)
    ]
    together = np.concatenate(found)
    return together.reshape(len(together), -1)


def _size(smoothed: SmoothedPostures) -> float:
    sizes = [
        np.nanmax(np.abs(one)) for one in (smoothed.features, smoothed.normalized.postures)
    ]
    return float(sizes[0] / sizes[1])


FILLED: dict[str, Method] = {
    "hold": partial(bridged_by, hold),
    LINEAR: partial(bridged_by, linear),
    "linear, in the body's frame": partial(bridged_by, linear, in_body=True),
    "PCHIP": partial(bridged_by, pchip),
    "cubic spline": partial(bridged_by, cubic),
    "PCA projection": partial(by_example, principal),
    "kNN mean": partial(by_example, nearest_mean),
}
OURS: dict[str, Method] = {
    "[SHJT13] postures, as published": joints(by_published_postures),
    "postures": joints(by_postures),
    "postures, of CMU alone": joints(by_postures, others_too=False),
    "residuals": joints(by_reconstruct, method=ReconstructMethod.RESIDUALS),
    "ours (both)": joints(by_reconstruct, method=ReconstructMethod.BOTH),
    "ours (both), CMU alone": joints(
        by_reconstruct, method=ReconstructMethod.BOTH, others_too=False
    ),
}
SMOOTHERS: dict[str, Method] = {
    "raw": raw,
    "Gaussian, 2 frames": partial(filtered, gaussian, sigma_frames=2.0),
    "one-euro (causal)": partial(filtered, one_euro, slowest=2.0, speed_gain=5.0),
    "Hampel, GCV spline": partial(filtered, hampel_gcv_spline),
}


def error(made: Array, damaged: Damaged) -> Array:
    """Distances on the damaged joints, meters, (n,)."""
    off = made - truth_of(damaged.pair)
    sound = np.where(damaged.where[..., None], np.nan, off)
    is_known = np.isfinite(sound).any(axis=(0, 2))
    mean_error = np.full(off.shape[1:], np.nan)
    mean_error[is_known] = np.nanmean(sound[:, is_known], axis=0)
    return np.asarray(np.linalg.norm(off - mean_error, axis=-1)[damaged.where])


@dataclass(frozen=True, eq=False)
class Found:
    """Errors of one method on the joints of one damage."""

    what: str
    seconds: str
    errors: Array


def losses(n_repetitions: int) -> list[str]:
    """Return tables of missing and of hidden joints."""
    methods = {**FILLED, **OURS}
    random, behind = (
        errors_of(with_missing_joints, methods, every=4),
        errors_of(hidden, methods, every=2),
    )
    return [
        errors_table("Missing joints, by number", random, lambda one: one.what),
        errors_table("Missing joints, by duration", random, lambda one: one.seconds),
        errors_table(
            "Joints hidden by the body, by where the sensor is", behind, lambda one: one.what
        ),
    ]


def damages(n_repetitions: int) -> list[str]:
    """Return tables of joints that were shaken or swapped, without a word of the tracker."""
    methods = {**SMOOTHERS, **OURS}
    jumpy, wrong = (
        errors_of(shaken, methods, every=3),
        errors_of(swapped, methods, every=3),
    )
    return [
        errors_table("Joints that vibrate", jumpy, lambda one: one.seconds),
        errors_table("Limbs swapped", wrong, lambda one: one.what),
    ]


def errors_of(
    damage: Callable[..., Iterator[Damaged]],
    methods: dict[str, Method],
    subjects: Sequence[str] = SUBJECTS,
    every: int = 1,
) -> dict[str, list[Found]]:
    """Let all methods mend the same damages; the last two rows see the takes undamaged.

    `every` second exercise is used where it is 2, and so on.
    """
    sound = {"nothing damaged, raw": raw, "nothing damaged, ours": OURS["ours (both)"]}
    result: dict[str, list[Found]] = {name: [] for name in (*methods, *sound)}
    for subject in subjects:
        for number, pair in enumerate(takes_of(subject, *REPETITIONS)[::every]):
            chance = [] if damage is hidden else [np.random.default_rng(number)]
            before = {name: method(pair, subject) for name, method in sound.items()}
            for each in damage(pair, *chance):
                made = {name: method(each.pair, subject) for name, method in methods.items()}
                for name, positions in {**made, **before}.items():
                    found = Found(each.what, each.seconds, error(positions, each))
                    result[name].append(found)
    return result


def errors_table(title: str, found: dict[str, list[Found]], by: Callable[[Found], str]) -> str:
    base = LINEAR if LINEAR in found else "raw"
    columns = list(dict.fromkeys(by(one) for one in found[base]))
    baseline = _mean(found[base])
    rows = {}
    for name, all_found in found.items():
        cells = [_mean([one for one in all_found if by(one) == column]) for column in columns]
        overall = _mean(all_found)
        rows[name] = [
            *map(_centimeters, [*cells, overall]),
            f"{overall / baseline - 1.0:+.0%}",
        ]
    n = sum(len(one.errors) for one in found[base])
    head = f"**{title}** (cm on these {n} joint-frames, offset-free)\n\n"
    return head + table(["method", *columns, "all", f"against {base}"], rows) + "\n"


def _mean(found: list[Found]) -> float:
    return float(np.nanmean(np.concatenate([one.errors for one in found])))


def _centimeters(meters: float) -> str:
    return f"{100.0 * meters:.2f}"
