"""Commas between cells, and commas in numbers."""

import numpy as np
from numpy.testing import assert_array_equal

from solvers.recordings import read_trc


def test_commas_of_a_spreadsheet_are_tabs(recordings, tmp_path):
    path = recordings / "corpus/lab/pyomeca_csv/markers.trc"

    with_commas = read_trc(path)

    (tmp_path / "tabs.trc").write_text(path.read_text().replace(",", "\t"))
    with_tabs = read_trc(tmp_path / "tabs.trc")
    assert with_commas.n_points == 51
    assert with_commas.frame_rate == 100.0
    assert_array_equal(with_commas.positions, with_tabs.positions)


def test_a_made_file_with_commas_is_that_with_tabs(tmp_path):
    text = (
        "PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n"
        "100\t100\t2\t2\tm\nFrame#\tTime\tA\t\t\tB\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n"
        "1\t0.00\t1.5\t2.5\t0.5\t1\t2\t3\n2\t0.01\t1.5\t\t\t1\t2\t4\n"
    )
    read = []
    for name, separator in (("tabs", "\t"), ("commas", ",")):
        (tmp_path / f"{name}.trc").write_text(text.replace("\t", separator))
        read.append(read_trc(tmp_path / f"{name}.trc"))

    assert read[0].names == read[1].names == ("A", "B")
    assert_array_equal(read[0].positions, read[1].positions)


def test_decimal_commas_are_no_separators(tmp_path):
    (tmp_path / "comma.trc").write_text(
        "PathFileType\t4\t(X/Y/Z)\ta.trc\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n"
        "100\t100\t2\t1\tm\nFrame#\tTime\tA\n\t\tX1\tY1\tZ1\n"
        "1\t0,00\t1,5\t2,5\t0,5\n2\t0,01\t1,5\t2,5\t0,5\n"
    )

    tracks = read_trc(tmp_path / "comma.trc")

    assert set(np.abs(tracks.positions).ravel()) == {1.5, 2.5, 0.5}
