"""Foot contacts are detected in spite of jitter, drift and scale."""

import numpy as np
import pytest
from numpy.testing import assert_array_equal

from solvers.errors import InvalidMotionError
from solvers.motion import (
    HumanoidMap,
    Motion,
    Skeleton,
    contact_probabilities,
    contacts_of_points,
    detect_contacts,
    forward_kinematics,
    reach,
)
from solvers.recordings import read_bvh
from solvers.rotations.representations import (
    IDENTITY,
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
)

STANCE = 0.6
"""Part of each step cycle of one second in which a foot of `walk` stands."""


@pytest.fixture
def walk(body) -> Motion:
    """Five seconds at 100 Hz of a gait with known contacts."""
    return walking(body)


def test_finds_the_stance_phases_of_a_known_gait(walk):
    found, truth = detect_contacts(walk)[:-10], standing(walk)[:-10]  # it ends as a foot lands

    assert (found == truth).mean() > 0.95
    assert count_of_runs(found) == count_of_runs(truth)


def test_jitter_changes_little(walk, rng):
    rotations = rng.normal(scale=np.radians(1.0), size=(walk.n_frames, walk.n_joints, 3))
    noisy = walk.with_poses(
        multiply(walk.rotations, quaternion_from_rotation_vector(rotations)),
        walk.root_positions + rng.normal(scale=0.005, size=(walk.n_frames, 3)),
    )

    assert (detect_contacts(noisy) == standing(walk)).mean() > 0.92


def test_clean_and_noisy_real_walks_agree(recordings, rng):
    for name in ("07_01", "35_10", "26_01"):
        clean = read_bvh(recordings / f"mocap/cmu_walk/{name}.bvh")
        clean = clean.slice(1, 600)
        rotations = rng.normal(scale=np.radians(1.0), size=(clean.n_frames, clean.n_joints, 3))
        noisy = clean.with_poses(
            multiply(clean.rotations, quaternion_from_rotation_vector(rotations))
        )

        found = detect_contacts(clean)

        assert (detect_contacts(noisy) == found).mean() > 0.92
        assert 0.4 < found.mean() < 0.85  # a walker's foot stands 60 % of the time


def test_hops_on_one_leg_have_contacts_of_that_leg(recordings):
    """CMU 49_02 hops on the left leg from 8 to 12 s, on the right from 12.5 to 15.5 s."""
    found = detect_contacts(read_bvh(recordings / "mocap/cmu_hop/49_02.bvh"))

    left, right = found[960:1440].mean(axis=0), found[1500:1860].mean(axis=0)
    assert left[0] > 0.3 and left[1] < 0.05
    assert right[1] > 0.3 and right[0] < 0.05


@pytest.mark.parametrize("size", [0.01, 0.5, 100.0])
def test_contacts_do_not_depend_on_size(walk, size):
    skeleton = walk.skeleton
    scaled = Motion(
        Skeleton(skeleton.names, skeleton.parents, size * skeleton.offsets),
        walk.rotations, size * walk.root_positions, walk.frame_rate,
    )  # fmt: skip

    assert_array_equal(detect_contacts(scaled), detect_contacts(walk))


def test_contacts_do_not_depend_on_position_or_heading(walk):
    rotation = quaternion_from_rotation_vector([0.0, 0.0, 1.1])
    rotations = walk.rotations.copy()
    rotations[:, 0] = multiply(rotation, rotations[:, 0])
    root_positions = rotate(rotation, walk.root_positions) + np.array([5.0, 2.0, -3.0])
    moved = walk.with_poses(rotations, root_positions)

    assert_array_equal(detect_contacts(moved), detect_contacts(walk))


def test_contacts_are_found_on_a_sloping_floor(walk):
    """Subject 07 of CMU climbs by 5 cm in four meters."""
    climb = np.zeros((walk.n_frames, 3))
    climb[:, 2] = 0.02 * np.arange(walk.n_frames) / walk.frame_rate

    found = detect_contacts(walk.with_poses(root_positions=walk.root_positions + climb))

    assert (found == detect_contacts(walk)).mean() > 0.97


