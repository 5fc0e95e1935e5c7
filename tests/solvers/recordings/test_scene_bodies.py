"""Bodies of files of other programs stand, whatever axis these files state."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.motion import FileConventions, Motion, Skeleton, world_poses
from solvers.recordings.conventions import (
    correct_stated_unit,
    describe_guesses,
    stand_takes_upright,
    stature,
)
from solvers.recordings.conventions.file_axes import turn_motion
from solvers.recordings.skeleton_files.smpl_body import smpl_joints
from solvers.rotations import quaternion_from_euler

NAMES, PARENTS, Y_UP_OFFSETS = smpl_joints(hands=False)
OFFSETS = Y_UP_OFFSETS @ np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]])
Y_UP, Z_UP = FileConventions("Y", "Z"), FileConventions("Z", "-Y")
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


@pytest.mark.parametrize("conventions", [Y_UP, Z_UP])
@pytest.mark.parametrize("turn", [about("X", 90), about("X", -90), about("Y", 90)])
def test_a_take_on_its_side_stands_and_its_axes_are_noted(conventions, turn):
    lying = turn_motion(walk(conventions), turn, turn)

    (standing,) = stand_takes_upright([lying])

    assert trunk_of(standing)[2] > 0.95
    assert standing.skeleton.rest_positions[:, 2].max() > 0.5
    assert standing.conventions.up != conventions.up
    assert standing.conventions.confidence == 1.0
    assert not describe_guesses(standing)


def test_the_noted_axes_are_those_of_the_file():
    turn = about("X", 90)

    (from_y,) = stand_takes_upright([turn_motion(walk(Y_UP), turn, turn)])
    (from_z,) = stand_takes_upright([turn_motion(walk(Z_UP), turn, turn)])

    assert (from_y.conventions.up, from_y.conventions.forward) == ("Z", "-Y")
    assert (from_z.conventions.up, from_z.conventions.forward) == ("-Y", "-Z")


@pytest.mark.parametrize("hips", [(0.0, 0.0, 0.1), (0.0, 0.0, 1.0), (2.0, 3.0, 0.1)])
def test_an_actor_who_lies_stays_lying_and_is_reported(hips):
    lying = turn_motion(walk(), about("X", 90), STILL)
    lying = replace(lying, root_positions=np.broadcast_to(hips, (60, 3)))

    (kept,) = stand_takes_upright([lying])

    assert abs(trunk_of(kept)[2]) < 0.2
    (message,) = describe_guesses(kept)
    assert message.startswith("Y is interpreted as up, but the take does not show it clearly")


def test_a_take_that_lies_next_to_one_that_stands_is_not_rotated():
    turn = about("X", 90)
    lying = turn_motion(walk(), turn, turn)

    kept = stand_takes_upright([walk(), lying])

    assert abs(trunk_of(kept[1])[2]) < 0.2
    assert not any(map(describe_guesses, kept))


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
    corrected = correct_stated_unit(enlarged(factor, walk()), 1.0)

    assert stature(corrected) == pytest.approx(stature(walk()))
    assert corrected.root_positions == pytest.approx(walk().root_positions)
    (message,) = describe_guesses(corrected)
    assert message.startswith(f"Lengths are interpreted as {name}, by the size of the body")


def test_the_factor_of_the_reader_is_undone():
    """A scene's reader may take ten times a body for Acclaim units."""
    acclaim = 0.0254 / 0.45
    corrected = correct_stated_unit(enlarged(10.0 * acclaim, walk()), acclaim)

    assert stature(corrected) == pytest.approx(stature(walk()))


@pytest.mark.parametrize("size", [0.4, 1.0, 3.0])
def test_children_and_giants_keep_the_unit_of_their_file(size):
    corrected = correct_stated_unit(enlarged(size, walk()), 1.0)

    assert stature(corrected) == pytest.approx(size * stature(walk()))
    assert not describe_guesses(corrected)
