"""A folder of depth images is read while a recorder writes it, whatever the recorder does."""

import shutil

import numpy as np
import pytest
from depth_folders import open3d, plain, save_png, tum
from numpy.testing import assert_array_equal

from solvers.errors import InvalidFileError
from solvers.recordings import DepthSettings, read_depth
from solvers.recordings.growing import GrowingFolder, open_growing
from solvers.recordings.growing.growing_folder import MAX_HOLD_S

LENS = {"fx": 9.0, "fy": 8.0, "cx": 3.25, "cy": 2.75}
SETTINGS = DepthSettings(scale=0.001, **LENS)
DEPTH = np.arange(6 * 6 * 8, dtype=np.uint16).reshape(6, 6, 8) + 1000


class Clock:
    """Seconds that pass when a test says so."""

    def __init__(self):
        self.time = 100.0

    def __call__(self):
        return self.time


@pytest.fixture
def clock():
    return Clock()


@pytest.fixture
def growing(tmp_path, clock):
    """A folder that does not exist yet, and its reader."""
    folder = tmp_path / "take"
    return folder, GrowingFolder(folder, SETTINGS, now=clock)


def names(images):
    return [image.name for image in images]


def write(folder, number, depth=DEPTH[0], name="{:04}.png"):
    save_png(folder / name.format(number), depth)


