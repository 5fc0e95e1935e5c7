"""Axial rotations from similar library poses, weighted against elbow and knee flexion."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from upright_positions import POSITIONS

from solvers.motion import (
    SENSOR_JOINTS,
    Motion,
    Sensor,
    Tracks,
    forward_kinematics,
    joint_parents,
)
from solvers.motion.humanoid.posture_joints import postures_from_motion
from solvers.reconstruction import ReconstructMethod, ReconstructSettings, reconstruct
from solvers.reconstruction.joint_rotations.limb_twist import twist_to_normal
from solvers.reconstruction.joint_rotations.motion_from_positions import motion_from_positions
from solvers.reconstruction.joint_rotations.trunk_twist import LimbTwists
from solvers.reconstruction.pose_library.posture_library import build_posture_library
from solvers.rotations.representations import rotate
from solvers.samples import GaitSettings, walking_gait
from solvers.workflows.reconstruct_motion import postures_recording

NAMES = SENSOR_JOINTS[Sensor.KINECT_V1]
PARENTS = joint_parents(NAMES)
TWIST_RAD = np.radians(50.0)
"""Twist of the left upper arm in similar postures."""


def hanging_arm(flexion: np.ndarray) -> Tracks:
    """A body whose left elbow flexes forward by these angles, radians."""
    still = np.zeros((len(flexion), 20, 3))
    for name, position in POSITIONS.items():
        still[:, NAMES.index(name)] = position
    direction = np.stack([0.0 * flexion, -np.sin(flexion), -np.cos(flexion)], axis=-1)
    elbow = still[:, NAMES.index("ElbowLeft")]
    still[:, NAMES.index("WristLeft")] = elbow + 0.25 * direction
    still[:, NAMES.index("HandLeft")] = elbow + 0.35 * direction
    return Tracks(NAMES, still, 30.0)


def similar_twists(
    n_frames: int, length: float = 1.0, library_only: bool = False
) -> LimbTwists:
    vectors = np.zeros((n_frames, 4), complex)
    vectors[:, 0] = length * np.exp(1j * TWIST_RAD)
    return LimbTwists(vectors, library_only)


def elbow_twist_deg(motion: Motion) -> np.ndarray:
    """Angle of the elbow axis about the hanging arm from facing front, degrees."""
    world = forward_kinematics(motion).rotations[:, motion.skeleton.index("ShoulderLeft")]
    hinge = rotate(world, np.array([0.0, 0.0, -1.0]))
    # The elbow axis of an untwisted hanging arm points to the right; the limb points down.
    return np.degrees(np.arctan2(hinge[:, 1], -hinge[:, 0]))


def test_straight_arm_gets_the_twist_of_similar_postures():
    tracks = hanging_arm(np.zeros(30))

    plain, motion = (
        motion_from_positions(tracks, PARENTS, twists=x) for x in (None, similar_twists(30))
    )

    assert_allclose(elbow_twist_deg(plain), 0.0, atol=1.0)
    assert_allclose(elbow_twist_deg(motion), np.degrees(TWIST_RAD), atol=10.0)


def test_library_twist_weighs_less_where_neighbors_disagree():
    tracks = hanging_arm(np.zeros(30))

    motion = motion_from_positions(tracks, PARENTS, twists=similar_twists(30, length=0.1))

    mean = 0.1 * np.exp(1j * TWIST_RAD) + 0.9  # the rest has no twist
    assert_allclose(elbow_twist_deg(motion), np.degrees(np.angle(mean)), atol=0.5)


def test_flexion_plane_determines_the_twist_where_the_elbow_flexes():
    tracks = hanging_arm(np.full(30, np.radians(80.0)))

    motion = motion_from_positions(tracks, PARENTS, twists=similar_twists(30))

    assert_allclose(elbow_twist_deg(motion), 0.0, atol=3.0)


def test_actor_bias_of_flexed_frames_applies_to_straight_ones():
    flexion = np.where(np.arange(300) < 100, np.radians(80.0), 0.0)

    motion = motion_from_positions(hanging_arm(flexion), PARENTS, twists=similar_twists(300))

    assert_allclose(elbow_twist_deg(motion), 0.0, atol=10.0)


def test_published_method_uses_library_twists_only():
    tracks = hanging_arm(np.full(30, np.radians(80.0)))

    motion = motion_from_positions(
        tracks, PARENTS, twists=similar_twists(30, length=0.3, library_only=True)
    )

    assert_allclose(elbow_twist_deg(motion), np.degrees(TWIST_RAD), atol=0.5)


def test_published_method_has_no_twist_where_it_is_unknown():
    twists, unknown = similar_twists(30, library_only=True), np.arange(30) >= 20
    twists.vectors[unknown] = 0.0

    motion = motion_from_positions(
        hanging_arm(np.full(30, np.radians(80.0))), PARENTS, twists=twists
    )

    assert_allclose(
        elbow_twist_deg(motion), np.where(unknown, 0.0, np.degrees(TWIST_RAD)), atol=0.5
    )


@pytest.mark.parametrize("dip", [0.5, 1.9])
def test_unobserved_twist_changes_equally_fast_at_all_frame_rates(dip):
    """From -85 to 85 degrees while no flexion shows it for `dip` seconds."""
    speeds = []
    for rate in (30.0, 120.0, 240.0):
        times = np.arange(round(6.0 * rate) + 1) / rate - 3.0
        angles = np.radians(85.0) * np.where(times < 0.0, -1.0, 1.0)
        still = np.tile([1.0, 0.0, 0.0, 0.0], (len(times), 1))
        along, plain = (np.tile(each, (len(times), 1)) for each in np.eye(3)[[2, 0]])
        normals = np.stack([np.cos(angles), np.sin(angles), 0.0 * angles], axis=-1)
        weights = np.where(np.abs(times) < dip / 2, 0.0, 1.0)
        rotated = twist_to_normal(still, along, plain, normals, weights, rate)
        course = np.unwrap(2.0 * np.arctan2(rotated[:, 3], rotated[:, 0]))
        speeds.append(np.abs(np.diff(course)).max() * rate)

    assert_allclose(speeds[1:], speeds[0], rtol=0.05)


def test_a_single_frame_gets_the_twist_of_a_longer_take():
    tracks = hanging_arm(np.full(2, np.radians(20.0)))

    one, two = (
        motion_from_positions(tracks.slice(0, n), PARENTS, twists=similar_twists(n)).rotations
        for n in (1, 2)
    )

    assert_allclose(one[0], two[0], atol=0.01)


@pytest.fixture(scope="module")
def gait() -> Motion:
    return walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))


def test_reconstruction_returns_the_twist_of_its_library(gait):
    library = build_posture_library([gait])
    recording = postures_recording(gait)

    both, published, residuals = (
        reconstruct(recording, library, settings=ReconstructSettings(method=method))
        for method in (
            ReconstructMethod.BOTH,
            ReconstructMethod.PUBLISHED_POSTURES,
            ReconstructMethod.RESIDUALS,
        )
    )

    assert residuals.twists is None
    for one, separate in ((both, False), (published, True)):
        assert one.twists is not None
        assert one.twists.ignore_flexion is separate
        assert one.twists.vectors.shape == (gait.n_frames, 4)
        assert np.abs(one.twists.vectors).min() > 0.5
    assert both.motion.observed.all()
    assert len(postures_from_motion(both.motion)) == gait.n_frames


@pytest.mark.parametrize(
    "method", [ReconstructMethod.BOTH, ReconstructMethod.PUBLISHED_POSTURES]
)
def test_older_library_leaves_the_twist_to_flexion(gait, method):
    library = build_posture_library([gait])
    recording, settings = postures_recording(gait), ReconstructSettings(method=method)

    old, new = (
        reconstruct(recording, each, settings=settings)
        for each in (replace(library, twists=None), library)
    )

    assert old.twists is None
    plain = motion_from_positions(old.tracks, recording.parents, old.reliability.combined)
    assert_allclose(old.motion.rotations, plain.rotations)
    assert np.abs(new.motion.rotations - plain.rotations).max() > 1e-3
