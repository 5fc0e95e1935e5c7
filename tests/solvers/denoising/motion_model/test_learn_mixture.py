"""Mixtures of windows are learned whichever way bones are turned, and never unpickled."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising import default_method, denoise
from solvers.denoising.motion_model import (
    SHIPPED_PAIRS,
    MixtureSmoother,
    learn_motion_mixture,
    load_motion_mixture,
)
from solvers.denoising.motion_model.learn_mixture import extract_windows
from solvers.errors import InvalidFileError, InvalidMotionError
from solvers.rotations import inverse, multiply, quaternion_from_rotation_vector


@pytest.mark.parametrize("n_joints", [1, 2])
def test_mixture_is_learned_along_the_axes_of_the_joints(swinging_leg, n_joints):
    turned = swinging_leg.rotations.copy()
    turn = quaternion_from_rotation_vector(np.array([0.5, -0.8, 0.3]))
    turned[:, 1:] = multiply(multiply(inverse(turn), turned[:, 1:]), turn)

    windows, same = (
        extract_windows([swinging_leg.with_poses(each)], n_joints)
        for each in (swinging_leg.rotations, turned)
    )

    assert windows.shape[1:] == (3 * n_joints, 16)
    assert_allclose(abs(same), abs(windows), atol=1e-5)


def test_learned_mixture_comes_back_from_its_file(tmp_path, swinging_leg):
    learned = learn_motion_mixture([swinging_leg], n_components=2, trained_on="a leg")
    learned.save(tmp_path / "leg.npz")

    loaded = load_motion_mixture(tmp_path / "leg.npz")

    assert loaded.trained_on == "a leg"
    assert_allclose(loaded.weights.sum(), 1.0)
    assert_allclose(loaded.covariances, learned.covariances, rtol=1e-5, atol=1e-6)


def test_too_little_to_learn_from(swinging_leg):
    with pytest.raises(InvalidMotionError, match="too short"):
        learn_motion_mixture([swinging_leg.slice(0, 5)])


def test_damaged_file_is_refused(tmp_path):
    (tmp_path / "bad.npz").write_bytes(b"PK\x03\x04 no archive")

    with pytest.raises(InvalidFileError):
        load_motion_mixture(tmp_path / "bad.npz")


def test_mixture_of_pairs_is_refused_where_joints_are_asked_for():
    with pytest.raises(InvalidFileError, match="another number of joints"):
        load_motion_mixture(SHIPPED_PAIRS)


def test_shipped_mixtures_name_their_training_data():
    joints, pairs = load_motion_mixture(), load_motion_mixture(SHIPPED_PAIRS, 2)

    assert (joints.n_joints, pairs.n_joints) == (1, 2)
    assert "CMU" in joints.trained_on
    assert "CMU" in pairs.trained_on


def test_clean_smooths_joints_alone_and_with_their_parents(swinging_leg, monkeypatch):
    used = {}

    def smoother(noise, frame_rate, mixtures, parents, *others):
        used.update(mixtures=mixtures, parents=parents)
        return MixtureSmoother(noise, frame_rate, mixtures, parents, *others)

    monkeypatch.setattr(default_method, "MixtureSmoother", smoother)
    denoise(swinging_leg)

    assert [mixture.n_joints for mixture in used["mixtures"]] == [1, 2]
    assert used["parents"].tolist() == [-1, 0, 1, -1]  # the position has none
