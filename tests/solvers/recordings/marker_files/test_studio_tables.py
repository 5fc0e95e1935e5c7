"""Tables of Motive, QTM and Nexus: unit, axes, gaps, rates, skeletons and what is no take."""

import numpy as np
import pytest
from exports.studio_tables import (
    motive,
    motive_bones,
    motive_points,
    qualisys_bodies,
    qualisys_markers,
    qualisys_skeleton,
    vicon,
    workstation,
)
from numpy.testing import assert_allclose

from solvers.errors import InvalidFileError
from solvers.motion import Tracks
from solvers.recordings import read_recording

NAMES = ("Anna:LFHD", "Anna:RFHD", "Anna:C 7")
POINTS = np.linspace(100.0, 1700.0, 54).reshape(6, 3, 3)


def z_up(positions):
    x, y, z = np.moveaxis(positions, -1, 0)
    return np.stack([x, -z, y], axis=-1)


@pytest.mark.parametrize("program", [vicon, workstation, qualisys_markers])
def test_markers_come_in_meters_without_the_prefix_of_the_actor(read_any, program):
    tracks = read_any(program(NAMES, POINTS))

    assert tracks.names == ("LFHD", "RFHD", "C 7")
    assert tracks.frame_rate == 100.0
    assert_allclose(tracks.positions, POINTS / 1000.0, atol=1e-9)


@pytest.mark.parametrize("unit", ["Millimeters", "Meters"])
def test_motive_markers_are_turned_to_z_up_in_the_unit_of_the_header(read_any, unit):
    factor = {"Millimeters": 1000.0, "Meters": 1.0}[unit]
    columns = motive_points("Marker", NAMES, factor * POINTS)

    tracks = read_any(motive(columns, fields={"Length Units": unit}))

    assert isinstance(tracks, Tracks)
    assert tracks.frame_rate == 120.0
    assert_allclose(tracks.positions, z_up(POINTS), atol=1e-6)


@pytest.mark.parametrize("blank", [np.nan, 0.0])
@pytest.mark.parametrize("program", [vicon, workstation, qualisys_markers])
def test_blank_and_zero_cells_are_gaps(read_any, program, blank):
    points = POINTS.copy()
    points[2:4, 1] = blank

    tracks = read_any(program(NAMES, points))

    assert np.isnan(tracks.positions[2:4, 1]).all()
    assert np.isfinite(tracks.positions).sum() == 3 * 16


def test_motive_gaps_and_skipped_frames_are_gaps(read_any):
    points = POINTS.copy()
    points[1, 0] = np.nan
    frames = [10, 11, 12, 14, 15, 16]
    times = [frame / 120.0 for frame in frames]

    tracks = read_any(
        motive(motive_points("Marker", NAMES, points), frames=frames, times=times)
    )

    assert tracks.n_frames == 7
    assert np.isnan(tracks.positions[1, 0]).all()
    assert np.isnan(tracks.positions[3]).all()
    assert_allclose(tracks.positions[5], z_up(POINTS[4]), atol=1e-6)


def test_repeated_time_stamps_are_skipped(read_any):
    times = np.array([0.0, 0.01, 0.01, 0.02, 0.03, 0.04])

    tracks = read_any(qualisys_markers(NAMES, POINTS, times=times, rate="EXT"))

    assert tracks.n_frames == 5
    assert tracks.frame_rate == 100.0
    assert_allclose(tracks.positions[2], POINTS[3] / 1000.0, atol=1e-6)


def test_an_external_clock_without_times_is_refused(read_any):
    with pytest.raises(InvalidFileError, match="does not state its frame rate"):
        read_any(qualisys_markers(NAMES, POINTS, rate="EXT", stamps=False))


def test_vicon_frames_that_are_skipped_are_gaps(read_any):
    tracks = read_any(vicon(NAMES, POINTS, frames=[5, 6, 7, 9, 10, 11]))

    assert tracks.n_frames == 7
    assert np.isnan(tracks.positions[3]).all()


def test_other_sections_of_vicon_are_skipped(read_any):
    devices = (
        "Devices\r\n1000\r\n,,Force\r\nFrame,Sub Frame,Fx\r\n,,N\r\n1,0,5\r\n1,1,6\r\n\r\n"
    )
    text = vicon(NAMES, POINTS, before=devices) + "Events\r\n100\r\n1,0,Foot Strike\r\n"

    assert_allclose(read_any(text).positions, POINTS / 1000.0, atol=1e-9)


def test_semicolons_and_decimal_commas_are_read(read_any):
    tracks = read_any(vicon(NAMES, POINTS, separator=";"))

    assert_allclose(tracks.positions, POINTS / 1000.0, atol=1e-9)


def test_quoted_numbers_with_decimal_commas_are_read(read_any):
    text = vicon(NAMES, POINTS)
    text = "\r\n".join(
        ",".join(f'"{cell.replace(".", ",")}"' for cell in line.split(","))
        for line in text.split("\r\n")
    )

    assert_allclose(read_any(text).positions, POINTS / 1000.0, atol=1e-9)


def test_decimal_commas_between_commas_are_refused(read_any):
    lines = vicon(NAMES, POINTS).split("\r\n")
    lines[5:-2] = [line.replace(".", ",") for line in lines[5:-2]]

    with pytest.raises(InvalidFileError, match=r"line 6: 20 cells .* decimal points"):
        read_any("\r\n".join(lines))