def test_contacts_hardly_depend_on_the_frame_rate(body):
    slow, fast = walking(body, 30.0), walking(body, 120.0)

    every_fourth = detect_contacts(fast)[::4]

    n_changes = np.abs(np.diff(every_fourth.astype(int), axis=0)).sum()
    assert (detect_contacts(slow) != every_fourth).sum() <= n_changes


def test_stances_of_a_fifth_of_a_second_keep_their_length():
    """Both feet hop in place, 0.2 s on the floor and 0.3 s in the air."""
    phase = np.arange(360) / 60.0 % 0.5
    flight = np.maximum(phase - 0.2, 0.0)
    feet = np.zeros((360, 2, 2, 3))
    feet[..., 2] = (0.5 * 9.81 * flight * (0.3 - flight))[:, None, None]
    standing = np.tile(phase[:, None] < 0.2, (1, 2))

    found = contacts_of_points(feet, 60.0)

    assert found[standing].all()
    assert (found == standing).mean() > 0.95


def test_feet_on_a_box_are_in_contact():
    """From 1 s on the left foot, and from 2 s the right one, step up by 20 cm in 0.6 s."""
    time = np.arange(360) / 60.0
    feet = np.zeros((360, 2, 2, 3))
    for foot, start in enumerate((1.0, 2.0)):
        ratio = np.clip((time - start) / 0.6, 0.0, 1.0)
        feet[:, foot, :, 1] = 0.35 * ratio[:, None]
        feet[:, foot, :, 2] = (0.2 * ratio + 0.12 * np.sin(np.pi * ratio) ** 2)[:, None]

    found = contacts_of_points(feet, 60.0)

    assert found[105:, 0].all() and found[165:, 1].all()
    assert not found[70:90, 0].any() and not found[130:150, 1].any()


def test_noise_of_each_frame_does_not_end_a_contact(rng):
    """Noise of 2 cm moves a foot at 1 m/s from frame to frame at 30 Hz."""
    feet = np.zeros((300, 2, 2, 3)) + rng.normal(scale=0.02, size=(300, 2, 1, 3))

    assert contacts_of_points(feet, 30.0).mean() > 0.99


def test_probability_is_lower_where_a_foot_lands_and_lifts(walk):
    probability, contacts = contact_probabilities(walk), detect_contacts(walk)

    changes = np.diff(contacts, axis=0)
    at_changes = probability[1:][changes]
    middle = probability[
        60 + np.arange(5) * 100 - 30, 0
    ]  # the left foot, half through a stance

    assert ((probability > 0.5) == contacts).all()
    assert at_changes.min() > 0.2 and at_changes.max() < 0.8
    assert middle.min() > 0.9


def test_lifted_still_foot_has_no_contact(walk):
    lifted = walk.skeleton.index("RightUpLeg")
    still = walk.slice(0, 1)
    rotations = np.repeat(still.rotations, 300, axis=0)
    rotations[:, lifted] = quaternion_from_rotation_vector([-1.2, 0, 0])
    posed = walk.with_poses(rotations, np.repeat(still.root_positions, 300, axis=0))

    assert_array_equal(detect_contacts(posed), np.tile([True, False], (300, 1)))


def test_hanging_feet_have_no_contact(walk):
    """After two seconds the body is lifted by 1 m and hangs still for three."""
    root_positions = np.repeat(walk.root_positions[:1], walk.n_frames, axis=0)
    root_positions[200:, 2] += 1.0
    still = np.repeat(walk.rotations[:1], walk.n_frames, axis=0)

    found = detect_contacts(walk.with_poses(still, root_positions))

    assert found[:190].all()
    assert not found[210:].any()


