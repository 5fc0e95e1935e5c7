"""Save and load residual priors; damaged files are refused."""

from dataclasses import replace

import numpy as np
import pytest
from bad_sensor import SMALL_PRIOR, pair, recording, simulate_bad_sensor, truth
from damage import damaged, searching
from hypothesis import given
from hypothesis import strategies as st

from solvers.errors import InvalidFileError, InvalidMotionError
from solvers.reconstruction import correct_postures, learn_residual_prior, load_residual_prior


@pytest.fixture(scope="module")
def prior():
    return learn_residual_prior(
        [pair(truth(speed)) for speed in (0.9, 1.6)], settings=SMALL_PRIOR
    )


def test_load_restores_a_saved_prior(prior, tmp_path):
    path = tmp_path / "prior.npz"
    prior.save(path)
    again = load_residual_prior(path)
    given_ = recording(simulate_bad_sensor(truth(1.3)))
    np.testing.assert_array_equal(
        correct_postures(given_, prior).tracks.positions,
        correct_postures(given_, again).tracks.positions,
    )


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"kernels": np.ones((2, 9))}, "shapes do not fit"),
        ({"kernels": -np.ones((20, 9))}, "not positive"),
        ({"means": np.full((20, 51, 3), np.nan)}, "not all numbers are finite"),
        ({"joints": np.array(["tail"] * 20)}, "unknown joints"),
    ],
)
def test_load_raises_for_a_damaged_prior(prior, tmp_path, change, message):
    path = tmp_path / "prior.npz"
    replace(prior, **change).save(path)
    with pytest.raises(InvalidFileError, match=message):
        load_residual_prior(path)


@given(data=st.data())
@searching(20)
def test_load_raises_for_a_broken_file(prior, tmp_path_factory, data):
    path = tmp_path_factory.mktemp("broken") / "prior.npz"
    prior.save(path)
    path.write_bytes(data.draw(damaged(path.read_bytes(), [b"0", b"\xff", b"PK"])))
    try:
        load_residual_prior(path)
    except InvalidFileError as refused:
        assert str(path) in str(refused)


def test_load_raises_for_coincident_joints(prior):
    with pytest.raises(InvalidMotionError, match="at one position"):
        correct_postures(recording(np.zeros((40, 20, 3))), prior)
