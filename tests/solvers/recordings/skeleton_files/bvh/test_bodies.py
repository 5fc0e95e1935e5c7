"""A BVH file with several ROOTs has several bodies."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.motion import Motion
from solvers.recordings import list_bodies, read_bvh, read_recording
from solvers.recordings.skeleton_files.bvh.writing import write_bvh
from solvers.rotations import multiply, rotate

SWORD = """ROOT sword
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  End Site
  {
    OFFSET 0 15 0
  }
}
"""
SWORD_FRAME = "5 17 5 0 0 0"
N_FRAMES = 40


def parts(path):
    """Return hierarchy, line of the frame time, and the first frames of a file."""
    hierarchy, motion = path.read_text().split("MOTION")
    lines = [line for line in motion.splitlines() if line.strip()]
    return hierarchy.split("HIERARCHY")[1].strip() + "\n", lines[1], lines[2 : 2 + N_FRAMES]


@pytest.fixture
def duet(recordings, tmp_path):
    """Two walkers and a sword in one file, and each walker alone."""
    walks = [recordings / f"mocap/cmu_walk/{name}.bvh" for name in ("05_01", "07_01")]
    return together(walks, tmp_path)


def together(walks, folder):
    """Write two walkers and a sword in one file, and each walker alone; return the folder."""
    walks = [parts(path) for path in walks]
    for number, (tree, time, frames) in enumerate(walks):
        text = "\n".join([
            "HIERARCHY\n" + tree + "MOTION",
            f"Frames: {N_FRAMES}",
            time,
            *frames,
        ])
        (folder / f"{number}.bvh").write_text(text + "\n")
    rows = zip(walks[0][2], [SWORD_FRAME] * N_FRAMES, walks[1][2], strict=True)
    text = [
        "HIERARCHY\n" + walks[0][0] + SWORD + walks[1][0] + "MOTION",
        f"Frames: {N_FRAMES}", walks[0][1], *(" ".join(row) for row in rows),
    ]  # fmt: skip
    (folder / "duet.bvh").write_text("\n".join(text) + "\n")
    return folder


def test_each_root_is_a_body_and_a_small_one_a_prop(duet):
    listed = [(body.name, body.is_person) for body in list_bodies(duet / "duet.bvh")]

    assert listed == [("Hips", True), ("sword", False), ("Hips_2", True)]


@pytest.mark.parametrize(("number", "body"), [(0, "Hips"), (1, "Hips_2")])
def test_a_body_among_others_moves_as_alone(duet, number, body):
    found = read_recording(duet / "duet.bvh", body=body)
    alone = read_recording(duet / f"{number}.bvh")

    assert found.skeleton.names == alone.skeleton.names
    assert_allclose(found.rotations, alone.rotations, atol=1e-12)
    assert_allclose(found.root_positions, alone.root_positions, atol=1e-12)


def test_all_bodies_turn_as_the_first_whose_rest_pose_is_different(recordings, tmp_path):
    """Z is up in the motion and Y in the rest pose, as some programs write it."""
    half = np.sqrt(0.5)
    rotation = np.array([half, half, 0.0, 0.0])
    for name in ("05_01", "07_01"):
        walk = read_bvh(recordings / f"mocap/cmu_walk/{name}.bvh").slice(1, N_FRAMES + 1)
        rotations = walk.rotations.copy()
        rotations[:, 0] = multiply(rotation, rotations[:, 0])
        lying = rotate(rotation, walk.root_positions)
        write_bvh(
            Motion(walk.skeleton, rotations, lying, walk.frame_rate), tmp_path / f"{name}.bvh"
        )
    together([tmp_path / "05_01.bvh", tmp_path / "07_01.bvh"], tmp_path)

    for number, body in enumerate(("Hips", "Hips_2")):
        found = read_recording(tmp_path / "duet.bvh", body=body)
        alone = read_recording(tmp_path / f"{number}.bvh")
        assert alone.conventions.rest_up != alone.conventions.up
        assert_allclose(found.skeleton.offsets, alone.skeleton.offsets, atol=1e-9)
        assert_allclose(found.root_positions, alone.root_positions, atol=1e-9)
        assert found.conventions.rest_up == alone.conventions.rest_up


def test_a_prop_has_the_unit_of_the_actor(duet):
    sword, actor = (read_recording(duet / "duet.bvh", body=body) for body in ("sword", "Hips"))

    assert sword.conventions.unit == actor.conventions.unit
    assert_allclose(sword.skeleton.offsets[1, 2], 15.0 * actor.conventions.unit)


def test_without_a_choice_the_first_actor_is_read_with_a_report(duet, collected_messages):
    messages, progress = collected_messages

    motion = read_bvh(duet / "duet.bvh", progress=progress)

    assert_allclose(motion.rotations, read_bvh(duet / "0.bvh").rotations, atol=1e-12)
    assert any("Left out: sword (prop" in message for message in messages)
