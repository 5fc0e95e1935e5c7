"""Whatever axes a program writes, the actor stands, in true size."""

import numpy as np
import pytest

from solvers.motion import Motion, Skeleton, find_humanoid_map, world_poses
from solvers.recordings import read_bvh
from solvers.recordings.conventions.axes import rotation_to_z_up
from solvers.recordings.skeleton_files.bvh.writing import write_bvh
from solvers.rotations import inverse, multiply, rotate

AXES = ("X", "Y", "Z", "-X", "-Y", "-Z")


@pytest.fixture
def walk(recordings) -> Motion:
    motion = read_bvh(recordings / "mocap/cmu_walk/07_01.bvh")
    return motion.slice(1, 200)


def turned(motion: Motion, axis: str, *, rest_too: bool) -> Motion:
    """Return the motion as it would be read from a file with another axis up."""
    rotation = inverse(rotation_to_z_up(axis))
    rest_rotation = rotation if rest_too else np.array([1.0, 0.0, 0.0, 0.0])
    rotations = multiply(multiply(rest_rotation, motion.rotations), inverse(rest_rotation))
    rotations[:, 0] = multiply(
        multiply(rotation, motion.rotations[:, 0]), inverse(rest_rotation)
    )
    offsets = rotate(rest_rotation, motion.skeleton.offsets)
    skeleton = Skeleton(motion.skeleton.names, motion.skeleton.parents, offsets)
    return Motion(
        skeleton, rotations, rotate(rotation, motion.root_positions), motion.frame_rate
    )


@pytest.mark.parametrize("rest_too", [True, False])
@pytest.mark.parametrize("axis", AXES)
def test_any_axis_may_be_up(walk, tmp_path, axis, rest_too):
    write_bvh(turned(walk, axis, rest_too=rest_too), tmp_path / "turned.bvh")

    read = read_bvh(tmp_path / "turned.bvh")

    there, here = (world_poses(m.skeleton, m.rotations, m.root_positions) for m in (walk, read))
    assert np.allclose(here.positions, there.positions, atol=1e-3)
    assert np.allclose(read.skeleton.offsets[1:], walk.skeleton.offsets[1:], atol=1e-4)


@pytest.mark.parametrize("axis", AXES)
def test_an_axis_that_is_given_is_taken(walk, tmp_path, axis):
    write_bvh(walk, tmp_path / "walk.bvh")

    read = read_bvh(tmp_path / "walk.bvh", up=axis)

    assert np.allclose(
        read.root_positions, rotate(rotation_to_z_up(axis), walk.root_positions), atol=1e-3
    )


def test_a_lying_actor_is_left_lying_and_reported(walk, tmp_path):
    """Asleep next to the origin, 10 cm above the floor, with a rest pose that stands."""
    rotation = np.array([np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0])
    rotations = walk.rotations.copy()
    rotations[:, 0] = multiply(rotation, rotations[:1, 0])
    rotations[:, 1:] = rotations[:1, 1:]
    root_positions = np.broadcast_to((1.0, 3.0, 0.1), walk.root_positions.shape)
    write_bvh(
        Motion(walk.skeleton, rotations, root_positions, walk.frame_rate), tmp_path / "lie.bvh"
    )
    messages = []

    read = read_bvh(
        tmp_path / "lie.bvh", progress=lambda _, message="": messages.append(message)
    )

    assert np.allclose(read.root_positions, root_positions, atol=1e-3)
    assert any("Y is interpreted as up" in message for message in messages)


@pytest.mark.parametrize("n_frames", [1, 100])
def test_who_stands_like_the_rest_pose_next_to_zero_is_no_question(walk, tmp_path, n_frames):
    """In the space of a camera, a shoulder may be at zero and the feet far from it."""
    start = walk.root_positions[:1] - (0.25, 0.0, 0.0)
    positions = 0.02 * (walk.root_positions - walk.root_positions[:1]) + start - (0, 0, 2.0)
    stands = Motion(walk.skeleton, walk.rotations, positions, walk.frame_rate)
    write_bvh(stands.slice(0, n_frames), tmp_path / "stand.bvh")
    messages = []

    read_bvh(tmp_path / "stand.bvh", progress=lambda _, message="": messages.append(message))

    assert not any("is interpreted as up" in message for message in messages)


