"""C3D files of all makers come out as what was measured, or as one sentence."""

import struct
import warnings
from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.errors import InvalidFileError, InvalidMotionError
from solvers.motion import Tracks
from solvers.recordings import read_c3d, write_c3d
from solvers.recordings.containers.c3d_file import C3dFile, is_c3d

INTEL, DEC, MIPS = 84, 85, 86
LABELS = [b"Ann:HEAD", b"Ann:HAND", b"Ann:HAND"]


def test_what_is_written_is_read_back(tracks, tmp_path):
    write_c3d(tracks, tmp_path / "take.c3d")

    back = read_c3d(tmp_path / "take.c3d")

    assert back.names == tracks.names
    assert back.frame_rate == tracks.frame_rate
    assert_allclose(back.positions, tracks.positions, atol=1e-6)  # 0.001 mm: single precision


@pytest.mark.parametrize("library", ["ezc3d", "c3d"])
def test_other_programs_read_what_is_written(tracks, tmp_path, library):
    write_c3d(tracks, tmp_path / "take.c3d")

    found = READ_BY[library](tmp_path / "take.c3d")

    assert found.labels == list(tracks.names)
    assert found.frame_rate == tracks.frame_rate
    assert_array_equal(found.seen, tracks.visible)
    known = tracks.visible
    assert_allclose(found.points[known], 1000 * tracks.positions[known], atol=1e-3)


def test_more_points_and_frames_than_one_number_holds(tmp_path, rng):
    """Beyond 255 labels and 65,535 frames the format has ways of its own."""
    names = tuple(f"M{number}" for number in range(300))
    many = Tracks(names, rng.normal(size=(2, 300, 3)), 100.0)
    long = Tracks(("M",), rng.normal(size=(70_000, 1, 3)), 1000.0)

    for tracks in (many, long):
        write_c3d(tracks, tmp_path / "take.c3d")
        back = read_c3d(tmp_path / "take.c3d")
        assert back.names == tracks.names
        assert_allclose(back.positions, tracks.positions, atol=1e-6)


@pytest.mark.parametrize("processor", [INTEL, DEC, MIPS])
@pytest.mark.parametrize("step", [0.5, -1.0], ids=["integers", "floats"])
def test_every_kind_of_number(tmp_path, processor, step):
    """Files made by hand, value by value, in the number formats of three processors."""
    values = np.array([[[100, 200, 1500, 0], [0, 0, 0, -1], [-50, 7, 3, 0]]] * 2)
    path = tmp_path / "take.c3d"
    path.write_bytes(c3d_bytes(values, processor, step))

    tracks = read_c3d(path)

    scale = 0.001 * (step if step > 0 else 1.0)
    assert tracks.names == ("HEAD", "HAND", "HAND_2")
    assert tracks.frame_rate == 50.0
    assert_allclose(tracks.positions[1, 0], np.array([100, 200, 1500]) * scale, rtol=1e-6)
    assert_array_equal(tracks.visible, [[True, False, True]] * 2)


@pytest.mark.parametrize(
    ("up", "expected"),
    [(b"+Z", (1, 2, 3)), (b"+Y", (1, -3, 2)), (b"+X", (2, 3, 1)), (b"-Z", (1, -2, -3))],
)
def test_up_follows_the_screen_parameters(tmp_path, up, expected):
    values = np.array([[[1000, 2000, 3000, 0]] * 3])
    path = tmp_path / "take.c3d"
    path.write_bytes(c3d_bytes(values, INTEL, -1.0, up=up))

    assert_allclose(read_c3d(path).positions[0, 0], expected, atol=1e-6)


def test_real_files_agree_with_the_libraries(recordings):
    """Wherever py-c3d reads a file, and ezc3d where it is right, all see the same points.

    ezc3d never returns from BKINtechnologies.c3d; and it takes the points of four files with
    `type1` in common (no POINT:UNITS or none right) from the wrong place.
    """
    n_compared = 0
    for path in sorted((recordings / "formats" / "c3d").iterdir()):
        if path.stat().st_size > LARGE:
            continue  # py-c3d takes seconds.
        points, observed = C3dFile(path).read_points()
        for library, read in READ_BY.items():
            if library == "ezc3d" and path.name in MISREAD_BY_EZC3D:
                continue
            try:
                theirs = read(path)
            except (ValueError, RuntimeError, OSError, AssertionError, KeyError, struct.error):
                continue
            known = observed & theirs.seen
            assert (observed == theirs.seen).mean() > 0.6, path
            assert_allclose(points[known], theirs.points[known], rtol=1e-5, atol=1e-4)
            n_compared += 1
    assert n_compared > 35


