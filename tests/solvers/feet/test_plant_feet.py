"""Planted feet do not move, and all else stays the same."""

import numpy as np
import pytest

from solvers.errors import InvalidMotionError, SolveCancelled
from solvers.feet.legs import find_legs
from solvers.feet.plant_feet import PlantSettings, plant_feet
from solvers.motion import Motion, Skeleton, forward_kinematics
from solvers.motion.humanoid.foot_contacts import detect_contacts
from solvers.recordings.skeleton_files import read_bvh
from solvers.rotations.representations import (
    angle_between,
    multiply,
    quaternion_from_rotation_vector,
)
from solvers.samples import GaitSettings, walking_gait


@pytest.fixture(scope="module")
def walk() -> Motion:
    return walking_gait(GaitSettings(duration=3.0, frame_rate=60.0))


@pytest.fixture(scope="module")
def contacts(walk):
    return detect_contacts(walk)


def add_foot_slide(motion: Motion, fraction: float = 0.15) -> Motion:
    """Return the same steps with a body that travels farther than the feet carry it."""
    root_positions = motion.root_positions.copy()
    root_positions[:, :2] += fraction * (root_positions[:, :2] - root_positions[0, :2])
    return motion.with_poses(root_positions=root_positions)


def ball_positions(motion: Motion) -> np.ndarray:
    """Return the positions of the toe joints, (n_frames, left and right, 3)."""
    toes = [leg.toe for leg in find_legs(motion.skeleton)]
    return forward_kinematics(motion).positions[:, toes]


def inner_steps(contacts: np.ndarray, margin: int) -> np.ndarray:
    """Return the steps between frames that are in contact for `margin` frames on both sides."""
    inner = contacts.copy()
    for shift in range(1, margin + 1):
        inner[shift:] &= contacts[:-shift]
        inner[:-shift] &= contacts[shift:]
    return inner[1:] & inner[:-1]


def test_skating_walk_stops_sliding(walk, contacts):
    planted = plant_feet(add_foot_slide(walk), contacts)

    assert planted.slide_before > 0.3
    assert planted.slide_after < 0.02 * planted.slide_before
    assert (planted.contacts == contacts).all()


def test_ball_in_contact_moves_less_than_a_millimeter(walk, contacts):
    """Only in the last third of a stance, after the foot has rolled onto the ball."""
    planted = plant_feet(add_foot_slide(walk), contacts).motion

    steps = np.linalg.norm(np.diff(ball_positions(planted)[..., :2], axis=0), axis=-1)
    assert (
        np.linalg.norm(np.diff(ball_positions(add_foot_slide(walk)), axis=0), axis=-1)[
            inner_steps(contacts, 9)
        ].max()
        > 0.002
    )
    assert steps[inner_steps(contacts, 9)].max() < 0.001


def test_joints_above_the_hips_are_unchanged(walk, contacts):
    source = add_foot_slide(walk)

    planted = plant_feet(source, contacts).motion

    legs = [
        joint for leg in find_legs(walk.skeleton) for joint in walk.skeleton.subtree(leg.hip)
    ]
    above = [joint for joint in range(walk.n_joints) if joint not in legs]
    assert (planted.rotations[:, above] == source.rotations[:, above]).all()
    assert planted.skeleton is source.skeleton


def test_a_clean_walk_hardly_changes(walk):
    planted = plant_feet(walk)

    moved = np.linalg.norm(
        forward_kinematics(planted.motion).positions - forward_kinematics(walk).positions,
        axis=-1,
    )
    feet = [joint for leg in find_legs(walk.skeleton) for joint in (leg.ankle, leg.toe)]
    assert moved[:, feet].max() < 0.015  # where a foot leaves the floor
    assert moved.max() < 0.025  # a straight knee moves four times as far as its foot
    assert moved.mean() < 0.0035


def test_feet_keep_their_own_roll(walk, contacts):
    """Heel strike and push-off tilt the foot by tens of degrees; planting, by less than 12."""
    source = add_foot_slide(walk)
    ankles = [leg.ankle for leg in find_legs(walk.skeleton)]

    planted = plant_feet(source, contacts).motion

    before, after = (
        forward_kinematics(motion).rotations[:, ankles] for motion in (source, planted)
    )
    assert np.degrees(angle_between(before, after).max()) < 12.0


