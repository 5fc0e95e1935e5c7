"""The noise must be what its settings say, since benchmarks quote them."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidMotionError, InvalidSettingError
from solvers.rotations.representations import inverse, multiply, rotation_vector_from_quaternion
from solvers.samples import CorruptionSettings, GaitSettings, corrupt, walking_gait

CLEAN = CorruptionSettings(jitter=0.0)


@pytest.fixture(scope="module")
def walk():
    return walking_gait(GaitSettings(duration=20.0, frame_rate=30.0))


def test_jitter_has_the_stated_deviation_on_every_channel(walk):
    error = noise(corrupt(walk, CorruptionSettings(jitter=3.0)), walk)

    moving = [not walk.skeleton.is_end_site(joint) for joint in range(walk.n_joints)]
    assert_allclose(error[:, moving].std(axis=0), 3.0, atol=0.5)
    assert_allclose(np.abs(error[:, moving]).mean(), 3.0 * np.sqrt(2 / np.pi), rtol=0.02)
    assert_allclose(error[:, np.invert(moving)], 0.0, atol=1e-9)


def test_spikes_have_the_stated_fraction_and_size(walk):
    """One channel at a time, so that the size can be read off the rotation vector."""
    settings = CorruptionSettings(jitter=0.0, spikes=0.01)

    error = noise(corrupt(walk, settings), walk)
    alone = error[np.count_nonzero(np.abs(error) > 1e-6, axis=2) == 1]
    size = np.abs(alone).max(axis=1)

    rotating = sum(not walk.skeleton.is_end_site(joint) for joint in range(walk.n_joints))
    fraction = np.count_nonzero(np.abs(error) > 1e-6) / (walk.n_frames * rotating * 3)
    assert fraction == pytest.approx(0.01, rel=0.1)
    assert 20.0 <= size.min() < 23.0 and 57.0 < size.max() <= 60.0
    assert abs(np.sign(alone.sum(axis=1)).mean()) < 0.2


def test_missing_joint_removes_its_descendants(walk):
    corrupted = corrupt(walk, CLEAN, missing={"RightArm": range(100, 160)})

    names = np.array(walk.skeleton.names)[~corrupted.observed[120]]
    assert set(names) == {"RightArm", "RightForeArm", "RightHand", "RightHand_end"}
    frames = np.flatnonzero((~corrupted.observed).any(axis=1))
    assert (frames[0], frames[-1]) == (100, 159)


def test_missing_root_removes_everything(walk):
    corrupted = corrupt(walk, CLEAN, missing={"Hips": range(5, 6)})

    assert not corrupted.observed[5].any()
    assert np.isnan(corrupted.root_positions[5]).all()
    assert corrupted.observed[6].all()


def test_root_has_the_stated_jitter_and_sway(walk):
    jitter = corrupt(walk, CorruptionSettings(jitter=0.0, root_jitter=0.02))
    sway = corrupt(walk, CorruptionSettings(jitter=0.0, root_sway=0.02))

    assert_allclose((jitter.root_positions - walk.root_positions).std(), 0.02, rtol=0.1)
    moved = sway.root_positions - walk.root_positions
    assert 0.01 < moved[:, :2].std() < 0.03
    assert np.abs(np.diff(moved, axis=0)).max() < 0.006, "slow"
    assert_allclose(moved[:, 2], 0.0, atol=1e-12)


def test_corrupt_changes_nothing_at_zero_settings(walk):
    same = corrupt(walk, CLEAN)

    assert_allclose(same.rotations, walk.rotations, atol=1e-12)
    assert_allclose(same.root_positions, walk.root_positions)


def test_corrupt_depends_on_the_seed_and_keeps_the_input(walk):
    before = walk.rotations.copy()

    first, again, other = (corrupt(walk, CorruptionSettings(seed=seed)) for seed in (1, 1, 2))

    assert np.array_equal(first.rotations, again.rotations)
    assert not np.array_equal(first.rotations, other.rotations)
    assert np.array_equal(walk.rotations, before)


@pytest.mark.parametrize("frames", [range(590, 601), range(-1, 4), range(0, 10, 2)])
def test_corrupt_names_the_joint_with_invalid_frames(walk, frames):
    with pytest.raises(InvalidMotionError, match="frames of Hips must be a plain range within"):
        corrupt(walk, CLEAN, missing={"Hips": frames})


def test_corrupt_raises_for_an_unknown_joint(walk):
    with pytest.raises(InvalidMotionError, match="There is no joint Tail"):
        corrupt(walk, CLEAN, missing={"Tail": range(2)})


def test_settings_raise_for_a_fraction_above_one():
    with pytest.raises(InvalidSettingError, match="spikes is 2; it must lie between 0 and 1"):
        CorruptionSettings(spikes=2.0)


def noise(corrupted, clean):
    """Rotation vectors from the clean to the corrupted pose, degrees."""
    error = multiply(inverse(clean.rotations), corrupted.rotations)
    return np.degrees(rotation_vector_from_quaternion(error))
