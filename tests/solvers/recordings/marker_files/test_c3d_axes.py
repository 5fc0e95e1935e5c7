"""Stated axes are obeyed unless the actor would hang."""

import numpy as np
import pytest

from solvers.recordings import read_c3d


def test_a_screen_that_hangs_the_actor_below_the_floor_is_not_obeyed(recordings):
    """QTM writes Y_SCREEN -Z of data with Z up."""
    said = []

    tracks = read_c3d(
        recordings / "corpus/lab/c3d_qualisys/Qualisys.c3d",
        progress=lambda _, message="": said.append(message),
    )

    heights = tracks.positions[..., 2]
    assert np.nanpercentile(heights, 1) > 0.0
    assert np.nanmedian(np.nanmax(heights, axis=1)) == pytest.approx(1.47, abs=0.05)
    assert any("Y_SCREEN says -Z" in message for message in said)