@pytest.mark.parametrize("stamps", [True, False])
@pytest.mark.parametrize("titles", [True, False])
def test_qualisys_columns_are_found_without_stamps_or_titles(read_any, stamps, titles):
    points = POINTS.copy()
    points[0, 0] = np.nan

    tracks = read_any(qualisys_markers(NAMES, points, stamps=stamps, titles=titles))

    assert_allclose(tracks.positions, points / 1000.0, atol=1e-6)


def test_tabs_after_the_titles_of_qualisys_are_no_columns(read_any):
    """QTM 2024 writes one after the last title, and none after the numbers."""
    text = qualisys_markers(NAMES, POINTS)
    titles = next(line for line in text.splitlines() if line.startswith("Frame"))

    tracks = read_any(text.replace(titles, titles + "\t"))

    assert tracks.names == ("LFHD", "RFHD", "C 7")


def test_frames_without_any_marker_keep_their_index(read_any):
    points = POINTS.copy()
    points[2] = np.nan

    tracks = read_any(qualisys_markers(NAMES, points, stamps=False, titles=False))

    assert tracks.n_frames == 6
    assert np.isnan(tracks.positions[2]).all()


@pytest.mark.parametrize("start", [b"\xef\xbb\xbf", b"\n\n", b""])
@pytest.mark.parametrize("ending", [b"\n", b"\r\n", b"\r"])
def test_marks_and_line_ends_do_not_matter(read_any, start, ending):
    text = vicon(NAMES, POINTS).encode().replace(b"\r\n", ending)

    assert_allclose(read_any(start + text).positions, POINTS / 1000.0, atol=1e-9)


def test_rigid_bodies_become_points_with_a_report(read_any, collected_messages):
    tracks = read_any(
        qualisys_bodies(("Head", "Bat"), POINTS[:, :2]), progress=collected_messages[1]
    )

    assert tracks.names == ("Head", "Bat")
    assert_allclose(tracks.positions, POINTS[:, :2] / 1000.0, atol=1e-6)
    assert "The origins of rigid bodies are read, not their rotations" in collected_messages[0]


def test_expected_markers_are_read_only_without_measured_ones(read_any):
    expected = motive_points("Rigid Body Marker", ("Bat:1", "Bat:2"), POINTS[:, :2])
    measured = motive_points("Marker", ("Bat:M1",), POINTS[:, 2:])

    assert read_any(motive(expected)).names == ("1", "2")
    assert read_any(motive(expected + measured)).names == ("M1",)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (qualisys_skeleton(reference="LOCAL"), "relative to their parents"),
        (qualisys_markers(NAMES, POINTS).replace("3D", "2D"), "2D positions of markers"),
        (qualisys_markers(NAMES, POINTS).replace("MARKER_NAMES", "NO_NAMES"), "no names of"),
        (qualisys_markers((*NAMES, "D"), POINTS, titles=False), "do not fit its 4 names"),
        (qualisys_markers(NAMES, POINTS).replace("100.000000", "tall"), "'tall' is not a"),
        (qualisys_markers(NAMES, np.full((3, 3, 3), np.nan)), "no markers that are observed"),
        ("NO_OF_FRAMES\t9\nFREQUENCY\t100\n", "header but no frames"),
        (vicon(NAMES, POINTS).replace("Trajectories", "Devices"), "no trajectories"),
        (vicon(NAMES, POINTS).replace(",X,Y,Z", ",RX,RY,RZ"), "no columns X, Y and Z"),
        ("\r\n".join(vicon(NAMES, POINTS).split("\r\n")[:5]), "no frames"),
        (vicon(NAMES, POINTS, rate="0"), "a frame rate of 0 Hz"),
        (motive(motive_bones(), fields={"Length Units": "Furlongs"}), "known length unit"),
        (motive(motive_bones(), fields={"Rotation Type": "XXZ"}), "known rotation type"),
        (motive(motive_bones()).replace("Frame,Time", "Row,Time"), "begins with Frame"),
        (motive(motive_bones()).replace(",Type", ",Sort").replace("Bone", "Thing"),
         "states what its columns are"),
        (motive(motive_bones()).replace("Position", "Velocity"), "no positions of markers"),
        (motive(motive_points("Marker", NAMES, 0 * POINTS)), "no markers that are observed"),
        (motive(motive_bones()).split("\r\n0,")[0] + "\r\n", "header but no frames"),
    ],
)  # fmt: skip
def test_what_cannot_be_read_is_refused_in_a_sentence(read_any, text, sentence):
    with pytest.raises(InvalidFileError, match=sentence):
        read_any(text)


def test_a_scale_replaces_the_unit(read_any):
    assert_allclose(read_any(vicon(NAMES, POINTS), scale=1.0).positions, POINTS, atol=1e-9)


def test_the_take_of_nexus_agrees_with_its_c3d(recordings):
    lab = recordings / "corpus/lab"
    tracks = read_recording(lab / "pyomeca_csv/markers.csv")
    c3d = read_recording(lab / "c3d_vicon/Vicon.c3d")

    assert tracks.frame_rate == c3d.frame_rate == 100.0
    assert tracks.n_frames == c3d.n_frames == 580
    assert set(tracks.names) <= set(c3d.names)
    same = c3d.positions[:, [c3d.names.index(name) for name in tracks.names]]
    assert_allclose(tracks.positions, same, atol=1e-5)
