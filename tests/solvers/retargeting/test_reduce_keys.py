"""Few keys reproduce the motion within the tolerance with the curves of Blender."""

from importlib import import_module

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from solvers.errors import InvalidFileError, InvalidMotionError, InvalidSettingError
from solvers.motion import Motion, Skeleton, forward_kinematics
from solvers.recordings import read_bvh
from solvers.retargeting import (
    RotationChannels,
    UnbakeSettings,
    load_sparse_motion,
    reduce_keys,
)
from solvers.retargeting.key_curves import KeyCurve, fit_curve
from solvers.rotations.representations import (
    IDENTITY,
    angle_between,
    quaternion_from_rotation_vector,
)
from solvers.samples import GaitSettings, walking_gait


@pytest.fixture(scope="module")
def walk() -> Motion:
    return walking_gait(GaitSettings(duration=3.0, frame_rate=30.0))


@pytest.mark.parametrize("tolerance", [0.0025, 0.01, 0.05])
def test_joint_errors_stay_within_the_tolerance(walk, tolerance):
    sparse = reduce_keys(walk, tolerance)

    before, after = (forward_kinematics(motion).positions for motion in (walk, sparse.dense()))
    errors = np.linalg.norm(after - before, axis=-1).max()
    assert errors <= tolerance
    assert errors <= sparse.error + 1e-12 <= tolerance + 1e-12
    assert sparse.n_keys < walk.n_frames * (4 * walk.n_joints + 3)


def test_rotations_of_hands_without_fingers_stay_within_tolerance(walk):
    """Such a hand moves no joint, but its rotation is visible."""
    hand = walk.skeleton.index("LeftHand")
    rotations = walk.rotations.copy()
    angle = np.sin(np.arange(walk.n_frames) / 4.0)
    rotations[:, hand] = quaternion_from_rotation_vector(angle[:, None] * (1.0, 0.0, 0.0))
    chosen = [joint for joint, name in enumerate(walk.skeleton.names) if name != "LeftHand_end"]
    handy = Motion(
        walk.skeleton.select(chosen), rotations[:, chosen], walk.root_positions, walk.frame_rate
    )

    dense = reduce_keys(handy, 0.005).dense()

    joint = handy.skeleton.index("LeftHand")
    difference = np.abs(np.abs((dense.rotations * handy.rotations).sum(-1)[:, joint]) - 1.0)
    assert np.degrees(2 * np.arccos(1.0 - difference.max())) < 2.0


def test_a_looser_tolerance_takes_fewer_keys(walk):
    counts = [reduce_keys(walk, tolerance).n_keys for tolerance in (0.002, 0.005, 0.01, 0.03)]

    assert counts == sorted(counts, reverse=True) and counts[-1] < counts[0] / 2


def test_constant_joints_need_one_key_and_resting_ones_none(walk):
    rotations = np.tile(IDENTITY, (90, walk.n_joints, 1))
    rotations[:, 3] = quaternion_from_rotation_vector(np.array([0.3, 0.0, 0.0]))
    still = Motion(walk.skeleton, rotations, np.tile([1.0, 2.0, 3.0], (90, 1)), 30.0)

    sparse = reduce_keys(still, 0.01)

    assert [len(curve.frames) for curve in sparse.rotations] == [
        1 if joint == 3 else 0 for joint in range(walk.n_joints)
    ]
    assert len(sparse.root.frames) == 1 and sparse.error < 1e-12
    assert_allclose(sparse.dense().rotations, rotations, atol=1e-12)


def test_key_poses_are_the_same_for_all_joints(walk):
    sparse = reduce_keys(walk, 0.02, settings=UnbakeSettings(key_poses=True))

    frames = {tuple(curve.frames) for curve in sparse.rotations if len(curve.frames) > 1}
    assert frames == {tuple(sparse.root.frames)}
    assert sparse.error <= 0.02


def test_real_walk_needs_a_third_of_its_keys(recordings):
    walk = read_bvh(recordings / "mocap/cmu_walk/05_01.bvh", scale=0.0254 / 0.45).slice(1, 400)

    sparse = reduce_keys(walk, 0.01)

    moving = sum(len(curve.frames) > 0 for curve in sparse.rotations)
    assert sparse.n_keys < walk.n_frames * (4 * moving + 3) / 3
    assert sparse.error <= 0.01


@pytest.mark.parametrize("n_frames", [1, 2, 3])
def test_shortest_clips_are_accepted(walk, n_frames):
    clip = walk.slice(0, n_frames)

    assert_allclose(
        reduce_keys(clip, 0.001).dense().root_positions, clip.root_positions, atol=2e-3
    )


def test_noisy_motion_stays_within_the_tolerance(walk, rng):
    rotations = quaternion_from_rotation_vector(rng.normal(0, 0.5, (40, walk.n_joints, 3)))
    noise = Motion(walk.skeleton, rotations, rng.normal(0, 0.1, (40, 3)), 30.0)

    assert reduce_keys(noise, 0.005).error <= 0.005


def test_keys_survive_export_and_import(walk, tmp_path):
    sparse = reduce_keys(walk, 0.01)

    sparse.save(tmp_path / "walk.npz")

    again = load_sparse_motion(tmp_path / "walk.npz")
    assert again.skeleton.names == walk.skeleton.names and again.n_keys == sparse.n_keys
    assert np.array_equal(again.dense().rotations, sparse.dense().rotations)
    (tmp_path / "broken.npz").write_bytes((tmp_path / "walk.npz").read_bytes()[:500])
    with pytest.raises(InvalidFileError, match=r"broken\.npz"):
        load_sparse_motion(tmp_path / "broken.npz")


