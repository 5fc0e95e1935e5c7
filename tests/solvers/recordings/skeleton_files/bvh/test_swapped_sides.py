"""Skeletons from left-handed axes, whose left side is on the right, are mirrored back."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.motion import Motion, Skeleton, world_poses
from solvers.recordings import (
    Axis,
    ReadingSettings,
    list_bodies,
    read_as,
    read_bvh,
    read_recording,
    write_bvh,
)
from solvers.recordings.conventions import SWAPPED
from solvers.recordings.skeleton_files.smpl_bodies.joints import smpl_joints
from solvers.rotations import multiply, quaternion_from_euler

F, RATE = 90, 30.0
NAMES, PARENTS, Y_UP_OFFSETS = smpl_joints(hands=False)
OFFSETS = Y_UP_OFFSETS @ np.array([[1.0, 0, 0], [0, 0, 1.0], [0, -1.0, 0]])
"""Z up, facing -Y."""
ACROSS = np.array([-1.0, 1.0, 1.0])
TOES, HEEL = (0.0, -0.13, -0.05), (0.0, 0.13, -0.05)
"""Ends of a foot, relative to the ankle."""
SWORD = """ROOT sword
{
OFFSET 0 0 0
CHANNELS 3 Xposition Yposition Zposition
End Site
{
OFFSET 0 80 0
}
}
"""


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


def with_feet(toes, *, name: str = "foot", **take) -> Motion:
    """Return squats whose toes are elsewhere, relative to the ankle, or have another name."""
    motion = squats(**take)
    offsets = motion.skeleton.offsets.copy()
    offsets[[NAMES.index("left_foot"), NAMES.index("right_foot")]] = toes
    names = tuple(each.replace("foot", name) for each in NAMES)
    return Motion(
        Skeleton(names, PARENTS, offsets), motion.rotations, motion.root_positions, RATE
    )


def as_read(motion: Motion, path, *, without: str = "") -> tuple[Motion, str]:
    """Write and read a take without some joints; return it with the messages."""
    kept = [k for k, name in enumerate(NAMES) if not without or without not in name]
    skeleton = Skeleton(
        tuple(motion.skeleton.names[k] for k in kept),
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
    skeleton = Skeleton(motion.skeleton.names, PARENTS, ACROSS * motion.skeleton.offsets)
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
    _, messages = as_read(with_feet(HEEL), tmp_path / "a.bvh")

    assert SWAPPED not in messages


def test_straight_knees_a_little_behind_show_no_front(tmp_path):
    """Captured knees are up to 5 % behind the line from hip to ankle."""
    take = with_feet(HEEL, name="ankle_end", knees=0.0)
    for side in ("left", "right"):
        take.skeleton.offsets[NAMES.index(f"{side}_knee"), 1] += 0.03
        take.skeleton.offsets[NAMES.index(f"{side}_ankle"), 1] -= 0.03

    _, messages = as_read(take, tmp_path / "a.bvh")

    assert SWAPPED not in messages


def test_knees_as_bent_as_of_a_walk_show_the_front(tmp_path):
    take = with_feet(TOES, name="ankle_end", knees=0.7)

    _, messages = as_read(in_left_handed_axes(take), tmp_path / "a.bvh")

    assert SWAPPED in messages


@pytest.mark.parametrize(("foot", "swapped"), [(TOES, True), (HEEL, False)])
def test_elbows_show_the_front_of_who_stands_straight(tmp_path, foot, swapped):
    """Feet that end somewhere are no toes; bent elbows are behind the arm."""
    take = with_feet(foot, name="ankle_end", knees=0.0)
    for side, sign in (("left", -1.0), ("right", 1.0)):
        bend = quaternion_from_euler([0.0, 0.0, sign], "XYZ")
        take.rotations[:, NAMES.index(f"{side}_elbow")] = bend
    take = in_left_handed_axes(take) if swapped else take

    _, messages = as_read(take, tmp_path / "a.bvh")

    assert (SWAPPED in messages) == swapped


def test_toes_that_point_down_show_no_front(tmp_path):
    """Feet of the rest pose of some rigs are those of a dancer."""
    _, messages = as_read(with_feet((0.0, 0.02, -0.13), knees=0.0), tmp_path / "a.bvh")

    assert SWAPPED not in messages


def test_an_animal_with_the_names_of_a_person_stays_as_it_is(tmp_path):
    """Its trunk is horizontal, and its front legs are longer than arms."""
    take = in_left_handed_axes(squats())
    for joint, name in enumerate(NAMES):
        if name.startswith(("spine", "neck", "head")):
            across, back, up = take.skeleton.offsets[joint]
            take.skeleton.offsets[joint] = 2.0 * np.array([across, -up, back])
        elif name.endswith(("elbow", "wrist")):
            take.skeleton.offsets[joint] *= 1.8

    _, messages = as_read(take, tmp_path / "a.bvh")

    assert SWAPPED not in messages


def test_all_bodies_and_props_of_a_file_are_mirrored(tmp_path, collected_messages):
    """They are in one scene, even if the front of some does not show."""
    trees, rows = [], []
    for take in (squats(), with_feet(HEEL, name="ankle_end", knees=0.0)):
        as_read(in_left_handed_axes(take), tmp_path / "one.bvh")
        tree, frames = (tmp_path / "one.bvh").read_text().split("MOTION")
        trees.append(tree.removeprefix("HIERARCHY"))
        rows.append(frames.splitlines()[3:])
    lines = (" ".join([*row, "70 90 -20"]) for row in zip(*rows, strict=True))
    head = [
        f"HIERARCHY{''.join(trees)}{SWORD}MOTION",
        f"Frames: {F}",
        f"Frame Time: {1 / RATE}",
    ]
    (tmp_path / "all.bvh").write_text("\n".join([*head, *lines]))
    messages, progress = collected_messages

    first, second, sword = (
        read_recording(tmp_path / "all.bvh", body=body.name)
        for body in list_bodies(tmp_path / "all.bvh", progress=progress)
    )

    knees = ("left_knee", "right_knee")
    assert_allclose(joints_of(first, knees), joints_of(squats(), knees), atol=1e-4)
    assert_allclose(joints_of(second, knees), joints_of(squats(knees=0.0), knees), atol=1e-4)
    assert_allclose(sword.root_positions, [[-0.7, 0.2, 0.9]] * F, atol=1e-4)
    assert messages.count(SWAPPED) == 1


@pytest.mark.parametrize(("forward", "opposite"), [("x", "-x"), ("-x", "x"), ("z", "z")])
def test_forward_is_an_axis_of_the_file_that_is_mirrored(tmp_path, forward, opposite):
    """In left-handed axes X is where -X is otherwise."""
    write_bvh(squats(), tmp_path / "right.bvh")
    write_bvh(in_left_handed_axes(squats()), tmp_path / "left.bvh")

    left, right = (
        read_as(tmp_path / f"{name}.bvh", ReadingSettings(up=Axis.Y, forward=Axis(axis)))
        for name, axis in (("left", forward), ("right", opposite))
    )

    assert_allclose(joints_of(left), joints_of(right), atol=1e-4)
