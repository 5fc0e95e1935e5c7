"""Folders of depth pictures, as TUM RGB-D, Stray Scanner and Open3D lay them out, and plain."""

import pickle
import shutil

import numpy as np
import pytest
from depth_files import pictures
from depth_folders import colors_of, open3d, plain, stray_scanner, tum
from numpy.testing import assert_allclose, assert_array_equal

from solvers.depth_scene.camera import Camera
from solvers.errors import InvalidFileError
from solvers.recordings import DepthSettings, read_depth, read_recording

LENS = DepthSettings(fx=9.0, fy=8.0)
MILLIMETERS = DepthSettings(fx=9.0, fy=8.0, scale=0.001)
SMALL = Camera(9.0, 8.0, 3.5, 2.5, 8, 6)
LEVEL = (0.0, 1.0, 0.0, 1.0, 0.0, 0.0, 0.0)
"""A camera one meter up: its y points down, and the world of ARKit has Y up."""


@pytest.fixture
def depth() -> np.ndarray:
    return pictures(9)


def all_frames(recording) -> np.ndarray:
    return np.stack([recording.frame(frame) for frame in range(recording.n_frames)])


def heard():
    text = []
    return text, lambda fraction, message="": text.append(message)


def test_tum_is_five_thousandths_of_a_meter_and_has_its_colors(tmp_path, depth):
    folder = tum(tmp_path, depth, 100.0 + np.arange(9) / 30.0)

    recording = read_depth(folder, LENS)

    assert recording.camera == SMALL
    assert recording.frame_rate == pytest.approx(30.0, rel=1e-3)
    assert_allclose(all_frames(recording), depth / 5000.0, rtol=1e-6)
    assert_array_equal(recording.color(4), colors_of(depth[4]))


@pytest.mark.parametrize("depth_first", [False, True])
def test_tum_by_its_associations(tmp_path, depth, depth_first):
    folder = tum(tmp_path, depth, np.arange(9) / 30.0)
    one, other = (
        (folder / f"{kind}.txt").read_text().splitlines()[1:] for kind in ("rgb", "depth")
    )
    pairs = zip(other, one, strict=True) if depth_first else zip(one, other, strict=True)
    (folder / "associations.txt").write_text("\n".join(" ".join(pair) for pair in pairs))
    (folder / "rgb.txt").unlink()
    (folder / "depth.txt").unlink()

    recording = read_depth(folder, LENS)

    assert_allclose(all_frames(recording), depth / 5000.0, rtol=1e-6)
    assert_array_equal(recording.color(7), colors_of(depth[7]))


def test_gaps_in_times_become_empty_frames_with_a_remark(tmp_path, depth):
    steps = np.array([0, 1, 2.2, 2.9, 4, 8, 9.1, 10, 11])
    text, progress = heard()

    recording = read_depth(tum(tmp_path, depth, 50.0 + steps / 30.0), LENS, progress=progress)

    assert recording.n_frames == 12
    shown = [0, 1, 2, 3, 4, None, None, None, 5, 6, 7, 8]
    for frame, picture in enumerate(shown):
        expected = 0 if picture is None else depth[picture] / 5000.0
        assert_allclose(recording.frame(frame), expected * np.ones((6, 8)), rtol=1e-6)
    assert recording.color(6).max() == 0
    assert "3 frames have no image, frame 6 first; they are empty." in text
    assert any(each.startswith("Resampled to 30 Hz from its time stamps") for each in text)


def test_times_that_run_backwards_are_refused(tmp_path, depth):
    folder = tum(tmp_path, depth, -np.arange(9.0)[::1] / 30.0)

    with pytest.raises(InvalidFileError, match="time stamps"):
        read_depth(folder, LENS)
    assert read_depth(folder, DepthSettings(fx=9.0, frame_rate=30.0)).n_frames == 9


def test_stray_scanner_states_its_camera_and_time(tmp_path, depth):
    folder = stray_scanner(tmp_path, depth, LEVEL)

    recording = read_recording(folder)

    assert recording.frame_rate == pytest.approx(60.0, rel=1e-3)
    camera = recording.camera  # The matrix is for pictures of 1920 x 1440.
    assert_allclose((camera.fx, camera.fy), (1400 * 8 / 1920, 1400 * 6 / 1440))
    assert_allclose((camera.cx, camera.cy), (960.5 * 8 / 1920 - 0.5, 720.5 * 6 / 1440 - 0.5))
    sure = depth % 3 >= 1
    assert_allclose(all_frames(recording), np.where(sure, depth, 0) * 0.001, rtol=1e-6)
    all_of_them = read_depth(folder, DepthSettings(min_confidence=0))
    assert_allclose(all_frames(all_of_them), depth * 0.001, rtol=1e-6)


