"""Takes with no, or almost no, observed samples, and with very many points."""

import numpy as np
import pytest

from solvers.denoising import denoise, learn_filter_bases
from solvers.denoising.quality import bone_drift, measure_quality
from solvers.errors import InvalidMotionError
from solvers.motion import Tracks
from solvers.samples import GaitSettings, walking_gait


def test_nothing_observed_is_refused(swinging_leg):
    blind = swinging_leg.with_poses(swinging_leg.rotations * np.nan)
    tracks = Tracks(("a", "b"), np.full((60, 2, 3), np.nan), 60.0)

    for recording in (blind, tracks):
        with pytest.raises(InvalidMotionError, match="Nothing was observed"):
            denoise(recording)


def test_examples_without_movement_are_refused():
    """A complete body: so many channels without movement once stopped the eigenvalue solver."""
    walk = walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))
    blind = walk.with_poses(walk.rotations * np.nan, walk.root_positions * np.nan)
    frozen = walk.with_poses(
        np.repeat(walk.rotations[:1], 30, axis=0),
        np.repeat(walk.root_positions[:1], 30, axis=0),
    )
    unobserved = Tracks(("a", "b"), np.full((60, 2, 3), np.nan), 60.0)

    for example in (blind, frozen, unobserved):
        with pytest.raises(InvalidMotionError, match="moves; choose clips with movement"):
            learn_filter_bases([example])
    with pytest.raises(InvalidMotionError, match="No example is as long as the window"):
        learn_filter_bases([walk.slice(0, 1)])


def test_bones_of_very_many_points_are_not_searched(rng, monkeypatch):
    tested = []
    monkeypatch.setattr(bone_drift, "_cost", lambda lengths: tested.append(1) or (1.0, True))
    for n_points in (bone_drift.MAX_POINTS, bone_drift.MAX_POINTS + 1):
        names = tuple(f"M{number}" for number in range(n_points))
        found = bone_drift.measure_bone_drifts(
            Tracks(names, rng.normal(size=(2, n_points, 3)), 30.0)
        )

        assert len(found) == (n_points - 1 if n_points <= bone_drift.MAX_POINTS else 0)
    assert len(tested) == 300 * 299 // 2


@pytest.mark.parametrize("n_points", [3, 4])
def test_check_reports_that_bones_are_not_searched(rng, monkeypatch, n_points):
    monkeypatch.setattr(bone_drift, "MAX_POINTS", 3)
    names = tuple(f"M{number}" for number in range(n_points))
    quality = measure_quality(Tracks(names, rng.normal(size=(60, n_points, 3)), 30.0))

    searched = n_points == 3
    assert quality.figures()["bones_searched"] is searched
    assert ("Bones are not searched among more than" in quality.report()) is not searched