@pytest.mark.parametrize("order", ["XYZ", "ZYX", "YXZ"])
def test_euler_channels_compose_as_in_blender(walk, rng, order, tmp_path):
    """Compose three curves of angles as Blender does."""
    axes = quaternion_from_rotation_vector(rng.normal(size=(walk.n_joints, 3)))
    channels = [RotationChannels(order, each) for each in axes]

    sparse = reduce_keys(walk, 0.01, channels=channels)

    assert sparse.error <= 0.01
    joint = walk.skeleton.index("LeftUpLeg")
    angles = sparse.rotations[joint].at(np.arange(walk.n_frames))
    rest = Rotation.from_quat(axes[joint], scalar_first=True)
    rotation = rest * Rotation.from_euler(order, angles) * rest.inv()
    difference = (
        rotation * Rotation.from_quat(walk.rotations[:, joint], scalar_first=True).inv()
    )
    assert np.degrees(difference.magnitude().max()) < 3.0
    sparse.save(tmp_path / "walk.npz")
    again = load_sparse_motion(tmp_path / "walk.npz").dense()
    assert_allclose(again.rotations, sparse.dense().rotations, atol=1e-14)


def test_channels_restore_the_rotations(rng):
    rotations = quaternion_from_rotation_vector(rng.normal(size=(50, 3)))
    for order in ("", "XYZ", "YZX"):
        channels = RotationChannels(order, [0.5, 0.5, -0.5, 0.5])
        back = channels.to_rotations(channels.from_rotations(rotations))
        assert angle_between(back, rotations).max() < 1e-6
    with pytest.raises(InvalidMotionError, match="orders"):
        RotationChannels("XYX")
    with pytest.raises(InvalidMotionError, match="orders"):
        RotationChannels("XYZ", [1.0, 0.0])


def test_reduce_keys_raises_for_gaps_and_invalid_input(walk):
    rotations = walk.rotations.copy()
    rotations[3, 2] = np.nan

    with pytest.raises(InvalidMotionError, match=walk.skeleton.names[2]):
        reduce_keys(walk.with_poses(rotations), 0.01)
    with pytest.raises(InvalidMotionError, match="as many rotation channels, not 1"):
        reduce_keys(walk, 0.01, channels=[RotationChannels()])
    for tolerance in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(InvalidSettingError, match="not positive"):
            reduce_keys(walk, tolerance)


def test_hermite_curve_equals_bezier_segments():
    """De Casteljau's construction, independent of Hermite polynomials."""
    curve = KeyCurve(
        np.array([0, 7, 10]), np.array([[0.0], [2.0], [-1.0]]), np.array([[0.5], [0.0], [-2.0]])
    )
    frames, values = curve.handles()

    for key in (0, 1):
        corners = np.array([
            [curve.frames[key], curve.values[key, 0]],
            [frames[key, 1], values[key, 1, 0]],
            [frames[key + 1, 0], values[key + 1, 0, 0]],
            [curve.frames[key + 1], curve.values[key + 1, 0]],
        ])
        for u in (0.2, 0.5, 0.9):
            points = corners
            while len(points) > 1:
                points = (1.0 - u) * points[:-1] + u * points[1:]
            assert curve.at(points[:, 0])[0, 0] == pytest.approx(points[0, 1], abs=1e-12)


@given(st.lists(st.integers(1, 58), unique=True, max_size=20), st.integers(0, 1000))
def test_fit_is_at_least_as_accurate_as_interpolation(inner, seed):
    samples = np.random.default_rng(seed).normal(size=(60, 2)).cumsum(axis=0)
    keys = np.array([0, *sorted(inner), 59])

    fitted = fit_curve(samples, keys)

    through = KeyCurve(keys, samples[keys], np.gradient(samples, axis=0)[keys])
    errors = [
        ((curve.at(np.arange(60)) - samples)[1:-1] ** 2).sum() for curve in (fitted, through)
    ]
    assert errors[0] <= errors[1] * 1.01 + 1e-9


def test_cubic_needs_two_keys():
    time = np.arange(100.0)
    samples = np.stack([1e-5 * time**3 - 2e-3 * time**2, 3.0 - time], axis=1)

    assert_allclose(fit_curve(samples, np.array([0, 99])).at(time), samples, atol=1e-3)


def test_single_joint_has_end_points():
    lone = Skeleton(("hips",), (-1,), np.zeros((1, 3)))
    angle = np.linspace(0, 3, 50)
    rotations = quaternion_from_rotation_vector(angle[:, None, None] * np.array([0, 0, 1.0]))

    sparse = reduce_keys(Motion(lone, rotations, np.zeros((50, 3)), 30.0), 0.001)

    assert 2 <= len(sparse.rotations[0].frames) < 10 and sparse.error <= 0.001


def test_motion_too_long_to_be_loaded_is_not_saved(walk, tmp_path, monkeypatch):
    sparse = reduce_keys(walk, 0.05)
    module = import_module("solvers.retargeting.reduce_keys")
    monkeypatch.setattr(module, "MAX_FRAMES", walk.n_frames - 1)

    with pytest.raises(InvalidMotionError, match=r"saved as keys\. Unbake a shorter part\."):
        sparse.save(tmp_path / "keys.npz")

    assert not list(tmp_path.iterdir())
