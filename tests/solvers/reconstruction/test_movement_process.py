"""The Gaussian process of movements: exact, mirrored, and inactive far from its data."""

from dataclasses import replace

import numpy as np
import pytest
from bad_sensor import KNEE, SMALL_PRIOR, pair, recording, simulate_bad_sensor, truth
from numpy.testing import assert_allclose

from solvers.errors import InvalidFileError
from solvers.motion.humanoid.posture_heading import mirror_postures
from solvers.reconstruction import learn_residual_prior, load_residual_prior
from solvers.reconstruction.residual_correction.inputs import smooth_postures
from solvers.reconstruction.residual_correction.learn_movement_process import (
    ACTOR_VARIANCE,
    MEAN_VARIANCE,
    TAKE_VARIANCE,
    TrainingTake,
    learn_movement_process,
)
from solvers.reconstruction.residual_correction.movement_process import (
    CONTEXT_SCALE_M,
    MOVEMENT_SCALE_M,
    PERSONAL_STRENGTHS,
    POSTURE_SCALE_M,
    SHARED_STRENGTHS,
    movement_parts,
)

RATE = 30.0


def take(speed: float, actor: str) -> TrainingTake:
    """A walk with errors that depend on posture and speed."""
    features = truth(speed)
    features = features - features[:, :1]
    errors = 0.1 * np.roll(features, 1, axis=1) + 0.02 * np.gradient(features, axis=0) * RATE
    return TrainingTake(features, errors, RATE, actor)


TAKES = (take(0.9, "a"), take(1.2, "a"), take(1.6, "b"))


@pytest.fixture(scope="module")
def process():
    return learn_movement_process(TAKES, 3.0, 500, mirror=True)


def test_movement_process_equals_the_naive_full_process(process):
    """Solve one dense system of all examples and their mirror images, joint by joint."""
    parts, errors, takes, actors = [], [], [], []
    for image in (False, True):
        for number, one in enumerate(TAKES):
            observed, off = movement_parts(one.features, RATE)[:, 5::10], one.errors[5::10]
            parts.append(mirror_postures(observed) if image else observed)
            errors.append(mirror_postures(off) if image else off)
            takes += [number + 10 * image] * len(off)
            actors += [one.actor + "m" * image] * len(off)
    examples, requested = (
        np.concatenate(parts, axis=1),
        movement_parts(take(1.4, "c").features, RATE),
    )
    same_take, same_actor = (np.equal.outer(one, one) for one in (takes, np.array(actors)))
    covariance = (
        naive_covariance(examples, examples, SHARED_STRENGTHS)
        + MEAN_VARIANCE
        + TAKE_VARIANCE * same_take
    )
    covariance += same_actor * (
        naive_covariance(examples, examples, PERSONAL_STRENGTHS) + ACTOR_VARIANCE
    )
    covariance += np.eye(len(covariance))
    expected = (
        naive_covariance(requested, examples, SHARED_STRENGTHS) + MEAN_VARIANCE
    ) @ np.linalg.solve(covariance, np.concatenate(errors).reshape(len(covariance), -1))

    offsets, _ = process.predict(take(1.4, "c").features, RATE, np.arange(90))

    assert_allclose(offsets.reshape(90, -1), expected, atol=2e-4)
    assert np.abs(expected).max() > 0.05


def naive_covariance(one: np.ndarray, other: np.ndarray, strengths: tuple) -> np.ndarray:
    """Compute the covariance from its definition, for (5, n, 20, 3) parts."""
    distances = ((one[:, :, None] - other[:, None]) ** 2).sum(axis=(-2, -1))
    center = np.concatenate([movement_parts(t.features, RATE)[0, 5::10] for t in TAKES])
    center = 0.5 * (center + mirror_postures(center)).mean(axis=0)
    slope = np.einsum("ijk,mjk->im", one[0] - center, other[0] - center)
    a, b, c, d = strengths
    return (
        a * np.exp(-0.5 * distances[0] / POSTURE_SCALE_M**2)
        + b * slope
        + c * np.exp(-0.5 * distances[:3].sum(axis=0) / CONTEXT_SCALE_M**2)
        + d * np.exp(-0.5 * distances[3:].sum(axis=0) / MOVEMENT_SCALE_M**2)
    )


