"""Bones of Motive and segments of QTM become the motion of a skeleton, or points."""

import numpy as np
import pytest
from exports.studio_tables import BODY, motive, motive_bones, qualisys_skeleton, waving
from numpy.testing import assert_allclose

from solvers.motion import Motion, Tracks, find_humanoid_map, world_poses
from solvers.recordings import list_bodies, read_recording


def z_up(positions):
    x, y, z = np.moveaxis(positions, -1, 0)
    return np.stack([x, -z, y], axis=-1)


def joints(motion):
    poses = world_poses(motion.skeleton, motion.rotations, motion.root_positions)
    return poses.positions


@pytest.mark.parametrize("parents", [True, False])
@pytest.mark.parametrize("actor", ["Anna:", "Anna_", ""])
def test_bones_of_motive_become_a_skeleton(read_any, parents, actor):
    motion = read_any(motive(motive_bones(actor), parents=parents))

    assert isinstance(motion, Motion)
    assert set(motion.skeleton.names) == set(BODY)
    assert find_humanoid_map(motion.skeleton).score > 0.9
    order = [list(BODY).index(name) for name in motion.skeleton.names]
    assert_allclose(joints(motion), z_up(waving()[0][:, order]), atol=1e-5)


def test_bones_relative_to_parents_become_the_same_motion(read_any):
    columns = motive_bones()
    positions, rotations = waving()
    names = list(BODY)
    for bone, (parent, offset) in enumerate(BODY.values()):
        if not parent:
            continue
        above = names.index(parent)
        local = np.arctan2(rotations[:, bone, 3], rotations[:, bone, 0]) - np.arctan2(
            rotations[:, above, 3], rotations[:, above, 0]
        )
        zero = np.zeros(6)
        for part, cells in enumerate((zero, zero, np.sin(local), np.cos(local))):
            columns[7 * bone + part] = (*columns[7 * bone + part][:4], cells)
        for part in range(3):
            cells = np.full(6, offset[part])
            columns[7 * bone + 4 + part] = (*columns[7 * bone + 4 + part][:4], cells)

    motion = read_any(motive(columns, fields={"Coordinate Space": "Local"}))

    order = [names.index(name) for name in motion.skeleton.names]
    assert_allclose(joints(motion), z_up(positions[:, order]), atol=1e-5)


def test_euler_angles_of_motive_are_applied_in_their_order(read_any):
    positions, rotations = waving()
    columns = []
    for bone, (name, (parent, _)) in enumerate(BODY.items()):
        angle = np.degrees(2.0 * np.arctan2(rotations[:, bone, 3], rotations[:, bone, 0]))
        zero = np.zeros(6)
        for axis, cells in zip("XYZ", (zero, zero, angle), strict=True):
            columns.append(("Bone", f"A:{name}", f"A:{parent}", f"Rotation {axis}", cells))
        for part, axis in enumerate("XYZ"):
            cells = positions[:, bone, part]
            columns.append(("Bone", f"A:{name}", f"A:{parent}", f"Position {axis}", cells))

    motion = read_any(motive(columns, fields={"Rotation Type": "XYZ"}))

    order = [list(BODY).index(name) for name in motion.skeleton.names]
    assert_allclose(joints(motion), z_up(positions[:, order]), atol=1e-5)


def test_skeleton_in_most_frames_is_read_with_a_report(read_any, collected_messages):
    other = motive_bones("Ben:")
    hidden = [(*rest, np.where(np.arange(6) < 3, cells, np.nan)) for *rest, cells in other]

    motion = read_any(motive(hidden + motive_bones("Anna:")), progress=collected_messages[1])

    assert np.isfinite(motion.root_positions).all()
    (message,) = [each for each in collected_messages[0] if "Left out" in each]
    assert message.startswith("Body Anna of 2. Left out: Ben (")


def test_each_skeleton_of_motive_can_be_chosen(make_writer):
    path = make_writer("take.csv")(motive(motive_bones("Ben:") + motive_bones("Anna:")))

    assert [body.name for body in list_bodies(path)] == ["Ben", "Anna"]
    found = [read_recording(path, body=name) for name in ("Ben", "Anna", "2")]
    assert all(isinstance(each, Motion) for each in found)
    assert_allclose(joints(found[0]), joints(found[1]))


def test_separated_bones_become_points_with_a_report(read_any, collected_messages):
    columns = motive_bones()
    noise = np.random.default_rng(1).normal(size=(len(columns), 6))
    torn = [
        (*rest, cells + noise[number] if "Position" in rest[3] else cells)
        for number, (*rest, cells) in enumerate(columns)
    ]

    tracks = read_any(motive(torn), progress=collected_messages[1])

    assert isinstance(tracks, Tracks)
    assert any("without their rotations" in message for message in collected_messages[0])


def test_a_skeleton_of_qualisys_stands_and_moves_as_recorded(read_any):
    motion = read_any(qualisys_skeleton())

    assert isinstance(motion, Motion)
    assert find_humanoid_map(motion.skeleton).score > 0.9
    positions = z_up(waving()[0])
    hand = list(BODY).index("LHand")
    assert_allclose(
        joints(motion)[:, motion.skeleton.names.index("LeftHand")],
        positions[:, hand],
        atol=1e-5,
    )
