"""All that rebuilds what a Kinect saw: ours, the published methods, and peers."""

from collections.abc import Callable, Sequence
from functools import cache, partial

import numpy as np
from numpy.typing import NDArray

from solvers.arrays import Array
from solvers.motion.humanoid.posture_heading import normalize_postures, rotate_about_vertical
from solvers.motion.humanoid.posture_joints import N_JOINTS, posture_positions
from solvers.reconstruction import (
    Reconstruction,
    ReconstructMethod,
    ReconstructSettings,
    ReliabilityMethod,
    ReliabilitySettings,
    ResidualMethod,
    measure_reliability,
    reconstruct,
    reconstruct_postures,
)
from solvers.reconstruction.published.posture_reconstruction import search_as_published
from solvers.reconstruction.published.residual_reconstruction import (
    ThreeTermSettings,
    reconstruct_published_residuals,
)
from solvers.reconstruction.residual_correction.correct_postures import smooth_trajectories
from solvers.reconstruction.residual_correction.inputs import smooth_postures

from ..peers import posture_regression
from ..peers.kalman import constant_velocity
from ..peers.one_euro import one_euro
from ..peers.posture_regression import Predict
from ..peers.smoothers import gaussian, gcv_spline
from .kinect_folds import (
    confident_prior,
    observed_postures,
    others,
    posture_library,
    residual_prior,
    truth_of,
)
from .kinect_pairs import Pair

Method = Callable[[Pair, str], Array]
"""From a take, and who was left out, to the joints of postures (n_frames, 20, 3)."""

SMOOTHING_S = 1 / 30
"""Seconds of the Gaussian that regressions see through, as our prior does."""
SMOOTHING = 0.05
"""Seconds; predictions of regressions are smoothed like ours."""
EXAMPLE_STEP_FRAMES = 5
"""Frames from one example to the next: 6 examples a second, as for our prior."""
SIGNS_PUBLISHED = ReliabilitySettings(method=ReliabilityMethod.PUBLISHED)
TERMS_PUBLISHED = ThreeTermSettings()


def raw(pair: Pair, subject: str) -> Array:
    """Return the recorded joints."""
    return observed_postures(pair)


def filtered(
    smooth: Callable[..., Array], pair: Pair, subject: str, **settings: float
) -> Array:
    """Smooth each coordinate on its own."""
    observed = observed_postures(pair)
    is_observed = np.isfinite(observed).all(axis=(0, 2))
    flat = observed[:, is_observed].reshape(len(observed), -1)
    observed[:, is_observed] = smooth(flat, pair.kinect.frame_rate, **settings).reshape(
        len(observed), -1, 3
    )
    return observed


def regressed(learn: Callable[[Array, Array], Predict], pair: Pair, subject: str) -> Array:
    """Add the offsets that a regression predicts in the frame of the heading."""
    return with_predicted_offsets(_regression(learn, subject), pair)


def with_predicted_offsets(predict: Predict, pair: Pair) -> Array:
    """Return joints with the offsets that a learned regression predicts."""
    smoothed = smooth_postures(pair.kinect, SMOOTHING_S)
    columns = _tracked(smoothed.features)
    offsets = np.zeros_like(smoothed.features)
    predicted = predict(smoothed.features[:, columns[1:]].reshape(len(offsets), -1))
    offsets[:, columns] = predicted.reshape(len(offsets), -1, 3)
    return _smoothed(smoothed.positions + smoothed.rotate_to_world(offsets), pair)


def from_examples(learn: Callable[[Array], Predict], pair: Pair, subject: str) -> Array:
    """Take the complete posture from true postures of others, scaled to the actor's size."""
    smoothed = smooth_postures(pair.kinect, SMOOTHING_S)
    columns = _tracked(smoothed.features)
    predict = _memory(learn, subject)
    made = np.full_like(smoothed.features, np.nan)
    found = predict(smoothed.features[:, columns].reshape(len(made), -1))
    observed = smoothed.normalized.postures[:, columns]
    size = np.linalg.norm(observed) / np.linalg.norm(smoothed.features[:, columns])
    made[:, columns] = size * found.reshape(len(made), -1, 3)
    return _smoothed(smoothed.normalized.to_world(made), pair)


@cache
def _regression(learn: Callable[[Array, Array], Predict], subject: str) -> Predict:
    return learn_offsets(learn, others(subject))


def learn_offsets(
    learn: Callable[[Array, Array], Predict], teachers: Sequence[Pair]
) -> Predict:
    """Learn from postures to the offsets of their true joints."""
    features, offsets = [], []
    for pair in teachers:
        smoothed = smooth_postures(pair.kinect, SMOOTHING_S)
        columns = _tracked(smoothed.features)
        off = rotate_about_vertical(
            truth_of(pair) - smoothed.positions, -smoothed.normalized.headings
        )
        features.append(smoothed.features[::EXAMPLE_STEP_FRAMES, columns[1:]])
        offsets.append(off[::EXAMPLE_STEP_FRAMES, columns])
    X, Y = (_flat(parts) for parts in (features, offsets))
    is_observed = np.isfinite(Y).all(axis=1)
    return learn(X[is_observed], Y[is_observed])


