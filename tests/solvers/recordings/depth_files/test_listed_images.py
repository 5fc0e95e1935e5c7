"""A recording names its images: only those in its folder are opened, and only if they fit."""

import os
import struct
import zlib
from io import BytesIO
from pathlib import PureWindowsPath

import numpy as np
import pytest
from depth_files import pictures
from depth_folders import colors_of, open3d, plain, save_png, stray_scanner, tum
from mkv_files import BINNED, k4a
from PIL import Image, ImageFile

from solvers.errors import InvalidFileError
from solvers.recordings import DepthSettings, depth_takes_in, read_depth
from solvers.recordings.containers import listed_images as listing

LENS = DepthSettings(fx=9.0, fy=8.0)
OUTSIDE = r"lists the image .*, which is outside of it\. Copy the image into the folder\."


@pytest.fixture
def depth() -> np.ndarray:
    return pictures(9)


@pytest.fixture
def folder(tmp_path, depth):
    """A recording laid out as TUM RGB-D, and an image next to its folder."""
    save_png(tmp_path / "secret.png", depth[0])
    save_png(tmp_path / "secret_rgb.png", colors_of(depth[0]))
    return tum(tmp_path / "take", depth, np.arange(9) / 30.0)


@pytest.mark.parametrize("kind", ["depth", "rgb"])
@pytest.mark.parametrize(
    "displacement", ["up", "absolute", "device", "link", "folder that is a link"]
)
def test_an_image_outside_of_the_folder_is_refused_and_not_opened(
    folder, depth, tmp_path, kind, displacement, monkeypatch
):
    secret = tmp_path / ("secret.png" if kind == "depth" else "secret_rgb.png")
    name = {
        "up": f"../{secret.name}",
        "absolute": str(secret),
        "device": "/dev/zero",
        "link": "link.png",
        "folder that is a link": f"away/{secret.name}",
    }[displacement]
    (folder / "link.png").symlink_to(secret)
    (folder / "away").symlink_to(tmp_path)
    lines = (folder / f"{kind}.txt").read_text().splitlines()
    (folder / f"{kind}.txt").write_text("\n".join([*lines[:-1], f"0.27 {name}"]))
    opened = []
    real = listing.open_regular
    monkeypatch.setattr(listing, "open_regular", lambda path: opened.append(path) or real(path))

    if kind == "rgb":  # Depth needs no color.
        recording = read_depth(folder, LENS)
        for frame, picture in enumerate(depth):
            assert recording.frame(frame)[picture > 0].all()
        assert recording.color(0).max() > 0

    with pytest.raises(InvalidFileError, match=OUTSIDE):
        read_depth(folder, LENS).color(8)

    assert all(path.resolve().is_relative_to(folder) for path in opened)


def test_image_on_another_machine_is_refused_without_access(folder, monkeypatch):
    monkeypatch.setattr(listing, "PurePath", PureWindowsPath)
    monkeypatch.setattr(os.path, "realpath", lambda path: pytest.fail("It was asked for."))

    for name in (r"\\server\share\x.png", "//server/share/x.png", "C:x.png", r"a\..\..\x.png"):
        with pytest.raises(InvalidFileError, match=OUTSIDE):
            listing.open_listed(folder, name)


@pytest.mark.parametrize("kind", ["depth", "rgb"])
def test_a_pipe_among_the_images_is_a_missing_one(folder, depth, kind):
    path = sorted((folder / kind).iterdir())[4]
    path.unlink()
    os.mkfifo(path)

    recording = read_depth(folder, LENS)

    assert (recording.frame(4).max() == 0.0) == (kind == "depth")
    assert recording.color(4).max() == 0
    assert recording.color(5).max() > 0