@pytest.mark.parametrize("along", np.arange(-1.2, 1.3, 0.2))
def test_who_lies_with_a_rest_pose_that_leans_is_a_question(walk, tmp_path, along):
    """Feet at zero made an actor of ACCAD stand up without a word."""
    lean = np.array([np.cos(np.radians(20.0)), np.sin(np.radians(20.0)), 0.0, 0.0])
    on_back = np.array([np.sqrt(0.5), np.sqrt(0.5), 0.0, 0.0])
    skeleton = Skeleton(
        walk.skeleton.names, walk.skeleton.parents, rotate(lean, walk.skeleton.offsets)
    )
    rotations = np.zeros_like(walk.rotations)
    rotations[..., 0] = 1.0
    rotations[:, 0] = multiply(on_back, inverse(lean))
    root_positions = np.broadcast_to((1.0, along, 0.1), walk.root_positions.shape)
    take = Motion(skeleton, rotations, root_positions, walk.frame_rate)
    write_bvh(take, tmp_path / "lie.bvh")
    messages = []

    read = read_bvh(
        tmp_path / "lie.bvh", progress=lambda _, message="": messages.append(message)
    )

    lies = np.allclose(read.root_positions, root_positions, atol=1e-3)
    assert lies or any("the take does not show it clearly" in message for message in messages)


@pytest.mark.parametrize(
    ("file", "travel"),
    [
        ("bandai_namco/dataset-1_bow_active_001.bvh", 0.3),
        ("bandai_namco/dataset-1_walk-left_old_001.bvh", 4.3),
        ("bandai_namco/dataset-1_walk_tired_001.bvh", 8.0),
        ("pybvh_test3/bvh_test3.bvh", 0.0),
        ("olympe_ballet/ballet.bvh", 0.4),
        ("smpl_momask/momask_out.bvh", 0.6),
    ],
)
def test_files_of_other_tools_stand_in_true_size(recordings, file, travel):
    motion = read_bvh(recordings / "corpus/bvh" / file)

    roles = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
    poses = world_poses(motion.skeleton, motion.rotations, motion.root_positions)
    head, hips = poses.positions[:, roles["head"]], poses.positions[:, roles["hips"]]
    up = (head - hips) / np.linalg.norm(head - hips, axis=1, keepdims=True)
    assert np.median(up[:, 2]) > 0.9
    assert 1.2 < np.median(np.ptp(poses.positions[..., 2], axis=1)) < 1.9
    assert np.linalg.norm(np.ptp(hips[:, :2], axis=0)) == pytest.approx(travel, abs=0.15)


@pytest.mark.parametrize("start_cm", [15.0, 30.0])
@pytest.mark.parametrize("style", ["run_angry", "walk_tired"])
def test_who_passes_zero_with_a_rest_pose_that_lies_is_no_question(
    recordings, tmp_path, style, start_cm
):
    """Feet that rest show which axis of Bandai-Namco's takes is up."""
    name = f"corpus/bvh/bandai_namco/dataset-1_{style}_001.bvh"
    head, rows = (recordings / name).read_text().split("Frame Time:")
    rate, *frames = rows.strip().splitlines()
    values = np.array([frame.split() for frame in frames], dtype=float)
    values[:, 0] += start_cm - values[0, 0]
    lines = (" ".join(f"{value:.4f}" for value in row) for row in values)
    (tmp_path / "a.bvh").write_text("\n".join([f"{head}Frame Time:{rate}", *lines]))
    messages = []

    read_bvh(tmp_path / "a.bvh", progress=lambda _, message="": messages.append(message))

    assert not any("the take does not show it clearly" in message for message in messages)
