"""A scene without animation takes over rate and length of a take; another one keeps them."""

from types import SimpleNamespace

import numpy as np
import pytest
from numpy.testing import assert_allclose

N_FRAMES, RATE = 317, 120.0  # of the walk
ANGLE_DEG = 2.0  # a quick foot turns so far between two samples of 24 Hz, low-pass filtered


@pytest.fixture
def walk(recordings):
    return recordings / "mocap" / "cmu_walk" / "07_01.bvh"


@pytest.fixture
def time_of():
    """Rate and range of a scene."""

    def read(scene):
        rate = scene.render.fps / scene.render.fps_base
        return pytest.approx(rate), scene.frame_start, scene.frame_end

    return read


def keyed(blank):
    """Key something that no recording made."""
    owner = blank.data.objects.new("Camera", blank.data.cameras.new("Camera"))
    blank.context.scene.collection.objects.link(owner)
    owner.location = 1.0, 2.0, 3.0
    owner.keyframe_insert("location", frame=10)
    return owner


def test_scene_takes_over_rate_and_length_when_nothing_is_animated(
    walk, bring, key_times, blank, time_of, capfd
):
    scene = blank.context.scene
    scene.render.fps, scene.frame_start, scene.frame_end, scene.frame_current = 25, 5, 400, 390

    times = key_times(bring(walk))

    assert time_of(scene) == (RATE, 1, N_FRAMES)
    assert list(times) == list(range(1, N_FRAMES + 1))
    assert scene.frame_current == 1
    assert "The scene now plays at 120 FPS." in capfd.readouterr().out


@pytest.mark.parametrize("is_chosen", [False, True])
def test_the_dialog_proposes_the_first_frame_of_the_scene(load, blank, is_chosen):
    blank.context.scene.frame_start = 1001
    operator = SimpleNamespace(
        frame_start=1, properties=SimpleNamespace(is_property_set=lambda name: is_chosen)
    )

    load("mocap_assist.importing.dialog.operators").propose_start(operator, blank.context)

    assert operator.frame_start == (1 if is_chosen else 1001)


def test_fractional_rate_is_taken_over(bring, blank, load, tmp_path, time_of, key_times):
    samples, rate = load("solvers.samples"), 30000 / 1001
    take = samples.walking_gait(samples.GaitSettings(duration=2.0, frame_rate=rate))
    load("solvers.recordings").write_bvh(take, tmp_path / "film.bvh")

    times = key_times(bring(tmp_path / "film.bvh"))

    render = blank.context.scene.render
    assert render.fps / render.fps_base == pytest.approx(rate, rel=1e-5)
    assert_allclose(times, np.round(times), atol=0.0)


def key_nothing_but_a_marker(blank):
    blank.context.scene.timeline_markers.new("cut", frame=9)


def key_scene(blank):
    blank.context.scene.keyframe_insert("gravity", frame=1)


def key_instance(blank):
    """An object of a collection that the scene shows as an instance only."""
    hero = blank.data.collections.new("Hero")
    inside = blank.data.objects.new("Inside", None)
    hero.objects.link(inside)
    inside.keyframe_insert("location", frame=1)
    instance = blank.data.objects.new("Instance", None)
    instance.instance_type, instance.instance_collection = "COLLECTION", hero
    blank.context.scene.collection.objects.link(instance)


def key_strip(blank):
    animation = keyed(blank).animation_data
    action, slot = animation.action, animation.action_slot
    strip = animation.nla_tracks.new().strips.new("moves", 1, action)
    animation.action, strip.action_slot = None, slot


def mesh_object(blank):
    mesh = blank.data.meshes.new("Face")
    mesh.from_pydata([(0, 0, 0)], [], [])
    face = blank.data.objects.new("Face", mesh)
    blank.context.scene.collection.objects.link(face)
    return face


def key_shape(blank):
    face = mesh_object(blank)
    face.shape_key_add(name="Basis")
    face.shape_key_add(name="Smile").keyframe_insert("value", frame=1)


def key_material(blank):
    paint = blank.data.materials.new("Paint")
    mesh_object(blank).data.materials.append(paint)
    paint.keyframe_insert("diffuse_color", frame=1)


