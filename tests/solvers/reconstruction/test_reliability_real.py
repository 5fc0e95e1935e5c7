"""Reliability on real recordings detects wrong joints and agrees with the device's states."""

import numpy as np
import pytest
from scipy.stats import rankdata

from solvers.motion import JointRecording, Sensor, Tracks
from solvers.motion.skeletons.joint_recording import TRACKED
from solvers.reconstruction import ReliabilityMethod, ReliabilitySettings, measure_reliability
from solvers.recordings import read_recording, read_ui_prmd_pair

PUBLISHED = ReliabilitySettings(method=ReliabilityMethod.PUBLISHED)
WITHOUT_STATE = ReliabilitySettings(inferred=1.0)
AT_JOINTS = {"LForeArm": "LELB", "RForeArm": "RELB", "LFoot": "LANK", "RFoot": "RANK"}
"""Joints on which a marker sits."""


def area_under_curve(reliability: np.ndarray, wrong: np.ndarray) -> float:
    """Probability that a wrong joint has a lower reliability than a correct one."""
    n_wrong, n_right = wrong.sum(), (~wrong).sum()
    ranks = rankdata(-reliability)[wrong].sum() - n_wrong * (n_wrong + 1) / 2.0
    return float(ranks / (n_wrong * n_right))


def test_wrong_kinect_joints_are_less_reliable_than_as_published(recordings):
    result, published, wrong = [], [], []
    for path in sorted((recordings / "kinect" / "ui_prmd").glob("m0[268]_s02_e0[1-4].npz")):
        recording, markers = read_ui_prmd_pair(path)
        joints = [recording.names.index(name) for name in AT_JOINTS]
        true = markers.positions[:, [markers.names.index(name) for name in AT_JOINTS.values()]]
        differences = recording.tracks.positions[:, joints] - true
        error = np.linalg.norm(differences - np.median(differences, axis=0), axis=-1)
        wrong.append(error > 0.05)
        result.append(measure_reliability(recording).combined[:, joints])
        published.append(measure_reliability(recording, settings=PUBLISHED).combined[:, joints])
    is_wrong = np.concatenate(wrong)

    assert 0.02 < is_wrong.mean() < 0.5
    area = area_under_curve(np.concatenate(result).ravel(), is_wrong.ravel())
    assert area > 0.8
    assert area > 0.03 + area_under_curve(np.concatenate(published).ravel(), is_wrong.ravel())


@pytest.mark.parametrize("folder", ["irds", "kimore", "azure"])
def test_inferred_joints_are_less_reliable_without_states(recordings, folder):
    found, uncertain = [], []
    files = [path for path in (recordings / "kinect" / folder).iterdir() if path.is_file()]
    for path in sorted(files)[:12]:
        take = read_recording(path)
        observed = take.tracks.visible
        found.append(measure_reliability(take, settings=WITHOUT_STATE).combined[observed])
        uncertain.append(take.tracking_state[observed] < TRACKED)

    assert area_under_curve(np.concatenate(found), np.concatenate(uncertain)) > 0.65


@pytest.mark.parametrize(
    ("folder", "minimum"),
    [("irds", 0.8), ("kimore", 0.8), ("laban", 0.8), ("msr_action3d", 0.7), ("azure", 0.8),
     ("ui_prmd", 0.8)],
)  # fmt: skip
def test_every_sensor_is_reliable_until_joints_vibrate(recordings, folder, minimum):
    """By error indicators only, without the tracker's states."""
    files = [path for path in (recordings / "kinect" / folder).iterdir() if path.is_file()]
    recording = read_recording(min(files))
    tracks = Tracks(recording.names, recording.tracks.positions, recording.frame_rate)
    take = JointRecording(tracks, None, recording.sensor)
    shaken = tracks.positions + np.random.default_rng(1).normal(
        scale=0.1, size=tracks.positions.shape
    )

    sound = measure_reliability(take)
    corrupted = measure_reliability(take.with_tracks(tracks.with_positions(shaken)))

    observed = tracks.visible
    for term in (sound.combined, sound.behavior, sound.kinematics, sound.tracking):
        assert term.shape == (take.n_frames, take.n_joints)
        assert ((term >= 0.0) & (term <= 1.0)).all()
    assert sound.combined[observed].mean() > minimum
    assert (sound.combined[observed] < 0.5).mean() < 0.1
    assert (corrupted.combined[observed] < 0.5).mean() > 0.95


@pytest.mark.parametrize("folder", ["irds", "kimore", "azure"])
def test_joint_missing_for_long_has_no_reliability(recordings, folder):
    """The window mean is 0 where all of it was inferred."""
    for path in sorted((recordings / "kinect" / folder).iterdir())[:12]:
        take = read_recording(path)
        guessed = take.tracking_state < TRACKED
        window = round(0.1 * take.frame_rate)
        padded = np.pad(guessed, ((window, window), (0, 0)), mode="edge")
        windows = np.lib.stride_tricks.sliding_window_view(padded, 2 * window + 1, axis=0)
        found = measure_reliability(take).combined[windows.all(axis=-1)]
        assert found.max(initial=0.0) < 1e-9


def test_ankles_at_24_meters_per_second_are_unreliable(recordings):
    path = recordings / "kinect" / "msr_action3d" / "a13_s01_e02_skeleton3D.txt"
    take = read_recording(path)
    steps = np.diff(take.tracks.positions, axis=0)
    speeds = take.frame_rate * np.linalg.norm(steps, axis=-1)
    assert take.frame_rate == 15.0
    assert speeds.max() > 24.0

    reliability = measure_reliability(JointRecording(take.tracks, None, take.sensor)).combined
    signs = measure_reliability(take, settings=WITHOUT_STATE).combined

    assert reliability[1:][speeds > 10.0].max() < 0.2
    assert signs[1:][speeds > 10.0].max() < 0.2


def test_confidence_of_a_tracker_without_states_is_used(recordings):
    uncertain, certain = [], []
    for path in sorted((recordings / "kinect" / "msr_action3d").iterdir())[::40]:
        take = read_recording(path)
        found, confidence = measure_reliability(take).combined, take.tracks.confidence
        uncertain.append(found[confidence < 0.05])
        certain.append(found[confidence == 1.0])

    assert np.concatenate(uncertain).mean() < 0.4
    assert np.concatenate(certain).mean() > 0.6


def test_names_without_a_body_have_a_reliability():
    names = ("a", "b", "c")
    tracks = Tracks(names, np.zeros((12, 3, 3)) + np.arange(3.0)[:, None], 30.0)

    found = measure_reliability(JointRecording(tracks, None, Sensor.OTHER))

    assert found.combined.min() > 0.99