def write_half(folder, number):
    """Write the first half of the bytes of an image; return all of them."""
    write(folder, number)
    path = folder / f"{number:04}.png"
    content = path.read_bytes()
    path.write_bytes(content[: len(content) // 2])
    return path, content


@pytest.mark.parametrize("layout", ["plain", "open3d", "tum"])
def test_images_are_those_of_the_complete_folder(tmp_path, layout):
    times = 1305031102.16 + np.arange(6) / 30.0
    folder = {
        "plain": lambda: plain(tmp_path / "take", DEPTH),
        "open3d": lambda: open3d(tmp_path / "take", DEPTH),
        "tum": lambda: tum(tmp_path / "take", DEPTH, times),
    }[layout]()
    settings = DepthSettings(**LENS, scale=0.001 if layout == "plain" else 0.0)
    complete = read_depth(folder, settings)
    source = open_growing(folder, settings)

    images = source.poll()

    assert source.camera == complete.camera and len(images) == complete.n_frames == 6
    for frame, image in enumerate(images):
        assert_array_equal(source.read(image), complete.frame(frame))
    rate = source.positions([image.position for image in images]).frame_rate
    assert rate == pytest.approx(complete.frame_rate, rel=1e-6)
    assert source.poll() == [] and source.remarks() == ()


def test_rotated_and_mirrored_cameras_are_those_of_the_complete_folder(tmp_path):
    settings = DepthSettings(scale=0.001, held=read_held("left"), **LENS)
    complete = read_depth(plain(tmp_path / "take", DEPTH), settings)
    source = GrowingFolder(tmp_path / "take", settings)

    first = source.poll()[0]

    assert source.camera == complete.camera
    assert_array_equal(source.read(first), complete.frame(0))


def read_held(value):
    return type(DepthSettings().held)(value)


def test_folder_and_first_image_are_waited_for(growing):
    folder, source = growing
    assert source.poll() == [] and source.camera is None
    folder.mkdir()
    assert source.poll() == []

    write(folder, 7)

    assert names(source.poll()) == ["0007.png"] and source.camera.width == 8
    write(folder, 8)
    assert names(source.poll()) == ["0008.png"]


def test_half_written_image_is_read_once_it_is_complete(growing, clock):
    folder, source = growing
    write(folder, 1)
    assert len(source.poll()) == 1
    path, content = write_half(folder, 2)
    assert source.poll() == []

    clock.time += 10.0
    path.write_bytes(content)

    (image,) = source.poll()
    assert_array_equal(source.read(image), (DEPTH[0] * 0.001).astype(np.float32))
    assert source.remarks() == ()


def test_later_images_wait_a_moment_for_a_half_written_one(growing, clock):
    """Recorders with several writers finish images in another order."""
    folder, source = growing
    write(folder, 1)
    source.poll()
    path, content = write_half(folder, 2)
    write(folder, 3)
    assert source.poll() == []

    clock.time += 2.0 * MAX_HOLD_S
    assert names(source.poll()) == ["0003.png"]

    path.write_bytes(content)
    assert source.poll() == []
    assert "not written completely: 1, 0002.png first" in source.remarks()[0]


def test_half_written_first_image_is_waited_for(growing):
    folder, source = growing
    folder.mkdir()
    path, content = write_half(folder, 1)
    assert source.poll() == []

    path.write_bytes(content)

    assert names(source.poll()) == ["0001.png"]


def test_images_of_other_recorders_and_sizes_are_left_out_and_reported(growing):
    folder, source = growing
    write(folder, 1)
    source.poll()

    write(folder, 2, DEPTH[0, :, :4])
    write(folder, 3, name="camera_b_{:04}.png")
    write(folder, 4, name="camera_b_{:04}.png")
    save_png(folder / "0005.png", np.zeros((6, 8, 3), np.uint8))
    (folder / "0006.png").write_bytes(b"no image at all")
    write(folder, 7)
    (folder / "notes.txt").write_text("take 3")

    assert source.poll() == []  # 0006 may be half-written
    (folder / "0006.png").unlink()
    assert names(source.poll()) == ["0007.png"]
    remarks = " ".join(source.remarks())
    assert "of the size of the first image: 2, 0002.png first" in remarks
    assert (
        "of another recorder; one folder holds one recording: 2, camera_b_0003.png" in remarks
    )


def test_damaged_and_removed_images_are_reported_when_read(growing):
    folder, source = growing
    for number in (1, 2, 3):
        write(folder, number)
    content = (folder / "0002.png").read_bytes()
    (folder / "0002.png").write_bytes(content[:41] + b"\0" * 20 + content[61:])

    first, second, third = source.poll()
    (folder / "0003.png").unlink()

    assert source.read(first) is not None
    assert source.read(second) is None and source.read(third) is None
    assert "removed before they were read: 2, 0002.png first" in source.remarks()[0]


def test_image_that_is_finished_after_later_ones_is_left_out(growing):
    folder, source = growing
    write(folder, 5)
    source.poll()

    write(folder, 2)

    assert source.poll() == []
    assert "finished after later ones: 1, 0002.png first" in source.remarks()[0]


def test_numbers_count_frames_in_steps_of_the_recorder(growing):
    folder, source = growing
    for number in (10, 12, 14, 20):
        write(folder, number)

    positions = [image.position for image in source.poll()]
    rate, seconds = source.positions(positions)

    assert rate == 30.0
    assert [round((each - 10.0) * seconds * rate) for each in positions] == [0, 1, 2, 5]


def test_names_without_numbers_follow_each_other(growing):
    folder, source = growing
    for name in ("a.png", "b.png", "c.png"):
        save_png(folder / name, DEPTH[0])

    images = source.poll()

    assert names(images) == ["a.png", "b.png", "c.png"]
    assert source.positions([image.position for image in images]) == (30.0, 0.0)


def test_removed_folder_ends_the_recording_with_a_sentence(growing, clock):
    folder, source = growing
    write(folder, 1)
    source.poll()

    shutil.rmtree(folder)
    clock.time += 1.0

    assert source.poll() == [] and source.is_gone
    assert "was removed while it was followed" in source.remarks()[-1]


@pytest.mark.parametrize(
    ("depth", "settings", "words"),
    [
        (DEPTH[0], DepthSettings(), "does not describe its images completely: set"),
        (DEPTH[0].astype(np.uint8), SETTINGS, "is a gray image of 8 bits; depth is gray"),
    ],
)
def test_images_that_are_no_depth_of_a_known_camera_are_refused(
    tmp_path, depth, settings, words
):
    write(tmp_path, 1, depth)
    with pytest.raises(InvalidFileError, match=words):
        GrowingFolder(tmp_path, settings).poll()


def test_description_that_is_still_written_is_waited_for(tmp_path):
    folder = open3d(tmp_path / "take", DEPTH[:1])
    described = (folder / "intrinsic.json").read_text()
    (folder / "intrinsic.json").write_text(described[:30])
    source = GrowingFolder(folder)
    assert source.poll() == [] and "is not an Open3D camera" in source.issue

    (folder / "intrinsic.json").write_text(described)

    assert len(source.poll()) == 1


def test_what_cannot_be_followed_is_refused(tmp_path):
    (tmp_path / "take.npz").write_bytes(b"")
    for path, words in (
        (tmp_path / "take.npz", "cannot be read while it grows"),
        (tmp_path / "no" / "take", "There is no folder"),
    ):
        with pytest.raises(InvalidFileError, match=words):
            open_growing(path)
