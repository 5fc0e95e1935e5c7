"""What Track Live writes of a motion that is given: nothing is solved."""

import numpy as np
import pytest
from depth_folders import save_png


@pytest.fixture
def n_frames():
    return 20


@pytest.fixture
def followed(load, given_poses, folder):
    def make(first=5, rate=30.0):
        body = load("solvers.depth_tracking.body.model").default_body()
        motion = load("solvers.depth_tracking.body.motion")
        tracked = load("mocap_assist.track.solve_tracking").Tracked(
            first=first,
            motion=motion.body_motion(body, given_poses, rate, None),
            body=body,
            floor=None,
            confidence={"hips": np.ones(20)},
            residual=np.full(20, 0.01),
            coverage=1.0,
            restarts=(),
            low_confidence=(),
            remarks=(),
        )
        camera = load("solvers.depth_scene").Camera(285.63, 285.63, 159.5, 119.5, 320, 240)
        return load("mocap_assist.track.solve_following").Followed(tracked, camera, 3.0, folder)

    return make


@pytest.fixture
def write(load, blank, follow_bundle, followed):
    def write(settings=None, **options):
        scene = blank.context.scene
        return load("mocap_assist.track.following").write_followed(
            scene, scene, settings or follow_bundle(), followed(**options)
        )

    return write


@pytest.fixture
def recorded(folder, truth):
    for number in range(30):
        save_png(folder / f"{number:06}.png", truth["depth"][number % 20])


def test_points_and_motion_have_the_same_time(write, recorded, blank, load):
    """Image 5 is the first of the motion, which begins at frame 3."""
    write()

    shown = load("mocap_assist.depth.depth_preview").Shown.read(blank.data.objects["take"].data)
    assert shown.frame(5) == 3.0 and shown.step == 1.0
    action = blank.context.object.animation_data.action
    assert action.frame_range[:] == pytest.approx((3.0, 22.0))


def test_scene_with_other_animation_keeps_its_time(write, recorded, blank):
    blank.ops.mesh.primitive_cube_add()
    blank.context.object.keyframe_insert("location", frame=1)

    write()

    scene = blank.context.scene
    assert (scene.render.fps, scene.frame_end) == (24, 250)
    last = 3.0 + 19 * 24.0 / 30.0
    action = blank.context.object.animation_data.action
    assert action.frame_range[1] == pytest.approx(last, abs=1e-3)


def test_points_of_a_recording_at_another_rate_keep_their_own_time(
    write, recorded, blank, load
):
    write(rate=15.0)

    mesh = blank.data.objects["take"].data
    shown = load("mocap_assist.depth.depth_preview").Shown.read(mesh)
    assert shown.step == 0.5 and shown.frame(10) == 3.0
    action = blank.context.object.animation_data.action
    assert action.frame_range[:] == pytest.approx((3.0, 22.0))


def test_recording_that_is_gone_has_an_armature_without_points(write, blank, load):
    message = write()

    assert "There is no file " in message
    points = blank.data.objects["take"]
    assert "take" in load("mocap_assist.depth.depth_preview").problem_of(points)
    assert blank.context.object.type == "ARMATURE"


def test_images_of_several_sizes_have_no_points(write, recorded, folder, truth, blank):
    save_png(folder / "000030.png", truth["depth"][0, :100])

    message = write()

    assert "000030.png has 320 x 100 pixels, the others 320 x 240" in message
    assert blank.context.object.type == "ARMATURE"


def test_damaged_image_is_hidden_and_the_others_have_points(
    write, recorded, folder, blank, load
):
    """It is one of those that the density of the points is measured in."""
    image = folder / "000007.png"
    image.write_bytes(image.read_bytes()[:200] + bytes(40) + image.read_bytes()[240:])

    write()

    preview, scene = load("mocap_assist.depth.depth_preview"), blank.context.scene
    points = blank.data.objects["take"]
    scene.frame_set(5)
    assert "000007.png is missing or damaged" in preview.problem_of(points)
    scene.frame_set(6)
    assert not preview.problem_of(points) and blank.context.object.type == "ARMATURE"


def test_points_are_those_of_the_take_if_the_file_was_saved_elsewhere(
    write, recorded, follow_bundle, blank, load
):
    """A path relative to the file has another meaning then."""
    bundle = follow_bundle()
    moved = bundle.recording.__class__(**vars(bundle.recording) | {"recording_file": "//take"})

    write(bundle._replace(recording=moved))

    points = blank.data.objects["take"]
    assert not load("mocap_assist.depth.depth_preview").problem_of(points)


def test_earlier_images_of_a_folder_are_forgotten(write, recorded, folder, truth, blank, load):
    preview = load("mocap_assist.depth.depth_preview")
    write()
    save_png(folder / "000030.png", truth["depth"][0])

    write()

    mesh = blank.data.objects["take.001"].data
    assert preview.recording_of(mesh).n_frames == 31


def test_error_leaves_the_scene_as_it_was(write, recorded, blank, load, monkeypatch):
    following = load("mocap_assist.track.following")
    monkeypatch.setattr(following, "add_armature", lambda *_, **__: 1 / 0)

    with pytest.raises(ZeroDivisionError):
        write()

    scene = blank.context.scene
    assert not blank.data.objects and not blank.data.meshes
    assert (scene.render.fps, scene.frame_end) == (24, 250)
