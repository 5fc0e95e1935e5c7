"""Bases that no clips give are refused when they are loaded, not believed."""

import numpy as np
import pytest
from learned_files import LEARNED, npz

from solvers.denoising.channels import BODY_POSITION
from solvers.denoising.window_priors.filter_bases import load_filter_bases
from solvers.errors import InvalidFileError

BASES = LEARNED["bases"].arrays


@pytest.mark.parametrize(
    ("name", "value", "fault"),
    [
        ("frame_rate", np.array(1e-9), "a frame rate of 1e-09 Hz"),
        ("frame_rate", np.array(1e5), "a frame rate of 100000 Hz"),
        ("frame_rate", np.array(5.0), "their patterns are longer than 3 s"),
        ("keys", np.full_like(BASES["keys"], BODY_POSITION), "a joint is there twice"),
        ("references", 0.0 * BASES["references"], "a joint is not a rotation"),
        ("references", 2.0 * BASES["references"], "a joint is not a rotation"),
        (
            "references",
            0.0 * BASES["references"] + 1e300,
            "references has numbers out of range",
        ),
        (
            "clip_means",
            0.0 * BASES["clip_means"] + 1e300,
            "clip_means has numbers out of range",
        ),
        ("slow", -BASES["slow"], "slow is not a covariance"),
        ("fast", -1.0 - BASES["fast"], "fast has numbers out of range"),
        ("values", -1.0 - BASES["values"], "values has numbers out of range"),
    ],
)
def test_bases_are_refused_when_no_clips_give_them(tmp_path, name, value, fault):
    path = tmp_path / "odd.npz"
    path.write_bytes(npz(BASES | {name: value}))

    with pytest.raises(InvalidFileError, match=fault) as error:
        load_filter_bases(path)

    assert str(error.value).startswith(f"{path} holds damaged bases (")


def test_bases_are_loaded_as_they_were_learned(tmp_path):
    path = tmp_path / "bases.npz"
    path.write_bytes(npz(BASES))

    assert np.array_equal(load_filter_bases(path).slow, BASES["slow"])
