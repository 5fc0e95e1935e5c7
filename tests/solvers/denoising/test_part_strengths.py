"""Each part of the body can have a strength of its own."""

import numpy as np
import pytest

from solvers.denoising import DenoiseSettings, denoise
from solvers.errors import InvalidMotionError
from solvers.motion import Tracks, joint_parts
from solvers.samples import CorruptionSettings, GaitSettings, corrupt, walking_gait

NOISE = CorruptionSettings(jitter=3.0)


def test_part_of_strength_zero_keeps_its_samples_and_no_other_part_changes():
    noisy = corrupt(walking_gait(GaitSettings(duration=2.0, frame_rate=30.0)), NOISE)
    noisy.rotations[30:40, noisy.skeleton.names.index("LeftForeArm")] = np.nan
    arms = np.array([part == "arms" for part in joint_parts(noisy.skeleton)])
    observed = np.isfinite(noisy.rotations[:, arms])

    cleaned = denoise(noisy, settings=DenoiseSettings(strength_arms=0.0)).recording

    all_cleaned = denoise(noisy).recording
    assert np.array_equal(
        cleaned.rotations[:, arms][observed], noisy.rotations[:, arms][observed]
    )
    assert cleaned.observed.all()
    assert np.array_equal(cleaned.rotations[:, ~arms], all_cleaned.rotations[:, ~arms])
    assert np.array_equal(cleaned.root_positions, all_cleaned.root_positions)


def test_points_have_no_body_parts():
    points = Tracks(("a",), np.zeros((60, 1, 3)), 30.0)

    with pytest.raises(InvalidMotionError, match="Points have no body parts"):
        denoise(points, settings=DenoiseSettings(strength_legs=0.5))
