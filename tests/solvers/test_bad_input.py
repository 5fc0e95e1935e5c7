"""Takes of which nothing, or nearly nothing, was seen."""

import numpy as np
import pytest

from solvers.denoising import denoise
from solvers.errors import InvalidMotionError
from solvers.motion import Tracks


def test_nothing_observed_is_refused(swinging_leg):
    blind = swinging_leg.with_poses(swinging_leg.rotations * np.nan)
    tracks = Tracks(("a", "b"), np.full((60, 2, 3), np.nan), 60.0)

    for recording in (blind, tracks):
        with pytest.raises(InvalidMotionError, match="Nothing was observed"):
            denoise(recording)
