"""NumPy's files: UI-PRMD pairs and freemocap's points; headers are not believed."""

import numpy as np
import pytest
from joint_files import npy, npz, ui_prmd
from numpy.testing import assert_allclose, assert_array_equal

from solvers.errors import InvalidFileError
from solvers.motion import JointRecording, Sensor
from solvers.motion.humanoid.names import roles_by_name
from solvers.motion.skeletons.mediapipe import BODY_POINTS
from solvers.recordings import (
    FloorPlacement,
    read_as,
    read_freemocap,
    read_recording,
    read_ui_prmd,
    read_ui_prmd_pair,
)
from solvers.recordings.conventions import conventions_of

NOSE, LEFT_WRIST, RIGHT_WRIST, ANKLES = 0, 15, 16, (27, 28)
TRIPLE = [NOSE, LEFT_WRIST, RIGHT_WRIST]
LIMBS = {
    11: (0.18, 0.0, 0.42), 13: (0.35, 0.0, 0.2), LEFT_WRIST: (0.5, 0.0, 0.0),
    23: (0.1, 0.0, -0.05), 25: (0.1, 0.0, -0.48), 27: (0.1, 0.0, -0.9),
}  # fmt: skip
"""Joints of the left side and their positions, meters above 1 m; those of the right follow."""


@pytest.fixture
def write(make_writer):
    return make_writer("take.np")


def test_ui_prmd_is_a_pair_in_one_world(recordings):
    path = recordings / "kinect" / "ui_prmd" / "m01_s01_e01.npz"
    with np.load(path, allow_pickle=False) as archive:
        expected = {name: archive[name] * 0.0002 for name in ("kinect", "markers")}

    recording, markers = read_ui_prmd_pair(path)

    assert_allclose(recording.tracks.positions, expected["kinect"])
    assert_allclose(markers.positions, expected["markers"])
    assert (recording.frame_rate, markers.frame_rate) == (30.0, 30.0)
    assert recording.sensor is Sensor.KINECT_V2
    distance = recording.tracks.positions[:, 4] - markers.positions[:, :4].mean(axis=1)
    assert (
        np.linalg.norm(distance, axis=-1).mean() < 0.25
    )  # the head, and the markers around it
    assert_array_equal(read_ui_prmd(path).tracks.positions, recording.tracks.positions)


def test_every_ui_prmd_take_stands_upright_with_left_on_the_left(recordings):
    paths = sorted((recordings / "kinect" / "ui_prmd").iterdir())
    for path in paths[::12]:
        recording = read_recording(path)
        assert isinstance(recording, JointRecording)
        default = dict(
            zip(recording.names, np.nanmedian(recording.tracks.positions, axis=0), strict=True)
        )
        forward = default["LToes"] - default["LFoot"] + default["RToes"] - default["RFoot"]
        to_left = default["LUpArm"] - default["RUpArm"]
        assert default["Head"][2] > default["Waist"][2] > default["LFoot"][2], path
        assert np.cross((0, 0, 1), forward) @ to_left > 0, path


def test_the_measured_floor_of_ui_prmd_is_kept(write):
    """Put on the lowest joints, the take moves by 3 to 7 cm."""
    kinect, markers = np.ones((40, 22, 3)), np.ones((40, 39, 3))
    kinect[..., 2] = np.linspace(0.3, 1.8, 22)
    path = write(npz(kinect=kinect, markers=markers, unit_m=1.0, frame_rate=30.0))

    settled = read_as(path, floor=FloorPlacement.AUTO)

    assert_allclose(settled.tracks.positions, kinect)
    assert conventions_of(settled).has_floor


def test_ui_prmd_at_the_origin_is_not_observed(write):
    kinect, markers = np.ones((4, 22, 3), np.int16), np.ones((4, 39, 3), np.int16)
    kinect[1, 2], markers[3, 5] = 0, 0

    recording, tracks = read_ui_prmd_pair(
        write(npz(kinect=kinect, markers=markers, unit_m=0.01, frame_rate=30.0)), scale=0.5
    )

    assert np.argwhere(~recording.tracks.visible).tolist() == [[1, 2]]
    assert np.argwhere(~tracks.visible).tolist() == [[3, 5]]
    assert np.nanmax(tracks.positions) == 0.5


