"""Feet are planted by reliable joints: missing toes do not move resting ankles."""

import numpy as np
import pytest
from kinect_walks import true_positions

from solvers import samples
from solvers.denoising import PlantSettings
from solvers.motion import (
    SENSOR_JOINTS,
    Motion,
    Sensor,
    Tracks,
    forward_kinematics,
    joint_parents,
)
from solvers.motion.humanoid import posture_joints
from solvers.reconstruction.joint_rotations.motion_from_positions import motion_from_positions
from solvers.recordings import read_recording
from solvers.workflows import plant_feet_if_possible, reconstruct_recording

NAMES = SENSOR_JOINTS[Sensor.KINECT_V1]
PLANTING = PlantSettings()
STANDING = np.ones((60, 2), bool)


def positions_of(motion: Motion, name: str) -> np.ndarray:
    return forward_kinematics(motion).positions[:, motion.skeleton.index(name)]


def reliability_of(motion: Motion, name: str, terms: float) -> np.ndarray:
    """All joints are reliable except one."""
    reliability = np.ones((motion.n_frames, motion.n_joints))
    reliability[:, motion.skeleton.index(name)] = terms
    return reliability


def standing(toe: np.ndarray) -> Motion:
    """A body that stands for 2 s, with its left toe at these positions about the ankle."""
    still = np.repeat(true_positions(samples, posture_joints)[:1], 60, axis=0)
    for side, across in (("Left", 0.1), ("Right", -0.1)):
        for part, height in (("Hip", 0.92), ("Knee", 0.5), ("Ankle", 0.08)):
            still[:, NAMES.index(part + side)] = (across, -0.01 * (part == "Knee"), height)
        still[:, NAMES.index(f"Foot{side}")] = (across, -0.14, 0.02)
    still[:, NAMES.index("HipCenter")] = (0.0, 0.0, 0.95)
    still[:, NAMES.index("FootLeft")] = still[:, NAMES.index("AnkleLeft")] + toe
    return motion_from_positions(Tracks(NAMES, still, 30.0), joint_parents(NAMES))


def wandering() -> Motion:
    """The toe goes round the ankle by 140 degrees, forth and back."""
    angles = np.radians(70.0) * np.sin(np.linspace(0.0, 2.0 * np.pi, 60))
    return standing(
        np.stack([0.15 * np.sin(angles), -0.15 * np.cos(angles), np.full(60, -0.06)], axis=-1)
    )


def test_resting_ankle_stays_when_its_toe_is_missing():
    motion = wandering()

    planted = plant_feet_if_possible(
        motion, PLANTING, STANDING, reliability=reliability_of(motion, "FootLeft", 0.0)
    )

    moved = positions_of(planted.motion, "AnkleLeft") - positions_of(motion, "AnkleLeft")
    assert np.linalg.norm(moved, axis=-1).max() < 0.01
    toe = positions_of(planted.motion, "FootLeft") - positions_of(planted.motion, "AnkleLeft")
    assert np.abs(np.degrees(np.arctan2(toe[:, 0], -toe[:, 1]))).max() < 30.0


@pytest.mark.parametrize("take", ["216_18_7_5_1_stand", "216_18_1_1_1_stand"])
def test_reliable_ankle_is_planted_near_its_rest_position(recordings, take):
    """A contact lasted while the foot shifted; planting moved still ankles by 12 cm."""
    recording = read_recording(recordings / "kinect" / "irds" / f"{take}.txt")

    found = reconstruct_recording(recording)

    before, terms = found.reconstruction.motion, found.reconstruction.reliability.combined
    for name in ("AnkleLeft", "AnkleRight"):
        before_positions = positions_of(before, name)
        around = np.lib.stride_tricks.sliding_window_view(before_positions, 15, axis=0)
        still = np.linalg.norm(np.ptp(around, axis=-1), axis=-1) < 0.02
        sure = still & (terms[7:-7, recording.names.index(name)] > 0.6)
        moved = np.linalg.norm(positions_of(found.motion, name) - before_positions, axis=-1)[
            7:-7
        ]
        assert moved[sure].max(initial=0.0) < 0.05, name


@pytest.mark.parametrize("toe_reliability", [0.0, 1.0])
def test_toe_that_points_up_is_flattened(toe_reliability):
    motion = standing(np.array([0.0, -0.1, 0.1]))

    reliability = reliability_of(motion, "FootLeft", toe_reliability)
    planted = plant_feet_if_possible(motion, PLANTING, STANDING, reliability=reliability).motion

    toe = positions_of(planted, "FootLeft") - positions_of(planted, "AnkleLeft")
    assert (toe[:, 2] < -0.02).all()
    assert (toe[:, 1] < -0.08).all()
    before_positions, shown = (
        np.linalg.norm(
            positions_of(each, "FootLeft") - positions_of(each, "AnkleLeft"), axis=-1
        )
        for each in (motion, planted)
    )
    np.testing.assert_allclose(shown, before_positions, atol=1e-9)


def test_reliable_feet_are_planted_as_without_reliability():
    body = samples.walking_gait(samples.GaitSettings(duration=3.0, frame_rate=30.0))

    plain = plant_feet_if_possible(body, PLANTING)
    reliable = plant_feet_if_possible(
        body, PLANTING, reliability=np.ones((body.n_frames, body.n_joints))
    )

    off = np.abs(
        forward_kinematics(plain.motion).positions
        - forward_kinematics(reliable.motion).positions
    )
    assert off.max() < 0.02
    assert reliable.planted.slide_after < 0.2 * reliable.planted.slide_before


@pytest.mark.parametrize("number", [1, 2, 3])
def test_feet_of_real_takes_stand_flat_where_their_ankles_are(recordings, number):
    """Planting moved reliable ankles by up to 15 cm, and toes pointed up in 63 % of take 2."""
    path = recordings / "kinect" / "kimore" / f"JointPositionExercise{number}.csv"
    recording = read_recording(path).slice(0, 300)

    found = reconstruct_recording(recording)

    before = found.reconstruction.motion
    for side, name in enumerate(("Left", "Right")):
        contact = found.planted.contacts[:, side]
        ankle, toe = (positions_of(found.motion, f"{part}{name}") for part in ("Ankle", "Foot"))
        assert (toe > ankle)[contact, 2].mean() < 0.1
        moved = np.linalg.norm(ankle - positions_of(before, f"Ankle{name}"), axis=-1)
        assert np.percentile(moved, 95) < 0.06
