"""Track with the other selected recordings: one body before several cameras."""

import json

import numpy as np
import pytest

FAST_SETTINGS = {
    "backward": False, "refine": False, "plant_feet": False, "other_cameras": True,
}  # fmt: skip
N_FRAMES, LATE_FRAMES = 26, 4
SIDE = np.array([[0, 0, 1, -2.8], [0, 1, 0, 0.1], [-1, 0, 0, 2.9], [0, 0, 0, 1.0]])
"""Transform from the first camera to one at the right of the actor."""


@pytest.fixture(scope="module")
def takes(load, tmp_path_factory):
    """Files of one walk before two cameras; the second begins later, at half the rate."""
    body, scene = load("solvers.depth_tracking.body"), load("solvers.depth_scene")
    transfer_poses = load(
        "solvers.depth_tracking.several_cameras.transfer_poses"
    ).transfer_poses
    model, time = body.default_body(), np.arange(N_FRAMES) / 30.0
    poses = np.zeros((N_FRAMES, 36))
    poses[:, 0], poses[:, 2] = 0.3 * np.sin(6.0 * time), 2.8
    for name, at_rest, size, pace in (
        ("yaw", 0.3, 0.3, 2.0), ("headX", 0.2, 0.0, 0.0), ("leftHumerusZ", 0.5, 0.7, 3.0),
        ("rightHumerusX", 0.3, 0.6, 4.0), ("rightHumerusZ", 0.6, 0.0, 0.0),
        ("leftRadius", 0.6, 0.0, 0.0), ("rightRadius", 0.8, 0.5, 5.0),
        ("leftFemurX", 0.4, 0.3, 3.0), ("rightFemurZ", 0.25, 0.0, 0.0),
        ("leftTibia", 0.5, 0.0, 0.0),
    ):  # fmt: skip
        angles = at_rest + size * (1.0 - np.cos(pace * time)) / 2.0
        poses[:, body.COORDINATES.index(name)] = angles
    folder = tmp_path_factory.mktemp("cameras")
    for name, of_camera, rate, size in (
        ("front", poses, 30.0, 1.0),
        ("side", transfer_poses(model, poses, SIDE)[LATE_FRAMES::2], 15.0, 1.25),
    ):
        camera = scene.Camera(
            142.8 * size, 142.8 * size, 79.75 * size, 59.75 * size, int(160 * size),
            int(120 * size),
        )  # fmt: skip
        images = [
            1000.0 * body.cast_rays(model, frames, camera).depth_image()
            for frames in body.segment_frames(model, of_camera)
        ]
        np.savez(
            folder / f"{name}.npz", depth=np.round(images).astype(np.uint16), frame_rate=rate,
            **{key: getattr(camera, key) for key in ("fx", "fy", "cx", "cy")},
        )  # fmt: skip
    return folder


@pytest.fixture
def imported(blank):
    """Import files and select their points; the first is active."""

    def imported(*paths):
        blank.context.scene.render.fps = 30
        made = []
        for path in paths:
            assert blank.ops.mocap_assist.import_recording(filepath=str(path)) == {"FINISHED"}
            made.append(blank.context.object)
        for each in made:
            each.select_set(True)
        blank.context.view_layer.objects.active = made[0]
        return made

    return imported


def test_two_cameras_make_one_motion_and_the_second_is_placed(takes, imported, blank, load):
    front, side = imported(takes / "front.npz", takes / "side.npz")
    stood = np.array(front.matrix_world)

    assert blank.ops.mocap_assist.track_depth(**FAST_SETTINGS) == {"FINISHED"}

    armature = blank.context.object
    assert armature.name == "front tracked"
    action = armature.animation_data.action
    assert tuple(action.frame_range) == (1.0, N_FRAMES)
    np.testing.assert_array_equal(front.matrix_world, stood)
    first_from_side = np.linalg.inv(stood) @ np.array(side.matrix_world)
    assert np.abs(first_from_side - np.linalg.inv(SIDE)).max() < 0.15
    shown = load("mocap_assist.depth.depth_preview").Shown.read(side.data)
    assert shown.start == pytest.approx(1.0 + LATE_FRAMES, abs=0.6)
    assert shown.step == pytest.approx(2.0)
    (camera,) = json.loads(action["mocap_assist_captured"])["cameras"]
    assert camera["object"] == "side"