@pytest.mark.parametrize(
    "animate",
    [
        keyed, key_nothing_but_a_marker, key_scene, key_instance, key_strip, key_shape,
        key_material,
    ],
)  # fmt: skip
def test_animated_scene_keeps_its_rate_and_gets_integer_frames(
    animate, walk, bring, key_times, blank, time_of, capfd
):
    scene = blank.context.scene
    animate(blank)
    scene.render.fps, scene.frame_end = 24, 40

    times = key_times(bring(walk))

    assert time_of(scene) == (24.0, 1, 40)
    assert list(times) == list(range(1, 65))
    message = capfd.readouterr().out
    assert "Resampled to the scene's 24 FPS. It ends at frame 64, the scene at 40." in message


def test_second_import_keeps_the_rate_of_the_first(walk, bring, key_times, blank, time_of):
    scene = blank.context.scene
    bring(walk)
    scene.render.fps, scene.frame_end = 24, 40

    times = key_times(bring(walk))

    assert time_of(scene) == (24.0, 1, 40)
    assert list(times) == list(range(1, 65))


def test_actions_that_nothing_plays_do_not_count(walk, bring, blank, time_of):
    camera = keyed(blank)
    camera.animation_data.action.use_fake_user = True
    blank.data.objects.remove(camera)

    bring(walk)

    assert time_of(blank.context.scene) == (RATE, 1, N_FRAMES)


def test_several_files_get_the_rate_of_the_first(
    walk, recordings, bring, key_times, blank, time_of, tmp_path
):
    other = recordings / "formats" / "bvh" / "test_mocapbank.bvh"  # 455 frames at 30 Hz
    for number, path in enumerate((walk, other, walk)):
        (tmp_path / f"{number}.bvh").write_bytes(path.read_bytes())

    bring(*(tmp_path / f"{number}.bvh" for number in range(3)))

    assert time_of(blank.context.scene) == (RATE, 1, 1 + 454 * 4)
    for name, n_keys in (("0", N_FRAMES), ("1", 1 + 454 * 4), ("2", N_FRAMES)):
        times = key_times(blank.data.objects[name])
        assert list(times) == list(range(1, n_keys + 1))


def test_resampled_bones_rotate_as_the_recorded_ones(walk, bring, poses, blank):
    """Rotations between samples lie on the sphere, and near the recorded ones."""
    keyed(blank)
    blank.context.scene.render.fps = 24
    frames = range(3, 62)
    expected = poses(bring(walk, frame_rate="SCALE"), frames)

    found = poses(bring(walk), frames)

    for name, matrices in expected.items():
        rotations = found[name][:, :3, :3]
        products = np.einsum("fij,fkj->fik", rotations, rotations)
        assert_allclose(products, np.broadcast_to(np.eye(3), products.shape), atol=1e-4)
        cosines = (np.einsum("fij,fij->f", rotations, matrices[:, :3, :3]) - 1.0) / 2.0
        rotated = np.degrees(np.arccos(np.clip(cosines, -1.0, 1.0)))
        assert np.median(rotated) < ANGLE_DEG, name


def test_sensor_values_lie_on_integer_frames(recordings, bring, blank, load):
    keyed(blank)
    blank.context.scene.render.fps = 24
    path = recordings / "kinect" / "irds" / "215_18_5_8_1_stand.txt"
    recording = load("solvers.recordings").read_recording(path)

    armature = bring(path)

    action = armature.animation_data.action
    curves = action.layers[0].strips[0].channelbags[0].fcurves
    times = {key.co.x for curve in curves for key in curve.keyframe_points}
    assert times == {float(round(time)) for time in times}
    joint = recording.names.index("FootLeft")
    curve = curves.find('pose.bones["FootLeft"]["mocap_tracking_state"]')
    state = recording.tracking_state[:, joint]
    assert len(set(state)) > 1
    for frame in range(1, 36):
        moment = (frame - 1) * recording.frame_rate / 24.0
        around = state[int(np.floor(moment)) : int(np.ceil(moment)) + 1]
        assert curve.evaluate(frame) == around.min()
