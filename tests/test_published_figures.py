"""Figures of the papers that benchmarks reproduce: what is measured there."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.motion import JointRecording, Sensor, Tracks
from solvers.motion.humanoid.posture_joints import N_JOINTS, POSTURE_JOINTS
from solvers.reconstruction.published.residual_reconstruction import minimize_terms

from .benchmarks.depth.depth_sequences import JOINTS
from .benchmarks.depth.depth_takes import ACTIONS
from .benchmarks.depth.published.part_edges import COMPONENTS, OCCLUDED
from .benchmarks.depth.published.part_registration import WITHOUT, reference_poses
from .benchmarks.reconstruction.part_figures import CENTIMETERS, METERS, SEARCH, SWEEPS


@pytest.mark.parametrize(("settings", "unit"), [(CENTIMETERS, 100.0), (METERS, 1.0)])
def test_weights_of_zhou_are_per_square_unit(rng, settings, unit):
    """Eq. 5.6 in that unit: a frame whose energy is differentiated by hand."""
    observed = rng.normal(size=(3, N_JOINTS, 3))
    recording = JointRecording(Tracks(POSTURE_JOINTS, observed, 30.0), None, Sensor.KINECT_V1)
    predicted = observed + 0.03 * rng.normal(size=observed.shape)
    variances = rng.uniform(1e-4, 1e-2, size=observed.shape[:2])
    reliability = rng.uniform(size=observed.shape[:2])

    found = minimize_terms(recording, predicted, variances, reliability, settings)

    x = unit * found[2]
    pull = 0.6 / (unit**2 * variances[2])[:, None] * (x - unit * predicted[2])
    line = unit * (2.0 * found[1] - found[0])
    stay = 2.0 * 0.2 * reliability[2][:, None] ** 2 * (x - unit * observed[2])
    assert_allclose(pull + stay + 2.0 * 0.2 * (x - line), 0.0, atol=1e-6 * unit)


def test_published_settings_are_among_those_that_are_swept():
    assert all(SEARCH[name] in values for name, values in SWEEPS.items())
    assert set(OCCLUDED) <= set(ACTIONS)
    assert WITHOUT["all terms"] == {} and not any(COMPONENTS["depth"])


def test_reference_pose_shows_all_of_a_body_that_faces_the_camera():
    one, depth = next(reference_poses())
    joints = dict(zip(JOINTS, one.joints[0], strict=True))
    rows, columns = np.nonzero(depth.frame(0))
    assert rows.min() > 0 and rows.max() < 239 and columns.min() > 0 and columns.max() < 319
    assert joints["leftHand"][0] - joints["leftUpperArm"][0] > 0.2  # the actor's left is right
    assert joints["leftHand"][1] > joints["leftUpperArm"][1] > joints["head"][1]
    pixels = depth.camera.project(one.joints[0])
    at_joints = depth.frame(0)[
        pixels[:, 1].round().astype(int).clip(0, 239), pixels[:, 0].round().astype(int)
    ]
    assert (at_joints > 0.0).mean() > 0.8