ROTATED = {  # Quarter turns of the telephone about its axis of sight, as the app writes them.
    0: (1.0, 0.0, 0.0, 0.0),
    1: (0.5**0.5, 0.5**0.5, 0.0, 0.0),
    3: (0.5**0.5, -(0.5**0.5), 0.0, 0.0),
    2: (0.0, 1.0, 0.0, 0.0),
}


@pytest.mark.parametrize("quarters", ROTATED)
def test_a_telephone_that_was_held_upright_on_its_side_or_on_its_head(
    tmp_path, depth, quarters
):
    """Whatever the pose says is up must be the top of the picture."""
    rotation = ROTATED[quarters]
    x, y, z, w = rotation
    up = np.array([
        2 * (x * y + z * w),
        1 - 2 * (x * x + z * z),
    ])  # in the camera: x right, y down
    folder = stray_scanner(tmp_path, depth, (0.0, 1.0, 0.0, *rotation))
    all_of_them = DepthSettings(min_confidence=0)

    frame = read_depth(folder, all_of_them).frame(4)

    assert np.isclose(np.abs(up).max(), 1.0)
    expected = {
        (0, -1): depth[4],
        (0, 1): depth[4][::-1, ::-1],
        (-1, 0): depth[4].T[:, ::-1],  # the left column becomes the top row, its foot first
        (1, 0): depth[4].T[::-1],
    }[tuple(up.round().astype(int).tolist())]
    assert_allclose(frame, expected * 0.001, rtol=1e-6)


def test_moving_phone_is_reported(tmp_path, depth):
    text, progress = heard()

    read_depth(stray_scanner(tmp_path, depth, LEVEL, moved=0.9), progress=progress)

    assert "The camera moved by 0.8 m; it is assumed to be static." in text


def test_stray_scanner_without_a_trajectory_has_60_hz(tmp_path, depth):
    folder = stray_scanner(tmp_path, depth, LEVEL)
    (folder / "odometry.csv").unlink()
    shutil.rmtree(folder / "confidence")

    recording = read_depth(folder)

    assert recording.frame_rate == 60.0
    assert_allclose(all_frames(recording), depth * 0.001, rtol=1e-6)


def test_open3d_states_its_camera_by_columns(tmp_path, depth):
    recording = read_recording(open3d(tmp_path, depth))

    assert recording.camera == Camera(9.0, 8.0, 3.25, 2.75, 8, 6)
    assert recording.frame_rate == 30.0
    assert_allclose(all_frames(recording), depth * 0.001, rtol=1e-6)
    assert_allclose(recording.color(3), 120, atol=2)


@pytest.mark.parametrize(
    ("settings", "missing"),
    [
        (DepthSettings(), r"set its scale \(.*\) and the camera's focal lengths fx and fy"),
        (
            DepthSettings(fx=9.0),
            r"set its scale \(meters per unit: 0.001 for millimeters\)\.",
        ),
        (
            DepthSettings(scale=0.001),
            r"set the camera's focal lengths fx and fy in pixels, and",
        ),
    ],
)
def test_plain_folder_requires_scale_and_camera(tmp_path, depth, settings, missing):
    with pytest.raises(InvalidFileError, match=missing):
        read_depth(plain(tmp_path, depth), settings)


@pytest.mark.parametrize("name", ["{}.png", "take{:03}.png", "depth {}.PNG"])
def test_a_plain_folder_is_in_the_order_of_its_numbers(tmp_path, name):
    depth = pictures(12)

    recording = read_depth(plain(tmp_path, depth, name, first=2), MILLIMETERS)

    assert recording.camera == SMALL
    assert_allclose(all_frames(recording), depth * 0.001, rtol=1e-6)


def test_a_number_that_was_left_out_is_an_empty_frame(tmp_path, depth):
    folder = plain(tmp_path, depth)
    (folder / "0004.png").unlink()
    text, progress = heard()

    recording = read_depth(folder, MILLIMETERS, progress=progress)

    expected = depth * 0.001
    expected[3] = 0.0
    assert_allclose(all_frames(recording), expected, rtol=1e-6)
    assert "1 frames have no image, frame 4 first; they are empty." in text


def test_every_third_picture_is_no_gap(tmp_path, depth):
    folder = plain(tmp_path, pictures(27))
    for number in range(1, 28):
        if number % 3:
            (folder / f"{number:04}.png").unlink()

    assert read_depth(folder, MILLIMETERS).n_frames == 9


def test_distant_numbers_are_no_gap(tmp_path):
    """They are of two takes, not of one with a hundred empty frames."""
    plain(tmp_path, pictures(4))
    plain(tmp_path, pictures(5), first=101)

    assert read_depth(tmp_path, MILLIMETERS).n_frames == 9


def test_a_folder_can_be_sent_to_another_process(tmp_path, depth):
    recording = read_depth(open3d(tmp_path, depth))

    again = pickle.loads(pickle.dumps(recording))

    assert_array_equal(again.frame(4), recording.frame(4))
    assert_array_equal(again.color(4), recording.color(4))
