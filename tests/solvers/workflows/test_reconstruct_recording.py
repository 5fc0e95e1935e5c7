"""From a recording of joints to a motion: any tracker, and one sentence for bad input."""

from dataclasses import replace

import numpy as np
import pytest
from kinect_walks import tracked_walk, true_positions

from solvers import motion as vocabulary
from solvers import samples
from solvers.denoising import PlantSettings
from solvers.errors import InvalidMotionError
from solvers.motion import (
    SENSOR_JOINTS,
    FileConventions,
    JointRecording,
    Sensor,
    Tracks,
    forward_kinematics,
    motion_from_points,
)
from solvers.motion.humanoid import posture_joints
from solvers.reconstruction import ReconstructSettings
from solvers.recordings import read_recording
from solvers.recordings.conventions import floor_level, put_on_floor
from solvers.workflows import reconstruct_motion, reconstruct_recording

NITE = {  # fifteen joints, as OpenNI's tracker names them, and the first Kinect's name of each
    "head": "Head", "neck": "ShoulderCenter", "torso": "Spine",
    "left_shoulder": "ShoulderLeft", "left_elbow": "ElbowLeft", "left_hand": "WristLeft",
    "right_shoulder": "ShoulderRight", "right_elbow": "ElbowRight",
    "right_hand": "WristRight", "left_hip": "HipLeft", "left_knee": "KneeLeft",
    "left_foot": "AnkleLeft", "right_hip": "HipRight", "right_knee": "KneeRight",
    "right_foot": "AnkleRight",
}  # fmt: skip


@pytest.fixture(scope="module")
def truth() -> np.ndarray:
    return true_positions(samples, posture_joints)


@pytest.fixture
def walk(truth) -> JointRecording:
    return tracked_walk(vocabulary, truth)


def test_all_joints_are_filled_and_bone_lengths_are_constant(walk):
    result = reconstruct_recording(walk)

    assert result.motion.observed.all()
    assert result.motion.n_frames == walk.n_frames
    assert result.remarks == ()


@pytest.mark.parametrize("sensor", [Sensor.KINECT_V1, Sensor.KINECT_V2])
def test_a_take_that_was_put_on_the_floor_stays_there(walk, sensor):
    """Otherwise corrected feet are up to 8 cm below: trackers place ankles too high."""
    no_floor = replace(walk.tracks, conventions=FileConventions(has_floor=False))
    placed = put_on_floor(replace(walk, sensor=sensor, tracks=no_floor))
    moved = placed.tracks.with_positions(placed.tracks.positions - (0.0, 0.0, 1.0))
    armature = motion_from_points(placed.tracks, placed.parents)

    result = reconstruct_recording(placed, planting=None).motion
    rebuilt = reconstruct_motion(armature, source=placed, sensor=sensor, resize=True).motion
    in_sensor_space = reconstruct_recording(placed.with_tracks(moved), planting=None).motion
    measured = reconstruct_motion(armature, sensor=sensor, resize=True).motion

    assert floor_level(result) == pytest.approx(0.0, abs=0.001)
    assert floor_level(rebuilt) == pytest.approx(0.0, abs=0.001)
    assert floor_level(in_sensor_space) < -0.9
    assert sensor is Sensor.KINECT_V1 or abs(floor_level(measured)) > 0.005


def test_standing_feet_do_not_slide(walk):
    result = reconstruct_recording(walk)

    assert result.planted.slide_after < 0.1 * result.planted.slide_before


def test_feet_are_not_planted_on_request(walk):
    result = reconstruct_recording(walk, planting=None)

    assert result.planted is None
    assert result.motion is result.reconstruction.motion


def test_body_without_legs_reports_that_feet_are_not_planted(truth):
    upper = [name for name in SENSOR_JOINTS[Sensor.KINECT_V1]
             if not name.startswith(("Knee", "Ankle", "Foot"))]  # fmt: skip
    indices = [SENSOR_JOINTS[Sensor.KINECT_V1].index(name) for name in upper]
    recording = JointRecording(
        Tracks(tuple(upper), truth[:, indices], 30.0), None, Sensor.OTHER
    )

    result = reconstruct_recording(recording, planting=PlantSettings())

    assert len(result.remarks) == 1 and result.remarks[0].startswith("Feet were not planted")


