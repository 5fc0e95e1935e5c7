"""Names of markers on head and feet show which way is up, and how tall the actor is."""

import numpy as np
import pytest

from solvers.motion import Tracks
from solvers.progress import unwatched
from solvers.recordings import read_recording
from solvers.recordings.conventions import (
    guess_unit_of_points,
    question_of_floor,
    question_of_size,
)
from solvers.recordings.conventions.marker_bodies import stature_of_markers
from solvers.recordings.conventions.points import other_standing_axis

MARKERS = {
    "LFHD": (0.1, -0.1, 1.68), "RFHD": (-0.1, -0.1, 1.68), "C7": (0, 0.1, 1.5),
    "LSHO": (0.2, 0, 1.45), "RSHO": (-0.2, 0, 1.45), "LASI": (0.1, -0.1, 1.0),
    "RASI": (-0.1, -0.1, 1.0), "LKNE": (0.1, 0, 0.5), "RKNE": (-0.1, 0, 0.5),
    "LANK": (0.1, 0, 0.1), "RANK": (-0.1, 0, 0.1), "LTOE": (0.1, -0.2, 0.04),
    "RTOE": (-0.1, -0.2, 0.04),
}  # fmt: skip
"""Positions in meters, Z up, of an actor of 1.8 m who faces -Y."""
WALK = np.array(list(MARKERS.values())) + np.linspace(0, 1, 5)[:, None, None] * (0, -2, 0)
Y_DOWN = WALK[..., [0, 2, 1]] * (1, -1, 1) + (0, 0, 4)
"""The same in the axes of a camera: X right, Y down, Z away from it."""
UNNAMED = [f"M{number}" for number in range(len(MARKERS))]


def trc_text(names, points):
    """Return a TRC file in meters."""
    n_frames, n_points, _ = points.shape
    lines = [
        "PathFileType\t4\t(X/Y/Z)\ttake.trc",
        "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits",
        f"100\t100\t{n_frames}\t{n_points}\tm",
        "Frame#\tTime\t" + "\t\t\t".join(names),
        "\t\t" + "\t".join(f"{axis}{i + 1}" for i in range(n_points) for axis in "XYZ"),
        "",
        *(
            "\t".join([str(i + 1), f"{i / 100}", *map(str, frame.ravel())])
            for i, frame in enumerate(points)
        ),
    ]
    return "\n".join(lines) + "\n"


@pytest.mark.parametrize("shift", [0.0, 1.3])
def test_markers_of_a_camera_with_y_down_stand(make_reader, shift):
    points = Y_DOWN + np.array([0, shift, 0])
    tracks = make_reader("take.trc")(trc_text(list(MARKERS), points))

    heights = tracks.positions[0, :, 2]
    assert tracks.conventions.up == "-Y"
    assert heights - heights.min() == pytest.approx(WALK[0, :, 2] - WALK[0, :, 2].min())


def test_actor_on_the_floor_of_a_negative_axis_stands_at_the_origin_too(make_reader):
    """Such a take could as well lie on height 0 of Z; both have a floor, and names decide."""
    upside_down = WALK[..., [0, 2, 1]] * (1, -1, 0.1) + (0, 0, 0.07)

    tracks = make_reader("take.trc")(trc_text(list(MARKERS), upside_down))

    assert tracks.conventions.up == "-Y"


@pytest.mark.parametrize("axis", ["+X", "+Y", "+Z"])
def test_markers_upside_down_along_a_stated_axis_stand_along_the_opposite(axis):
    points = -np.roll(WALK, "XYZ".index(axis[-1]) - 2, axis=-1)

    assert other_standing_axis(points, axis, list(MARKERS)) == f"-{axis[-1]}"
    assert other_standing_axis(points, axis, UNNAMED) == ""


def test_actor_who_lies_on_the_floor_is_not_stood_up():
    lying = WALK[..., [0, 2, 1]] * (1, -1, 1)
    lying[..., 1:] += np.array([3.0, 0.05]) - lying[..., 1:].min(axis=(0, 1))

    assert other_standing_axis(lying, "+Z", list(MARKERS)) == ""


def test_actor_who_stands_along_another_axis_than_the_stated_one_stands():
    """ART-Human states Y up of takes with Z up; spread arms are as wide as a body is tall."""
    away = WALK * (1.0, 2.0, 1.0) + (0.0, 6.0, 0.0)

    assert other_standing_axis(away, "+Y", list(MARKERS)) == "+Z"
    assert other_standing_axis(away, "+Y", UNNAMED) == ""


