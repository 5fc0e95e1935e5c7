"""What is written as BVH comes back, and what cannot be written is not half written."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidMotionError, InvalidSettingError
from solvers.motion import Motion, Skeleton
from solvers.recordings import read_bvh, write_bvh
from solvers.rotations.representations import quaternion_from_rotation_vector


def test_end_sites_are_written_only_if_they_survive_reading(leg, tmp_path):
    """An end that turns, or has a name of its own, is a joint."""
    rotations = np.tile([1.0, 0, 0, 0], (2, 4, 1))
    rotated = rotations.copy()
    rotated[1, 3] = quaternion_from_rotation_vector([0.1, 0.2, 0.0])
    position = np.tile([0, 0, 0.9], (2, 1))
    renamed = Skeleton(("hip", "knee", "ankle", "toe_end"), leg.parents, leg.offsets)

    for motion, n_ends in [
        (Motion(leg, rotations, position, 30.0), 1),
        (
            Motion(leg, rotated, position, 30.0),
            1,
        ),  # The end of the end: many programs want one.
        (Motion(renamed, rotations, position, 30.0), 1),
    ]:
        write_bvh(motion, tmp_path / "leg.bvh")
        back = read_bvh(tmp_path / "leg.bvh")
        assert back.skeleton.names == motion.skeleton.names
        assert_allclose(back.rotations, motion.rotations, atol=1e-8)
        text = (tmp_path / "leg.bvh").read_text()
        assert text.count("End Site") == n_ends


@pytest.mark.parametrize("height", [-1.2, -0.9, 0.0, 0.4, 0.9, 3.0])
def test_a_take_that_is_not_on_the_floor_keeps_its_place(swinging_leg, tmp_path, height):
    """The rest height is not added to hips near 0, as of takes of video models."""
    offsets = swinging_leg.skeleton.offsets.copy()
    offsets[0] = [0.1, -0.2, 0.95]
    skeleton = replace(swinging_leg.skeleton, offsets=offsets)
    path = swinging_leg.root_positions * (1.0, 1.0, 0.0) + (0.0, 0.0, height)
    motion = replace(swinging_leg, skeleton=skeleton, root_positions=path)

    write_bvh(motion, tmp_path / "leg.bvh")

    back = read_bvh(tmp_path / "leg.bvh", up="Y", scale=0.01)
    assert_allclose(back.root_positions, path, atol=1e-7)
    is_ambiguous = height < 0.95 / 2
    assert_allclose(back.skeleton.offsets[0], 0.0 if is_ambiguous else offsets[0], atol=1e-7)


def test_angles_do_not_jump(leg, tmp_path):
    """A joint that turns three times round is written so: -180 to 180 would flip."""
    time = np.linspace(0, 1, 200)
    vectors = np.zeros((200, 4, 3))
    vectors[:, 0, 2] = 6 * np.pi * time
    rotations = quaternion_from_rotation_vector(vectors)
    motion = Motion(leg, rotations, np.tile([0, 0, 0.9], (200, 1)), 100.0)

    write_bvh(motion, tmp_path / "turns.bvh")

    rows = np.loadtxt(
        (tmp_path / "turns.bvh").read_text().split("Frame Time")[1].splitlines()[1:]
    )
    assert np.abs(np.diff(rows[:, 3:6], axis=0)).max() < 6.0
    assert np.ptp(rows[:, 3:6], axis=0).max() == pytest.approx(1080.0, abs=0.01)


def test_gaps_are_refused_and_the_old_file_stays(swinging_leg, tmp_path):
    path = tmp_path / "leg.bvh"
    path.write_text("precious")
    rotations = swinging_leg.rotations.copy()
    rotations[7:9, 1] = np.nan

    with pytest.raises(InvalidMotionError, match=r"1 joints have gaps \(knee; .* frame 7\)"):
        write_bvh(swinging_leg.with_poses(rotations), path)

    assert path.read_text() == "precious"
    assert [each.name for each in tmp_path.iterdir()] == ["leg.bvh"]


@pytest.mark.parametrize("options", [{"order": "XYX"}, {"scale": 0.0}, {"scale": np.nan}])
def test_invalid_options_are_refused(swinging_leg, tmp_path, options):
    with pytest.raises(InvalidSettingError, match="positive scale"):
        write_bvh(swinging_leg, tmp_path / "leg.bvh", **options)


def test_a_chain_of_two_thousand_joints(tmp_path):
    """Ropes have long chains; nothing here recurses."""
    names = tuple(f"link {number}" for number in range(2000))
    rope = Skeleton(names, tuple(range(-1, 1999)), np.tile([0, 0, 0.01], (2000, 1)))
    motion = Motion(rope, np.tile([1.0, 0, 0, 0], (1, 2000, 1)), np.zeros((1, 3)), 30.0)

    write_bvh(motion, tmp_path / "rope.bvh")

    assert read_bvh(tmp_path / "rope.bvh").skeleton.names[1999] == "link_1999"
