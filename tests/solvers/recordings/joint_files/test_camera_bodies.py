"""Bodies of ZED, Nuitrack and MediaPipe: joints, axes, gaps, confidence, and flat landmarks."""

import json

import numpy as np
import pytest
from exports.camera_bodies import (
    AXES,
    STANDING,
    mediapipe,
    mediapipe_csv,
    mediapipe_json,
    nuitrack_csv,
    nuitrack_json,
    picture,
    walking,
    zed,
)
from numpy.testing import assert_allclose

from solvers.errors import InvalidFileError
from solvers.motion import JointRecording, Sensor
from solvers.motion.humanoid import posture_joint_indices
from solvers.motion.skeletons import BODY_POINTS, COMPUTED_JOINTS, NUITRACK, ZED_BODIES


def positions_of(recording, names):
    return recording.tracks.positions[:, [recording.names.index(name) for name in names]]


def stands(recording):
    """Whether it is a recording of a whole body that can become an armature."""
    assert isinstance(recording, JointRecording)
    assert len(posture_joint_indices(recording.names)) >= 15
    roots = [at for at, parent in enumerate(recording.parents) if parent < 0]
    return sum(root in recording.parents for root in roots) == 1


@pytest.mark.parametrize("axes", AXES)
@pytest.mark.parametrize("n_joints", ZED_BODIES)
def test_a_body_of_the_zed_stands_in_any_axes(read_any, n_joints, axes):
    text, positions = zed(n_joints, axes)

    recording = read_any(text)

    assert recording.sensor is Sensor.ZED
    assert recording.frame_rate == 30.0
    assert stands(recording)
    found = positions_of(recording, ZED_BODIES[n_joints])
    if axes == "left-handed z up, x forward":  # The camera looks along another axis.
        found = np.stack([-found[..., 1], found[..., 0], found[..., 2]], axis=-1)
    assert_allclose(found, positions, atol=0.01)  # Stamps are rounded to milliseconds.


def test_of_the_zed_gaps_are_nan_and_confidence_is_a_fraction(read_any):
    recording = read_any(zed(18)[0])

    nose = recording.names.index("Nose")
    assert np.isnan(recording.tracks.positions[2]).all()
    assert np.isnan(recording.tracks.positions[3, nose]).all()
    assert_allclose(recording.tracks.confidence[[0, 1, 4]], 0.8, atol=0.01)  # stamps
    assert_allclose(recording.tracks.confidence[2], 0.0, atol=0.01)


def test_a_body_of_the_zed_in_millimeters_comes_in_true_size(read_any, collected_messages):
    recording = read_any(zed(34, unit=0.001)[0], progress=collected_messages[1])

    assert np.nanmax(recording.tracks.positions[..., 2]) == pytest.approx(1.69, abs=0.01)
    assert any("millimeters" in message for message in collected_messages[0])


def test_a_user_of_nuitrack_comes_in_from_the_csv(read_any):
    text, positions = nuitrack_csv()

    recording = read_any(text)

    assert recording.sensor is Sensor.NUITRACK
    assert recording.frame_rate == 30.0
    assert stands(recording)
    names = [name for name in NUITRACK.values() if "Clavicle" not in name]
    kept = [list(NUITRACK.values()).index(name) for name in names]
    assert_allclose(positions_of(recording, names), positions[:, kept], atol=1e-3)
    assert "SpineChest" in recording.names


def test_a_repeated_stamp_of_nuitrack_is_skipped(read_any):
    text, _ = nuitrack_csv()
    lines = text.splitlines()

    assert read_any("\n".join([*lines, lines[-1]])).n_frames == 6


@pytest.mark.parametrize("style", ["list", "names"])
def test_json_in_the_shape_of_the_interface_of_nuitrack_is_read(read_any, style):
    text, positions = nuitrack_json(style)

    recording = read_any(text)

    assert_allclose(positions_of(recording, ["Head"])[:, 0], positions[:, 0], atol=1e-3)
    assert_allclose(recording.tracks.confidence, 0.75)


def test_a_joint_without_confidence_was_not_tracked(read_any):
    text, _ = nuitrack_json()
    recording = read_any(text.replace('"confidence": 0.75', '"confidence": 0', 1))

    assert np.isnan(positions_of(recording, ["Head"])[0]).all()


def test_a_second_person_in_world_landmarks_is_reported(read_any, collected_messages):
    messages, progress = collected_messages
    content = json.loads(mediapipe_json(mediapipe()))
    for frame in content["frames"][:3]:
        frame["worldLandmarks"] = [frame["worldLandmarks"]] * 2

    read_any(json.dumps(content), progress=progress)

    assert any("3 frames have more than one person" in message for message in messages)


