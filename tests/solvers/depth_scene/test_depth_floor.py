"""Detection of the floor in rooms with ground truth."""

import numpy as np
import pytest
from depth_rooms import in_room, room, tilted
from numpy.testing import assert_allclose

from solvers.depth_scene.camera import Camera
from solvers.depth_scene.floor import LEVEL, FloorPlane, find_floor
from solvers.depth_scene.recording import DepthRecording
from solvers.recordings import read_depth

KINECT = Camera(285.63, 285.63, 159.5, 119.5, 320, 240)


def empty_recording(camera: Camera = KINECT) -> DepthRecording:
    shape = (camera.height, camera.width)
    return DepthRecording(camera, 5, 30.0, lambda _: np.zeros(shape, np.float32))


def angle_between(floor: FloorPlane, up: np.ndarray) -> float:
    return float(np.degrees(np.arccos(np.clip(floor.up @ up, -1.0, 1.0))))


@pytest.mark.parametrize(
    ("down", "roll", "height"), [(0.0, 0.0, 0.6), (12.0, 5.0, 1.4), (30.0, -8.0, 2.2)]
)
def test_find_floor_matches_an_empty_room(down, roll, height):
    up = tilted(down, roll)

    floor = find_floor(in_room(empty_recording(), room(KINECT, up, height, 4.0), noise=0.0015))

    assert angle_between(floor, up) < 0.5
    assert floor.height == pytest.approx(height, abs=0.01)


def test_find_floor_works_behind_a_real_human(recordings):
    actor = read_depth(recordings / "depth" / "truth" / "walk_front.npz")
    with np.load(recordings / "depth" / "truth" / "walk_front.npz") as archive:
        joints = archive["joints"].astype(np.float64)
    height = np.quantile(joints[..., 1], 0.99) + 0.03
    up = tilted(0.0)

    floor = find_floor(in_room(actor, room(KINECT, up, height, 5.0), noise=0.0015))

    assert angle_between(floor, up) < 0.5
    assert floor.height == pytest.approx(height, abs=0.01)
    assert np.quantile(floor.heights(joints), 0.01) == pytest.approx(0.03, abs=0.02)


def test_find_floor_rejects_a_table():
    """The table covers more of the image than the floor next to it."""
    up = tilted(20.0)
    floor, table = room(KINECT, up, 1.5, 4.0), room(KINECT, up, 0.8, 2.2)
    table[:, 220:] = np.inf
    empty = np.where(KINECT.back_project(table)[..., 2] < 2.0, table, floor)

    detected = find_floor(in_room(empty_recording(), np.minimum(empty, floor), noise=0.001))

    assert detected.height == pytest.approx(1.5, abs=0.02)


def test_find_floor_returns_none_for_the_actor_alone(recordings):
    paths = sorted((recordings / "depth" / "utd_mhad").glob("*_s3_t1_depth.mat"))
    paths += sorted((recordings / "depth" / "truth").iterdir())
    paths += sorted((recordings / "depth" / "skeltrack").iterdir())

    assert [path for path in paths if find_floor(read_depth(path)) is not None] == []


def test_find_floor_returns_none_for_an_empty_recording_and_a_wall():
    up = tilted(0.0)

    assert find_floor(empty_recording()) is None
    assert (
        find_floor(in_room(empty_recording(), room(KINECT, up, 50.0, 3.0), noise=0.0015))
        is None
    )


def test_world_from_camera_matches_the_camera_pose(rng):
    floor = FloorPlane(tilted(25.0, 10.0), 1.3)

    rotation, translation = floor.world_from_camera()

    points = rng.normal(size=(20, 3))
    world = points @ rotation.T + translation
    assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(rotation) == pytest.approx(1.0)
    assert_allclose(world[:, 2], floor.heights(points))
    ahead = rotation @ (0.0, 0.0, 1.0)
    assert ahead[0] == pytest.approx(0.0, abs=1e-12)
    assert ahead[1] > 0.0
    assert_allclose(translation, (0.0, 0.0, 1.3))


def test_level_camera_looks_along_y():
    rotation, _ = LEVEL.world_from_camera()

    assert_allclose(
        rotation @ np.eye(3), np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]]), atol=1e-12
    )
