"""Hands and axial rotations do not flip when palms and thumbs are noisy."""

import numpy as np
import pytest

from solvers.reconstruction.joint_rotations.limb_twist import smooth_direction, twist_to_normal
from solvers.reconstruction.joint_rotations.motion_from_positions import motion_from_positions
from solvers.recordings import read_recording
from solvers.rotations.representations import IDENTITY, angle_between, rotate

RATE = 30.0
UP = np.tile((0.0, 0.0, 1.0), (60, 1))
ACROSS = np.tile((1.0, 0.0, 0.0), (60, 1))
STILL = np.tile(IDENTITY, (60, 1))


def directions_at(degrees: np.ndarray) -> np.ndarray:
    """Directions at these angles (degrees) from ACROSS about UP."""
    angles = np.radians(degrees)
    return np.stack([np.cos(angles), np.sin(angles), np.zeros(60)], axis=-1)


@pytest.mark.parametrize("rate", [15.0, 30.0, 120.0])
def test_axial_jump_of_almost_360_degrees_is_interpolated(rate):
    degrees = np.where(np.arange(60) < 30, -87.0, 87.0)

    rotations = twist_to_normal(STILL, UP, ACROSS, directions_at(degrees), np.ones(60), rate)

    steps = np.degrees(angle_between(rotations[1:], rotations[:-1]))
    assert steps.max() < 60.0
    shown = rotate(rotations, ACROSS)
    assert np.degrees(np.arccos(shown[0] @ directions_at(degrees)[0])) < 10.0
    assert np.degrees(np.arccos(shown[-1] @ directions_at(degrees)[-1])) < 10.0


def test_constant_twist_rate_is_followed():
    degrees = np.linspace(-60.0, 60.0, 60)

    rotations = twist_to_normal(STILL, UP, ACROSS, directions_at(degrees), np.ones(60), RATE)

    shown = rotate(rotations, ACROSS)
    cosine = np.einsum("fi,fi->f", shown, directions_at(degrees))
    assert np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))).max() < 8.0


@pytest.mark.parametrize(
    "wrong", [(0.0, 0.015, 0.0), (0.02, 0.0, -0.07)], ids=["too short", "folded back"]
)
def test_impossible_palm_is_ignored(wrong):
    observed = np.tile((0.0, 0.0, 0.08), (60, 1))
    observed[30:34] = wrong

    directions = smooth_direction(
        observed, STILL, np.array([0.0, 0.0, 0.25]), np.ones(60), RATE
    )

    assert (
        np.degrees(
            np.arccos(directions[30:34, 2] / np.linalg.norm(directions[30:34], axis=-1))
        ).max()
        < 5
    )


@pytest.mark.parametrize(
    "file", ["irds/217_18_0_3_1_wheelchair.txt", "kimore/JointPositionExercise3.csv"]
)
def test_wrists_of_real_takes_never_flip(recordings, file):
    """Tracked palms are 2 cm long and folded onto the forearm; wrists had flipped by 140
    degrees.
    """
    recording = read_recording(recordings / "kinect" / file)

    motion = motion_from_positions(recording.tracks, recording.parents)

    for name in ("WristLeft", "WristRight"):
        rotations = motion.rotations[:, motion.skeleton.index(name)]
        steps = np.degrees(angle_between(rotations[1:], rotations[:-1]))
        assert np.nanmax(steps) < 60.0, name
