"""Reliability on real recordings: it tells wrong joints, and agrees with the device's flag."""

import numpy as np
import pytest
from scipy.stats import rankdata

from solvers.motion import JointRecording, Sensor, Tracks
from solvers.motion.joint_recording import TRACKED
from solvers.reconstruction import ReliabilityMethod, ReliabilitySettings, measure_reliability
from solvers.recordings import read_recording, read_ui_prmd_pair

PUBLISHED = ReliabilitySettings(method=ReliabilityMethod.PUBLISHED)
WITHOUT_STATE = ReliabilitySettings(inferred=1.0)
AT_JOINTS = {"LForeArm": "LELB", "RForeArm": "RELB", "LFoot": "LANK", "RFoot": "RANK"}
"""Joints on which a marker sits."""


def area_under_curve(reliability: np.ndarray, wrong: np.ndarray) -> float:
    """Chance that a wrong joint is trusted less than a right one."""
    n_wrong, n_right = wrong.sum(), (~wrong).sum()
    ranks = rankdata(-reliability)[wrong].sum() - n_wrong * (n_wrong + 1) / 2.0
    return float(ranks / (n_wrong * n_right))


def test_wrong_joints_of_a_kinect_are_doubted_more_than_as_published(recordings):
    ours, published, wrong = [], [], []
    for path in sorted((recordings / "kinect" / "ui_prmd").glob("m0[268]_s02_e0[1-4].npz")):
        recording, markers = read_ui_prmd_pair(path)
        joints = [recording.names.index(name) for name in AT_JOINTS]
        true = markers.positions[:, [markers.names.index(name) for name in AT_JOINTS.values()]]
        off = recording.tracks.positions[:, joints] - true
        error = np.linalg.norm(off - np.median(off, axis=0), axis=-1)
        wrong.append(error > 0.05)
        ours.append(measure_reliability(recording).combined[:, joints])
        published.append(measure_reliability(recording, settings=PUBLISHED).combined[:, joints])
    is_wrong = np.concatenate(wrong)

    assert 0.02 < is_wrong.mean() < 0.5
    area = area_under_curve(np.concatenate(ours).ravel(), is_wrong.ravel())
    assert area > 0.8
    assert area > 0.03 + area_under_curve(np.concatenate(published).ravel(), is_wrong.ravel())


@pytest.mark.parametrize("folder", ["irds", "kimore", "azure"])
def test_what_the_device_doubts_is_doubted_without_its_word(recordings, folder):
    found, doubted = [], []
    files = [path for path in (recordings / "kinect" / folder).iterdir() if path.is_file()]
    for path in sorted(files)[:12]:
        take = read_recording(path)
        seen = take.tracks.visible
        found.append(measure_reliability(take, settings=WITHOUT_STATE).combined[seen])
        doubted.append(take.tracking_state[seen] < TRACKED)

    assert area_under_curve(np.concatenate(found), np.concatenate(doubted)) > 0.65


@pytest.mark.parametrize(
    "folder", ["irds", "kimore", "laban", "msr_action3d", "azure", "ui_prmd"]
)
def test_every_sensor_and_skeleton_has_reliability(recordings, folder):
    files = [path for path in (recordings / "kinect" / folder).iterdir() if path.is_file()]
    take = read_recording(min(files))

    found = measure_reliability(take)

    for term in (found.combined, found.behaviour, found.kinematics, found.tracking):
        assert term.shape == (take.n_frames, take.n_joints)
        assert ((term >= 0.0) & (term <= 1.0)).all()
    assert found.combined[take.tracks.visible].mean() > 0.4
    if take.tracking_state is not None:
        assert found.combined[take.tracking_state < TRACKED].max(initial=0.0) < 0.9


def test_names_that_are_no_body_have_reliability_too():
    names = ("a", "b", "c")
    tracks = Tracks(names, np.zeros((12, 3, 3)) + np.arange(3.0)[:, None], 30.0)

    found = measure_reliability(JointRecording(tracks, None, Sensor.OTHER))

    assert found.combined.min() > 0.99