def pair(n_kinect: int, n_markers: int, unit: float) -> bytes:
    kinect, markers = np.ones((n_kinect, 22, 3)), np.ones((n_markers, 39, 3))
    return npz(kinect=kinect, markers=markers, unit_m=unit, frame_rate=30.0)


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (ui_prmd()[:-30], "cut short or of another kind"),
        (npz(kinect=np.zeros((3, 22, 3))), "cut short or of another kind"),
        (npz(kinect=np.zeros(3), markers=np.zeros(3), unit_m=1.0, frame_rate=1.0), "22 joints"),
        (pair(3, 2, 1.0),
         "in as many frames"),
        (pair(3, 3, 0.0),
         "a unit and a frame rate"),
        (npz(kinect=np.zeros(20_000_000, np.int8), markers=1.0, unit_m=1.0, frame_rate=1.0),
         "cut short or of another kind"),
    ],
)  # fmt: skip
def test_what_is_no_ui_prmd_take(write, content, sentence):
    with pytest.raises(InvalidFileError, match=sentence):
        read_ui_prmd(write(content))


@pytest.fixture
def person() -> np.ndarray:
    """MediaPipe's body and hands, meters, Z up, facing -Y; the wrists apart by 1 m."""
    points = np.random.default_rng(5).normal(scale=0.02, size=(20, 75, 3))
    points += (0, 0, 1)
    points[:, NOSE] += (0, -0.1, 0.65)
    for left, place in LIMBS.items():
        points[:, left] += place
        points[:, left + 1] += (-place[0], *place[1:])
    points[:, 33:54] += points[:, [RIGHT_WRIST]] - (0, 0, 1)
    points[:, 54:] += points[:, [LEFT_WRIST]] - (0, 0, 1)
    points[3, 5] = np.nan
    return points


ROTATIONS = {
    "z up": np.eye(3),
    "y up": np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0.0]]),  # x, -z, y
    "y down, as a camera sees it": np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0.0]]),
    "upside down": np.diag([1.0, -1, -1]),
    "x up": np.roll(np.eye(3), -1, axis=0),
}


@pytest.mark.parametrize("unit", [1.0, 0.001])
@pytest.mark.parametrize("axes", ROTATIONS)
def test_freemocap_comes_out_upright_in_meters(write, person, unit, axes):
    """In all axes and units that versions of freemocap had; never mirrored."""
    into_file = np.linalg.inv(ROTATIONS[axes])

    recording = read_recording(write(npy(person @ into_file.T / unit)))

    assert isinstance(recording, JointRecording)
    tracks = recording.tracks
    up = tracks.positions[:, NOSE] - tracks.positions[:, list(ANKLES)].mean(axis=1)
    assert_allclose(np.median(up, axis=0)[2], 1.55, atol=0.05)
    before, after = person[0, TRIPLE], tracks.positions[0, TRIPLE]
    assert np.linalg.det(after) * np.linalg.det(before) > 0
    assert np.isnan(tracks.positions[3, 5]).all()
    assert tracks.visible.sum() == 20 * (75 + 4) - 1


def test_freemocap_hands_are_assigned_by_the_wrists(write, person):
    swapped = person.copy()
    swapped[:, 33:54], swapped[:, 54:] = person[:, 54:], person[:, 33:54]

    right_first = read_freemocap(write(npy(person)))
    left_first = read_freemocap(write(npy(swapped)))

    assert right_first.names[:33] == BODY_POINTS
    assert (right_first.names[33], right_first.names[54]) == (
        "right_hand_wrist",
        "left_hand_wrist",
    )
    assert (left_first.names[33], left_first.names[54]) == (
        "left_hand_wrist",
        "right_hand_wrist",
    )