def test_pipe_or_link_does_not_hide_adjacent_takes(tmp_path, depth):
    save_png(tmp_path / "secret.png", depth[0])
    shots = tmp_path / "shots"
    take = open3d(shots / "take", depth)
    os.mkfifo(shots / "pipe.png")
    (shots / "thumb.png").symlink_to(tmp_path / "secret.png")

    assert depth_takes_in(shots) == [take]


@pytest.mark.parametrize("name", ["a\0b.png", "x" * 300 + ".png", "rgb", ""])
def test_a_name_of_no_file_is_a_missing_image(folder, name):
    assert not listing.is_listed(folder, name)


@pytest.mark.parametrize("size", [(13_000, 13_000), (129, 10), (10, 97), (2**31 - 1, 1)])
def test_color_that_is_too_large_is_refused_by_its_header(folder, size, monkeypatch):
    path = sorted((folder / "rgb").iterdir())[4]
    path.write_bytes(announced(*size))
    monkeypatch.setattr(
        ImageFile.ImageFile, "load", lambda image: pytest.fail("It was unpacked.")
    )

    with pytest.raises(InvalidFileError, match=r"more than 128 x 96 pixels\. Export it"):
        read_depth(folder, LENS).color(4)


def test_color_of_another_size_that_is_bearable_is_brought_to_that_of_depth(folder):
    path = sorted((folder / "rgb").iterdir())[4]
    save_png(path, np.full((96, 128, 3), 77, np.uint8))

    assert (read_depth(folder, LENS).color(4) == 77).all()


@pytest.mark.parametrize("content", [b"%!PS-Adobe-3.0 EPSF-3.0\n%%BoundingBox: 0 0 8 6\n", b""])
def test_color_of_a_kind_that_starts_a_program_is_not_opened(folder, content):
    path = sorted((folder / "rgb").iterdir())[4]
    path.write_bytes(content)

    with pytest.raises(InvalidFileError, match=r"png is missing or damaged"):
        read_depth(folder, LENS).color(4)


@pytest.mark.parametrize("size", [(9, 6), (4096, 4096), (8, 5)])
def test_depth_that_has_changed_its_size_is_refused_before_it_is_unpacked(
    tmp_path, depth, size
):
    folder = plain(tmp_path, depth)
    recording = read_depth(folder, DepthSettings(fx=9.0, scale=0.001))
    (folder / "0003.png").write_bytes(announced(*size, kind=0, bits=16))

    with pytest.raises(InvalidFileError, match=r"0003\.png"):
        recording.frame(2)


def test_confidence_of_another_size_than_depth_is_refused(tmp_path, depth):
    folder = stray_scanner(tmp_path, depth, (0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0))
    save_png(folder / "confidence" / "000004.png", np.zeros((5, 8), np.uint8))

    with pytest.raises(InvalidFileError, match=r"000004\.png is no longer a gray image of"):
        read_depth(folder).frame(4)


def test_color_in_a_video_is_bounded_by_its_track(tmp_path, monkeypatch):
    file = BytesIO()
    Image.new("RGB", (1281, 720)).save(file, "JPEG")
    content = k4a(pictures(2, *BINNED), color=(b"MJPG", [file.getvalue()] * 2))
    (tmp_path / "take.mkv").write_bytes(content)
    monkeypatch.setattr(Image.Image, "convert", lambda *_: pytest.fail("It was unpacked."))

    with pytest.raises(InvalidFileError, match="damaged color image"):
        read_depth(tmp_path / "take.mkv").color(0)


def announced(width: int, height: int, kind: int = 2, bits: int = 8) -> bytes:
    """A PNG whose header states a size, and that holds next to nothing."""

    def chunk(name: bytes, content: bytes) -> bytes:
        checksum = zlib.crc32(name + content)
        return struct.pack(">I", len(content)) + name + content + struct.pack(">I", checksum)

    header = struct.pack(">IIBBBBB", width, height, bits, kind, 0, 0, 0)
    body = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"\0" * 99))
    return b"\x89PNG\r\n\x1a\n" + body + chunk(b"IEND", b"")
