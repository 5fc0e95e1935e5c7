"""Frames without a person have no residual; the stored report stays valid JSON."""

import json

import numpy as np
import pytest


def strict(text):
    """Read JSON, in which there is no NaN."""
    return json.loads(text, parse_constant=lambda name: pytest.fail(f"{name} is no JSON"))


def test_track_omits_an_unknown_residual(write_tracked):
    made = write_tracked(residual=np.nan)
    assert (
        "20 frames" in made.message and "nan" not in made.message and " cm" not in made.message
    )
    assert strict(made.source[0]["mocap_assist_captured"])["mean_residual_cm"] is None


def test_track_reports_the_mean_of_known_residuals(write_tracked):
    residual = np.where(np.arange(20) % 2, np.nan, 0.03)
    made = write_tracked(residual=residual)
    assert "3.0 cm" in made.message
    report = strict(made.source[0]["mocap_assist_captured"])
    assert report["mean_residual_cm"] == pytest.approx(3.0)


def test_track_from_here_writes_known_residuals(write_tracked, read_take, load, blank):
    made = write_tracked()
    solvers, retracking = load("solvers.depth_tracking"), load("mocap_assist.track.retracking")
    take = read_take(made)
    joints = load("solvers.motion").Tracks(("hips",), np.zeros((3, 1, 3)), 30.0)
    result = solvers.Retracked(take.motion, 5, 4, 6, (True, True), joints, np.full(3, np.nan))
    settings = retracking.RetrackBundle(solvers.RetrackSettings())
    scene = blank.context.scene
    retracking.write_retracked(scene, made.armature, settings, result)
    (entry,) = strict(made.armature.animation_data.action["mocap_assist_history"])
    assert entry["mean_residual_cm"] is None and entry["first_picture"] == 4
