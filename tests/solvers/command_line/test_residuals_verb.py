"""`learn-residuals`, and `reconstruct` with what it learned."""

import numpy as np
import pytest

from solvers.motion import SENSOR_JOINTS, JointRecording, Sensor, Tracks
from solvers.motion.humanoid.posture_joints import postures_from_motion
from solvers.reconstruction import load_residual_prior
from solvers.recordings import read_recording, write_bvh, write_joint_csv
from solvers.samples import GaitSettings, walking_gait

NAMES = SENSOR_JOINTS[Sensor.KINECT_V1]
KNEE = NAMES.index("KneeLeft")
SMALL_PRIOR = ["--local-points", "10", "--pose-points", "10", "--sample", "50"]


@pytest.fixture
def stage(tmp_path):
    """Three walks of an optical system, and of a sensor with the knees too far out."""
    (tmp_path / "kinect").mkdir()
    (tmp_path / "truth").mkdir()
    for name, speed in (("anna_1", 0.9), ("anna_2", 1.2), ("bob_1", 1.5)):
        walk = walking_gait(GaitSettings(duration=3.0, frame_rate=30.0, speed=speed))
        write_bvh(walk, tmp_path / "truth" / f"{name}.bvh")
        observed = postures_from_motion(walk)
        observed[:, KNEE, 0] += 0.08
        observed[:, NAMES.index("KneeRight"), 0] -= 0.08
        joints = JointRecording(Tracks(NAMES, observed, 30.0), None, Sensor.KINECT_V1)
        write_joint_csv(joints, tmp_path / "kinect" / f"{name}.csv")
    return tmp_path


def learn(call, stage, *more):
    return call(
        "learn-residuals", stage / "kinect", "--truth", stage / "truth",
        "--output", stage / "sensor.npz", *SMALL_PRIOR, *more,
    )  # fmt: skip


def test_sensor_errors_are_learned_and_corrected(call, stage):
    status, out, err = learn(call, stage, "--actors", "anna", "bob")
    assert (status, err) == (0, "")
    assert "3 takes of 2 actors" in out
    assert "leftLowerLeg" in load_residual_prior(stage / "sensor.npz").joints
    source, target = stage / "kinect" / "anna_2.csv", stage / "clean.csv"
    observed = read_recording(source).tracks.positions[:, KNEE, 0]
    for option, moved in (((), -0.08), (("--shift",), -0.08), (("--no-shift",), 0.0)):
        target.unlink(missing_ok=True)
        given = ["--residuals", stage / "sensor.npz", *option]
        assert call("reconstruct", source, target, *given)[0] == 0
        clean = read_recording(target).tracks.positions[:, KNEE, 0]
        assert np.mean(clean - observed) == pytest.approx(moved, abs=0.03)


def test_take_without_a_partner_is_named(call, stage):
    (stage / "truth" / "bob_1.bvh").unlink()
    status, _, err = learn(call, stage)
    assert status == 2
    assert "name it bob_1" in err


def test_an_unknown_actor_is_named(call, stage):
    status, _, err = learn(call, stage, "--actors", "anna")
    assert status == 2
    assert "bob_1 does not start with the name of an actor: anna" in err


def test_confidence_requires_actor_labels(call, stage):
    """Three takes are not three actors: each would be tested on a training actor."""
    status, _, err = learn(call, stage, "--confidence")

    assert status == 2
    assert "--confidence needs --actors" in err
    assert not (stage / "sensor.npz").exists()


def test_confidence_is_learned_from_three_actors_or_more(call, stage):
    status, _, err = learn(call, stage, "--actors", "anna", "bob", "--confidence")
    assert status == 2
    assert "needs 3; there are 2" in err

    status, _, err = learn(call, stage, "--actors", "anna_1", "anna_2", "bob", "--confidence")

    assert (status, err) == (0, "")
    calibration = load_residual_prior(stage / "sensor.npz").calibration
    assert (calibration[:, 2] > 0.0).all()
