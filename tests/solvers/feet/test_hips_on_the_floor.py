"""Hips of an actor who sits or lies stay where they touch the floor, and roll there."""

from functools import cache

import numpy as np
import pytest

from solvers.arrays import Flags
from solvers.feet import PlantSettings, find_legs, find_supports, plant_feet
from solvers.feet.body_supports import SUPPORTS, detect_supports
from solvers.motion import Motion, Skeleton, find_humanoid_map
from solvers.recordings import read_acclaim
from solvers.samples import walker_skeleton
from tests.benchmarks.contacts.weightless_feet import made_takes
from tests.benchmarks.shared.clips import every

HIPS = SUPPORTS.index("hips")
SITS = made_takes()["sits on the floor, a leg slides"]


@cache
def lying(recordings) -> Motion:
    """Return an actor who lies down; the hips are on the floor from frame 80 on."""
    path = recordings / "mocap/hdm05/HDM_bd_lieDownFloor_001_120.amc"
    return every(read_acclaim(path), 4)


def detected(motion: Motion) -> Flags:
    """Return contacts of all parts, those of feet left out."""
    humanoid = find_humanoid_map(motion.skeleton)
    supports = detect_supports(motion, humanoid, find_legs(motion.skeleton, humanoid))
    return np.hstack([np.zeros((motion.n_frames, 2), np.bool_), supports])


def swaying(motion: Motion) -> Motion:
    """Return the body, whose root sways by 3 cm to both sides every four seconds."""
    time = np.arange(motion.n_frames) / motion.frame_rate
    roots = motion.root_positions.copy()
    roots[:, 0] += 0.03 * np.sin(2.0 * np.pi * 0.25 * time)
    return motion.with_poses(root_positions=roots)


def test_hips_of_an_actor_who_lies_are_nearer_to_the_truth(recordings):
    truth = lying(recordings)
    given = swaying(truth)

    planted = plant_feet(given, detected(given))

    assert planted.supports[85:, HIPS].all() and not planted.supports[:70, HIPS].any()
    errors = [
        np.std((motion.root_positions - truth.root_positions)[85:, :2], axis=0)
        for motion in (given, planted.motion)
    ]
    assert np.linalg.norm(errors[1]) < 0.5 * np.linalg.norm(errors[0])
    trunk = [given.skeleton.index(name) for name in ("root", "lowerback", "thorax", "head")]
    assert (planted.motion.rotations[:, trunk] == given.rotations[:, trunk]).all()


def test_seat_stays_where_it_is():
    given = swaying(SITS)

    planted = plant_feet(given, detected(given))

    assert planted.supports[:, HIPS].all()
    assert np.ptp(planted.motion.root_positions[:, 0]) < 0.005


def test_hips_that_may_not_move_stay_as_they_are():
    given = swaying(SITS)

    planted = plant_feet(given, detected(given), settings=PlantSettings(move_root=False))

    assert (planted.motion.root_positions == given.root_positions).all()
    assert not planted.supports.any()


@pytest.mark.parametrize("speed", [0.3, 0.6])
def test_hips_that_slide_over_the_floor_do_not_count(speed):
    time = np.arange(SITS.n_frames) / SITS.frame_rate
    roots = SITS.root_positions + speed * time[:, None] * [0.0, 1.0, 0.0]

    assert not detected(SITS.with_poses(root_positions=roots)).any()


def test_hips_are_held_only_where_contacts_are_given():
    assert not plant_feet(swaying(SITS)).supports.any()


def test_hips_on_a_chair_do_not_count():
    roots = SITS.root_positions.copy()
    roots[:, 2] += 0.4
    rotations = SITS.rotations.copy()
    for side in ("Left", "Right"):
        thigh, shin = (SITS.skeleton.index(f"{side}{part}") for part in ("UpLeg", "Leg"))
        rotations[:, [thigh, shin]] = rotations[:1, [thigh, shin]]
        rotations[:, shin] = rotations[:, thigh] * [1.0, -1.0, -1.0, -1.0]

    assert not detected(SITS.with_poses(rotations, roots)).any()


def test_surface_is_that_of_the_pelvis_whatever_way_the_rest_pose_faces():
    skeleton = walker_skeleton()
    offsets = {}
    for name, rotation in (("as it is", np.eye(3)), ("turned", np.diag([-1.0, -1.0, 1.0]))):
        rotated = Skeleton(skeleton.names, skeleton.parents, skeleton.offsets @ rotation)
        hips = find_supports(rotated, find_humanoid_map(rotated))[-1]
        offsets[name] = np.array([point.offset for point in hips.points]) @ rotation

    assert hips.name == "hips" and hips.chain == ()
    assert offsets["turned"] == pytest.approx(offsets["as it is"])
    child = Skeleton(skeleton.names, skeleton.parents, 0.5 * skeleton.offsets)
    hips = find_supports(child, find_humanoid_map(child))[-1]
    assert [point.offset for point in hips.points] == pytest.approx(0.5 * offsets["as it is"])
    left, right = offsets["as it is"][::2], offsets["as it is"][1::2]
    assert right == pytest.approx(left * [-1.0, 1.0, 1.0])
    assert left[0, 2] < -0.05 < 0.04 < left[0, 0] < left[:, 0].max() < 0.2
