"""Any input gives finite numbers or a clear error."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as some
from numpy.testing import assert_allclose

from solvers.errors import InvalidMotionError
from solvers.motion import Motion, Skeleton, forward_kinematics
from solvers.physics import (
    Ground,
    SimulateSettings,
    describe_first_failure,
    follow_target,
    simulate,
)
from solvers.physics.control import apply_control
from solvers.samples import GaitSettings, walking_gait

WALK = walking_gait(GaitSettings(duration=1.0, frame_rate=30.0))
STILL = [1.0, 0.0, 0.0, 0.0]


def test_body_far_above_the_ground_is_unchanged_and_reported():
    sky = WALK.with_poses(root_positions=WALK.root_positions + np.array([0, 0, 10.0]))

    result = simulate(sky, settings=SimulateSettings(ground=Ground.HEIGHT))

    assert np.array_equal(result.motion.rotations, sky.rotations)
    assert np.array_equal(result.motion.root_positions, sky.root_positions)
    assert not result.followed.any()
    assert describe_first_failure(result.followed, range(WALK.n_frames)) == ""
    assert result.message.startswith("The simulated body could not follow the take, which is")
    assert "The take stands at a height of 10.0" in result.message
    assert "If that is wrong, set the ground to be under the feet" in result.message


def test_frames_not_followed_are_those_of_the_take():
    """A walker is lifted by more than 1 m for 1.5 of 8 seconds."""
    long = walking_gait(GaitSettings(duration=8.0, frame_rate=30.0))
    lift = np.interp(np.arange(240), [100, 108, 145, 153], [0.0, 1.2, 1.2, 0.0])
    roots = long.root_positions + np.outer(lift, [0.0, 0.0, 1.0])

    result = simulate(long.with_poses(root_positions=roots))

    failed = np.flatnonzero(~result.followed)
    assert len(failed) and set(failed) <= set(range(100, 190))
    assert (np.diff(failed) == 1).mean() > 0.5, "it was lost before that was certain"
    assert np.array_equal(result.motion.root_positions[failed], roots[failed])
    assert not np.array_equal(result.motion.root_positions[10:50], roots[10:50])
    assert f"in {len(failed)} of 240 frames; there the take is unchanged" in result.message
    first = describe_first_failure(result.followed, range(1001, 1241))
    assert first == f"The first frame that the body could not follow is {1001 + failed[0]}."
    steps = np.abs(np.diff(result.motion.root_positions, axis=0)).max()
    assert steps < 2 * np.abs(np.diff(roots, axis=0)).max(), "it eases over"


def test_segments_between_jumps_are_simulated_separately():
    roots = WALK.root_positions.copy()
    roots[12:] += [5.0, -3.0, 0.0]

    result = simulate(WALK.with_poses(root_positions=roots))

    assert result.followed.all()
    assert describe_first_failure(result.followed, range(WALK.n_frames)) == ""
    assert np.abs(result.motion.root_positions - roots).max() < 0.05
    separate = simulate(WALK.slice(0, 12)).motion
    assert_allclose(result.motion.root_positions[:12], separate.root_positions, atol=0.01)


def test_gaps_are_filled_in_simulated_joints():
    rotations, roots = WALK.rotations.copy(), WALK.root_positions.copy()
    rotations[5:10], rotations[:, 3], roots[20:] = np.nan, np.nan, np.nan

    result = simulate(WALK.with_poses(rotations, roots))

    assert np.isfinite(result.motion.rotations[:, :3]).all()
    assert np.isfinite(result.motion.root_positions).all()


def test_simulate_raises_when_the_root_is_never_observed():
    roots = np.full_like(WALK.root_positions, np.nan)

    with pytest.raises(InvalidMotionError, match="position of the root is never observed"):
        simulate(WALK.with_poses(root_positions=roots))


@pytest.mark.parametrize("scale", [0.01, 100.0])
def test_simulate_raises_for_a_wrong_unit(scale):
    skeleton = WALK.skeleton
    body = Skeleton(skeleton.names, skeleton.parents, scale * skeleton.offsets)

    with pytest.raises(InvalidMotionError, match="is not plausible; set the scale of the"):
        simulate(Motion(body, WALK.rotations, scale * WALK.root_positions, 30.0))


def test_simulate_raises_for_a_low_frame_rate():
    with pytest.raises(
        InvalidMotionError, match="At 2 frames a second the movement between frames is unknown"
    ):
        simulate(replace(WALK, frame_rate=2.0))


@pytest.mark.parametrize("n_frames", [1, 2, 3])
def test_simulate_accepts_few_frames(n_frames):
    result = simulate(WALK.slice(0, n_frames))

    assert result.motion.n_frames == n_frames and result.followed.all()
    assert result.distance < 0.01


@pytest.mark.parametrize("plant", [True, False])
def test_unstable_engine_returns_the_take(monkeypatch, plant):
    """Muscle forces without bounds make the ground forces NaN in one step."""
    calls = []

    def exploding(engine, world, *others):
        used = apply_control(engine, world, *others)
        calls.append(used)
        if len(calls) % 100 == 50:
            world.data.qfrc_applied[:] = 1e300
        return used

    monkeypatch.setattr(follow_target, "apply_control", exploding)

    result = simulate(WALK, settings=SimulateSettings(plant=plant))

    assert np.isfinite(result.foot_loads).all() and np.isfinite(result.support).all()
    failed = ~result.followed
    assert failed.any()
    assert np.array_equal(result.motion.rotations[failed], WALK.rotations[failed])
    assert np.isfinite(result.motion.rotations).all()


@pytest.mark.parametrize("n_joints", [1, 2, 5])
def test_other_skeleton_is_simulated_bone_by_bone(n_joints):
    """An upright stick above the ground falls onto it and keeps its length."""
    names = tuple(f"joint{n}" for n in range(n_joints))
    offsets = np.tile([0.0, 0.0, 0.2], (n_joints, 1))
    skeleton = Skeleton(names, tuple(range(-1, n_joints - 1)), offsets)
    roots = np.tile([0.0, 0.0, 0.1], (60, 1))
    motion = Motion(skeleton, np.tile(STILL, (60, n_joints, 1)), roots, 30.0)

    result = simulate(motion)

    assert np.isfinite(result.motion.rotations).all()
    assert result.penetration_after <= max(result.penetration_before, 0.005)
    positions = forward_kinematics(result.motion).positions
    lengths = np.linalg.norm(np.diff(positions, axis=1), axis=-1)
    assert_allclose(lengths, 0.2, atol=1e-12)


def test_more_joints_than_the_engine_can_build_are_refused():
    """20 frames of a chain of 250 took 46 s, those of one of 2,000 more than 400."""
    n_joints = 300
    offsets = np.tile([0.0, 0.0, 0.1], (n_joints, 1))
    skeleton = Skeleton(
        tuple(f"joint{n}" for n in range(n_joints)), tuple(range(-1, n_joints - 1)), offsets
    )
    motion = Motion(
        skeleton, np.tile(STILL, (20, n_joints, 1)), np.tile([0.0, 0.0, 0.1], (20, 1)), 30.0
    )

    with pytest.raises(InvalidMotionError, match=r"250 bones at most, and 299 of this"):
        simulate(motion)


@pytest.mark.parametrize("bones", ["all in one place", "one tiny bone"])
def test_bones_of_zero_length_are_stable(bones):
    offsets = np.zeros((3, 3))
    if bones == "one tiny bone":
        offsets[1:] = [[0, 0, 1e-7], [0, 0, 0.5]]
    skeleton = Skeleton(("a", "b", "c"), (-1, 0, 1), offsets)
    motion = Motion(
        skeleton, np.tile(STILL, (20, 3, 1)), np.tile([0.0, 0.0, 0.2], (20, 1)), 30.0
    )

    result = simulate(motion)

    assert np.isfinite(result.motion.rotations).all()


@settings(max_examples=12)
@given(
    seed=some.integers(0, 1000),
    noise=some.floats(0.0, 3.0),
    travel=some.floats(0.0, 2.0),
    options=some.fixed_dictionaries({
        "support": some.floats(0.0, 3.0),
        "friction": some.floats(0.0, 5.0),
        "response": some.floats(0.5, 15.0),
        "smoothing": some.floats(0.0, 0.5),
    }),
)
def test_random_motion_gives_finite_results(seed, noise, travel, options):
    rng = np.random.default_rng(seed)
    shaken = WALK.rotations + noise * rng.normal(size=WALK.rotations.shape)
    shaken /= np.linalg.norm(shaken, axis=-1, keepdims=True)
    roots = WALK.root_positions + travel * rng.normal(size=WALK.root_positions.shape)
    motion = WALK.with_poses(shaken, roots)

    result = simulate(motion.slice(0, 15), settings=SimulateSettings(**options))

    assert np.isfinite(result.motion.rotations).all()
    assert np.isfinite(result.motion.root_positions).all()
    assert np.isfinite(result.distance) and np.isfinite(result.support).all()
    assert result.message.startswith("The simulated body")
