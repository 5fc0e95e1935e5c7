"""Pose after pose, a rig gets what `retarget` gives it without goals of feet and hands."""

import numpy as np
import pytest
from numpy.testing import assert_allclose
from rigs import RIGS

from solvers.motion import find_humanoid_map
from solvers.retargeting import LiveRetargeting, RetargetSettings, retarget
from solvers.samples import GaitSettings, walking_gait

SETTINGS = RetargetSettings(keep_feet=False, keep_hands=False, to_ground=True)


@pytest.mark.parametrize("family", RIGS)
def test_live_poses_are_those_of_the_motion(family):
    walk, rig = walking_gait(GaitSettings(duration=2.0, frame_rate=30.0)), RIGS[family]()
    source, target = find_humanoid_map(walk.skeleton), find_humanoid_map(rig)
    expected = retarget(walk, source, rig, target, settings=SETTINGS)
    live = LiveRetargeting(walk, source, rig, target, SETTINGS)
    poses = [live.update(walk.slice(frame, frame + 1)) for frame in range(0, 60, 10)]
    assert_allclose(
        np.concatenate([each.rotations for each in poses]), expected.rotations[::10], atol=1e-9
    )
    assert_allclose(
        np.concatenate([each.root_positions for each in poses]),
        expected.root_positions[::10],
        atol=1e-9,
    )
