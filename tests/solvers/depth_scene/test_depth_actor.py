"""Detection of the actor among floors, walls, furniture and other people, with ground truth."""

from dataclasses import replace

import numpy as np
import pytest
from depth_rooms import in_room, room, tilted

from solvers.depth_scene.actor import find_actor
from solvers.depth_scene.bodies import find_bodies
from solvers.depth_scene.camera import Camera
from solvers.depth_scene.foreground import ForegroundMethod, ForegroundSettings
from solvers.depth_scene.recording import DepthRecording
from solvers.errors import InvalidMotionError, SolveCancelled
from solvers.recordings import read_depth

KINECT = Camera(285.63, 285.63, 159.5, 119.5, 320, 240)
UP = tilted(0.0)
FLOOR = 0.95


@pytest.fixture(scope="module")
def takes(recordings):
    def read(name):
        with np.load(recordings / "depth" / "truth" / f"{name}.npz") as archive:
            depth = (archive["depth"] * 0.001).astype(np.float32)
        return DepthRecording(KINECT, len(depth), 30.0, lambda frame: depth[frame])

    return {name: read(name) for name in ("walk_front", "walk_side", "walk_diagonal", "jump")}


def agreement(found: np.ndarray, true: np.ndarray) -> float:
    """Intersection over union."""
    return float((found & true).sum() / max((found | true).sum(), 1))


def agreements(actor_only: DepthRecording, true: DepthRecording) -> list[float]:
    frames = range(0, true.n_frames, 12)
    return [agreement(actor_only.frame(frame) > 0, true.frame(frame) > 0) for frame in frames]


def changed(take: DepthRecording, change) -> DepthRecording:
    return replace(take, read_depth=lambda frame: change(frame, take.frame(frame)))


def floor_of(take: DepthRecording) -> float:
    """Height of the camera above the lowest point of the actor, meters."""
    lowest = [
        take.camera.back_project(take.frame(frame))[take.frame(frame) > 0.0, 1].max()
        for frame in range(0, take.n_frames, 5)
    ]
    return float(np.quantile(lowest, 0.9))


@pytest.mark.parametrize("name", ["walk_front", "walk_side", "walk_diagonal", "jump"])
def test_find_actor_works_in_a_room_with_default_settings(takes, name):
    take = takes[name]
    recording = in_room(take, room(KINECT, UP, floor_of(take) + 0.01, 5.5), 0.0015)

    actor = find_actor(recording)

    assert actor.method is ForegroundMethod.AUTOMATIC
    assert actor.floor.height == pytest.approx(floor_of(take), abs=0.03)
    assert actor.visible.all()
    assert actor.remarks == ()
    assert np.mean(agreements(actor.recording, take)) > 0.85