def test_every_file_at_hand_is_read_or_refused_with_the_reason(recordings):
    folders = [recordings / "formats" / "c3d", recordings / "markers"]
    paths = [path for folder in folders for path in sorted(folder.iterdir())]
    refused = {}
    for path in [*paths, recordings / "mocap" / "05_13.c3d"]:
        try:
            tracks = read_c3d(path)
        except InvalidFileError as error:
            refused[path.name] = str(error)
        else:
            extent = np.nanmax(np.abs(tracks.positions))
            assert 0.3 < extent < 12.0, f"{path}: {extent} m"

    assert list(refused) == ["parameterOverflow.c3d"]
    assert "no points that are observed" in refused["parameterOverflow.c3d"]


def test_people_stand_upright(recordings):
    """Neither of these says which way is up: one has Y up, the other Z."""
    for name in ("standing.C3D", "mocap36.c3d"):
        tracks = read_c3d(recordings / "formats" / "c3d" / name)
        size = np.nanmedian(np.ptp(np.nan_to_num(tracks.positions, nan=0.5), axis=1), axis=0)
        assert size[2] == max(size)


def test_joint_angles_and_forces_are_no_points(recordings):
    names = read_c3d(recordings / "formats" / "c3d" / "PiG_Motion-FlatFoot-Hole.c3d").names

    assert "LANK" in names
    assert not [name for name in names if name.endswith(("Angles", "Force", "Moment", "Power"))]


