"""Matrices of learned models are covariances, or are refused when they are loaded."""

import numpy as np
import pytest
from learned_files import LEARNED, npz

from solvers.errors import InvalidFileError


@pytest.mark.parametrize(
    ("kind", "name"), [("motion mixture", "covariances"), ("body relation", "moments")]
)
@pytest.mark.parametrize("change", ["negative", "indefinite", "asymmetric", "huge", "infinite"])
def test_matrix_that_is_no_covariance_is_refused(tmp_path, kind, name, change):
    arrays = dict(LEARNED[kind].arrays)
    odd = np.array(arrays[name], dtype=float)
    if change == "negative":
        odd[..., 0, :] = odd[..., :, 0] = 0.0
        odd[..., 0, 0] = -10.0  # With the ridge of a body relation it has no inverse.
    elif change == "indefinite":
        odd[..., 0, 1] = odd[..., 1, 0] = 3.0 * odd.max()
    elif change == "asymmetric":
        odd[..., 0, 1] += 0.01 * odd.max()
    else:
        odd[..., 0, 0] = 1e30 if change == "huge" else np.inf

    assert "damaged" in refused(tmp_path / "odd.npz", kind, arrays | {name: odd})


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("weights", [0.5, 0.4]), ("weights", [1.0, 0.0]), ("frame_rate", 0.0),
    ],
)  # fmt: skip
def test_mixture_of_other_numbers_is_refused(tmp_path, name, value):
    arrays = LEARNED["motion mixture"].arrays | {name: np.array(value)}

    assert "damaged motion mixture" in refused(tmp_path / "odd.npz", "motion mixture", arrays)


def test_relation_of_no_joint_is_refused(tmp_path):
    arrays = {"keys": np.zeros(0, "U4"), "moments": np.zeros((0, 0))}
    arrays = LEARNED["body relation"].arrays | arrays

    assert "damaged body relation" in refused(tmp_path / "odd.npz", "body relation", arrays)


def refused(path, kind, arrays) -> str:
    path.write_bytes(npz(arrays))
    with pytest.raises(InvalidFileError) as error:
        LEARNED[kind].load(path)
    return str(error.value)