@cache
def _memory(learn: Callable[[Array], Predict], subject: str) -> Predict:
    examples = []
    for pair in others(subject):
        plain = normalize_postures(truth_of(pair), pair.truth.frame_rate)
        observed = smooth_postures(pair.kinect, SMOOTHING_S)
        size = np.nanmax(np.abs(observed.features)) / np.nanmax(
            np.abs(observed.normalized.postures)
        )
        columns = _tracked(observed.features)
        examples.append(size * plain.postures[::EXAMPLE_STEP_FRAMES, columns])
    X = _flat(examples)
    return learn(X[np.isfinite(X).all(axis=1)])


def _tracked(features: Array) -> NDArray[np.intp]:
    """Which joints this sensor measures; the hips come first."""
    return np.flatnonzero(np.isfinite(features).all(axis=(0, 2)))


def _flat(parts: list[Array]) -> Array:
    together = np.concatenate(parts)
    return together.reshape(len(together), -1)


def _smoothed(positions: Array, pair: Pair) -> Array:
    ones = np.ones((len(positions), N_JOINTS))
    return smooth_trajectories(positions, ones, SMOOTHING * pair.kinect.frame_rate)


def by_postures(pair: Pair, subject: str, *, others_too: bool = True) -> Reconstruction:
    """A library of postures alone."""
    return reconstruct_postures(pair.kinect, posture_library(subject, others_too))


def by_published_postures(pair: Pair, subject: str) -> Reconstruction:
    """[SHJT13]: a library of postures alone, searched frame by frame."""
    return reconstruct_postures(
        pair.kinect,
        posture_library(subject),
        reliability=measure_reliability(pair.kinect, settings=SIGNS_PUBLISHED),
        complete=search_as_published,
    )


def by_published_residuals(
    pair: Pair, subject: str, settings: ThreeTermSettings = TERMS_PUBLISHED
) -> Reconstruction:
    """[ZH14]: Gaussian processes joint by joint, and three terms frame by frame."""
    return reconstruct_published_residuals(
        pair.kinect, residual_prior(subject, ResidualMethod.PUBLISHED), settings=settings
    )


def by_reconstruct(
    pair: Pair,
    subject: str,
    *,
    method: ReconstructMethod,
    others_too: bool = True,
    causal: bool = False,
    confident: bool = False,
    shift: bool = True,
) -> Reconstruction:
    """Ours, with the offsets of the sensor that the prior knows.

    `confident`: and with what leaving out each of the others shows of its confidence.
    """
    return reconstruct(
        pair.kinect,
        posture_library(subject, others_too),
        confident_prior(subject)
        if confident
        else residual_prior(subject, ResidualMethod.HIERARCHICAL),
        settings=ReconstructSettings(method=method, shift=shift, causal=causal),
    )


def joints(solve: Callable[..., Reconstruction], **settings: object) -> Method:
    """Only where the joints of postures are."""
    return lambda pair, subject: posture_positions(solve(pair, subject, **settings).tracks)


METHODS: dict[str, Method] = {
    "raw": raw,
    **{
        f"Gaussian, {n} frames": partial(filtered, gaussian, sigma_frames=float(n))
        for n in (1, 2, 3)
    },
    "one-euro (causal)": partial(filtered, one_euro, slowest=2.0, speed_gain=5.0),
    "Kalman, constant velocity, smoothed": partial(filtered, constant_velocity, agility=0.5),
    "GCV smoothing spline": partial(filtered, gcv_spline),
    "constant offset": partial(regressed, posture_regression.constant),
    "ridge, complete pose": partial(regressed, posture_regression.ridge),
    "random-forest offsets (as Shen 2012)": partial(
        regressed, posture_regression.random_forest
    ),
    "Gaussian process, scikit-learn": partial(regressed, posture_regression.gaussian_process),
    "PCA projection": partial(from_examples, posture_regression.principal_projection),
    "kNN mean, true postures": partial(from_examples, posture_regression.nearest_mean),
    "[SHJT13] postures, as published": joints(by_published_postures),
    "postures": joints(by_postures),
    "postures, of CMU alone": joints(by_postures, others_too=False),
    "[ZH14] residuals, as published": joints(by_published_residuals),
    "residuals": joints(by_reconstruct, method=ReconstructMethod.RESIDUALS),
    "ours (both)": joints(by_reconstruct, method=ReconstructMethod.BOTH),
    "ours (both), CMU alone": joints(
        by_reconstruct, method=ReconstructMethod.BOTH, others_too=False
    ),
    "ours (both), causal": joints(by_reconstruct, method=ReconstructMethod.BOTH, causal=True),
}
