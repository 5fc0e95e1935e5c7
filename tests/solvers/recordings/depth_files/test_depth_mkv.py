"""Recordings of an Azure Kinect, written here as k4arecorder does, and cut and broken."""

import io
import pickle

import numpy as np
import pytest
from depth_files import pictures
from mkv_files import (
    BINNED,
    LENS,
    NFOV,
    STRAIGHT,
    block,
    calibration,
    cluster,
    ebml_header,
    ebml_laced,
    element,
    equal,
    head,
    k4a,
    xiph,
)
from numpy.testing import assert_allclose, assert_array_equal
from PIL import Image

from solvers.depth_scene.camera import Camera
from solvers.errors import InvalidFileError, SolveCancelled
from solvers.recordings import DepthSettings, read_depth, read_recording

OWN = DepthSettings(fx=9.0, fy=8.0)


@pytest.fixture
def write(make_writer):
    return make_writer("take.mkv")


def all_frames(recording) -> np.ndarray:
    return np.stack([recording.frame(frame) for frame in range(recording.n_frames)])


def heard():
    text = []
    return text, lambda fraction, message="": text.append(message)


@pytest.mark.parametrize("group", [False, True])
@pytest.mark.parametrize("open_sizes", [False, True])
def test_every_picture_comes_out_big_end_first(write, group, open_sizes):
    depth = pictures(12)

    recording = read_depth(write(k4a(depth, group=group, open_sizes=open_sizes)), OWN)

    assert recording.camera == Camera(9.0, 8.0, 3.5, 2.5, 8, 6)
    assert recording.frame_rate == pytest.approx(30.0)
    assert_allclose(all_frames(recording), depth * 0.001, rtol=1e-6)


def test_the_calibration_counts_the_sensor_as_one(write):
    """Of the sensor's 1024 x 1024 pixels, 640 x 576 remain from column 192 and row 180 on."""
    depth = pictures(3, *NFOV)

    camera = read_recording(write(k4a(depth, calibration(STRAIGHT)))).camera

    assert (camera.fx, camera.fy) == (0.492 * 1024, 0.493 * 1024)
    assert_allclose((camera.cx, camera.cy), (0.502 * 1024 - 192.5, 0.506 * 1024 - 180.5))
    half = read_recording(write(k4a(pictures(3, *BINNED), calibration(STRAIGHT)))).camera
    assert half.fx == 0.492 * 512
    # The same place on the sensor, where each pixel is two wide.
    assert_allclose((half.cx + 0.5) * 2, camera.cx + 0.5)


def test_without_distortion_nothing_moves(write):
    depth = pictures(3, *BINNED)

    recording = read_recording(write(k4a(depth, calibration(STRAIGHT))))

    assert_allclose(all_frames(recording), depth * 0.001, rtol=1e-6)


def bent(x: float, y: float) -> tuple[float, float]:
    """The model of the Azure Kinect, number by number, for one direction."""
    _, _, _, _, k1, k2, k3, k4, k5, k6, _, _, p2, p1 = LENS
    r = x * x + y * y
    d = (1 + k1 * r + k2 * r**2 + k3 * r**3) / (1 + k4 * r + k5 * r**2 + k6 * r**3)
    across = x * d + (r + 2 * x * x) * p2 + 4 * x * y * p1
    return across, y * d + (r + 2 * y * y) * p1 + 4 * x * y * p2


def test_the_lens_is_straightened(write):
    """Each pixel of the result is found in the picture where the model says that it fell."""
    rows, columns = np.mgrid[: BINNED[0], : BINNED[1]]
    depth = (1000 + 3 * columns + 5 * rows).astype(np.uint16)[np.newaxis].repeat(3, axis=0)

    recording = read_recording(write(k4a(depth)))

    camera, frame = recording.camera, recording.frame(1)
    moved = 0.0
    for column, row in [(160, 144), (40, 30), (300, 200), (10, 280), (319, 0)]:
        x, y = bent((column - camera.cx) / camera.fx, (row - camera.cy) / camera.fy)
        at = round(x * camera.fx + camera.cx), round(y * camera.fy + camera.cy)
        inside = 0 <= at[0] < BINNED[1] and 0 <= at[1] < BINNED[0]
        expected = 1000 + 3 * at[0] + 5 * at[1] if inside else 0
        assert frame[row, column] == pytest.approx(expected * 0.001)
        moved = max(moved, abs(at[0] - column))
    assert moved > 8


def test_dropped_frames_are_empty(write):
    depth = pictures(6)
    times = np.array([0, 33, 67, 200, 233, 267.0])
    text, progress = heard()

    recording = read_depth(write(k4a(depth, times=times)), OWN, progress=progress)

    assert recording.n_frames == 9
    assert_allclose(recording.frame(6), depth[3] * 0.001, rtol=1e-6)
    assert [recording.frame(frame).max() > 0 for frame in range(9)] == [
        1,
        1,
        1,
        0,
        0,
        0,
        1,
        1,
        1,
    ]
    assert "3 frames have no image, frame 4 first; they are empty." in text


