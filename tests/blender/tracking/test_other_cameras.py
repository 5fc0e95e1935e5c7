"""Track with the other selected recordings: one body before several cameras."""

import json
import pickle

import numpy as np
import pytest
from modal_events import event, nothing_is_left, wait

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
    assert camera["object"] == "side" and camera["recording"].endswith("side.npz")


@pytest.fixture
def write_joined(load, blank):
    """Let Track write a default body of two cameras, without solving."""
    tracking, solving = (
        load(f"mocap_assist.track.{name}") for name in ("tracking", "solve_tracking")
    )
    body = load("solvers.depth_tracking.body")

    def write(front, side, *, first_shows_floor, offset=0.5):
        floor = load("solvers.depth_scene").FloorPlane(np.array([0.0, -0.8, -0.6]), 1.2)
        poses = np.zeros((N_FRAMES, 36))
        poses[:, 2] = 2.8
        model = body.default_body()
        found = solving.FoundCamera(
            ("OBJECT", side.session_uid, side.name), np.linalg.inv(SIDE), offset, 0.02,
            shows_floor=True,
        )  # fmt: skip
        tracked = solving.Tracked(
            first=0, motion=body.body_motion(model, poses, 30.0, floor), body=model,
            floor=floor, confidence={}, residual=np.full(N_FRAMES, 0.01), coverage=1.0,
            restarts=(), low_confidence=(), remarks=(), cameras=(found,),
            first_shows_floor=first_shows_floor, other_numbers=(found.object_number,),
        )  # fmt: skip
        settings = tracking.TrackBundle(
            tracking.TrackChoices(other_cameras=True),
            load("solvers.depth_tracking.capturing").CaptureSettings(),
            load("solvers.depth_scene").ForegroundSettings(),
            load("solvers.denoising").PlantSettings(),
        )
        return tracking.write_tracked(blank.context.scene, front, settings, tracked)

    return write


def placed(points, blank, *matrices):
    from mathutils import Matrix

    for each, matrix in zip(points, matrices, strict=True):
        each.matrix_world = Matrix(matrix)
    blank.context.view_layer.update()


def test_points_of_the_second_camera_move_in_space_and_time(
    takes, imported, blank, load, write_joined
):
    front, side = imported(takes / "front.npz", takes / "side.npz")
    stood = np.diag([2.0, 2.0, 2.0, 1.0])
    stood[:3, 3] = 3.0, 1.0, 0.5
    placed([front, side], blank, stood.tolist(), np.eye(4).tolist())

    message = write_joined(front, side, first_shows_floor=True)

    blank.context.view_layer.update()
    np.testing.assert_allclose(front.matrix_world, stood, atol=1e-5)
    np.testing.assert_allclose(side.matrix_world, stood @ np.linalg.inv(SIDE), atol=1e-5)
    shown = load("mocap_assist.depth.depth_preview").Shown.read(side.data)
    assert (shown.start, shown.step) == (1.0 + 0.5 * 30.0, 2.0)
    assert message.endswith("The points of camera 2, side, were moved to its position.")


def test_points_without_floor_move_to_those_that_stand_on_it(
    takes, imported, blank, write_joined
):
    front, side = imported(takes / "front.npz", takes / "side.npz")
    stood = np.array([[1, 0, 0, 2], [0, 0.6, 0.8, 1], [0, -0.8, 0.6, 1.2], [0, 0, 0, 1.0]])
    placed([front, side], blank, np.eye(4).tolist(), stood.tolist())

    message = write_joined(front, side, first_shows_floor=False, offset=0.0)

    blank.context.view_layer.update()
    np.testing.assert_allclose(side.matrix_world, stood, atol=1e-5)
    np.testing.assert_allclose(front.matrix_world, stood @ SIDE, atol=1e-5)
    assert "The points of camera 1, front, were moved to its position." in message


def test_points_of_a_camera_move_with_their_parents_and_against_keys(
    takes, imported, blank, write_joined
):
    front, side = imported(takes / "front.npz", takes / "side.npz")
    stood = np.diag([1e-3, 1e-3, 1e-3, 1.0])  # a scene in kilometers
    stood[:3, 3] = 3e-3, 1e-3, 0.0
    front.parent = side  # which moves it, though it stands where it should
    placed([side, front], blank, np.eye(4).tolist(), stood.tolist())

    message = write_joined(front, side, first_shows_floor=True)

    blank.context.view_layer.update()
    right = stood @ np.linalg.inv(SIDE)
    np.testing.assert_allclose(front.matrix_world, stood, atol=1e-6)
    np.testing.assert_allclose(side.matrix_world, right, atol=1e-6)
    assert message.endswith("camera 2, side, were moved to its position.")
    away = right.copy()
    away[1, 3] += 9e-5  # 9 cm
    placed([side, front], blank, away.tolist(), stood.tolist())
    side.keyframe_insert("location")
    message = write_joined(front, side, first_shows_floor=True)
    assert "camera 2, side, are not at its position: keys, a constraint" in message


