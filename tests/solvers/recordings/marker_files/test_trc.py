"""TRC files of all makers come out as what was measured, or as one sentence."""

import re

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.errors import InvalidFileError
from solvers.motion import Tracks
from solvers.recordings import read_recording, read_trc, write_trc

KEYS = "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate"
FILE = (
    "PathFileType\t4\t(X/Y/Z)\ttake.trc\n"
    f"{KEYS}\n"
    "100\t200\t4\t2\tmm\t200\n"
    "Frame#\tTime\tHEAD\t\t\tHAND\t\t\n"
    "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n"
    "\n"
    "1\t0.00\t10\t1500\t20\t300\t900\t40\n"
    "2\t0.01\t11\t1501\t21\t301\t901\t41\n"
    "3\t0.02\t12\t1502\t22\t302\t902\t42\n"
    "4\t0.03\t13\t1503\t23\t303\t903\t43\n"
)
"""Two markers, so Y is up; the second frame has HEAD at (0.011, -0.021, 1.501)."""
FRAMES = np.arange(4.0)[:, None, None]
POSITIONS = (
    np.array([[10.0, -20.0, 1500.0], [300.0, -40.0, 900.0]]) + (1, -1, 1) * FRAMES
) / 1000

Z_UP = {"Anto.trc", "SprintMotion.trc", "UpperLimbStatic.trc"}
RATES = {
    "10002-20130626160334-Unnamed.trc": 400, "Anto.trc": 100, "Knee.trc": 200,
    "SprintMotion.trc": 250, "UpperLimbStatic.trc": 100, "arm26_elbow_flex.trc": 120,
    "ballet_reduced.trc": 30, "dataWithEformat.trc": 119.88012,
    "dataWithNaNsWithSpaces.trc": 100, "exampleFormat.trc": 100, "leg39_swing.trc": 60,
    "marker_trajectories.trc": 60, "motion_capture_run.trc": 150, "sample.trc": 120,
    "static_walk_1.trc": 100, "static_walk_2.trc": 100, "subject02_running.trc": 60,
    "walk.trc": 150, "walk2.trc": 150, "walk_free_01.trc": 60, "walk_free_02.trc": 60,
    "walk_free_03.trc": 60,
}  # fmt: skip


@pytest.fixture
def read(make_reader):
    """Read a TRC file of this text."""
    return make_reader("take.trc")


@pytest.mark.parametrize("name", RATES)
def test_real_files_are_what_a_naive_reader_sees(recordings, name):
    path = recordings / "formats" / "trc" / name
    names, points = naive(path)

    tracks = read_recording(path)

    n_named = len(names)
    assert tracks.n_points == points.shape[1]
    assert tracks.names[:n_named] == (*names[:n_named],)
    assert all(each.startswith("point_") for each in tracks.names[n_named:])
    assert tracks.frame_rate == RATES[name]
    x, y, z = np.moveaxis(points, -1, 0)
    upright = points if name in Z_UP else np.stack([x, -z, y], axis=-1)
    assert_allclose(tracks.positions, upright, rtol=1e-12)


def test_every_file_at_hand_is_read_or_refused_with_the_reason(recordings):
    refused = {}
    for path in sorted((recordings / "formats" / "trc").iterdir()):
        try:
            read_recording(path)
        except InvalidFileError as error:
            refused[path.name] = str(error)

    assert list(refused) == ["futureOrientationInverseKinematics.trc"]
    assert "holds angles" in refused["futureOrientationInverseKinematics.trc"]
    rotated = recordings / "formats" / "trc" / "futureOrientationInverseKinematics.trc"
    assert read_trc(rotated, scale=1.0).names == ("humerus", "ulna")


def test_a_file_made_by_hand(read):
    tracks = read(FILE)

    assert tracks.names == ("HEAD", "HAND")
    assert tracks.frame_rate == 100.0
    assert_allclose(tracks.positions, POSITIONS)


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("\n", "\r\n"),
        ("\n", "\r"),
        ("\n", "\t\t\t\n"),
        ("Z2\n\n", "Z2\n"),
        ("Z2\n\n", "Z2\n\t\t\t\n\n\n"),
        ("\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n", ""),
        ("\t\tX1", "X1"),
        ("PathFileType\t4\t(X/Y/Z)\ttake.trc\n", ""),
        ("PathFileType\t4\t(X/Y/Z)\t", "pathfiletype  4\t(X/Y/Z) "),
        ("PathFileType", "\ufeffPathFileType"),
        ("100\t200\t4\t2\tmm\t200", "  100.0\t\t200.0\t\t   4\t\t2\t\t mm\t 200"),
        ("100\t200\t4\t2\tmm\t200", "100,00\t200,00\t4\t2\tmm\t200,00"),
        ("\t4\t2\tmm", "\t9000\t2000000\tmm"),
        ("\t4\t2\tmm", "\t0\t0\tmm"),
        ("OrigDataRate\n100\t200", "OrigDataRate\n\t200"),
        ("HEAD\t\t\tHAND\t\t", "HEAD\tHAND"),
        ("HEAD\t\t\tHAND\t\t", " HEAD \t\t\tHAND\t\t\t\t\t\t"),
        ("HEAD\t\t\tHAND", "Ann:HEAD\t\t\tAnn:HAND"),
        ("Frame#\tTime\tHEAD", "Frame#\tTime HEAD"),
        ("Frame#\tTime\tHEAD", "Frame #\t Times\t HEAD"),
        ("Frame#\tTime\tHEAD\t\t\tHAND\t\t", "Frame# Time HEAD HAND"),
        ("\t\tX1\tY1\tZ1\tX2", "\t\tX5\tY5\tZ5\tX 6"),
        ("\tmm\t200", "\tmm   200  0"),
        ("\t1501\t", "\t1.501E+03\t"),
        ("\t1501\t", "\t 1501,0 \t"),
        ("\t0.0", "\t3.1"),
        ("\n4\t", "\n40\t"),
    ],
)
def test_what_differs_between_makers_changes_nothing(read, old, new):
    """Each was seen in a file, or in the program of a maker."""
    assert old in FILE
    tracks = read(FILE.replace(old, new))

    assert tracks.names == ("HEAD", "HAND")
    assert tracks.frame_rate == 100.0
    assert_allclose(tracks.positions, POSITIONS)


