"""What every test may ask for."""

import sys
from pathlib import Path

import numpy as np
import pytest
from hypothesis import settings

from solvers.motion import Motion, Skeleton
from solvers.motion.rotations import quaternion_from_rotation_vector

pytest_plugins = ("common_fixtures",)

# The same examples every time, and no clock: a busy machine must not fail a test.
settings.register_profile("steady", deadline=None, derandomize=True, database=None)
settings.load_profile("steady")

ON_ONE_PYTHON = (
    "command_line/test_capture_verb.py", "command_line/test_reconstruct_verb.py",
    "depth_tracking/test_calibrate_body.py", "depth_tracking/test_capture.py",
    "depth_tracking/test_retrack_recordings.py", "variation/test_bad_examples.py",
    "workflows/test_capture_recording.py",
)  # fmt: skip
"""Long tests of whole takes below tests/solvers, which run on Python 3.11 alone."""


def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    long = {Path(__file__).parent / "solvers" / name for name in ON_ONE_PYTHON}
    assert all(path.exists() for path in long)
    if sys.version_info >= (3, 12):
        left_out = [item for item in items if item.path in long]
        items[:] = [item for item in items if item.path not in long]
        config.hook.pytest_deselected(items=left_out)


@pytest.fixture
def leg() -> Skeleton:
    """A hip, a knee, an ankle and an end site, hanging down from 0.9 m."""
    offsets = np.array([[0, 0, 0.9], [0, 0, -0.45], [0, 0, -0.42], [0, -0.15, -0.03]])
    return Skeleton(("hip", "knee", "ankle", "ankle_end"), (-1, 0, 1, 2), offsets)


@pytest.fixture
def swinging_leg(leg) -> Motion:
    """Two seconds at 60 Hz: the leg swings once a second and moves forward at 1 m/s."""
    time = np.arange(120) / 60.0
    vectors = np.zeros((120, 4, 3))
    vectors[:, 0, 0] = 0.5 * np.sin(2 * np.pi * time)
    vectors[:, 1, 0] = -0.4 * (1 + np.cos(2 * np.pi * time))
    vectors[:, 2, 0] = 0.2 * np.sin(2 * np.pi * time + 1)
    place = np.stack([0 * time, -time, 0.9 + 0.02 * np.cos(4 * np.pi * time)], axis=-1)
    return Motion(leg, quaternion_from_rotation_vector(vectors), place, 60.0)
