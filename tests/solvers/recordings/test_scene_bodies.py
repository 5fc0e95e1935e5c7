"""Bodies of files of other programs stand, whatever axis these files state."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.motion import FileConventions, Motion, Skeleton, world_poses
from solvers.recordings.conventions import (
    correct_stated_unit,
    describe_guesses,
    describe_lying,
    question_of_size,
    stand_scene_upright,
    stature,
)
from solvers.recordings.conventions.body_axes import estimate_up_axis
from solvers.recordings.conventions.file_axes import reinterpreted, rotate_motion
from solvers.recordings.skeleton_files.smpl_bodies.joints import smpl_joints
from solvers.rotations import quaternion_from_euler, rotate

NAMES, PARENTS, Y_UP_OFFSETS = smpl_joints(hands=False)
OFFSETS = Y_UP_OFFSETS @ np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]])
Y_UP, Z_UP = FileConventions("Y", "Z"), FileConventions("Z", "-Y")
SIDES = ("left", "right")
STILL = np.array([1.0, 0.0, 0.0, 0.0])


def walk(conventions=Y_UP) -> Motion:
    """Return a body that stands on the floor and moves forward."""
    rotations = np.zeros((60, len(NAMES), 4))
    rotations[..., 0] = 1.0
    hips = np.zeros((60, 3))
    hips[:, 1] = -np.linspace(0.0, 3.0, 60)
    hips[:, 2] = 0.96
    return Motion(Skeleton(NAMES, PARENTS, OFFSETS), rotations, hips, 30.0, conventions)


def about(axis: str, degrees: float) -> np.ndarray:
    angles = np.array([np.radians(degrees) * (each == axis) for each in "XYZ"])
    return quaternion_from_euler(angles, "XYZ")


def trunk_of(motion: Motion) -> np.ndarray:
    positions = world_poses(motion.skeleton, motion.rotations, motion.root_positions).positions
    trunk = positions[:, NAMES.index("head")] - positions[:, NAMES.index("pelvis")]
    return np.median(trunk / np.linalg.norm(trunk, axis=1, keepdims=True), axis=0)


def enlarged(factor: float, motion: Motion) -> Motion:
    skeleton = replace(motion.skeleton, offsets=factor * motion.skeleton.offsets)
    return replace(motion, skeleton=skeleton, root_positions=factor * motion.root_positions)


@pytest.mark.parametrize(
    ("factor", "name"),
    [
        (0.01, "units of 100 m"),
        (10.0, "decimeters"),
        (100.0, "centimeters"),
        (1 / 0.0254, "inches"),
    ],
)
def test_a_wrong_unit_of_a_file_is_corrected_and_reported(factor, name):
    corrected = correct_stated_unit(enlarged(factor, walk()), Y_UP, 1.0)

    assert stature(corrected) == pytest.approx(stature(walk()))
    assert corrected.root_positions == pytest.approx(walk().root_positions)
    (message,) = describe_guesses(corrected)
    assert message.startswith(f"Lengths are interpreted as {name}, by the size of the body")


def test_the_factor_of_the_reader_is_undone():
    """A scene's reader may take ten times a body for Acclaim units."""
    acclaim = 0.0254 / 0.45
    corrected = correct_stated_unit(enlarged(10.0 * acclaim, walk()), Y_UP, acclaim)

    assert stature(corrected) == pytest.approx(stature(walk()))


@pytest.mark.parametrize(
    ("conventions", "degrees", "up"), [(Y_UP, 90, "Z"), (Z_UP, 90, "-Y"), (Y_UP, 180, "-Y")]
)
def test_an_actor_who_never_stands_is_reported_with_the_axis_to_choose(
    conventions, degrees, up
):
    rotation = about("X", degrees)
    lying = rotate_motion(walk(conventions), rotation, rotation)

    (message,) = describe_lying([lying])

    assert f"{conventions.up} up; set Up to {up} if" in message
    assert trunk_of(reinterpreted(lying, up, None))[2] > 0.9