@pytest.mark.parametrize(("width", "height"), [(224, 171), (240, 180), (512, 424), (100, 100)])
def test_images_of_any_size_have_bodies(width, height):
    """A person moves in front of a wall; every pixel has a depth, as with few sensors."""
    camera = Camera(width, width, width / 2, height / 2, width, height)
    shape = np.zeros((height, width), dtype=bool)
    shape[int(0.2 * height) : int(0.9 * height), int(0.1 * width) : int(0.3 * width)] = True

    def person(frame):
        return np.roll(shape, frame * width // 100, axis=1)

    actor = find_actor(
        DepthRecording(
            camera, 60, 30.0, lambda frame: np.where(person(frame), 2.5, 4.0).astype(np.float32)
        )
    )

    assert agreement(actor.recording.frame(30) > 0.0, person(30)) > 0.9


def test_find_actor_ignores_furniture(takes):
    """A cupboard with more visible surface than the actor, and a stool."""
    take = takes["walk_side"]
    empty = room(KINECT, UP, floor_of(take) + 0.01, 5.5)
    empty[40:200, 5:60] = np.minimum(empty[40:200, 5:60], 3.0)
    empty[170:200, 280:310] = np.minimum(empty[170:200, 280:310], 3.5)

    actor = find_actor(in_room(take, empty, 0.001))

    assert actor.remarks == ()
    assert np.mean(agreements(actor.recording, take)) > 0.85


def test_find_actor_uses_frames_of_the_empty_room(takes):
    """The actor stands at the cupboard and is separated from it."""
    take = takes["walk_front"]
    empty = room(KINECT, UP, floor_of(take) + 0.01, 5.0)
    column = np.nonzero((take.frame(40) > 0.0).any(axis=0))[0].max()
    depth = float(np.median(take.frame(40)[take.frame(40) > 0.0])) + 0.1
    empty[30:220, column - 5 : column + 60] = depth
    empty_images = np.zeros((240, 320), np.float32)
    recording = in_room(
        DepthRecording(
            KINECT,
            106,
            30.0,
            lambda frame: empty_images if frame < 30 else take.frame(frame - 30),
        ),
        empty,
        0.001,
    )

    actor = find_actor(recording, empty=range(30))

    assert actor.method is ForegroundMethod.BACKGROUND
    assert not actor.visible[:25].any()
    assert actor.visible[31:].all()
    assert any("No person is visible in" in remark for remark in actor.remarks)
    found = agreement(actor.recording.frame(70) > 0.0, take.frame(40) > 0.0)
    assert found > 0.8
    with pytest.raises(InvalidMotionError, match="Select frames without the actor"):
        find_actor(
            recording, ForegroundSettings(actor_mask=ForegroundMethod.BACKGROUND), empty=[]
        )


def test_find_actor_keeps_a_recording_of_the_actor_alone(recordings):
    folder = recordings / "depth" / "utd_mhad"
    for path in sorted(folder.glob("a*_s7_t1_depth.mat"))[::4]:
        recording = read_depth(path)
        actor = find_actor(recording)
        assert actor.method is ForegroundMethod.RECORDED, path
        assert actor.floor is None
        assert actor.visible.all() and actor.feet_visible, path
        assert actor.remarks == (), path
        assert min(agreements(actor.recording, recording)) > 0.98


def test_find_actor_reports_missing_feet_of_a_close_actor(recordings):
    for path in sorted((recordings / "depth" / "skeltrack").iterdir()):
        actor = find_actor(read_depth(path))
        assert actor.method is ForegroundMethod.RECORDED
        assert not actor.feet_visible
        assert "The image ends above the feet" in actor.remarks[0]


@pytest.mark.parametrize("in_a_room", [False, True])
def test_find_actor_follows_the_same_person_when_two_pass(takes, in_a_room):
    """A smaller person enters at the right edge and leaves at the left, behind the actor."""
    take, other = takes["walk_front"], takes["walk_side"]

    def with_another(frame, depth):
        small = np.where(
            other.frame(frame)[::2, ::2] > 0.0, other.frame(frame)[::2, ::2] + 1.3, 0
        )
        image = np.zeros((240, 640), np.float32)
        left = 160 + 290 - 6 * frame
        image[60:180, left : left + 160] = small
        behind = image[:, 160:480]
        return np.where(depth > 0.0, depth, behind)

    both = changed(take, with_another)
    if in_a_room:
        both = in_room(both, room(KINECT, UP, floor_of(take) + 0.01, 7.5), 0.0005)

    actor = find_actor(both, ForegroundSettings(max_distance=7.0))

    assert "2 people are visible" in actor.remarks[0]
    assert actor.visible.all()
    assert min(agreements(actor.recording, take)) > 0.8


def test_find_actor_handles_an_actor_who_leaves_and_returns(takes):
    take = takes["walk_diagonal"]
    missing_frames = range(30, 60)
    recording = changed(take, lambda frame, depth: depth * (frame not in missing_frames))

    actor = find_actor(recording)

    assert (~actor.visible).sum() == pytest.approx(30, abs=6)
    assert not actor.visible[36:54].any()
    assert all(actor.recording.frame(frame).max() == 0.0 for frame in missing_frames)
    assert min(agreements(actor.recording, recording)[:2]) > 0.98
    assert agreement(actor.recording.frame(80) > 0, take.frame(80) > 0) > 0.98
    assert "No person is visible in" in actor.remarks[0]


@pytest.mark.parametrize("in_a_room", [False, True])
def test_find_actor_raises_without_a_person(in_a_room):
    empty_images = DepthRecording(KINECT, 20, 30.0, lambda _: np.zeros((240, 320), np.float32))
    recording = (
        in_room(empty_images, room(KINECT, UP, 0.9, 4.0), 0.001) if in_a_room else empty_images
    )

    with pytest.raises(InvalidMotionError, match="No person is visible in this recording"):
        find_actor(recording)


def test_find_bodies_is_consistent_across_resolutions(takes):
    """At four times the width, bodies are detected in a coarse image and then refined."""
    depth = takes["walk_front"].frame(40)
    large = depth.repeat(4, axis=0).repeat(4, axis=1)
    camera = Camera(4 * 285.63, 4 * 285.63, 639.5, 479.5, 1280, 960)

    small, found = find_bodies(depth, KINECT, 0.08), find_bodies(large, camera, 0.08)

    assert len(small.areas) == len(found.areas) == 1
    np.testing.assert_allclose(found.areas, small.areas, rtol=0.05)
    np.testing.assert_allclose(found.centers, small.centers, atol=0.02)
    assert agreement(found.mask(1), large > 0.0) > 0.97


def test_find_actor_can_be_cancelled(takes, cancel):
    with pytest.raises(SolveCancelled):
        find_actor(takes["walk_front"], progress=cancel)


@pytest.mark.parametrize("factor", [0.25, 2.0])
def test_find_actor_reports_the_height_from_a_wrong_focal_length(takes, factor):
    take = takes["walk_front"]
    wrong = Camera(285.63 / factor, 285.63 / factor, 159.5, 119.5, 320, 240)

    actor = find_actor(replace(take, camera=wrong), ForegroundSettings(min_body_area=0.01))

    assert f"The actor would be {1.62 * factor:.1f} m tall: check" in actor.remarks[-1]