def test_movement_process_predicts_errors_at_a_new_speed(process):
    new = take(1.4, "c")

    offsets, nearness = process.predict(new.features, RATE, np.arange(90))

    left = np.linalg.norm(offsets - new.errors, axis=-1).mean()
    assert left < 0.3 * np.linalg.norm(new.errors, axis=-1).mean()
    assert nearness.min() > 0.9


def test_errors_of_a_mirrored_pose_are_mirrored(process):
    new = take(1.4, "c").features
    here, near = process.predict(new, RATE, np.arange(90))
    mirrored, also_near = process.predict(mirror_postures(new), RATE, np.arange(90))

    assert_allclose(mirror_postures(here), mirrored, atol=1e-5)
    assert_allclose(near, also_near, atol=1e-5)


def test_proximity_is_zero_far_from_the_points(process):
    upside_down = take(1.4, "c").features * (1.0, 1.0, -1.0)

    _, nearness = process.predict(upside_down, RATE, np.arange(90))

    assert nearness.max() < 0.01


def test_rarely_observed_joints_are_not_predicted():
    unobserved = replace(TAKES[0], errors=TAKES[0].errors.copy())
    unobserved.errors[:, KNEE] = np.nan
    unobserved.errors[::2, 3] = np.nan

    result = learn_movement_process((unobserved, TAKES[1]), 30.0, 500, mirror=False)

    assert KNEE in result.joints
    assert len(result.points) == 90
    both = replace(TAKES[1], errors=unobserved.errors)
    assert (
        KNEE not in learn_movement_process((unobserved, both), 30.0, 500, mirror=False).joints
    )


def test_too_few_examples_return_no_process():
    short = replace(TAKES[0], features=TAKES[0].features[:9], errors=TAKES[0].errors[:9])

    assert learn_movement_process((short,), 30.0, 500, mirror=True) is None


@pytest.mark.parametrize("n_frames", [1, 2, 5, 30])
def test_short_takes_and_blocks_of_frames(process, n_frames):
    features = take(1.4, "c").features[:n_frames]

    offsets, nearness = process.predict(features, RATE, np.arange(n_frames))

    assert np.isfinite(offsets).all()
    assert nearness.shape == (n_frames,)


@pytest.fixture(scope="module")
def prior():
    return learn_residual_prior(
        [pair(truth(speed)) for speed in (0.9, 1.6)], settings=SMALL_PRIOR
    )


def test_interpolation_between_predictions_is_accurate(prior):
    """Interpolate linearly between every second frame; the knee's error has cusps."""
    smoothed = smooth_postures(recording(simulate_bad_sensor(truth(1.3))), 1 / 30)
    few = prior.predict(smoothed)
    all_frames = prior.predict(replace(smoothed, frame_rate=10.0))
    still = replace(prior, movement=None)

    each = still.predict(smoothed, causal=True)
    some = still.predict(smoothed)

    assert few.offsets.shape == all_frames.offsets.shape == each.offsets.shape
    assert_allclose(some.offsets[::2], each.offsets[::2], atol=1e-12)
    assert_allclose(some.variances[::2], each.variances[::2], atol=1e-12)
    assert np.abs(some.offsets - each.offsets).max() < 0.15 * np.abs(each.offsets).max()


def test_causal_prediction_ignores_later_frames(prior):
    """Predictions of the first second do not depend on later frames."""
    smoothed = smooth_postures(recording(simulate_bad_sensor(truth(1.3))), 0.0)
    cut = replace(smoothed, features=smoothed.features[:30])

    complete, begun = (prior.predict(one, causal=True).offsets for one in (smoothed, cut))

    assert_allclose(complete[:30], begun, atol=1e-9)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"mean": np.zeros(4)}, "shapes do not fit, first that of movement_mean"),
        ({"joints": np.arange(1, 21)}, "movement_joints has numbers out of range"),
        ({"weights": np.full((1, 1), np.nan)}, "first that of movement_weights"),
    ],
)
def test_load_raises_for_damaged_movement_processes(prior, tmp_path, change, message):
    path = tmp_path / "prior.npz"
    replace(prior, movement=replace(prior.movement, **change)).save(path)

    with pytest.raises(InvalidFileError, match=message):
        load_residual_prior(path)
