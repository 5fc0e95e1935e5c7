"""Stated axes are obeyed unless the actor would hang."""

import numpy as np
import pytest

from solvers.motion import Tracks
from solvers.recordings import read_c3d, read_trc, write_c3d, write_trc


def test_a_screen_that_hangs_the_actor_below_the_floor_is_not_obeyed(recordings):
    """QTM writes Y_SCREEN -Z of data with Z up."""
    messages = []

    tracks = read_c3d(
        recordings / "corpus/lab/c3d_qualisys/Qualisys.c3d",
        progress=lambda _, message="": messages.append(message),
    )

    heights = tracks.positions[..., 2]
    assert np.nanpercentile(heights, 1) > 0.0
    assert np.nanmedian(np.nanmax(heights, axis=1)) == pytest.approx(1.47, abs=0.05)
    assert any("Y_SCREEN states -Z" in message for message in messages)


def standing(rng, n_markers=12):
    """Return markers between 5 cm and 1.7 m above the floor, of an actor who walks."""
    body = rng.uniform((-0.3, -0.2, 0.05), (0.3, 0.2, 1.7), (n_markers, 3))
    body[:2, 2] = 0.05, 1.7
    walk = np.linspace((-1.0, -0.5, 0.0), (1.0, 0.5, 0.0), 20)
    names = tuple(f"M{number}" for number in range(n_markers))
    return Tracks(names, body + walk[:, None], 100.0)


def read_with_screen(tracks, path, screen):
    """Write markers, state another Y_SCREEN, and read them; return what was said too."""
    write_c3d(tracks, path)
    content = path.read_bytes()
    start = content.index(b"+Z", content.index(b"Y_SCREEN"))
    path.write_bytes(content[:start] + screen + content[start + 2 :])
    messages = []
    read = read_c3d(path, progress=lambda _, message="": messages.append(message))
    return read.positions, " ".join(messages)


def test_a_screen_upside_down_is_not_obeyed(tmp_path, rng):
    tracks = standing(rng)

    read, messages = read_with_screen(tracks, tmp_path / "a.c3d", b"-Z")

    assert read == pytest.approx(tracks.positions, abs=1e-5)
    assert (
        "Y_SCREEN states -Z, which would put the actor below the floor; it was ignored"
        in messages
    )


def test_a_body_that_stands_along_another_axis_is_believed(tmp_path, rng):
    tracks = standing(rng)
    along_x = tracks.with_positions(np.roll(tracks.positions, 1, axis=-1))

    read, messages = read_with_screen(along_x, tmp_path / "a.c3d", b"+Z")

    assert read == pytest.approx(tracks.positions, abs=1e-5)
    assert "Y_SCREEN states +Z, but the actor stands along +X, which is used" in messages


@pytest.mark.parametrize("pose", ["lies", "spreads the arms over a pit", "below the floor"])
def test_the_screen_is_obeyed_where_it_may_be_right(tmp_path, rng, pose):
    tracks = standing(rng)
    if pose == "lies":
        tracks = tracks.with_positions(
            np.roll(tracks.positions, 1, axis=-1) + np.array([0, 0, 0.4])
        )
    else:
        spread = (4.0, 1.0, 1.0) if "arms" in pose else (1.0, 1.0, 1.0)
        tracks = tracks.with_positions(tracks.positions * spread - (-3.0, -3.0, 0.5))

    read, messages = read_with_screen(tracks, tmp_path / "a.c3d", b"+Z")

    assert read == pytest.approx(tracks.positions, abs=1e-5)
    assert "Y_SCREEN" not in messages


@pytest.mark.parametrize("up", ["X", "Y", "Z"])
def test_a_table_without_axes_stands_whatever_is_up(tmp_path, rng, up):
    """A TRC states no axis; what was judged is noted, so that it can be changed."""
    tracks = standing(rng)
    stored = np.roll(tracks.positions, {"X": 1, "Y": 2, "Z": 0}[up], axis=-1)
    x, y, z = np.moveaxis(stored, -1, 0)
    written = tracks.with_positions(np.stack([x, -z, y], axis=-1))  # it is written with Y up
    write_trc(written, tmp_path / "a.trc")
    text = (tmp_path / "a.trc").read_text()
    (tmp_path / "a.trc").write_text(text.replace("\tY up", ""))

    read = read_trc(tmp_path / "a.trc")

    assert read.positions[..., 2] == pytest.approx(tracks.positions[..., 2], abs=1e-5)
    assert read.conventions.up == up
