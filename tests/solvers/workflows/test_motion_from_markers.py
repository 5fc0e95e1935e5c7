"""From a damaged optical take to a complete motion, in one call."""

import numpy as np
import pytest
from marked_bodies import markers_on

from solvers.errors import InvalidMotionError
from solvers.motion import Tracks, find_humanoid_map, forward_kinematics
from solvers.samples import GaitSettings, walking_gait
from solvers.workflows import MarkerMotionSettings, motion_from_markers


@pytest.fixture(scope="module")
def walk():
    return walking_gait(GaitSettings(duration=3.0, frame_rate=60.0))


@pytest.fixture(scope="module")
def corrupted(walk) -> Tracks:
    """Swapped wrists, a missing head marker, a missing arm, and points of other names."""
    take = markers_on(walk, noise=0.0005, skin=0.002)
    positions = take.positions.copy()
    index_of_name = {name: index for index, name in enumerate(take.names)}
    wrists = [index_of_name["LWRA"], index_of_name["LWRB"]]
    positions[50:90, wrists] = positions[50:90, wrists[::-1]]
    positions[20:80, index_of_name["LFHD"]] = np.nan
    for name in ("RELB", "RUPA", "RFRM", "RWRA", "RWRB", "RFIN"):
        positions[100:130, index_of_name[name]] = np.nan
    other = np.zeros((take.n_frames, 1, 3)) + 5.0
    return Tracks((*take.names, "*0"), np.concatenate([positions, other], axis=1), 60.0)


def test_motion_has_no_gaps_and_is_accurate(walk, corrupted):
    result = motion_from_markers(corrupted)

    assert result.motion.observed.all()
    (swap,) = result.swaps
    assert set(swap.names) == {"LWRA", "LWRB"} and swap.frames == range(50, 90)
    assert "*0" not in result.markers.names
    assert result.filled[20:80, result.markers.names.index("LFHD")].all()
    joints = find_humanoid_map(walk.skeleton).indices(walk.skeleton)
    theirs = forward_kinematics(walk).positions
    ours = forward_kinematics(result.motion).positions
    for part in ("leftHand", "head", "leftFoot"):
        off = ours[:, result.motion.skeleton.index(part)] - theirs[:, joints[part]]
        assert np.linalg.norm(off, axis=1).max() < 0.05, part
    hand = ours[:, result.motion.skeleton.index("rightHand")] - theirs[:, joints["rightHand"]]
    assert np.linalg.norm(hand, axis=1)[100:130].mean() < 0.08


def test_observed_samples_are_unchanged_unless_smoothed(corrupted):
    result = motion_from_markers(corrupted)
    smooth = motion_from_markers(corrupted, settings=MarkerMotionSettings(smooth=True))

    observed = result.solved.motion.observed
    assert np.array_equal(
        result.motion.rotations[observed], result.solved.motion.rotations[observed]
    )
    assert not np.array_equal(result.motion.rotations, smooth.motion.rotations)


def test_steps_can_be_disabled(corrupted):
    plain = MarkerMotionSettings(unswap=False, fill=False)

    result = motion_from_markers(corrupted, settings=plain)

    assert result.swaps == () and not result.filled.any()
    assert result.motion.observed.all()


def test_points_of_no_marker_set_are_refused(walk):
    points = Tracks(("a", "b"), np.zeros((5, 2, 3)), 60.0)

    with pytest.raises(InvalidMotionError, match="Label them first"):
        motion_from_markers(points)
