"""Sizes of OpenEXR pictures are known before anything is unpacked."""

import struct

import pytest
from exr_files import exr_header

from solvers.errors import InvalidFileError
from solvers.recordings.depth_files.exr_header import check_exr


@pytest.fixture
def check(tmp_path):
    path = tmp_path / "depth1.exr"

    def check(content):
        path.write_bytes(content)
        check_exr(path)

    return check


@pytest.mark.parametrize("channels", ["V", "RGBA", "BGRAZ"])
def test_plausible_image_is_accepted(check, channels):
    check(exr_header(640, 480, channels))
    check(exr_header(4096, 4096, channels[:4]))


@pytest.mark.parametrize(
    ("width", "height"), [(12_000, 12_000), (2, 2**30), (2**31 - 1, 2), (0, 20), (-5, 20)]
)
def test_a_size_that_no_camera_has_is_refused(check, width, height):
    with pytest.raises(InvalidFileError, match=r"depth1\.exr has images of .* pixels, which"):
        check(exr_header(width, height))


def test_so_is_that_of_any_part(check):
    small, large = exr_header(32, 20, multipart=True), exr_header(12_000, 9)[8:]

    check(small + b"\0")
    with pytest.raises(InvalidFileError, match="12000 x 9 pixels"):
        check(small + large + b"\0")


def test_many_channels_are_refused(check):
    check(exr_header(1920, 1080, "A" * 32))
    with pytest.raises(InvalidFileError, match="has 33 channels, too many to read"):
        check(exr_header(1920, 1080, "A" * 33))


@pytest.mark.parametrize(
    "content",
    [
        b"",
        b"\x89PNG\r\n\x1a\n" + bytes(90),
        exr_header(32, 20)[:-40],
        exr_header(32, 20, name="dataWindows"),
        exr_header(32, 20, name="d" * 300),
        exr_header(32, 20)[:8] + b"a\0b\0" + struct.pack("<I", 2**32 - 1),
        exr_header(32, 20)[:8] + (b"a\0b\0" + bytes(4)) * 20_000,
        exr_header(32, 20)[:8] + b"channels\0chlist\0" + struct.pack("<I", 2**31) + bytes(99),
    ],
    ids=["empty", "PNG", "cut", "sizeless", "long", "beyond", "endless", "channels"],
)
def test_what_is_damaged_is_refused(check, content):
    with pytest.raises(InvalidFileError, match="cannot be read as OpenEXR"):
        check(content)