def test_contact_lasts_while_the_heel_rises(walk):
    """Within a second the flat foot tilts by 50 degrees about its toes."""
    n_frames = 200
    still = walk.slice(0, 1)
    base = walk.with_poses(
        np.repeat(still.rotations, n_frames, axis=0),
        np.repeat(still.root_positions, n_frames, axis=0),
    )
    hip, knee, ankle, toes = (
        walk.skeleton.index(f"Left{name}") for name in ("UpLeg", "Leg", "Foot", "ToeBase")
    )
    angle = np.radians(50.0) * np.clip(np.arange(n_frames) / 100.0 - 0.5, 0.0, 1.0)
    tilt = quaternion_from_rotation_vector(angle[:, None] * np.array([1.0, 0.0, 0.0]))
    flat = forward_kinematics(base)
    pivot = flat.positions[:, toes]
    lifted = pivot + rotate(tilt, flat.positions[:, ankle] - pivot)
    tiptoe = reach(base, (hip, knee, ankle), lifted)
    rotations = tiptoe.rotations.copy()
    above = forward_kinematics(tiptoe).rotations[:, knee]
    rotations[:, ankle] = multiply(inverse(above), multiply(tilt, flat.rotations[:, ankle]))
    tiptoe = tiptoe.with_poses(rotations)

    moved = forward_kinematics(tiptoe).positions
    assert np.abs(moved[:, toes] - pivot).max() < 1e-9
    assert np.ptp(moved[:, ankle, 2]) > 0.07
    assert detect_contacts(tiptoe)[:, 0].all()


def test_missing_feet_have_no_contact(walk):
    rotations = walk.rotations.copy()
    rotations[200:260, walk.skeleton.index("LeftLeg")] = np.nan

    found = detect_contacts(walk.with_poses(rotations))

    assert not found[200:260, 0].any()
    assert_array_equal(found[:, 1], detect_contacts(walk)[:, 1])


def test_missing_bodies_and_single_frames_are_accepted(walk):
    hidden = walk.with_poses(root_positions=np.full_like(walk.root_positions, np.nan))

    assert not detect_contacts(hidden).any()
    assert detect_contacts(walk.slice(0, 1)).shape == (1, 2)


def test_detect_contacts_raises_without_feet(leg, swinging_leg):
    with pytest.raises(InvalidMotionError, match="role leftFoot or rightFoot"):
        detect_contacts(swinging_leg)
    with pytest.raises(InvalidMotionError, match="role rightFoot"):
        detect_contacts(swinging_leg, HumanoidMap({"leftFoot": "ankle"}))


def walking(body: Skeleton, frame_rate: float = 100.0) -> Motion:
    """Feet follow a planned path, and legs reach for it; the step length is 0.8 m."""
    time = np.arange(round(5.0 * frame_rate)) / frame_rate
    n_frames = len(time)
    root_positions = np.stack([0 * time, -0.8 * time, 0 * time + 0.93], axis=-1)
    motion = Motion(
        body, np.tile(IDENTITY, (n_frames, body.n_joints, 1)), root_positions, frame_rate
    )
    for side, lag in (("Left", 0.0), ("Right", 0.5)):
        joints = tuple(body.index(side + name) for name in ("UpLeg", "Leg", "Foot"))
        ankle = forward_kinematics(motion).positions[:, joints[2]]
        ankle[:, 1:] = planned_ankle(time + lag, lag)
        motion = reach(motion, joints, ankle)
    return motion


def planned_ankle(time: np.ndarray, lag: float) -> np.ndarray:
    """Forward and upward position of an ankle that is at 0.08 m in stance."""
    cycle, phase = np.divmod(time, 1.0)
    swing = np.clip((phase - STANCE) / (1.0 - STANCE), 0.0, 1.0)
    eased_swing = swing * swing * (3.0 - 2.0 * swing)
    return np.stack(
        [
            -0.8 * (cycle + eased_swing + STANCE / 2 - lag),
            0.08 + 0.15 * np.sin(np.pi * swing) ** 2,
        ],
        axis=-1,
    )


def standing(walk: Motion) -> np.ndarray:
    time = np.arange(walk.n_frames) / walk.frame_rate
    return np.stack([(time + lag) % 1.0 < STANCE for lag in (0.0, 0.5)], axis=-1)


def count_of_runs(flags: np.ndarray) -> list[int]:
    starts = np.diff(flags.astype(int), axis=0, prepend=0) > 0
    return starts.sum(axis=0).tolist()