def test_freemocap_adds_the_joints_on_the_middle_of_the_body(write, person):
    recording = read_freemocap(write(npy(person)))
    positions = dict(
        zip(recording.names, np.moveaxis(recording.tracks.positions, 1, 0), strict=True)
    )

    hips = (positions["left_hip"] + positions["right_hip"]) / 2.0
    shoulders = (positions["left_shoulder"] + positions["right_shoulder"]) / 2.0
    assert_allclose(positions["hips_center"], hips)
    assert_allclose(positions["trunk_center"], (hips + shoulders) / 2.0)
    assert recording.sensor is Sensor.MEDIAPIPE
    assert np.isnan(positions["head_center"]).any() == np.isnan(positions["left_ear"]).any()


def test_freemocap_bodies_hang_together_and_every_limb_has_its_role(write, person):
    recording = read_freemocap(write(npy(person)))
    names = recording.names
    above = {
        name: names[parent] if parent >= 0 else ""
        for name, parent in zip(names, recording.parents, strict=True)
    }

    assert [name for name, parent in above.items() if not parent] == [
        "right_hand_wrist",
        "left_hand_wrist",
        "hips_center",
    ]
    chain = ["left_hand_index_3"]
    while chain[-1]:
        chain.append(above[chain[-1]])
    assert chain[:-1] == [
        "left_hand_index_3", "left_hand_index_2", "left_hand_index_1", "left_wrist",
        "left_elbow", "left_shoulder", "neck_center", "trunk_center", "hips_center",
    ]  # fmt: skip
    roles = roles_by_name(names)
    assert roles["hips"] == "hips_center"
    assert roles["rightUpperArm"] == "right_shoulder"
    assert roles["leftFoot"] == "left_ankle"
    assert roles["leftHand"] == "left_wrist"
    assert roles["rightIndexIntermediate"] == "right_hand_index_2"


@pytest.mark.parametrize("right_first", [True, False])
@pytest.mark.parametrize("missing", [LEFT_WRIST, RIGHT_WRIST, slice(33, 54), slice(54, 75)])
def test_freemocap_hands_are_assigned_by_observed_points(write, person, right_first, missing):
    points = person.copy()
    if not right_first:
        points[:, 33:54], points[:, 54:] = person[:, 54:], person[:, 33:54]
    points[:, missing] = np.nan

    names = read_freemocap(write(npy(points))).names

    assert names[33] == ("right_hand_wrist" if right_first else "left_hand_wrist")


@pytest.mark.parametrize(
    ("n_points", "last"), [(33, "head_center"), (553, "head_center"), (7, "point_7")]
)
def test_freemocap_names_by_the_number_of_points(write, rng, person, n_points, last):
    points = rng.normal(size=(4, n_points, 3))
    points[:, :33] = person[:4, : min(n_points, 33)]
    tracks = read_freemocap(write(npy(points)), frame_rate=24.0)

    assert tracks.names[-1] == last
    assert tracks.frame_rate == 24.0


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (npy(np.zeros((3, 5, 3)))[:-1], "damaged, cut short"),
        (npy(np.zeros((3, 5, 3))).replace(b"(3, 5, 3)", b"(9, 9, 9)"), "damaged, cut short"),
        (npy(np.zeros((3, 5, 3))).replace(b"'<f8'", b"'|O8'"), "damaged, cut short"),
        (npy(np.zeros((3, 5, 3))).replace(b"(3, 5, 3)", b"(-1,-1,3)"), "damaged, cut short"),
        (npy(np.array(["a", "b"])), "damaged, cut short"),
        (npy(np.zeros((3, 5, 2))), r"shape \(3, 5, 2\); points over time"),
        (npy(np.full((3, 5, 3), np.nan)), "no points that are observed"),
    ],
)
def test_what_are_no_points(write, content, sentence):
    with pytest.raises(InvalidFileError, match=sentence):
        read_freemocap(write(content))
