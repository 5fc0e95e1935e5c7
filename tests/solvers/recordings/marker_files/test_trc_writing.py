"""What is written as TRC is what was measured, to the last digit, and blank where missing."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.testing import assert_allclose

from solvers.motion import Tracks
from solvers.recordings import read_recording, write_trc


@settings(max_examples=60, deadline=None, derandomize=True, database=None)
@given(st.data())
def test_what_is_written_is_read_back_to_the_last_digit(tmp_path_factory, data):
    """Also where the guess of the unit or of the axis would go wrong."""
    n_frames, n_points = data.draw(st.integers(1, 6)), data.draw(st.integers(1, 12))
    rate = data.draw(st.floats(0.5, 2000.0))
    rng = np.random.default_rng(data.draw(st.integers(0, 99)))
    positions = rng.normal(scale=data.draw(st.sampled_from([0.1, 2.0, 300.0])),
                           size=(n_frames, n_points, 3))  # fmt: skip
    positions[rng.random(size=(n_frames, n_points)) < 0.3] = np.nan
    positions[0, 0] = 1.0
    tracks = Tracks(tuple(f"M {number}" for number in range(n_points)), positions, rate)
    path = tmp_path_factory.mktemp("trc") / "take.trc"

    write_trc(tracks, path)
    back = read_recording(path)

    assert back.names == tracks.names
    assert back.frame_rate == tracks.frame_rate
    assert_allclose(back.positions, np.round(1000 * positions, 6) / 1000, atol=1e-12)
    written = path.read_bytes()
    write_trc(back, path)
    assert path.read_bytes() == written


def test_gaps_are_written_blank_without_the_text_nan(tmp_path):
    positions = np.array([
        [[0.011, -0.021, 1.501], [np.nan] * 3],
        [[np.nan] * 3, [-1e-12, 2, 3]],
    ])

    write_trc(Tracks(("HEAD", "HA\tND"), positions, 100.0), tmp_path / "take.trc")

    assert (tmp_path / "take.trc").read_text().splitlines()[1:] == [
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame"
        "\tOrigNumFrames",
        "100.0\t100.0\t2\t2\tmm\t100.0\t1\t2",
        "Frame#\tTime\tHEAD\t\t\tHA ND\t\t",
        "\t\tX1\tY1\tZ1\tX2\tY2\tZ2",
        "",
        "1\t0.0000000\t11.000000\t1501.000000\t21.000000\t\t\t",
        "2\t0.0100000\t\t\t\t0.000000\t3000.000000\t-2000.000000",
    ]


def test_point_at_the_origin_stays_observed(tmp_path):
    """Though others mean by the origin that a point was not seen."""
    tracks = Tracks(
        ("root", "head"), np.tile([[[0.0, 0.0, 0.0], [0.0, 0.0, 1.5]]], (5, 1, 1)), 50.0
    )
    write_trc(tracks, tmp_path / "take.trc")

    found = read_recording(tmp_path / "take.trc")

    assert_allclose(found.positions, tracks.positions, atol=2e-9)
