"""Examples of another movement are rejected by observed samples of the missing joints."""

import numpy as np
import pytest

from solvers.denoising import learn_filter_bases
from solvers.errors import SolveCancelled
from solvers.motion import Motion
from solvers.progress import unwatched
from solvers.samples import GaitSettings, walking_gait
from solvers.workflows import prior_validation as module
from solvers.workflows.prior_validation import prior_fills_gaps


def walk(cadence: float, duration: float = 4.0) -> Motion:
    return walking_gait(
        GaitSettings(cadence=cadence, duration=duration, frame_rate=30.0, speed=1.0)
    )


def leg(motion: Motion) -> list[int]:
    return list(motion.skeleton.subtree(motion.skeleton.names.index("LeftUpLeg")))


def without(motion: Motion, joints, frames: slice) -> Motion:
    rotations = motion.rotations.copy()
    rotations[frames, joints] = np.nan
    return motion.with_poses(rotations)


@pytest.fixture(scope="module")
def take():
    motion = walk(115)
    return without(motion, leg(motion), slice(40, 70))


@pytest.fixture(scope="module")
def good():
    return learn_filter_bases([walk(110), walk(120)])


def test_prior_of_walks_is_accepted_for_a_walk(take, good):
    assert prior_fills_gaps(take, good, unwatched)


@pytest.mark.parametrize(("times", "believed"), [(0.9, True), (1.1, False)])
def test_prior_of_other_movements_is_rejected(take, good, monkeypatch, times, believed):
    monkeypatch.setattr(
        module, "_error", lambda trial, bases, progress: 1.0 if bases is None else times
    )
    assert prior_fills_gaps(take, good, unwatched) is believed


@pytest.mark.parametrize("frames", [slice(40, 45), slice(0, None), slice(0, 0)])
def test_no_validation_runs_without_a_long_gap_or_observed_samples(frames, good, monkeypatch):
    motion = walk(115)
    monkeypatch.setattr(module, "denoise", None)
    assert prior_fills_gaps(without(motion, leg(motion), frames), good, unwatched)


def test_held_out_samples_are_observed_and_within_the_take(take):
    joints = leg(take)
    trials = list(module._trials(take))
    assert len(trials) == 2
    for trial in trials:
        frames, parts = np.nonzero(trial.hidden_mask)
        assert set(parts) == set(joints)
        assert 6 <= len(set(frames)) <= 30
        assert np.isfinite(trial.truth.rotations[trial.hidden_mask]).all()
        assert not np.isfinite(trial.masked.rotations[trial.hidden_mask]).any()


def test_a_long_take_is_validated_in_a_window(monkeypatch):
    motion = walk(115, duration=60.0)
    (first, _) = module._trials(without(motion, leg(motion), slice(300, 330)))
    assert first.truth.n_frames <= 30 + 2 * 120


def test_validation_can_be_cancelled(take, good):
    def cancel(fraction, message=""):
        if fraction > 0.3:
            raise SolveCancelled

    with pytest.raises(SolveCancelled):
        prior_fills_gaps(take, good, cancel)
