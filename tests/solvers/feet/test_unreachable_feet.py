"""Feet that no leg can keep where they are."""

import numpy as np

from solvers.feet import plant_feet
from solvers.samples import GaitSettings, walking_gait


def test_feet_that_no_leg_can_keep_in_place_are_reported():
    """Both feet are said to stand while the body walks away."""
    walk = walking_gait(GaitSettings(duration=4.0, frame_rate=30.0))
    everywhere = np.ones((walk.n_frames, 2), dtype=np.bool_)

    planted = plant_feet(walk, everywhere)

    assert any("did not fully succeed" in remark for remark in planted.remarks)
    assert not plant_feet(walk).remarks