@pytest.mark.parametrize("lace", [(xiph, 2), (equal, 4), (ebml_laced, 6)])
def test_laced_blocks_hold_several_pictures(write, lace):
    depth = pictures(6)
    joined, flags = lace
    raw = [picture.astype(">u2").tobytes() for picture in depth]
    clusters = [
        cluster(time, [block(2, 0, joined(raw[first : first + 3]), flags)])
        for time, first in ((0, 0), (100, 3))
    ]
    inside = head(8, 6, calibration()) + b"".join(clusters)

    path = write(ebml_header() + element(0x18538067, inside))
    recording = read_depth(path, DepthSettings(fx=9.0, fy=8.0, frame_rate=30.0))

    assert_allclose(all_frames(recording), depth * 0.001, rtol=1e-6)


def test_a_file_that_was_cut_short_is_read_so_far(write):
    depth = pictures(12)
    complete = k4a(depth, open_sizes=True)
    text, progress = heard()

    recording = read_depth(write(complete[: len(complete) * 3 // 4]), OWN, progress=progress)

    assert 5 < recording.n_frames < 12
    assert_allclose(all_frames(recording), depth[: recording.n_frames] * 0.001, rtol=1e-6)
    assert "The file is cut short; the frames before the end are read." in text


def test_a_picture_of_another_size_is_an_empty_frame(write):
    depth = pictures(5)
    content = k4a(depth)
    raw = depth[2].astype(">u2").tobytes()
    damaged = content.replace(block(2, 1, raw), block(2, 1, raw[:-2]) + b"\xec\x80")
    text, progress = heard()

    recording = read_depth(write(damaged), OWN, progress=progress)

    assert [recording.frame(frame).max() > 0 for frame in range(5)] == [1, 1, 0, 1, 1]
    assert any("1 images are damaged" in sentence for sentence in text)


def test_colors_are_found_where_the_points_fall(write):
    """A wall one meter away; its left half is red for the camera of color, its right blue."""
    painted = np.zeros((720, 1280, 3), np.uint8)
    painted[:, :640, 0], painted[:, 640:, 2] = 255, 255
    file = io.BytesIO()
    Image.fromarray(painted).save(file, "JPEG", quality=95, subsampling=0)
    depth = np.full((3, *BINNED), 1000, np.uint16)
    depth[:, 100, 100] = 0

    recording = read_recording(
        write(k4a(depth, calibration(STRAIGHT), color=(b"MJPG", [file.getvalue()] * 3)))
    )

    color = recording.color(1)
    assert color[100, 100].tolist() == [0, 0, 0]
    reds = (color[150, :, 0] > 128).sum()
    # Column 639.5 of color, seen from 32 mm to the right of the camera of depth.
    x = (639.5 + 0.5 - 0.498 * 1280) / (0.475 * 1280) + 0.032
    assert reds == pytest.approx(x * recording.camera.fx + recording.camera.cx, abs=1.0)
    blue = recording.color(1)[150, 300]
    assert blue[2] > 200
    assert blue[0] < 50


def test_it_can_be_sent_to_another_process(write):
    recording = read_recording(write(k4a(pictures(3, *BINNED))))

    assert_array_equal(pickle.loads(pickle.dumps(recording)).frame(1), recording.frame(1))


def at_time(time: int) -> bytes:
    """A recording of one picture, in a cluster of that time."""
    picture = pictures(1).astype(">u2").tobytes()
    inside = head(8, 6, None) + cluster(time, [block(2, 0, picture)])
    return ebml_header() + element(0x18538067, inside)


WRONG_NAME = k4a(pictures(4), name="INFRARED").replace(b"222", b"999")


@pytest.mark.parametrize(
    ("content", "settings", "sentence"),
    [
        (k4a(pictures(4)), DepthSettings(), "8 x 6 pixels, which no Azure Kinect has"),
        (k4a(pictures(3, *BINNED), b"{}"), DepthSettings(), "no readable calibration"),
        (k4a(pictures(3, *BINNED), calibration(LENS[:7])), DepthSettings(), "no readable"),
        (k4a(pictures(3, *BINNED), calibration(Location="D9")), DepthSettings(), "no readable"),
        (k4a(pictures(0, 6, 8)), OWN, "a video without raw depth"),
        (WRONG_NAME, OWN, "a video without raw depth"),
        (ebml_header(), OWN, "a video without raw depth"),
        (ebml_header()[:6], OWN, "a video without raw depth"),
        (ebml_header() + b"\0\0\0\0", OWN, "it is not in the Matroska format"),
        (at_time(2**60), OWN, "it is not in the Matroska format"),
        (at_time(2**64 - 1), OWN, "it is not in the Matroska format"),
    ],
)  # fmt: skip
def test_unreadable_recording_is_refused_with_the_reason(write, content, settings, sentence):
    with pytest.raises(InvalidFileError, match=sentence):
        read_depth(write(content), settings)


def test_file_without_calibration_requires_the_camera(write):
    path = write(at_time(0))

    with pytest.raises(InvalidFileError, match=r"no calibration of the camera\. Set"):
        read_depth(path)
    assert read_depth(path, OWN).n_frames == 1


def test_reading_can_be_stopped(write, cancel):
    with pytest.raises(SolveCancelled):
        read_depth(write(k4a(pictures(5))), OWN, progress=cancel)
