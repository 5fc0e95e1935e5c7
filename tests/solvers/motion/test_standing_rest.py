"""A rest pose that no body can take must not spoil what is judged from it."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.motion import Motion, Skeleton, find_humanoid_map, forward_kinematics
from solvers.motion.humanoid import with_standing_rest
from solvers.retargeting import retarget
from solvers.rotations import (
    IDENTITY,
    inverse,
    multiply,
    quaternion_from_rotation_vector,
    rotate,
)
from solvers.samples import GaitSettings, walking_gait

WALK = walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))
HUMANOID = find_humanoid_map(WALK.skeleton)
INDICES = HUMANOID.indices(WALK.skeleton)


def with_bones_along_axes(motion: Motion) -> Motion:
    """Return the same motion; in the rest pose the left leg points up, and the arms back."""
    return with_turned_rest(motion, {
        "leftUpperLeg": (0.0, np.pi, 0.0), "leftUpperArm": (0.0, 0.0, 1.6),
        "rightUpperArm": (0.5, 0.0, 1.2), "leftFoot": (1.2, 0.3, 0.0),
    })  # fmt: skip


def with_turned_rest(motion: Motion, rest_rotations: dict[str, tuple[float, ...]]) -> Motion:
    """Return the same motion; in the rest pose limbs are turned by rotation vectors."""
    skeleton = motion.skeleton
    turns = np.tile(IDENTITY, (skeleton.n_joints, 1))
    for role, vector in rest_rotations.items():
        rotation = quaternion_from_rotation_vector(np.array(vector))
        below = skeleton.subtree(INDICES[role])
        turns[below] = multiply(rotation, turns[below])
    parents = list(skeleton.parents)
    parent_rotations = np.concatenate([IDENTITY[None], turns[parents[1:]]])
    rotations = multiply(multiply(parent_rotations, motion.rotations), inverse(turns))
    offsets = rotate(parent_rotations, skeleton.offsets)
    odd = Skeleton(skeleton.names, skeleton.parents, offsets)
    return Motion(odd, rotations, motion.root_positions, motion.frame_rate)


ODD = with_bones_along_axes(WALK)


def test_the_odd_rest_pose_shows_the_same_motion():
    """The test's own premise."""
    assert_allclose(
        forward_kinematics(ODD).positions, forward_kinematics(WALK).positions, atol=1e-9
    )


def test_joints_stay_where_they_are():
    stood = with_standing_rest(ODD, HUMANOID)

    assert_allclose(
        forward_kinematics(stood).positions, forward_kinematics(WALK).positions, atol=1e-9
    )


def test_the_new_rest_pose_stands_and_faces_the_front():
    rest = with_standing_rest(ODD, HUMANOID).skeleton.rest_positions

    roles = ("leftFoot", "rightFoot", "head")
    left, right, head = (rest[INDICES[role]] - rest[INDICES["hips"]] for role in roles)
    assert max(left[2], right[2]) < -0.7
    assert head[2] > 0.4
    assert left[0] > right[0]
    toes = rest[INDICES["leftToes"]] - rest[INDICES["leftFoot"]]
    assert toes[1] < -0.05


def test_a_body_that_rests_standing_is_left_as_it_is():
    assert with_standing_rest(WALK, HUMANOID) is WALK


def test_a_trunk_that_rests_turned_away_from_the_legs_is_no_person():
    """Bones along axes may leave the shoulders across the hips, with the legs straight down."""
    rotated = with_turned_rest(WALK, {"spine": (0.0, 0.0, np.pi / 2)})

    stood = with_standing_rest(rotated, HUMANOID)

    rest = stood.skeleton.rest_positions
    shoulders = rest[INDICES["leftUpperArm"]] - rest[INDICES["rightUpperArm"]]
    assert shoulders[0] > 0.9 * np.linalg.norm(shoulders)


def test_gaps_stay_in_the_same_joints():
    rotations = ODD.rotations.copy()
    rotations[5:9, INDICES["leftLowerArm"]] = np.nan
    gapped = ODD.with_poses(rotations)

    stood = with_standing_rest(gapped, HUMANOID)

    assert np.array_equal(np.isnan(stood.rotations), np.isnan(rotations))


def test_a_body_never_observed_is_left_as_it_is():
    missing = ODD.with_poses(np.full_like(ODD.rotations, np.nan))

    assert with_standing_rest(missing, HUMANOID) is missing


@pytest.mark.parametrize("role", ["leftFoot", "rightFoot", "leftHand", "head", "hips"])
def test_retargeting_does_not_depend_on_the_rest_pose(role):
    """The Bandai-Namco set: hips came out 0.8 m too low, and collars hung down."""
    expected = retarget(WALK, HUMANOID, WALK.skeleton, HUMANOID)

    found = retarget(ODD, HUMANOID, WALK.skeleton, HUMANOID)

    distance = np.linalg.norm(
        forward_kinematics(found).positions[:, INDICES[role]]
        - forward_kinematics(expected).positions[:, INDICES[role]],
        axis=-1,
    )
    assert distance.max() < 0.06


def test_the_feet_rest_as_they_stand_though_toes_are_raised_for_a_moment():
    raised = {side: np.arange(WALK.n_frames) // 4 == 5 for side in ("left", "right")}

    assert_the_feet_rest_as_they_stand(with_pitched_feet(WALK, raised, -0.6))


def test_the_feet_rest_as_they_stand_though_they_hang_most_of_the_time():
    """A runner's foot is in the air for more than half of the time."""
    hanging = {
        side: heights(side) > np.quantile(heights(side), 0.3) for side in ("left", "right")
    }

    assert_the_feet_rest_as_they_stand(with_pitched_feet(WALK, hanging, 0.8))


def with_pitched_feet(motion: Motion, frames: dict, angle: float) -> Motion:
    """Return the motion with feet pitched by an angle, radians, in some frames of each side."""
    rotations = motion.rotations.copy()
    pitch = quaternion_from_rotation_vector(np.array([angle, 0.0, 0.0]))
    for side, chosen in frames.items():
        foot = INDICES[f"{side}Foot"]
        rotations[chosen, foot] = multiply(rotations[chosen, foot], pitch)
    return motion.with_poses(rotations)


def assert_the_feet_rest_as_they_stand(motion: Motion) -> None:
    stood = with_standing_rest(with_bones_along_axes(motion), HUMANOID)

    standing = forward_kinematics(WALK).positions
    for side in ("left", "right"):
        low = slope(standing, side)[heights(side) <= np.quantile(heights(side), 0.25)]
        found = slope(stood.skeleton.rest_positions, side)
        assert found == pytest.approx(np.median(low), abs=np.radians(3.0))


def heights(side: str) -> np.ndarray:
    """Return the height of an ankle of the walk, meters."""
    return forward_kinematics(WALK).positions[:, INDICES[f"{side}Foot"], 2]


def slope(positions, side):
    """Return the slope of a foot, radians."""
    bone = positions[..., INDICES[f"{side}Toes"], :] - positions[..., INDICES[f"{side}Foot"], :]
    return np.arctan2(bone[..., 2], np.linalg.norm(bone[..., :2], axis=-1))
