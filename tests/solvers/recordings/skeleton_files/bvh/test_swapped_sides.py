"""Skeletons from left-handed axes, whose left side is on the right, are mirrored back."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.motion import Motion, Skeleton, world_poses
from solvers.recordings import read_bvh, write_bvh
from solvers.recordings.conventions import SWAPPED
from solvers.recordings.skeleton_files.smpl_bodies.joints import smpl_joints
from solvers.rotations import multiply, quaternion_from_euler

F, RATE = 90, 30.0
NAMES, PARENTS, Y_UP_OFFSETS = smpl_joints(hands=False)
OFFSETS = Y_UP_OFFSETS @ np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]])
"""Z up, facing -Y."""
ACROSS = np.array([-1.0, 1.0, 1.0])


def squats(*, knees: float = 1.0, root_degrees: float = 0.0) -> Motion:
    """Return a take of squats, 30 degrees to the left, or of an actor who lies after a turn."""
    rotations = np.zeros((F, len(NAMES), 4))
    rotations[..., 0] = 1.0
    bend = np.zeros((F, 3))
    bend[:, 0] = knees * np.abs(np.sin(np.linspace(0.0, 6.0, F)))
    for side in ("left", "right"):
        rotations[:, NAMES.index(f"{side}_hip")] = quaternion_from_euler(-bend / 2.0, "XYZ")
        rotations[:, NAMES.index(f"{side}_knee")] = quaternion_from_euler(bend, "XYZ")
    turns = np.radians([[0.0, 0.0, 30.0], [root_degrees, 0.0, 0.0]])
    rotations[:, 0] = multiply(*quaternion_from_euler(turns, "XYZ"))
    height = 0.15 if root_degrees else 0.9
    positions = np.broadcast_to([0.4, 0.2, height], (F, 3))
    return Motion(Skeleton(NAMES, PARENTS, OFFSETS), rotations, positions, RATE)


def as_read(motion: Motion, path, *, without: str = "") -> tuple[Motion, str]:
    """Write and read a take without some joints; return it with the messages."""
    kept = [k for k, name in enumerate(NAMES) if not without or without not in name]
    skeleton = Skeleton(
        tuple(NAMES[k] for k in kept),
        tuple(kept.index(PARENTS[k]) if PARENTS[k] >= 0 else -1 for k in kept),
        motion.skeleton.offsets[kept],
    )
    write_bvh(Motion(skeleton, motion.rotations[:, kept], motion.root_positions, RATE), path)
    messages: list[str] = []
    read = read_bvh(path, up="Y", progress=lambda _, message="": messages.append(message))
    return read, " ".join(messages)


def in_left_handed_axes(motion: Motion) -> Motion:
    """Return the take of a program with left-handed axes: x is negated, names stay."""
    rotations = motion.rotations.copy()
    rotations[..., 2:] *= -1.0
    skeleton = Skeleton(NAMES, PARENTS, ACROSS * motion.skeleton.offsets)
    return Motion(skeleton, rotations, ACROSS * motion.root_positions, RATE)


def joints_of(motion: Motion, names=NAMES) -> np.ndarray:
    poses = world_poses(motion.skeleton, motion.rotations, motion.root_positions)
    return poses.positions[:, [motion.skeleton.index(name) for name in names]]


@pytest.mark.parametrize("root_degrees", [0.0, -90.0, 90.0])
@pytest.mark.parametrize("knees", [0.0, 1.0])
def test_a_mirrored_body_is_the_recorded_one_again_in_any_pose(tmp_path, root_degrees, knees):
    take = squats(knees=knees, root_degrees=root_degrees)

    motion, messages = as_read(in_left_handed_axes(take), tmp_path / "a.bvh")

    assert SWAPPED in messages
    assert_allclose(joints_of(motion), joints_of(take), atol=1e-4)


@pytest.mark.parametrize("without", ["", "foot"])
@pytest.mark.parametrize("root_degrees", [0.0, -90.0, 90.0])
def test_a_body_with_its_sides_right_stays_as_it_is(tmp_path, root_degrees, without):
    take = squats(root_degrees=root_degrees)

    motion, messages = as_read(take, tmp_path / "a.bvh", without=without)

    assert SWAPPED not in messages
    knees = ("left_knee", "right_knee")
    assert_allclose(joints_of(motion, knees), joints_of(take, knees), atol=1e-4)


def test_feet_that_end_at_the_heel_are_no_toes_that_point_backward(tmp_path):
    """Only bent knees, which point forward, show the front then."""
    take = squats()
    for side in ("left", "right"):
        take.skeleton.offsets[NAMES.index(f"{side}_foot")] *= (1.0, -1.0, 1.0)

    _, messages = as_read(take, tmp_path / "a.bvh")

    assert SWAPPED not in messages