@pytest.mark.parametrize(
    ("spoil", "sentence"),
    [
        (lambda content: b"", "not a C3D file, or is cut short"),
        (lambda content: b"text" * 1000, "not a C3D file"),
        (lambda content: content[: len(content) // 2], "cut short"),
        (lambda content: content[:1024], "cut short"),
        (lambda content: content[:2] + b"\0\0" + content[4:], "no points, only other signals"),
    ],
)
def test_damage_is_one_sentence(tracks, tmp_path, spoil, sentence):
    path = tmp_path / "take.c3d"
    write_c3d(tracks, path)
    path.write_bytes(spoil(path.read_bytes()))

    with pytest.raises(InvalidFileError, match=sentence):
        read_c3d(path)


@pytest.mark.parametrize(
    ("spoil", "known"),
    [
        (lambda complete: complete, True),
        (lambda complete: complete[:600], True),
        (lambda complete: complete[:512], True),
        (lambda complete: b"\xc8" + complete[1:], True),
        (lambda complete: complete[:515] + b"\0" + complete[516:], True),
        (lambda complete: b"\xc8" + complete[1:515] + b"\0" + complete[516:], False),
        (
            lambda complete: b"\x89PNG\r\n\x1a\n" + complete[8:515] + b"\0" + complete[516:],
            False,
        ),
    ],
    ids=["whole", "cut", "header alone", "first byte", "processor", "both", "PNG"],
)
def test_a_file_is_known_by_its_header_or_its_parameters(tracks, tmp_path, spoil, known):
    path = tmp_path / "take.c3d"
    write_c3d(tracks, path)

    assert is_c3d(spoil(path.read_bytes())) == known


def test_every_file_at_hand_is_known(recordings):
    for path in (recordings / "formats" / "c3d").iterdir():
        with path.open("rb") as file:
            assert is_c3d(file.read(4096)), path


@pytest.mark.parametrize("kind", [-1, 1, 2, 4])
def test_oversized_parameter_is_skipped(tmp_path, kind):
    """Found by fuzzing: 127 sizes of 255 made a product that wrapped around."""
    complete = c3d_bytes(np.ones((2, 3, 4)), INTEL, -1.0)
    endless = struct.pack("<bb3sHbB", 3, 1, b"BIG", 132, kind, 127) + b"\xff" * 127 + b"\0"
    entries = complete[512 + 4 : 1024].rstrip(b"\0") + b"\0"
    path = tmp_path / "take.c3d"
    path.write_bytes(complete[:516] + (entries + endless).ljust(508, b"\0") + complete[1024:])

    tracks = read_c3d(path)

    assert "POINT:BIG" in C3dFile(path).parameters
    assert tracks.names == ("HEAD", "HAND", "HAND_2")


def test_more_names_than_fit_are_refused_and_nothing_is_written(tmp_path):
    names = tuple(f"{'M' * 200}{number}" for number in range(700))
    tracks = Tracks(names, np.ones((1, 700, 3)), 100.0)

    with pytest.raises(InvalidMotionError, match="700 points with these names"):
        write_c3d(tracks, tmp_path / "take.c3d")
    assert not list(tmp_path.iterdir())


@pytest.fixture
def tracks(rng) -> Tracks:
    """Five points, some of them missing in some frames; more than one block of data."""
    positions = rng.normal(scale=2.0, size=(40, 5, 3))
    positions[3:9, 1] = np.nan
    positions[0, 4] = np.nan
    return Tracks(("LASI", "RASI", "C7", "LFHD", "x"), positions, 120.0)


LARGE = 350_000
MISREAD_BY_EZC3D = {
    "BKINtechnologies.c3d", "561xxa01_anonym.C3D", "dynamic.C3D", "standing.C3D", "type1.C3D",
}  # fmt: skip


def _with_ezc3d(path):
    import ezc3d

    file = ezc3d.c3d(str(path))
    points = file["data"]["points"][:3].transpose(2, 1, 0)
    observed = np.isfinite(points).all(axis=-1) & (
        file["data"]["meta_points"]["residuals"][0].T >= 0
    )
    described = file["parameters"]["POINT"]
    return SimpleNamespace(
        points=points,
        seen=observed,
        labels=described["LABELS"].get("value", []),
        frame_rate=described["RATE"]["value"][0],
    )


def _with_c3d(path):
    import c3d

    with path.open("rb") as file, warnings.catch_warnings():
        warnings.simplefilter("ignore")
        reader = c3d.Reader(file)
        points = np.array([points for _, points, _ in reader.read_frames(copy=True)])
        labels = [label.strip() for label in reader.point_labels]
    return SimpleNamespace(
        points=points[..., :3], seen=points[..., 3] >= 0, labels=labels,
        frame_rate=reader.point_rate,
    )  # fmt: skip


READ_BY = {"ezc3d": _with_ezc3d, "c3d": _with_c3d}


def c3d_bytes(values: np.ndarray, processor: int, step: float, up: bytes = b"+Z") -> bytes:
    """Write a C3D file by hand: 1 block of header, 1 of parameters, then the values."""
    order = ">" if processor == MIPS else "<"

    def real(value: float) -> bytes:
        if processor != DEC:
            return struct.pack(f"{order}f", value)
        coded = struct.pack("<f", 4.0 * value)
        return coded[2:] + coded[:2]

    def integers(*numbers: int) -> bytes:
        return struct.pack(f"{order}{len(numbers)}h", *numbers)

    def entry(name: bytes, group: int, rest: bytes) -> bytes:
        return struct.pack("bb", len(name), group) + name + integers(2 + len(rest)) + rest

    def texts(name: bytes, values: list[bytes]) -> bytes:
        length = max(len(value) for value in values)
        data = b"".join(value.ljust(length) for value in values)
        return entry(name, 1, struct.pack("bBBB", -1, 2, length, len(values)) + data + b"\0")

    header = bytes([2, 80]) + integers(values.shape[1], 0, 1, len(values), 0)
    header += real(step) + integers(3, 0) + real(50.0)
    parameters = bytes([1, 80, 1, processor]) + entry(b"POINT", -1, b"\0")
    parameters += entry(b"RATE", 1, struct.pack("bB", 4, 0) + real(50.0) + b"\0")
    parameters += texts(b"LABELS", LABELS) + texts(b"UNITS", [b"mm"])
    parameters += texts(b"Y_SCREEN", [up]) + b"\0\0"
    numbers = [int(value) for value in values.ravel()]
    data = integers(*numbers) if step > 0 else b"".join(real(value) for value in numbers)
    return header.ljust(512, b"\0") + parameters.ljust(512, b"\0") + data
