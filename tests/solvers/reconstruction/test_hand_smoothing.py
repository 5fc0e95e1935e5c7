"""Hands and twists do not flip, whatever a camera makes of palm and thumb."""

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


def seen_at(degrees: np.ndarray) -> np.ndarray:
    """Ways about UP, so far from ACROSS."""
    angles = np.radians(degrees)
    return np.stack([np.cos(angles), np.sin(angles), np.zeros(60)], axis=-1)


@pytest.mark.parametrize("rate", [15.0, 30.0, 120.0])
def test_twist_jump_of_almost_a_turn_is_interpolated(rate):
    degrees = np.where(np.arange(60) < 30, -87.0, 87.0)

    turns = twist_to_normal(STILL, UP, ACROSS, seen_at(degrees), np.ones(60), rate)

    steps = np.degrees(angle_between(turns[1:], turns[:-1]))
    assert steps.max() < 60.0
    shown = rotate(turns, ACROSS)
    assert np.degrees(np.arccos(shown[0] @ seen_at(degrees)[0])) < 10.0
    assert np.degrees(np.arccos(shown[-1] @ seen_at(degrees)[-1])) < 10.0


def test_constant_twist_rate_is_followed():
    degrees = np.linspace(-60.0, 60.0, 60)

    turns = twist_to_normal(STILL, UP, ACROSS, seen_at(degrees), np.ones(60), RATE)

    shown = rotate(turns, ACROSS)
    off = np.einsum("fi,fi->f", shown, seen_at(degrees))
    assert np.degrees(np.arccos(np.clip(off, -1.0, 1.0))).max() < 8.0


@pytest.mark.parametrize(
    "wrong", [(0.0, 0.015, 0.0), (0.02, 0.0, -0.07)], ids=["too short", "folded back"]
)
def test_impossible_palm_is_ignored(wrong):
    seen = np.tile((0.0, 0.0, 0.08), (60, 1))
    seen[30:34] = wrong

    ways = smooth_direction(seen, STILL, np.array([0.0, 0.0, 0.25]), np.ones(60), RATE)

    assert (
        np.degrees(np.arccos(ways[30:34, 2] / np.linalg.norm(ways[30:34], axis=-1))).max() < 5
    )


@pytest.mark.parametrize(
    "file", ["irds/217_18_0_3_1_wheelchair.txt", "kimore/JointPositionExercise3.csv"]
)
def test_wrists_of_real_takes_never_flip(recordings, file):
    """Palms are seen 2 cm long there, folded onto the forearm; they turned by 140 degrees."""
    recording = read_recording(recordings / "kinect" / file)

    motion = motion_from_positions(recording.tracks, recording.parents)

    for name in ("WristLeft", "WristRight"):
        turns = motion.rotations[:, motion.skeleton.index(name)]
        steps = np.degrees(angle_between(turns[1:], turns[:-1]))
        assert np.nanmax(steps) < 60.0, name