@pytest.mark.parametrize(
    "gap",
    ["\t\t", "nan\tNaN\tNAN", "   NaN\t NaN  \t  nan", " \t  \t", "0.0\t0\t-0", "11\t\t21",
     "1.#QNAN\t1.#IND\t-1.#IND", "inf\t-inf\t1e999", "3.4e38\t1\t2", "null\tnone\t-"],
)  # fmt: skip
def test_missing_marker_is_a_gap_only_there(read, gap):
    tracks = read(FILE.replace("11\t1501\t21", gap))

    expected = POSITIONS.copy()
    expected[1, 0] = np.nan
    assert_array_equal(np.isnan(tracks.positions), np.isnan(expected))
    assert_allclose(tracks.positions, expected)


def test_rows_may_end_at_the_last_observed_marker(read):
    tracks = read(FILE.replace("\t301\t901\t41", "").replace("13\t1503\t23\t303\t903\t43", ""))

    assert_array_equal(tracks.visible, [[True, True], [True, False], [True, True], [False] * 2])


def test_columns_beyond_the_names_are_markers_without_one(read):
    tracks = read(FILE.replace("902\t42", "902\t42\t5\t6\t7\t\t\t"))

    assert tracks.names == ("HEAD", "HAND", "point_3")
    assert_array_equal(tracks.visible[:, 2], [False, False, True, False])
    assert_allclose(tracks.positions[2, 2], (0.005, -0.007, 0.006))


def test_times_in_milliseconds_are_detected_by_the_stated_rate(read):
    tracks = read(re.sub(r"\t0\.0(\d)\t", r"\t\g<1>0\t", FILE))

    assert tracks.frame_rate == 100.0
    assert_array_equal(tracks.positions, read(FILE).positions)


def test_frame_numbers_serve_where_the_times_do_not(read):
    tracks = read(re.sub(r"\t0\.0\d\t", "\t0.00\t", FILE).replace("\n3\t", "\n4\t"))

    assert tracks.frame_rate == 100.0
    assert_allclose(tracks.positions, POSITIONS)  # 1 2 4 4: neither of them increases.
    tracks = read(re.sub(r"\t0\.0\d\t", "\t0.00\t", FILE).replace("\n4\t", "\n5\t"))
    assert_array_equal(tracks.visible[:, 0], [True, True, True, False, True])


@pytest.mark.parametrize(
    ("names", "expected"),
    [
        ("HAND\t\t\tHAND", ("HAND", "HAND_2")),
        ("\t\t\tHAND", ("point_1", "HAND")),
        ("Tête\t\t\t*Unnamed 7", ("Tête", "*Unnamed 7")),
    ],
)
def test_names_are_unique_and_complete(read, names, expected):
    for encoding in ("utf-8", "latin-1"):
        text = FILE.replace("HEAD\t\t\tHAND", names)
        assert read(text.encode(encoding)).names == expected


@pytest.mark.parametrize(
    ("unit", "meters"),
    [("mm", 0.001), ("Millimeters", 0.001), ("m", 1.0), ("METRES", 1.0), ("cm", 0.01),
     ("inches", 0.0254), ("in", 0.0254), ("ft", 0.3048), ("", 0.001), ("parsecs", 0.001)],
)  # fmt: skip
def test_the_unit_is_the_header_s_or_gives_a_person_s_size(read, unit, meters):
    tracks = read(FILE.replace("\tmm\t", f"\t{unit}\t"))

    assert_allclose(tracks.positions, 1000 * meters * POSITIONS)
    assert_allclose(read(FILE, scale=2.0).positions, 2000 * POSITIONS)