def test_fifteen_joints_of_another_tracker_are_reconstructed(truth):
    indices = [SENSOR_JOINTS[Sensor.KINECT_V1].index(name) for name in NITE.values()]
    recording = JointRecording(Tracks(tuple(NITE), truth[:, indices], 30.0), None, Sensor.OTHER)

    result = reconstruct_recording(recording, planting=None)

    shown = result.motion.skeleton
    wrist = forward_kinematics(result.motion).positions[:, shown.index("WristLeft")]
    true = truth[:, SENSOR_JOINTS[Sensor.KINECT_V1].index("WristLeft")]
    assert np.linalg.norm(wrist - true, axis=-1).mean() < 0.05


@pytest.mark.parametrize(
    "file",
    ["azure/joints_sync_1.csv", "irds/215_18_5_8_1_stand.txt", "laban/Ges01_wavehand.csv"],
)
def test_trackers_with_25_and_32_joints_are_reconstructed(recordings, file):
    recording = read_recording(recordings / "kinect" / file)

    result = reconstruct_recording(recording)

    assert result.motion.observed.all()
    assert set(recording.names) <= set(result.motion.skeleton.names)


def as_recording(
    positions: np.ndarray, names=SENSOR_JOINTS[Sensor.KINECT_V1]
) -> JointRecording:
    return JointRecording(Tracks(names, positions, 30.0), None, Sensor.OTHER)


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        (lambda p: np.full_like(p, np.nan), "No joint is tracked in any of the 90 frames"),
        (
            lambda p: np.where(np.arange(20)[:, None] == 3, p, np.nan),
            r"Only one joint \(Head\)",
        ),
        (lambda p: 1000.0 * p, "millimeters were read as meters.*scale of 0.001"),
        (lambda p: 100.0 * p, "centimeters were read as meters.*scale of 0.01"),
        (lambda p: 0.001 * p, "scale of 1000"),
        (np.zeros_like, "All joints have the same position"),
    ],
    ids=["nothing", "one joint", "millimeters", "centimeters", "kilometers", "zeros"],
)
def test_invalid_recordings_are_reported_in_one_sentence(truth, spoil, message):
    with pytest.raises(InvalidMotionError, match=message):
        reconstruct_recording(as_recording(spoil(truth)))


@pytest.mark.parametrize(
    ("state", "settings", "message"),
    [
        (0, ReconstructSettings(), "the tracking state `tracked`, although positions"),
        (1, ReconstructSettings(inferred=0.0), "infers the others. Raise Inferred Weight"),
    ],
)
def test_recordings_of_untracked_joints_are_refused(truth, state, settings, message):
    tracks = as_recording(truth).tracks
    recording = JointRecording(tracks, np.full(truth.shape[:2], state, np.int8), Sensor.OTHER)

    with pytest.raises(InvalidMotionError, match=message):
        reconstruct_recording(recording, settings=settings)


def test_recording_of_a_spine_only_is_refused(truth):
    columns = [SENSOR_JOINTS[Sensor.KINECT_V1].index(name) for name in ("HipCenter", "Spine")]
    recording = as_recording(truth[:, columns], ("SpineBase", "SpineMid"))

    with pytest.raises(InvalidMotionError, match=r"Only 2 joints .* \(hips, spine\)"):
        reconstruct_recording(recording)


def test_unrecognized_joint_names_are_reported(truth):
    names = tuple(f"marker{number}" for number in range(20))

    with pytest.raises(InvalidMotionError, match=r"No body was recognized .* \(marker0"):
        reconstruct_recording(as_recording(truth, names))


def test_small_and_tall_bodies_are_accepted(truth):
    for size in (0.5, 1.3):
        assert reconstruct_recording(as_recording(size * truth)).motion.observed.all()


def test_gap_in_time_stamps_is_estimated_and_reported(walk, tmp_path):
    """The recording stops for three seconds; the file's own times say so."""
    path = tmp_path / "jump.csv"
    head = "mocap-assist-joints,1,units=m,up=z"
    columns = ",".join(f"{name}.{axis}" for name in walk.names for axis in "xyz")
    rows = [
        ",".join(map(str, [frame / 30.0 + 3.0 * (frame >= 45), *indices.ravel()]))
        for frame, indices in enumerate(walk.tracks.positions)
    ]
    path.write_text("\n".join([head, f"time,{columns}", *rows]))

    result = reconstruct_recording(read_recording(path), planting=None)

    assert result.motion.n_frames == pytest.approx(180, abs=2)
    assert result.motion.observed.all()
    assert "Nothing was tracked for 3.0 s from 1.5 s on" in result.remarks[0]


