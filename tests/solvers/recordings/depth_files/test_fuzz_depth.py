"""Damaged recordings of depth are read or refused, within the bounds of ../test_fuzz.py."""

from io import BytesIO

import numpy as np
import pytest
from damage import damaged, read_or_refuse, searching
from depth_files import depth_npz, matlab, pictures
from depth_folders import open3d, stray_scanner, tum
from hypothesis import given
from mkv_files import BINNED, bitmap, k4a
from PIL import Image

from solvers.recordings import DepthSettings, read_depth, read_recording

EXAMPLES = 30
OWN = DepthSettings(fx=9.0, fy=8.0)
DEPTH = pictures(5)
BY_COLUMN = DEPTH.transpose(1, 2, 0)


def jpeg() -> bytes:
    file = BytesIO()
    Image.fromarray(np.full((72, 128, 3), 99, np.uint8)).save(file, "JPEG")
    return file.getvalue()


FILES = {
    "npz": depth_npz(DEPTH),
    "npz, not packed": depth_npz(DEPTH, packed=False, color=np.zeros((5, 6, 8, 3), np.uint8)),
    "mat": matlab("depth", BY_COLUMN),
    "mat, not packed": matlab("depth", BY_COLUMN, packed=False),
    "mkv": k4a(DEPTH),
    "mkv, sizes open": k4a(DEPTH, open_sizes=True, group=True),
}
NUMBERS = [
    b"\0\0\0\0", b"\xff\xff\xff\xff", b"\x01\0\0\0", b"\x80",
    b"\x01\xff\xff\xff\xff\xff\xff\xff",
    b"\x0e\0\0\0\xff\xff\xff\x7f", b"(1, 4096, 4096)", b"'<f8'", b"PK\x03\x04", b"\xa3\x81",
    bitmap(4096, 4096, b"b16g"), bitmap(-1, 0, b"b16g"),
]  # fmt: skip
WORDS = [
    b"nan",
    b"-1",
    b"1e308",
    b"0",
    b",",
    b"\n",
    b"{",
    b"null",
    b"\xff",
    b"depth/",
    b"/etc",
    b'"',
]


@pytest.mark.parametrize("kind", FILES)
def test_undamaged_files_are_read(kind, tmp_path):
    (tmp_path / "take").write_bytes(FILES[kind])

    recording = read_depth(tmp_path / "take", OWN)

    np.testing.assert_allclose(recording.frame(3), DEPTH[3] * 0.001, rtol=1e-6)


@pytest.mark.parametrize("kind", FILES)
def test_damaged_depth_files_are_read_or_refused(kind, tmp_path):
    path = tmp_path / "take"

    @searching(EXAMPLES)
    @given(damaged(FILES[kind], NUMBERS))
    def search(content: bytes) -> None:
        path.write_bytes(content)
        read_or_refuse(lambda: read_depth(path, OWN))
        read_or_refuse(lambda: read_recording(path))

    search()


def test_a_damaged_recording_of_a_real_size(tmp_path):
    """With its own calibration, infrared and color."""
    complete = k4a(pictures(2, *BINNED), color=(b"MJPG", [jpeg()] * 2))
    path = tmp_path / "take"

    @searching(EXAMPLES // 3)
    @given(damaged(complete, NUMBERS + WORDS))
    def search(content: bytes) -> None:
        path.write_bytes(content)
        read_or_refuse(lambda: read_recording(path))

    search()


@pytest.mark.parametrize(
    ("layout", "name"),
    [
        ("open3d", "intrinsic.json"),
        ("open3d", "depth/00003.png"),
        ("open3d", "color/00003.jpg"),
        ("stray", "odometry.csv"),
        ("stray", "camera_matrix.csv"),
        ("stray", "confidence/000002.png"),
        ("tum", "depth.txt"),
        ("tum", "rgb.txt"),
    ],
)
def test_damaged_files_in_folders(layout, name, tmp_path):
    folder = {
        "open3d": lambda: open3d(tmp_path, DEPTH),
        "stray": lambda: stray_scanner(tmp_path, DEPTH, (0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0)),
        "tum": lambda: tum(tmp_path, DEPTH, np.arange(5) / 30.0),
    }[layout]()
    complete = (folder / name).read_bytes()
    settings = OWN if layout == "tum" else DepthSettings()

    @searching(EXAMPLES)
    @given(damaged(complete, WORDS if name.endswith(("txt", "csv", "json")) else NUMBERS))
    def search(content: bytes) -> None:
        (folder / name).write_bytes(content)
        read_or_refuse(lambda: read_depth(folder, settings))

    search()