def test_cameras_that_are_read_again_are_those_that_were_solved(takes, imported, load):
    front, *_ = imported(takes / "front.npz", takes / "side.npz", takes / "side.npz")
    cameras = load("mocap_assist.track.other_cameras")
    fingerprint = load("mocap_assist.runtime.redo").fingerprint
    solved = cameras.read_cameras(front)
    assert [each.object_number[-1] for each in solved.others] == ["side", "side.001"]

    sent = pickle.loads(pickle.dumps(tuple(each.object_number for each in solved.others)))

    assert fingerprint(cameras.read_again(front, sent)) == fingerprint(solved)


def test_esc_keeps_what_was_tracked_before_the_first_camera(
    takes, imported, load, press_button, window, blank
):
    imported(takes / "front.npz", takes / "side.npz")
    tracking = load("mocap_assist.track.tracking")
    settings = tracking.TrackBundle(
        tracking.TrackChoices(plant_feet=False, other_cameras=True),
        load("solvers.depth_tracking.capturing").CaptureSettings(backward=False, refine=False),
        load("solvers.depth_scene").ForegroundSettings(),
        load("solvers.denoising").PlantSettings(),
        escaping=tracking.EscChoices(keep_on_esc=True),
    )
    button = press_button("track_depth", settings)
    wait(button, window, until=lambda: button._view and button._view.drawn)

    assert button.modal(window.context, event("ESC", "PRESS")) == {"FINISHED"}

    ((_, message),) = window.reports
    assert f"of {N_FRAMES} frames tracked. The cameras were not joined" in message
    assert blank.context.object.name == "front tracked" and nothing_is_left(window)


def test_deleted_camera_is_named_and_nothing_is_added(takes, imported, blank, write_joined):
    front, side = imported(takes / "front.npz", takes / "side.npz")
    kept = type("Kept", (), {"session_uid": side.session_uid, "name": "side"})
    blank.data.objects.remove(side)
    before = set(blank.data.objects.keys())

    with pytest.raises(Exception, match="side was deleted during the solve"):
        write_joined(front, kept, first_shows_floor=True)

    assert set(blank.data.objects.keys()) == before


def test_unfitting_requests_are_refused_in_one_sentence(takes, imported, blank, draw):
    _, side = imported(takes / "front.npz", takes / "side.npz")
    track = blank.context.scene.mocap_assist.track
    assert "max_offset" not in draw("MOCAP_PT_track")
    track.other_cameras = True
    assert "max_offset" in draw("MOCAP_PT_track")
    assert blank.ops.mocap_assist.track_depth.poll()
    side.select_set(False)
    assert not blank.ops.mocap_assist.track_depth.poll()
    track.other_cameras = False
    for settings, sentence in (
        (FAST_SETTINGS, "Select the points of the other cameras, too"),
        (FAST_SETTINGS | {"all_people": True}, "Several cameras track one person"),
        (FAST_SETTINGS | {"method": "EDGES"}, "The method lou tracks one person"),
        ({"all_people": True, "method": "EDGES"}, "The method lou tracks one person"),
    ):
        with pytest.raises(RuntimeError, match=sentence):
            blank.ops.mocap_assist.track_depth(**settings)
    imported(takes / "front.npz", takes / "front.npz")
    with pytest.raises(RuntimeError, match=r"shows the same recording as front"):
        blank.ops.mocap_assist.track_depth(**FAST_SETTINGS)
    assert not blank.data.armatures


def test_command_joins_the_files(takes, load, tmp_path, monkeypatch, command):
    verb, solved = load("mocap_assist.batch.capture_verb"), []

    def stop(solve, arguments, progress):
        solved.append(solve.args[0])
        raise load("solvers.errors").InvalidMotionError("Stopped.")

    monkeypatch.setattr(verb, "solve_in_subprocess", stop)
    words = [takes / "side.npz", takes / "front.npz", "--other-cameras"]

    command("capture", *words, "--output", tmp_path / "out.blend")

    (cameras,) = solved
    assert cameras.first.frame_rate == 15.0
    assert [each.recording.frame_rate for each in cameras.others] == [30.0]
    for refused, sentence in (
        ([*words, "--all-people"], "Leave out --all-people or --other-cameras."),
        (words[1:], "--other-cameras joins recordings of one take."),
        ([words[0], *words], "The same recording is named twice."),
    ):
        status, _, err = command("capture", *refused, "--output", tmp_path / "out.blend")
        assert status == 2 and sentence in err
    assert len(solved) == 1


def test_command_takes_the_cameras_in_the_order_of_their_names(load, tmp_path, monkeypatch):
    """The first one has the frames of the motion, also if the next is a folder."""
    verb = load("mocap_assist.batch.capture_verb")
    monkeypatch.setattr(verb, "is_take", lambda path: path.suffix == "")

    given = [tmp_path / "b.npz", tmp_path / "folder", tmp_path / "a.npz"]

    assert [path for each in given for path in verb._recordings_of(each)] == given