def test_actor_who_lies_on_a_bed_is_not_stood_up():
    lying = WALK[:1][..., [0, 2, 1]] + (0.0, 1.0, 0.6)

    assert other_standing_axis(lying, "+Z", list(MARKERS)) == ""


@pytest.mark.parametrize(("scale", "size"), [(1000, "1,800"), (0.1, "0.18")])
def test_size_of_markers_that_is_no_person_s_is_a_question(scale, size):
    tracks = Tracks(tuple(MARKERS), scale * WALK, 100.0)

    question = f"The actor is {size} m tall; set Unit or Scale if this is not right"
    assert question_of_size(tracks) == question
    assert not question_of_size(Tracks(tuple(UNNAMED), scale * WALK, 100.0))


@pytest.mark.parametrize(("shift", "asks"), [(-1.0, True), (0.0, False), (0.9, False)])
def test_most_markers_below_the_floor_are_a_question(shift, asks):
    """Markers of objects, a few below the floor and actors on a platform are none."""
    points = WALK + np.array([0.0, 0.0, shift])
    markers = Tracks((*MARKERS, "plate"), np.pad(points, ((0, 0), (0, 1), (0, 0))), 100.0)
    markers.positions[:, -1, 2] = -0.4

    question = question_of_floor(markers)

    assert asks == ("stays 0.96 m below the floor; set Place on Floor to On" in question)
    assert asks or not question
    assert not question_of_floor(Tracks((*UNNAMED, "plate"), markers.positions, 100.0))


def test_size_of_a_person_in_any_pose_is_no_question():
    crouching = WALK.copy()
    crouching[1:, :7, 2] *= 0.6

    assert not question_of_size(Tracks(tuple(MARKERS), WALK, 100.0))
    assert not question_of_size(Tracks(tuple(MARKERS), crouching, 100.0))


SQUAT = MARKERS | {
    "LFHD": (0.1, -0.1, 0.8), "RFHD": (-0.1, -0.1, 0.8), "C7": (0, 0.05, 0.68),
    "LSHO": (0.2, 0, 0.65), "RSHO": (-0.2, 0, 0.65), "LASI": (0.12, 0.15, 0.25),
    "RASI": (-0.12, 0.15, 0.25), "LKNE": (0.15, -0.3, 0.5), "RKNE": (-0.15, -0.3, 0.5),
}  # fmt: skip
"""The same actor, who squats: the head is 0.8 m high."""


@pytest.mark.parametrize("unit", [0.001, 0.01, 1.0])
@pytest.mark.parametrize("size", [1.0, 0.8, 0.6, 0.45])
def test_who_squats_keeps_the_unit(unit, size):
    """In centimeters such adults are ten times too large; children are not in inches."""
    points = np.repeat(size / unit * np.array([*SQUAT.values()])[None], 3, axis=0)

    assert guess_unit_of_points(points, [*SQUAT], unwatched) == unit
    assert stature_of_markers([*SQUAT], unit * points) == pytest.approx(1.8 * size, rel=0.05)


@pytest.mark.parametrize("unit", [0.001, 1.0])
def test_who_squats_without_markers_on_the_legs_keeps_the_unit(unit):
    names = [name for name in SQUAT if name[1:] not in {"KNE", "ASI"}]
    points = np.repeat(np.array([SQUAT[name] for name in names])[None] / unit, 3, axis=0)

    assert guess_unit_of_points(points, names, unwatched) == unit


@pytest.mark.parametrize("size", [1.0, 0.6, 0.4])
def test_a_dog_in_millimeters_is_no_horse(size, collected_messages):
    messages, collect = collected_messages
    dog = {
        "Head": (0.45, 0, 0.55), "LFoot": (-0.3, 0.07, 0.02), "RFoot": (-0.3, -0.07, 0.02),
        "LHip": (-0.25, 0.05, 0.4), "RHip": (-0.25, -0.05, 0.4), "Tail": (-0.45, 0, 0.45),
    }  # fmt: skip
    points = 1000.0 * size * np.repeat(np.array([*dog.values()])[None], 3, axis=0)

    assert guess_unit_of_points(points, [*dog], collect) == 0.001
    assert not messages


def test_size_of_markers_of_real_files_is_a_person_s(recordings):
    folder = recordings / "formats" / "trc"
    names = ("ballet_reduced.trc", "static_walk_1.trc", "walk_free_01.trc")

    assert not [name for name in names if question_of_size(read_recording(folder / name))]