def test_wrong_foot_rotation_does_not_move_its_leg(walk, contacts):
    """For a tenth of a second in mid-stance the foot is captured upside down."""
    leg = find_legs(walk.skeleton)[0]
    middle = int(np.flatnonzero(inner_steps(contacts, 12)[:, 0])[0]) + 3
    rotations = walk.rotations.copy()
    flip = quaternion_from_rotation_vector([2.5, 0.0, 0.0])
    frames = slice(middle, middle + 6)
    rotations[frames, leg.ankle] = multiply(rotations[frames, leg.ankle], flip)
    broken = walk.with_poses(rotations)

    planted = plant_feet(broken, contacts).motion

    before, after = (
        forward_kinematics(motion).positions[:, leg.ankle] for motion in (broken, planted)
    )
    assert np.linalg.norm(after - before, axis=1).max() < 0.015


def test_no_contact_is_no_change(walk):
    planted = plant_feet(walk, np.zeros((walk.n_frames, 2), dtype=bool))

    assert (planted.motion.rotations == walk.rotations).all()
    assert (planted.motion.root_positions == walk.root_positions).all()
    assert planted.slide_after == 0.0


def test_permanent_contact_holds_both_feet(walk):
    """A jittering stand, in contact all the time."""
    rng = np.random.default_rng(3)
    stand = walk.with_poses(
        np.repeat(walk.rotations[:1], 120, axis=0),
        np.repeat(walk.root_positions[:1], 120, axis=0),
    )
    noise = quaternion_from_rotation_vector(
        rng.normal(scale=0.02, size=(120, walk.n_joints, 3))
    )
    shaky = stand.with_poses(multiply(stand.rotations, noise))

    planted = plant_feet(shaky, np.ones((120, 2), dtype=bool))

    assert planted.slide_after < 0.05 * planted.slide_before


@pytest.mark.parametrize("captured", ["arms", "right leg"])
def test_legs_that_were_not_captured_stay_stiff(walk, captured):
    """A suit for the upper body: legs hang from hips that sway in place."""
    rotations = walk.rotations.copy()
    stiff = {leg.side: [*leg.chain, leg.toe] for leg in find_legs(walk.skeleton)}
    for side in ("left", "right") if captured == "arms" else ("left",):
        rotations[:, stiff[side]] = rotations[0, stiff[side]]
    sway = np.zeros((walk.n_frames, 3))
    sway[:, 0] = 0.05 * np.sin(np.arange(walk.n_frames) / 20.0)
    rotations[:, 0] = quaternion_from_rotation_vector(sway)
    hips = np.broadcast_to(walk.root_positions[0], sway.shape)
    swaying = walk.with_poses(rotations=rotations, root_positions=hips)

    planted = plant_feet(swaying)

    assert not planted.contacts[:, 0].any()
    kept = planted.motion.rotations[:, stiff["left"]]
    assert kept == pytest.approx(rotations[:, stiff["left"]], abs=1e-12)


def test_rotates_and_moves_with_its_input(walk, contacts):
    rotation = quaternion_from_rotation_vector([0.0, 0.0, 2.0])
    source = add_foot_slide(walk).slice(0, 90)
    rotations = source.rotations.copy()
    rotations[:, 0] = multiply(rotation, rotations[:, 0])
    c, s = np.cos(2.0), np.sin(2.0)
    root_positions = source.root_positions @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]).T

    original = plant_feet(source, contacts[:90]).motion
    moved = plant_feet(
        source.with_poses(rotations, np.add(root_positions, (5.0, -3.0, 0.0))), contacts[:90]
    ).motion

    assert angle_between(original.rotations[:, 1:], moved.rotations[:, 1:]).max() < 1e-5


def test_feet_have_the_same_trajectory_at_twice_the_frame_rate():
    fast = add_foot_slide(walking_gait(GaitSettings(duration=3.0, frame_rate=120.0)))
    contacts = detect_contacts(fast)
    slow = Motion(fast.skeleton, fast.rotations[::2], fast.root_positions[::2], 60.0)

    at_120 = forward_kinematics(plant_feet(fast, contacts).motion).positions[::2]
    at_60 = forward_kinematics(plant_feet(slow, contacts[::2]).motion).positions

    moved = np.linalg.norm(at_60 - forward_kinematics(slow).positions, axis=-1).max()
    assert np.linalg.norm(at_120 - at_60, axis=-1).max() < 0.2 * moved
    assert np.linalg.norm(at_120 - at_60, axis=-1).mean() < 0.002