@pytest.mark.parametrize("meters", [0.3048, 0.0254, 0.01, 0.001])
def test_the_height_of_named_markers_shows_a_unit_that_is_not_stated(tmp_path, rng, meters):
    """Feet are not read as meters, nor inches as centimeters."""
    names = ("LFHD", "RFHD", "C7", "LANK", "RANK", "LHEE", "RHEE", "LASI")
    heights = np.array([1.66, 1.66, 1.5, 0.08, 0.08, 0.04, 0.04, 1.0])
    points = rng.uniform(-0.2, 0.2, size=(5, 8, 3))
    points[..., 2] = heights
    write_trc(Tracks(names, 0.001 / meters * points, 60.0), tmp_path / "take.trc")
    text = (tmp_path / "take.trc").read_text().replace("\tmm\t", "\t\t")
    (tmp_path / "take.trc").write_text(text)
    messages = []

    tracks = read_trc(
        tmp_path / "take.trc", progress=lambda _, message="": messages.append(message)
    )

    assert tracks.conventions.unit == meters
    assert_allclose(tracks.positions[:, 0, 2], 1.66, atol=0.01)
    is_rare = meters in {0.3048, 0.0254}
    assert any("by the size of the body" in str(each) for each in messages) == is_rare


@pytest.mark.parametrize(("names", "up"), [("Y up", 2), ("Z up", 1), ("-z up", -1), ("", 2)])
def test_up_axis_is_read_from_the_first_line(read, names, up):
    tracks = read(FILE.replace("take.trc\n", f"take.trc\t{names}\t\t\n"))

    assert tracks.positions[1, 0, 2] == pytest.approx({2: 1.501, 1: 0.021, -1: -0.021}[up])


@pytest.mark.parametrize("axes", [(0, 1, 2), (0, 2, 1)])
def test_a_body_stands_upright(tmp_path, rng, axes):
    body = rng.uniform((-0.3, -0.2, 0.0), (0.3, 0.2, 1.8), size=(5, 12, 3))[..., axes]
    tracks = Tracks(tuple("abcdefghijkl"), body, 60.0)
    write_trc(tracks, tmp_path / "take.trc")
    text = (tmp_path / "take.trc").read_text().replace("\tY up", "")
    (tmp_path / "take.trc").write_text(text)

    size = np.ptp(read_trc(tmp_path / "take.trc").positions, axis=(0, 1))

    assert size[2] == max(size)


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (lambda text: text[:30], "no line that begins with Frame#"),
        (lambda text: text.replace("Frame#", "Number"), "no line that begins with Frame#"),
        (lambda text: text[: text.index("1\t0.00")], "a header but no frames"),
        (lambda text: text.replace("\t1501", "\tx1501"), r"line 8: 'x1501' is not a number"),
        (lambda text: text.replace("2\t0.01", "2\t"), "line 8 begins with '2 +11 1501"),
        (lambda text: text.replace("2\t0.01", "Events"), "line 8.*'Events' is not a number"),
        (lambda text: text.replace("\n100\t200", "\nfast\t200"), "line 3, DataRate: 'fast'"),
        (lambda text: text[: text.index("\t10\t1500")], "no markers that are observed"),
        (lambda text: text.replace("4\t0.03", "4\t1e308"), "line 10 begins with '4 1e308"),
        (lambda text: text.replace("4\t0.03", "4\t9999999"), "span 1e.07 s"),
        (lambda text: text.replace("\n100\t", "\n0\t").replace("0.0", "0\t"), "frame rate"),
        (
            lambda text: text + "5\t0.04" + "\t" * 200_000 + "7\n" + "6\t0.05\n" * 60,
            "hardly any",
        ),
    ],
)
def test_damage_is_one_sentence(read, spoil, sentence):
    with pytest.raises(InvalidFileError, match=sentence):
        read(spoil(FILE))


def test_a_file_of_times_alone_has_no_markers(read):
    rows = "".join(f"{frame}\t{frame / 100}\n" for frame in range(9))
    text = FILE[: FILE.index("1\t0.00")].replace("HEAD\t\t\tHAND", "")

    with pytest.raises(InvalidFileError, match="no markers, only the times"):
        read(text + rows)


def naive(path) -> tuple[list[str], np.ndarray]:
    """Read as one would by hand: names, and meters in the file's axes; zeros are gaps."""
    lines = path.read_text(encoding="utf-8").split("\n")
    meters = {"mm": 0.001, "m": 1.0}["mm" if "\tmm\t" in lines[2].replace(" ", "") else "m"]
    names = [cell.strip() for cell in lines[3].split("\t")[2:] if cell.strip()]
    for position in range(1, len(names)):
        if names[position] in names[:position]:
            names[position] += "_2"
    rows = []
    for line in lines[4:]:
        cells = [cell.strip() for cell in line.split("\t")]
        if cells[0].isdigit():
            rows.append([float(cell or "nan") for cell in cells[2:]])
    n_points = max(len(names), *(len(row) // 3 for row in rows))
    points = np.full((len(rows), n_points, 3), np.nan)
    for frame, row in enumerate(rows):
        for point in range(len(row) // 3):
            x, y, z = row[3 * point : 3 * point + 3]
            if (x, y, z) != (0.0, 0.0, 0.0) and x == x and y == y and z == z:
                points[frame, point] = (x, y, z)
    return names, meters * points
