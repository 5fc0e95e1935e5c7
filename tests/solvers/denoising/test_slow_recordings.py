"""Recordings of few frames a second."""

from numpy.testing import assert_array_equal

from solvers.denoising import denoise
from solvers.motion import Motion
from solvers.samples import GaitSettings, walking_gait


def test_report_says_that_the_poses_of_few_keys_stay():
    walk = walking_gait(GaitSettings(duration=20.0, frame_rate=10.0))
    keys = Motion(walk.skeleton, walk.rotations[::5], walk.root_positions[::5], 2.0)

    slow, fast = denoise(keys), denoise(walk)

    assert "At 2.0 frames a second, keys are poses" in slow.prior_used
    assert "keys are poses" not in fast.prior_used
    assert isinstance(slow.recording, Motion)
    assert_array_equal(slow.recording.rotations, keys.rotations)