def test_two_frames_are_reconstructed(truth):
    assert reconstruct_recording(as_recording(truth[:2])).motion.n_frames == 2
    assert reconstruct_recording(as_recording(truth[:1])).motion.n_frames == 1


def test_motion_of_a_tracker_armature_is_reconstructed_on_its_skeleton(walk):
    motion = motion_from_points(walk.tracks, walk.parents)
    order = [walk.names.index(name) for name in motion.skeleton.names]

    result = reconstruct_motion(motion, tracking_state=walk.tracking_state[:, order])

    assert result.motion.skeleton is motion.skeleton
    assert result.motion.observed.all()
    wrist = motion.skeleton.index("WristLeft")
    assert result.reliability[45, wrist] < 0.3 < result.reliability[10, wrist]


def test_motion_of_another_rig_is_reconstructed():
    walk = samples.walking_gait(samples.GaitSettings(duration=1.0, frame_rate=30.0))

    result = reconstruct_motion(walk)

    assert result.motion.skeleton is walk.skeleton
    is_known = np.isfinite(result.reliability).all(axis=0)
    assert 15 <= is_known.sum() < walk.n_joints or is_known.all()


def test_hips_never_tracked_are_between_the_legs(recordings):
    recording = read_recording(recordings / "kinect" / "irds" / "215_18_5_3_1_stand.txt")
    hips, *legs = (recording.names.index(each) for each in ("SpineBase", "HipLeft", "HipRight"))
    untracked = recording.tracks.positions.copy()
    untracked[:, hips] = np.nan
    blind_recording = recording.with_tracks(recording.tracks.with_positions(untracked))

    found = reconstruct_recording(
        blind_recording, planting=None, settings=ReconstructSettings(shift=False)
    ).reconstruction.tracks.positions

    true = recording.tracks.positions[:, hips]
    assert np.nanmax(np.linalg.norm(found[:, hips] - true, axis=-1)) < 0.06
    assert np.linalg.norm(found[:, hips] - found[:, legs].mean(axis=1), axis=-1).max() < 0.06
    assert np.isnan(blind_recording.tracks.positions[:, hips]).all()


def test_offset_of_a_known_sensor_is_corrected_by_default_and_reported(recordings):
    recording = read_recording(recordings / "kinect" / "irds" / "215_18_5_3_1_stand.txt")

    def moved_cm(result):
        moved = result.reconstruction.tracks.positions - recording.tracks.positions
        return 100.0 * np.linalg.norm(np.nanmean(moved, axis=0), axis=-1)

    default = reconstruct_recording(recording, planting=None)
    kept = reconstruct_recording(
        recording, planting=None, settings=ReconstructSettings(shift=False)
    )

    hips = recording.names.index("SpineBase")
    assert moved_cm(default)[hips] > 4.0 > 1.0 > moved_cm(kept)[hips]
    assert any("Reconstruct without Sensor Offset keeps them" in one for one in default.remarks)
    assert not any("Sensor Offset" in one for one in kept.remarks)
    assert abs(default.rebuilt.mean() - kept.rebuilt.mean()) < 0.05  # hand tips alone


def test_offsets_are_not_corrected_for_an_unknown_sensor(walk):
    result = reconstruct_recording(walk, planting=None)

    assert result.reconstruction.shift is None
    assert not any("Sensor Offset" in one for one in result.remarks)


def test_motion_without_its_file_is_corrected_for_the_sensor_it_came_from(recordings):
    recording = read_recording(recordings / "kinect" / "irds" / "215_18_5_3_1_stand.txt")
    motion = motion_from_points(recording.tracks, recording.parents)

    known = reconstruct_motion(motion, sensor=recording.sensor)
    unknown = reconstruct_motion(motion)

    assert any("Sensor Offset" in one for one in known.remarks)
    assert unknown.remarks == ()


def test_recording_without_tracked_joints_is_refused(truth):
    tracks = Tracks(SENSOR_JOINTS[Sensor.KINECT_V1], truth, 30.0)
    untracked = JointRecording(tracks, np.zeros(truth.shape[:2], np.int8), Sensor.KINECT_V1)

    with pytest.raises(InvalidMotionError, match="the tracking state `tracked`"):
        reconstruct_recording(untracked)
