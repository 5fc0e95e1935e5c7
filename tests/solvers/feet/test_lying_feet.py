"""Feet of who sits or lies on the floor bear no weight and are not planted."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.denoising import plant_feet
from solvers.feet import standing_feet
from solvers.feet.dragged_feet import find_dragged_feet
from solvers.feet.legs import LegJoints, find_legs
from solvers.feet.standing_feet import detect_standing_feet
from solvers.motion import Motion, Skeleton, detect_contacts, forward_kinematics, reach
from solvers.motion.humanoid import find_humanoid_map
from solvers.recordings import read_acclaim
from solvers.rotations import IDENTITY, inverse, multiply, quaternion_from_rotation_vector
from solvers.samples import GaitSettings, walking_gait


def ankle_displacements(before: Motion, after: Motion) -> np.ndarray:
    ankles = [leg.ankle for leg in find_legs(before.skeleton)]
    old, new = (forward_kinematics(each).positions[:, ankles] for each in (before, after))
    return np.linalg.norm(new - old, axis=-1)


def lie_on_the_back(tilt: float) -> Motion:
    """Knees up and feet flat on the floor, of which the left one slides; the pelvis tilts."""
    walk = walking_gait(GaitSettings(duration=2.0, frame_rate=60.0))
    skeleton = walk.skeleton
    still = np.tile(IDENTITY, (*walk.rotations.shape[:2], 1))
    on_the_back = quaternion_from_rotation_vector([-np.pi / 2, 0.0, 0.0])
    still[:, 0] = quaternion_from_rotation_vector([-np.pi / 2 - tilt, 0.0, 0.0])
    still[:, skeleton.index("Spine")] = multiply(inverse(still[:, 0]), on_the_back)
    lying = walk.with_poses(still, np.tile([0.0, 0.0, 0.15], (walk.n_frames, 1)))
    sliding = 0.1 * (1.0 - np.cos(np.arange(walk.n_frames) / 20.0))
    for leg, slide in zip(find_legs(skeleton), (sliding, np.zeros_like(sliding)), strict=True):
        ankle = forward_kinematics(lying).positions[:, leg.hip].copy()
        ankle[:, 1:] = np.stack([-0.45 - slide, np.full_like(slide, 0.08)], axis=-1)
        lying = lying.with_poses(flat_feet(lying, leg))
        lying = reach(lying, leg.chain, ankle)
    return lying


def flat_feet(motion: Motion, leg: LegJoints) -> np.ndarray:
    rotations = motion.rotations.copy()
    rotations[:, leg.ankle] = inverse(forward_kinematics(motion).rotations[:, leg.knee])
    return rotations


def test_feet_are_planted_until_the_actor_lies(recordings):
    motion = read_acclaim(recordings / "mocap/hdm05/HDM_bd_lieDownFloor_002_120.amc")
    contacts = detect_contacts(motion)

    planted = plant_feet(motion)

    # The hips come to rest after 2.7 of 6 seconds.
    standing, lying = slice(0, 240), slice(350, None)
    assert contacts[lying].any(axis=0).all()
    assert not planted.contacts[lying].any()
    drags = find_dragged_feet(motion, find_legs(motion.skeleton), contacts)
    assert (planted.contacts[standing] == (contacts & ~drags)[standing]).all()
    skeleton = motion.skeleton
    legs = [
        joint
        for side in ("lhipjoint", "rhipjoint")
        for joint in skeleton.subtree(skeleton.index(side))
    ]
    assert_allclose(
        planted.motion.rotations[500:, legs], motion.rotations[500:, legs], atol=1e-4
    )
    assert ankle_displacements(motion, planted.motion)[standing].max() > 0.005


def test_feet_of_the_deepest_squat_stay_planted(recordings):
    motion = read_acclaim(recordings / "mocap/hdm05/HDM_bd_squat1Reps_007_120.amc")

    assert (plant_feet(motion).contacts == detect_contacts(motion)).all()


@pytest.mark.parametrize("tilt", [0.0, 70.0])
def test_body_on_its_back_keeps_its_sliding_feet(tilt):
    """The hip joints are 5 cm below the hips in the T-pose; a tilted pelvis raises them."""
    lying = lie_on_the_back(np.radians(tilt))

    planted = plant_feet(lying)

    assert detect_contacts(lying).any()
    assert not planted.contacts.any()
    assert (planted.motion.rotations == lying.rotations).all()


def test_root_that_drops_through_the_floor_for_a_frame_does_not_lower_the_ground():
    lying = lie_on_the_back(0.0)
    lying.root_positions[10, 2] -= 1.0

    assert not plant_feet(lying).contacts.any()


def test_no_contact_is_shorter_because_the_actor_lies_down(monkeypatch):
    """The hips leave the floor for two frames, which are too short for a contact."""
    lying = lie_on_the_back(0.0)
    still = np.repeat(lying.rotations[:1], lying.n_frames, axis=0)
    lying = lying.with_poses(still, lying.root_positions)
    rests = np.ones(lying.n_frames, dtype=np.bool_)
    rests[20:22] = False
    monkeypatch.setattr(standing_feet, "rests_on_hips", lambda *_: rests)
    legs = find_legs(lying.skeleton)

    assert detect_contacts(lying).all()
    assert not detect_standing_feet(lying, find_humanoid_map(lying.skeleton), legs).any()
    rests[20:40] = False
    standing = detect_standing_feet(lying, find_humanoid_map(lying.skeleton), legs)
    assert (standing == ~rests[:, None]).all()


def test_hips_at_the_floor_say_nothing_about_lying():
    """Some rigs have their root, which is named hips, between the feet."""
    walk = walking_gait(GaitSettings(duration=2.0, frame_rate=60.0))
    skeleton = walk.skeleton
    offsets = skeleton.offsets.copy()
    height = float(walk.root_positions[:, 2].mean())
    for child in skeleton.children[0]:
        offsets[child] += (0.0, 0.0, height)
    low = Motion(
        Skeleton(skeleton.names, skeleton.parents, offsets),
        walk.rotations,
        walk.root_positions - (0.0, 0.0, height),
        walk.frame_rate,
    )
    humanoid = find_humanoid_map(low.skeleton)

    standing = detect_standing_feet(low, humanoid, find_legs(low.skeleton))

    assert humanoid.indices(low.skeleton)["hips"] == 0
    assert standing.any() and (standing == detect_contacts(low)).all()
