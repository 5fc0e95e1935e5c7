"""The grid of matches over the view: every cell is visible, and figures stand in theirs."""

from types import SimpleNamespace

import numpy as np
import pytest


@pytest.fixture
def gallery(load):
    return load("mocap_assist.find_similar.gallery")


@pytest.mark.parametrize("n_matches", [1, 5, 24, 60])
@pytest.mark.parametrize("size", [(1000, 500), (300, 900), (120, 90)])
def test_cells_are_within_the_view_and_separate(gallery, n_matches, size):
    space = gallery.Box(40.0, 10.0, *size)

    cells = gallery.cells_in(space, n_matches, scale=1.0)

    assert len(cells) == min(n_matches, gallery.MAX_CELLS)
    middles = [(c.x + 0.5 * c.width, c.y + 0.5 * c.height) for c in cells]
    assert [gallery.cell_at(cells, *middle) for middle in middles] == list(range(len(cells)))
    if size != (120, 90):  # where nothing fits, they only do not overlap
        assert all(space.has(c.x, c.y) and space.has(c.x + c.width, c.y) for c in cells)
    assert gallery.cell_at(cells, space.x, space.y) == -1


def test_figure_stands_in_its_cell_and_the_clip_repeats(gallery):
    postures = np.zeros((10, 20, 3), np.float32)
    postures[:, :, 2] = np.linspace(-1.0, 0.8, 20)
    postures[[0, 6], 3] += [[0.9], [0.5]]
    found = SimpleNamespace(postures=postures, rate=20.0)
    cell = gallery.Box(100.0, 50.0, 190.0, 224.0)

    lines, left = gallery.figure_lines(found, 1, cell)

    assert len(lines) == len(left) == 19 and left.any() and not left.all()
    assert (lines[..., 1] >= cell.y + 34.0).all()
    assert all(cell.has(*point) for point in lines.reshape(-1, 2))
    assert gallery.posture_row(found, None) == 6
    assert [gallery.posture_row(found, seconds) for seconds in (0.0, 0.3, 0.5)] == [0, 6, 0]

    found.postures[1, 0] = np.nan
    assert len(gallery.figure_lines(found, 1, cell)[0]) < 19


@pytest.mark.parametrize("end", ["a new file", "the extension goes"])
def test_nothing_stays_over_the_view_where_blender_ends_the_button(
    load, window, blank, monkeypatch, end
):
    drawing = load("mocap_assist.find_similar.gallery_drawing")
    monkeypatch.setattr(
        drawing, "bpy", SimpleNamespace(context=window.context, types=blank.types)
    )
    area = SimpleNamespace(as_pointer=lambda: 1)
    shown = drawing.Gallery(window.context, SimpleNamespace(), area)
    assert shown.is_open and window.timers

    if end == "a new file":
        blank.ops.wm.read_homefile(use_empty=True, use_factory_startup=True)
    else:
        drawing.unregister()
        drawing.register()

    assert not shown.is_open and not window.timers
    with pytest.raises(ValueError):
        blank.types.SpaceView3D.draw_handler_remove(shown._handle, "WINDOW")
    shown.close(window.context)
