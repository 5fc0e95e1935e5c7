"""A picture that lies is worse than none: lines must stand where the numbers say."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from PIL import Image

from solvers.errors import InvalidMotionError
from solvers.motion import Motion, Skeleton
from solvers.pictures import (
    CurveSettings,
    Picture,
    StickFigureSettings,
    ViewDirection,
    draw_curves,
    draw_stick_figures,
    draw_table,
    stack_pictures,
)
from solvers.pictures.canvas import SERIES, Canvas
from solvers.pictures.curves import ticks
from solvers.pictures.stick_figures import project_to_view
from solvers.rotations import (
    IDENTITY,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
)
from solvers.samples import GaitSettings, walking_gait

RAW, CLEAN = SERIES[:2]


def test_line_covers_the_predicted_pixels():
    """Three pixels wide and horizontal: rows 19, 20 and 21 are full, their neighbors white."""
    canvas = Canvas(60, 40)
    canvas.line([(10.0, 20.5), (50.0, 20.5)], CLEAN, 3.0)

    pixels = canvas.picture().pixels

    assert (pixels[19:22, 12:48] == CLEAN).all()
    assert (pixels[:18] == 255).all() and (pixels[23:] == 255).all()
    assert (pixels[:, :8] == 255).all() and (pixels[:, 53:] == 255).all()


def test_slanted_line_is_antialiased():
    canvas = Canvas(60, 60)
    canvas.line([(5.0, 5.0), (55.0, 40.0)], CLEAN, 2.0)

    shades = {tuple(pixel) for pixel in canvas.picture().pixels.reshape(-1, 3)}

    assert len(shades) > 5


def test_line_breaks_at_nan():
    canvas = Canvas(90, 20)
    canvas.line([(5, 10), (30, 10), (np.nan, 10), (60, 10), (85, 10)], RAW, 2.0)

    pixels = canvas.picture().pixels

    assert (pixels[:, 34:56] == 255).all()
    assert (pixels[10, 8:28] == RAW).all() and (pixels[10, 62:82] == RAW).all()


@pytest.mark.parametrize(
    ("view", "expected"),
    [(ViewDirection.SIDE, (2.0, 3.0, 1.0)), (ViewDirection.FRONT, (1.0, 3.0, -2.0))],
)
def test_project_to_view_maps_left_forward_and_up(view, expected):
    """A point one meter to the left, two ahead and three up, for two directions of facing."""
    points = np.array([[[1.0, -2.0, 3.0]], [[2.0, 1.0, 3.0]]])

    projected = project_to_view(points, np.array([0.0, np.pi / 2]), view)

    assert_allclose(projected[:, 0], [expected, expected], atol=1e-12)


def test_figure_has_the_requested_height(swinging_leg):
    still = swinging_leg.with_poses(*rest_pose(swinging_leg))

    pixels = draw_stick_figures(
        {"leg": still}, StickFigureSettings(n_figures=1, height=180)
    ).pixels
    rows = np.flatnonzero(is_color(pixels[44:], CLEAN).any(axis=1))

    assert rows[-1] - rows[0] == pytest.approx(180, abs=6)


def test_missing_joint_is_not_drawn(swinging_leg):
    rotations = swinging_leg.rotations.copy()
    rotations[:, 1] = np.nan
    settings = StickFigureSettings(n_figures=3)

    complete = draw_stick_figures({"leg": swinging_leg}, settings).pixels
    thigh = draw_stick_figures({"leg": swinging_leg.with_poses(rotations)}, settings).pixels

    assert lowest_row(thigh) < lowest_row(complete) - 60
    assert is_color(thigh[44:], CLEAN).any()


def test_last_motion_is_drawn_on_top(swinging_leg):
    pixels = draw_stick_figures({"raw": swinging_leg, "clean": swinging_leg}).pixels

    figures = pixels[44:]
    assert not is_color(figures, RAW).any()
    assert is_color(figures, CLEAN).any()


def test_left_side_is_drawn_lighter():
    """In front view, the left (+X) is on the right of the picture."""
    skeleton = Skeleton(
        ("root", "left", "right"),
        (-1, 0, 0),
        np.array([[0, 0, 1], [0.5, 0, 0], [-0.5, 0, 0.0]]),
    )
    still = Motion(skeleton, np.tile([1.0, 0, 0, 0], (1, 3, 1)), np.array([[0, 0, 1.0]]), 30.0)

    pixels = draw_stick_figures(
        {"a": still}, StickFigureSettings(view=ViewDirection.FRONT)
    ).pixels[44:]
    columns = np.flatnonzero(is_color(pixels, CLEAN).any(axis=0))
    drawn = np.flatnonzero((pixels[:-60] < 250).any(axis=(0, 2)))

    middle = drawn.mean()
    assert columns.max() < middle + 8
    assert columns.min() < middle - 50


def test_figures_are_drawn_across_a_gap_of_the_root(swinging_leg):
    root = swinging_leg.root_positions.copy()
    root[30:] = np.nan

    picture = draw_stick_figures({"leg": swinging_leg.with_poses(root_positions=root)})

    assert is_color(picture.pixels[44:], CLEAN).any()


def test_view_turns_with_hips_below_a_still_bone():
    """Of a walk to the east, as of one to the south, the side is drawn."""
    south = walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))
    rotation = quaternion_from_rotation_vector([0.0, 0.0, np.pi / 2])
    skeleton = south.skeleton
    parents = (-1, *(parent + 1 for parent in skeleton.parents))
    offsets = np.vstack([np.zeros(3), skeleton.offsets])
    offsets[1] = 0.0
    rig = Skeleton(("root", *skeleton.names), parents, offsets)
    rotations = np.insert(south.rotations, 0, IDENTITY, axis=1)
    rotations[:, 1] = multiply(rotation, south.rotations[:, 0])
    east = Motion(rig, rotations, rotate(rotation, south.root_positions), south.frame_rate)

    expected, actual = (draw_stick_figures({"walk": each}).pixels for each in (south, east))

    height, width = (
        min(sides) for sides in zip(expected.shape[:2], actual.shape[:2], strict=True)
    )
    differs = (expected[:height, :width] != actual[:height, :width]).any(axis=-1)
    assert differs.mean() < 0.2 * (expected != 255).any(axis=-1).mean()


def test_motion_that_is_missing_has_no_figures_and_a_shaded_plot(swinging_leg):
    missing = swinging_leg.with_poses(
        np.full_like(swinging_leg.rotations, np.nan),
        np.full_like(swinging_leg.root_positions, np.nan),
    )

    assert not is_color(draw_stick_figures({"leg": missing}).pixels[44:], CLEAN).any()
    plot = draw_curves({"leg": missing}, ["hip"]).pixels[64:, 70:]
    assert not is_color(plot, CLEAN).any()
    assert (plot == (246, 238, 226)).all(axis=-1).mean() > 0.5


def test_drawing_raises_for_different_lengths(swinging_leg):
    with pytest.raises(InvalidMotionError, match=r"as long as each other, not \[60, 120\]"):
        draw_stick_figures({"a": swinging_leg, "b": swinging_leg.slice(0, 60)})


@pytest.mark.parametrize("frames", [range(0), range(5, 5)])
def test_drawing_raises_without_frames(swinging_leg, frames):
    with pytest.raises(InvalidMotionError, match="no frame to draw"):
        draw_stick_figures({"a": swinging_leg}, frames=frames)
    with pytest.raises(InvalidMotionError, match="at least one motion and one joint"):
        draw_curves({"a": swinging_leg}, [])


def test_curve_passes_through_its_values(leg):
    """The hip rotates by a linear ramp of 40 degrees, so the plot is its own diagonal."""
    vectors = np.zeros((101, 4, 3))
    vectors[:, 0, 0] = np.radians(np.linspace(-20.0, 20.0, 101))
    ramp = Motion(leg, quaternion_from_rotation_vector(vectors), np.zeros((101, 3)), 50.0)

    pixels = draw_curves({"ramp": ramp}, ["hip"], CurveSettings(width=400, height=200)).pixels
    rows, columns = np.nonzero(is_color(pixels[64:265, 70:], CLEAN))

    slope, offset = np.polyfit(columns + 70, rows + 64, 1)
    assert_allclose(slope, -200 / (400 - 20 - 64), rtol=0.02)
    assert_allclose(offset + slope * 64, 264, atol=2)


def test_gap_is_shaded_and_breaks_the_curve(swinging_leg):
    rotations = swinging_leg.rotations.copy()
    rotations[40:80, 1] = np.nan
    gapped = swinging_leg.with_poses(rotations)

    pixels = draw_curves({"raw": gapped, "clean": swinging_leg}, ["knee"]).pixels
    middle = slice(64 + 380, 64 + 640)  # the gap, without its borders

    assert not is_color(pixels[64:, middle], RAW).any()
    assert is_color(pixels[64:, middle], CLEAN).any()
    assert (pixels[70:200, middle] == (246, 238, 226)).all(axis=-1).mean() > 0.5


def test_single_frame_has_the_plots_of_many_without_a_curve(swinging_leg):
    pixels, many = (
        draw_curves({"a": each}, ["hip", "knee"]).pixels
        for each in (swinging_leg.slice(0, 1), swinging_leg)
    )
    assert pixels.shape == many.shape
    assert not is_color(pixels[64:, 70:], CLEAN).any()


@pytest.mark.parametrize(
    ("low", "high", "expected"),
    [
        (0.0, 1.0, [0.0, 0.2, 0.4, 0.6, 0.8, 1.0]),
        (-33.0, 47.0, [-20.0, 0.0, 20.0, 40.0]),
        (7.0, 7.0, [7.0]),
    ],
)
def test_ticks_are_round_numbers(low, high, expected):
    assert_allclose(ticks(low, high, 6), expected)


def test_table_right_aligns_figures():
    pixels = draw_table(["", "after"], [["slide", "1"], ["jitter", "1234"]]).pixels
    rows = [pixels[16 + 26 * n + 2 : 16 + 26 * (n + 1) - 2] for n in (1, 2)]

    rightmost = [np.flatnonzero((row < 128).any(axis=(0, 2))).max() for row in rows]

    assert abs(rightmost[0] - rightmost[1]) <= 2


def test_table_raises_for_rows_of_another_length():
    with pytest.raises(InvalidMotionError, match="needs 2 columns"):
        draw_table(["a", "b"], [["only one"]])


def test_picture_is_saved_atomically(tmp_path):
    picture = Picture(np.arange(2 * 3 * 3, dtype=np.uint8).reshape(2, 3, 3))
    picture.save(tmp_path / "small.png")

    with Image.open(tmp_path / "small.png") as image:
        assert np.array_equal(np.asarray(image), picture.pixels)
    with pytest.raises(TypeError):
        Picture(np.zeros((2, 2, 5), np.complex128)).save(tmp_path / "broken.png")
    assert [file.name for file in tmp_path.iterdir()] == ["small.png"]


def test_stack_pads_narrow_pictures():
    both = stack_pictures([
        Picture(np.zeros((2, 5, 3), np.uint8)),
        Picture(np.zeros((3, 2, 3), np.uint8)),
    ])

    assert both.pixels.shape == (5, 5, 3)
    assert (both.pixels[2:, 2:] == 255).all() and not both.pixels[:2].any()


def rest_pose(motion):
    rest = np.tile([1.0, 0.0, 0.0, 0.0], (motion.n_frames, motion.n_joints, 1))
    return rest, np.tile(motion.skeleton.offsets[0], (motion.n_frames, 1))


def is_color(pixels, color):
    return (np.abs(pixels.astype(int) - color) <= 2).all(axis=-1)


def lowest_row(pixels):
    return np.flatnonzero(is_color(pixels, CLEAN).any(axis=1)).max()
