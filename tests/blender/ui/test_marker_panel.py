"""Where markers are selected, the panels offer what is for markers."""

import pytest


@pytest.fixture
def markers(blank, load, tmp_path, rng):
    tracks = load("solvers.motion").Tracks(("LASI", "RASI"), rng.normal(size=(9, 2, 3)), 30.0)
    load("solvers.recordings").write_trc(tracks, tmp_path / "two.trc")
    blank.ops.mocap_assist.import_recording(
        directory=str(tmp_path), files=[{"name": "two.trc"}]
    )


def test_markers_have_settings_of_their_own(draw, markers):
    clean, solve = draw("MOCAP_PT_clean"), draw("MOCAP_PT_markers")

    assert "unswap" in clean
    assert "plant_feet" not in clean
    assert {"evidence", "fill", "smooth", "subject", "mocap_assist.solve_skeleton"} <= set(
        solve
    )