@pytest.mark.parametrize("empty", [[], None])
def test_an_empty_place_is_no_second_person(read_any, collected_messages, empty):
    messages, progress = collected_messages
    content = json.loads(mediapipe_json(mediapipe()))
    for frame in content["frames"]:
        frame["worldLandmarks"] = [frame["worldLandmarks"], empty]

    read_any(json.dumps(content), progress=progress)

    assert not any("more than one person" in message for message in messages)


def expected_landmarks(points):
    x, y, z = np.moveaxis(points[..., :3], -1, 0)
    return np.stack([x, z, -y], axis=-1)


@pytest.mark.parametrize("key", ["worldLandmarks", "pose_world_landmarks"])
def test_world_landmarks_in_json_are_read_next_to_image_landmarks(read_any, key):
    points = mediapipe()
    points[2] = np.nan

    recording = read_any(mediapipe_json(points, key))

    assert recording.sensor is Sensor.MEDIAPIPE
    assert recording.frame_rate == 25.0
    assert recording.names == (*BODY_POINTS, *COMPUTED_JOINTS)
    assert stands(recording)
    assert_allclose(recording.tracks.positions[:, :33], expected_landmarks(points), atol=1e-6)
    assert_allclose(recording.tracks.confidence[0, :33], np.linspace(0.5, 1.0, 33))
    assert_allclose(recording.tracks.confidence[2], 0.0)


def test_lists_of_lists_without_names_are_read_with_a_message(read_any, collected_messages):
    points = mediapipe()
    frames = [{"landmarks": [body[:, :3].tolist()]} for body in points]

    recording = read_any(json.dumps(frames), progress=collected_messages[1])

    assert recording.tracks.confidence is None
    assert_allclose(recording.tracks.positions[:, :33], expected_landmarks(points), atol=1e-6)
    assert "The file has no frame rate; 30 Hz is assumed" in collected_messages[0]


@pytest.mark.parametrize("style", ["names", "numbers", "letters", "world", "long"])
def test_world_landmarks_in_csv_are_read(read_any, style):
    points = mediapipe()

    recording = read_any(mediapipe_csv(points, style))

    assert recording.frame_rate == 25.0
    assert_allclose(recording.tracks.positions[:, :33], expected_landmarks(points), atol=1e-5)
    assert_allclose(recording.tracks.confidence[0, :33], np.linspace(0.5, 1.0, 33), atol=1e-5)


def test_blank_cells_of_a_csv_are_gaps(read_any):
    points = mediapipe()
    points[1, 5] = np.nan

    recording = read_any(mediapipe_csv(points))

    assert np.isnan(recording.tracks.positions[1, 5]).all()
    assert recording.tracks.confidence[1, 5] == 0.0


@pytest.mark.parametrize(
    "text",
    [
        mediapipe_csv(picture(mediapipe())),
        mediapipe_csv(picture(mediapipe()), "long"),
        mediapipe_json(picture(mediapipe()), "landmarks", flat=False),
        mediapipe_csv(picture(mediapipe())).replace("_z,", "_other,"),
    ],
)
def test_landmarks_of_a_picture_are_refused_with_what_would_serve(read_any, text):
    with pytest.raises(InvalidFileError, match=r"image landmarks, .* pose_world_landmarks"):
        read_any(text)


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        (zed()[0][:9000], "damaged or cut short"),
        (zed()[0].replace('"keypoint"', '"joint"'), "no body in any"),
        (json.dumps({"1": {"is_tracked": True, "body_list": 5}}), "list of bodies"),
        (json.dumps({"1": {"is_tracked": True, "timestamp": 1,
                           "body_list": [{"id": 1, "keypoint": [[0, 1, 2]] * 70}]}}),
         "bodies of 70 joints"),
        (nuitrack_csv()[0].splitlines()[0], "only a header"),
        (nuitrack_csv()[0].replace("0.95", "tall", 1), "is not a number"),
        (nuitrack_json()[0].replace('"real"', '"proj"'), "no joint that is observed"),
        (nuitrack_json()[0][:2000], "damaged or cut short"),
        (mediapipe_json(mediapipe())[:5000], "damaged or cut short"),
        (mediapipe_json(mediapipe()[:, :20]), "20 points without names, which form no body"),
        (mediapipe_json(np.full((3, 33, 4), np.nan)), "no body in any"),
        (mediapipe_csv(mediapipe()).splitlines()[0] + "\n", "header but no frames"),
    ],
)  # fmt: skip
def test_what_cannot_be_read_is_refused_in_a_sentence(read_any, text, sentence):
    with pytest.raises(InvalidFileError, match=sentence):
        read_any(text)


def test_the_made_body_is_one():
    """The left side of one who faces -Y is at +X."""
    assert STANDING["ShoulderLeft"][0] > 0.0 > walking(["Nose"])[0, 0, 1] - STANDING["Neck"][1]