def test_hips_are_lowered_if_a_leg_is_too_short(walk, contacts):
    """The strides are half a foot longer than the legs can reach."""
    source = add_foot_slide(walk, 0.45)

    planted = plant_feet(source, contacts)
    without = plant_feet(source, contacts, settings=PlantSettings(move_root=False))

    assert planted.slide_after < 0.05 * planted.slide_before
    assert planted.slide_after < without.slide_after
    lowered = source.root_positions[:, 2] - planted.motion.root_positions[:, 2]
    assert 0.005 < lowered.max() < 0.15
    assert np.abs(np.diff(lowered, n=2)).max() * 60.0**2 < 20.0


def test_knees_of_real_walks_do_not_pop(recordings):
    walk = read_bvh(recordings / "mocap" / "cmu_walk" / "10_04.bvh").slice(1, 481)

    planted = plant_feet(walk)

    # The rest is one frame in which the captured toes jump by 4 cm, and fast toes that leave.
    assert planted.slide_after < 0.1 * planted.slide_before
    for leg in find_legs(walk.skeleton):
        before, after = (
            np.abs(np.diff(angle_between(motion.rotations[:, leg.knee], [1.0, 0, 0, 0]), n=2))
            for motion in (walk, planted.motion)
        )
        assert after.mean() < 1.3 * before.mean()


def test_uneven_ground_stays_uneven(walk, contacts):
    """On a ramp of 1 in 10 each contact keeps its height."""
    root_positions = walk.root_positions.copy()
    root_positions[:, 2] -= 0.1 * root_positions[:, 1]
    uphill = walk.with_poses(root_positions=root_positions)

    planted = plant_feet(uphill, contacts).motion

    assert (
        np.abs(ball_positions(planted)[..., 2] - ball_positions(uphill)[..., 2])[contacts].max()
        < 0.03
    )


def test_contacts_on_a_level_floor_have_one_height(walk, contacts):
    root_positions = walk.root_positions.copy()
    root_positions[:, 2] += 0.008 * np.sin(np.arange(walk.n_frames) / 60.0)
    planted = plant_feet(walk.with_poses(root_positions=root_positions), contacts).motion

    inner = np.concatenate([[False], inner_steps(contacts, 6)[:, 0]])
    assert np.ptp(ball_positions(planted)[inner, 0, 2]) < 0.006


def test_one_frame_is_planted():
    walk = walking_gait(GaitSettings(duration=1.0, frame_rate=30.0)).slice(0, 1)

    planted = plant_feet(walk, np.ones((1, 2), dtype=bool))

    assert planted.motion.n_frames == 1
    assert planted.slide_after == 0.0
    moved = forward_kinematics(planted.motion).positions - forward_kinematics(walk).positions
    assert np.abs(moved).max() < 0.005


def test_gaps_are_refused_with_their_joints(walk):
    rotations = walk.rotations.copy()
    rotations[3, walk.skeleton.index("LeftArm")] = np.nan

    with pytest.raises(InvalidMotionError, match="these have gaps: LeftArm"):
        plant_feet(walk.with_poses(rotations))


def test_a_skeleton_without_legs_is_refused():
    arm = Skeleton(("a", "b"), (-1, 0), np.array([[0, 0, 1.0], [0, 0, 0.3]]))
    with pytest.raises(InvalidMotionError, match="No leg was found"):
        plant_feet(Motion(arm, np.tile([1.0, 0, 0, 0], (5, 2, 1)), np.zeros((5, 3)), 30.0))


def test_contacts_of_another_clip_are_refused(walk):
    with pytest.raises(InvalidMotionError, match=r"Contacts need shape \(180, 2\)"):
        plant_feet(walk, np.ones((7, 2), dtype=bool))


def test_progress_rises_to_one_and_can_cancel(walk, cancel):
    fractions = []
    plant_feet(walk, progress=lambda fraction, message="": fractions.append(fraction))

    assert fractions == sorted(fractions) and fractions[-1] == 1.0

    with pytest.raises(SolveCancelled):
        plant_feet(walk, progress=cancel)