def test_an_animal_is_not_questioned():
    """The trunk of a bird lies, and is as long as that of a giant."""
    trunk = [NAMES.index(name) for name in ("spine1", "spine2", "spine3", "neck", "head")]
    legs = [NAMES.index(f"{side}_{part}") for side in SIDES for part in ("knee", "ankle")]
    offsets = OFFSETS.copy()
    offsets[trunk] = 3.0 * offsets[trunk][:, [0, 2, 1]] * (1.0, -1.0, 0.0)
    offsets[legs] = rotate(about("X", 20), offsets[legs])
    high = walk().root_positions + np.array([0.0, 0.0, 3.0])
    bird = replace(walk(), skeleton=Skeleton(NAMES, PARENTS, offsets), root_positions=high)

    assert estimate_up_axis(bird).axis != "Y"
    assert not describe_lying([bird])
    assert not question_of_size(bird)


def test_a_take_that_stands_confirms_the_axis_of_the_file():
    rotation = about("X", 90)

    assert not describe_lying([walk()])
    assert not describe_lying([rotate_motion(walk(), rotation, rotation), walk()])


@pytest.mark.parametrize(
    ("conventions", "degrees", "up"), [(Y_UP, 90, "Z"), (Z_UP, -90, "Y"), (Y_UP, 180, "-Y")]
)
def test_a_walk_up_the_wall_is_turned_and_reported(conventions, degrees, up):
    rotation = about("X", degrees)

    (rotated,) = stand_scene_upright([rotate_motion(walk(conventions), rotation, rotation)])

    assert trunk_of(rotated)[2] > 0.9
    assert np.ptp(rotated.root_positions[:, 2]) == pytest.approx(0.0, abs=1e-9)
    assert rotated.conventions.up == up
    (message,) = describe_guesses(rotated)
    assert f"states that {conventions.up} is up, but the actor stands along {up}" in message
    back = reinterpreted(rotated, conventions.up, None)
    assert np.abs(trunk_of(back)[2]) < 0.1 or degrees == 180
    assert not describe_guesses(back)


def lying(rest: str) -> Motion:
    """Return a body that lies on the floor, with its feet at the origin along its length."""
    rotation = about("X", 90)
    still = rotate_motion(in_place(walk()), rotation, rotation)
    if rest == "stands":
        return rotate_motion(in_place(walk()), rotation, STILL)
    if rest == "is a frame":
        offsets = still.skeleton.offsets.copy()
        offsets[NAMES.index("left_elbow")] += [0.0, 0.1, 0.2]
        return replace(still, skeleton=replace(still.skeleton, offsets=offsets))
    away = still.root_positions + np.array([0.0, 1.0, 0.1])
    return replace(still, root_positions=away)


def in_place(motion: Motion) -> Motion:
    return replace(motion, root_positions=motion.root_positions * [0.0, 0.0, 1.0])


@pytest.mark.parametrize("rest", ["stands", "is a frame", "lies far from the origin"])
def test_an_actor_who_really_lies_is_left_lying(rest):
    take = lying(rest)

    (kept,) = stand_scene_upright([take])

    assert kept is take


def test_a_body_in_place_is_turned_by_its_rest_pose_and_the_floor():
    rotation = about("X", 90)

    (rotated,) = stand_scene_upright([rotate_motion(in_place(walk()), rotation, rotation)])

    assert trunk_of(rotated)[2] > 0.9


def test_one_take_that_stands_confirms_the_axis_for_all():
    rotation = about("X", 90)
    takes = [rotate_motion(walk(), rotation, rotation), walk()]

    assert stand_scene_upright(takes) == takes


def test_an_actor_who_crawls_head_first_is_left_lying():
    """Its feet are at the origin of the file's other axis in most frames."""
    rotation = about("X", 90)
    still = rotate_motion(in_place(walk()), rotation, rotation)
    ahead = np.maximum(np.linspace(-2.0, 1.0, 60), 0.0)[::-1, None] * [0.0, -3.0, 0.0]

    take = replace(still, root_positions=still.root_positions + ahead)

    assert stand_scene_upright([take]) == [take]


@pytest.mark.parametrize("size", [0.4, 1.0, 3.0])
def test_children_and_giants_keep_the_unit_of_their_file(size):
    corrected = correct_stated_unit(enlarged(size, walk()), Y_UP, 1.0)

    assert stature(corrected) == pytest.approx(size * stature(walk()))
    assert not describe_guesses(corrected)
