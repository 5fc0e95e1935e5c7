"""Folders of EXR pictures, such as Blender writes, are recordings of depth too."""

import os
from pathlib import Path

import numpy as np
import pytest
from depth_views import points_of
from exr_files import exr_header

WIDTH, HEIGHT = 32, 20
TOLERANCE_M = 1e-3  # meters


def depth_at(frame: int) -> np.ndarray:
    """A slope: every pixel of another depth; nothing in a corner."""
    rows, columns = np.mgrid[:HEIGHT, :WIDTH]
    depth = 2.0 + 0.01 * columns + 0.02 * rows + 0.1 * frame
    depth[:4, :4] = 1e10  # Blender's word for nothing
    return depth.astype(np.float32)


@pytest.fixture
def folder(blank, tmp_path):
    """Three pictures, written by Blender; its rows begin at the bottom."""
    made = tmp_path / "z pass"
    made.mkdir()
    settings = blank.context.scene.render.image_settings
    settings.file_format = "OPEN_EXR"
    settings.color_depth = "32"
    for frame in range(3):
        write(blank, made / f"depth{frame + 9}.exr", depth_at(frame))
    return made


def write(bpy, path, depth):
    height, width = depth.shape
    image = bpy.data.images.new("depth", width, height, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., :3] = depth[::-1, :, None]
    image.pixels.foreach_set(pixels.ravel())
    image.filepath_raw, image.file_format = str(path), "OPEN_EXR"
    image.save()
    bpy.data.images.remove(image)


@pytest.fixture
def lens(blank):
    """The scene's own camera, which may have rendered the pictures."""
    camera = blank.data.cameras.new("lens")
    camera.lens, camera.sensor_width = 50.0, 36.0
    owner = blank.data.objects.new("lens", camera)
    blank.context.collection.objects.link(owner)
    blank.context.scene.camera = owner
    return owner


def bring(bpy, path, **settings):
    status = bpy.ops.mocap_assist.import_recording(filepath=str(path), **settings)
    assert status == {"FINISHED"}
    return bpy.context.object


def test_pictures_come_in_their_order_with_the_top_row_on_top(folder, blank):
    made = bring(blank, folder, focal_length=40.0, frame_rate="ONE")

    assert made.name == "z pass"
    for frame in range(3):
        blank.context.scene.frame_set(1 + frame)
        depth = depth_at(frame)
        row, column = np.nonzero(depth < 100.0)
        points, depth = points_of(made), depth[row, column]
        assert np.abs(points[:, 1] - depth).max() < TOLERANCE_M
        assert (
            np.abs(points[:, 2] + (row - (HEIGHT - 1) / 2) / 40.0 * depth).max() < TOLERANCE_M
        )
    assert not blank.data.images


def test_the_camera_of_the_scene_is_taken(folder, lens, blank):
    """50 mm in front of 36 mm that are 32 pixels wide."""
    made = bring(blank, folder / "depth9.exr")

    focal = 50.0 / 36.0 * WIDTH
    row, column = np.nonzero(depth_at(0) < 100.0)
    across = (column - (WIDTH - 1) / 2) / focal * depth_at(0)[row, column]
    assert np.abs(points_of(made)[:, 0] - across).max() < TOLERANCE_M


def test_they_are_copied_once_and_play_from_the_copy(folder, lens, blank, load):
    first, second = bring(blank, folder), bring(blank, folder)

    shown = load("mocap_assist.depth.depth_preview").Shown
    assert shown.read(first.data).path == shown.read(second.data).path
    write(blank, folder / "depth9.exr", depth_at(7))
    assert shown.read(bring(blank, folder).data).path != shown.read(first.data).path


def test_missing_camera_is_requested(folder, blank):
    with pytest.raises(
        RuntimeError, match="give the focal length in pixels, or give the scene"
    ):
        bring(blank, folder)
    assert not blank.data.objects
    assert not blank.data.images


@pytest.mark.parametrize(
    ("name", "content", "sentence"),
    [
        ("depth10.exr", b"no picture", r"depth10\.exr .*(cannot be read|is not an image)"),
        ("depth10.exr", b"", r"depth10\.exr .*(cannot be read|is not an image)"),
        (
            "depth10.exr",
            exr_header(12_000, 12_000),
            r"depth10\.exr has .* 12000 x 12000 pixels",
        ),
        ("depth10.exr", None, r"depth10\.exr has 6 x 4 pixels, the first image 32 x 20"),
    ],
)
def test_a_picture_that_is_none_is_named(folder, lens, blank, name, content, sentence):
    if content is None:
        write(blank, folder / name, np.ones((4, 6), np.float32))
    else:
        (folder / name).write_bytes(content)

    with pytest.raises(RuntimeError, match=sentence):
        bring(blank, folder)
    assert [each.name for each in blank.data.objects] == ["lens"]
    assert not blank.data.images


def test_a_pipe_in_the_folder_is_passed_over(folder, lens, blank):
    """Opening one waits for another program, forever."""
    os.mkfifo(folder / "depth8.exr")

    assert bring(blank, folder).name == "z pass"


@pytest.fixture
def copies(load, blank, monkeypatch):
    """Where copies are kept, with none in it and room for two."""
    exr_folder = load("mocap_assist.depth.exr_folder")
    monkeypatch.setattr(exr_folder, "MAX_COPIES", 2)
    place = blank.utils.extension_path_user(exr_folder.EXTENSION, path="depth", create=True)
    exr_folder.remove_old_copies(Path(place), 0, 0)
    return Path(place)


def test_the_copies_that_were_used_longest_ago_go_when_another_is_made(
    folder, lens, blank, copies, load
):
    exr_folder = load("mocap_assist.depth.exr_folder")
    readable = load("mocap_assist.importing.depth_folders").readable
    choices = load("mocap_assist.importing.button_settings").ImportChoices()
    made = []
    for number in range(3):
        write(blank, folder / "depth9.exr", depth_at(20 + number))
        made.append(readable(blank.context, folder, choices))
        age = 100 - number if number else 0
        os.utime(made[-1], (1e9 - age, 1e9 - age))

    assert [each.exists() for each in made] == [True, False, True]
    exr_folder.remove_old_copies(copies, 2, made[0].stat().st_size)
    assert [each.exists() for each in made] == [True, False, False]


def test_a_copy_that_the_open_file_shows_stays(folder, lens, blank, copies, load):
    bring(blank, folder)
    shown = load("mocap_assist.depth.depth_preview").Shown.read(blank.context.object.data)

    load("mocap_assist.depth.exr_folder").remove_old_copies(copies, 0, 0)

    assert Path(shown.path).is_file()
    blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    load("mocap_assist.depth.exr_folder").remove_old_copies(copies, 0, 0)
    assert not list(copies.iterdir())
