"""An `.mkv` is read while it grows, wherever the recorder has stopped for the moment."""

import numpy as np
import pytest
from depth_files import pictures
from mkv_files import STRAIGHT, calibration, k4a
from numpy.testing import assert_array_equal

from solvers.errors import InvalidFileError
from solvers.recordings import CameraOrientation, DepthSettings, read_depth
from solvers.recordings.growing import open_growing
from solvers.recordings.growing.growing_source import measure_positions
from solvers.recordings.growing.image_names import PositionKind

OWN = DepthSettings(fx=9.0, fy=8.0)


@pytest.mark.parametrize("open_sizes", [False, True])
@pytest.mark.parametrize("step", [7, 101, 100_000])
def test_images_are_those_of_the_complete_file(tmp_path, step, open_sizes):
    content = k4a(pictures(12), open_sizes=open_sizes)
    path = tmp_path / "take.mkv"
    source, found = open_growing(path, OWN), []

    with path.open("wb") as file:
        for start in range(0, len(content), step):
            file.write(content[start : start + step])
            file.flush()
            images = source.poll()
            found += [(image.position, source.read(image)) for image in images]

    complete = read_depth(path, OWN)
    assert source.camera == complete.camera and len(found) == complete.n_frames == 12
    for frame, (_, depth) in enumerate(found):
        assert_array_equal(depth, complete.frame(frame))
    rate = source.positions([position for position, _ in found]).frame_rate
    assert rate == pytest.approx(complete.frame_rate, rel=2e-3)
    assert source.remarks() == ()


def test_lens_is_that_of_the_file(tmp_path):
    settings = DepthSettings(held=CameraOrientation.LEFT)
    depth = np.full((2, 288, 320), 1500, np.uint16)
    path = tmp_path / "take.mkv"
    path.write_bytes(k4a(depth, calibration(STRAIGHT)))
    complete, source = read_depth(path, settings), open_growing(path, settings)

    first, _ = source.poll()

    assert source.camera == complete.camera
    assert_array_equal(source.read(first), complete.frame(0))


def test_file_is_waited_for_and_may_be_cut_off_or_removed(tmp_path):
    content, path = k4a(pictures(6)), tmp_path / "take.mkv"
    source = open_growing(path, OWN)
    assert source.poll() == [] and not source.is_gone
    path.write_bytes(content)
    assert len(source.poll()) == 6

    path.write_bytes(content[: len(content) // 2])

    assert source.poll() == [] and source.is_gone
    assert source.remarks()[-1].endswith(
        "became shorter while it was followed. The motion ends there."
    )

    source = open_growing(path, OWN)
    source.poll()
    path.unlink()
    assert source.poll() == [] and source.is_gone
    assert "was removed while it was followed" in source.remarks()[-1]


def test_other_files_are_no_recording(tmp_path):
    (tmp_path / "take.mkv").write_bytes(b"no Matroska at all")
    source = open_growing(tmp_path / "take.mkv", OWN)

    assert source.poll() == [] and "is a video without raw depth" in source.issue


def test_file_without_a_camera_is_refused(tmp_path):
    path = tmp_path / "take.mkv"
    path.write_bytes(k4a(pictures(2), b"{}"))
    with pytest.raises(InvalidFileError):
        open_growing(path).poll()


def test_rate_of_stamps_that_jump():
    """Stamps of 30 Hz, rounded to milliseconds, with a gap and two jumps of the clock."""
    times = np.round(np.arange(90) / 30.0, 3)
    times[20:] += 0.1
    times[40:] += 3600.0
    times[60:] -= 86_400.0

    rate, seconds = measure_positions(PositionKind.TIMES, times.tolist(), 60.0)

    assert rate == pytest.approx(30.0, rel=1e-3) and seconds == 1.0
