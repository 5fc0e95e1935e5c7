"""Heels stay above the ground, and toes flex within their range, for any source."""

import numpy as np
import pytest
from rigs import mixamo

from solvers.motion import (
    Motion,
    Skeleton,
    Tracks,
    detect_contacts,
    find_humanoid_map,
    foot_points,
    forward_kinematics,
    joint_parents,
    motion_from_points,
)
from solvers.recordings import read_recording
from solvers.retargeting import RetargetSettings, retarget
from solvers.rotations.representations import rotate
from solvers.samples import walking_gait

RIG = mixamo()
FEET = [
    [RIG.index(f"mixamorig:{side}{bone}") for bone in ("Foot", "ToeBase", "Toe_end")]
    for side in ("Left", "Right")
]
DEFAULTS = RetargetSettings()
ACROSS, FORWARD = np.array([1.0, 0.0, 0.0]), np.array([0.0, -1.0, 0.0])
SENSED = ("msr_action3d/a11_s03_e03", "msr_action3d/a13_s01_e01", "irds/215_18_0_5_1")
TAKES = ("cmu_walk/07_05.bvh", "cmu_walk/07_01.bvh", "05_13.amc")


@pytest.mark.parametrize("take", SENSED)
def test_sensor_feet_below_the_floor_do_not_flex_the_toes(recordings, take):
    """Sensors track no tips of toes; the toes used to compensate for the missing height."""
    folder, name = take.split("/")
    path = next((recordings / "kinect" / folder).glob(f"{name}*"))

    result = retargeted_to(sensor_motion(read_recording(path)))

    assert np.nanmax(toe_flexion_deg(result)) < 60.0


@pytest.mark.parametrize("take", TAKES)
def test_heels_stay_above_ground_and_toes_in_the_foot_plane(recordings, take):
    motion = first_frames(read_recording(recordings / "mocap" / take))

    result = retargeted_to(motion)

    world = forward_kinematics(result)
    in_contact = detect_contacts(motion)
    ankles = foot_points(RIG, find_humanoid_map(RIG))[:, 0]
    heights = world.positions[:, ankles, 2] - RIG.rest_positions[ankles, 2]
    assert heights[in_contact].min() > -0.01
    for foot, ball, tip in FEET:
        toes = world.positions[:, tip] - world.positions[:, ball]
        across = rotate(world.rotations[:, foot], ACROSS)
        offset = (toes * across).sum(axis=1) / np.linalg.norm(toes, axis=1)
        assert np.degrees(np.arcsin(np.abs(offset).max())) < 10.0
        low = world.positions[:, [ball, tip], 2] - RIG.rest_positions[[ball, tip], 2]
        assert low[:, 0].min() > -0.007
        assert low[:, 1].min() > -0.045
    free = toe_flexion_deg(retargeted_to(motion, settings=RetargetSettings(keep_feet=False)))
    at_rest = toe_flexion_deg(resting(motion.n_frames)).max()
    assert (toe_flexion_deg(result) < np.maximum(free, at_rest + 32.0) + 8.0).all()


def test_tails_that_prolong_the_shins_are_no_feet():
    """Importers of glTF invent such tails; the body sank by the length of a shin."""
    walk = walking_gait()
    skeleton = walk.skeleton
    feet = [skeleton.index(f"{side}Foot") for side in ("Left", "Right")]
    toes = {joint for foot in feet for joint in skeleton.subtree(foot)} - {*feet}
    kept = [joint for joint in range(skeleton.n_joints) if joint not in toes]
    bare = skeleton.select(kept)
    ends = [bare.index(skeleton.names[foot]) for foot in feet]
    tailed = Skeleton(
        (*bare.names, *(f"{bare.names[foot]}_end" for foot in ends)),
        (*bare.parents, *ends),
        np.concatenate([bare.offsets, bare.offsets[ends]]),
    )
    still = np.tile((1.0, 0.0, 0.0, 0.0), (walk.n_frames, 2, 1))
    rotations = np.concatenate([walk.rotations[:, kept], still], axis=1)
    motion = Motion(tailed, rotations, walk.root_positions, walk.frame_rate)

    heights = forward_kinematics(retargeted_to(motion)).positions[..., 2]

    ankles = [ankle for ankle, _, _ in FEET]
    assert heights[:, ankles].min(axis=0) == pytest.approx(
        RIG.rest_positions[ankles, 2], abs=0.03
    )


def angle(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    lengths = np.linalg.norm(one, axis=-1) * np.linalg.norm(other, axis=-1)
    return np.degrees(np.arccos(np.clip((one * other).sum(axis=-1) / lengths, -1.0, 1.0)))


def toe_flexion_deg(motion: Motion) -> np.ndarray:
    """Flexion of the balls of both feet, shape (2, n_frames), degrees."""
    positions = forward_kinematics(motion).positions
    return np.array([
        angle(positions[:, ball] - positions[:, foot], positions[:, tip] - positions[:, ball])
        for foot, ball, tip in FEET
    ])


def sensor_motion(recording) -> Motion:
    connected = [
        j for j, up in enumerate(recording.parents) if up >= 0 or j in recording.parents
    ]
    names = tuple(recording.tracks.names[joint] for joint in connected)
    tracks = Tracks(
        names, recording.tracks.positions[:300, connected], recording.tracks.frame_rate
    )
    return motion_from_points(tracks, joint_parents(names))


def first_frames(motion: Motion) -> Motion:
    """Every second of the first 900 frames, without the T-pose."""
    few = slice(3, 900, 2)
    return Motion(
        motion.skeleton, motion.rotations[few], motion.root_positions[few],
        motion.frame_rate / 2.0,
    )  # fmt: skip


def resting(n_frames: int) -> Motion:
    rotations = np.zeros((n_frames, RIG.n_joints, 4))
    rotations[..., 0] = 1.0
    return Motion(RIG, rotations, np.zeros((n_frames, 3)), 60.0)


def retargeted_to(
    motion: Motion, rig: Skeleton = RIG, settings: RetargetSettings = DEFAULTS
) -> Motion:
    humanoid = find_humanoid_map(motion.skeleton)
    return retarget(motion, humanoid, rig, find_humanoid_map(rig), settings=settings)


def test_a_joint_straight_below_the_ankle_is_no_direction_of_the_foot():
    """In some files the joint below the ankle is at the sole, and the tip in front of it."""
    walk = walking_gait()
    skeleton = walk.skeleton
    offsets, names = skeleton.offsets.copy(), list(skeleton.names)
    for side in ("Left", "Right"):
        ball = skeleton.index(f"{side}ToeBase")
        offsets[ball], offsets[ball + 1] = (0.0, 0.0, offsets[ball][2]), (0.0, -0.2, 0.0)
        names[ball], names[ball + 1] = f"{side}ForeFoot", f"{side}ForeFoot_end"
    stub = Skeleton(tuple(names), skeleton.parents, offsets)

    result, expected = (
        retargeted_to(Motion(each, walk.rotations, walk.root_positions, walk.frame_rate))
        for each in (stub, skeleton)
    )

    for foot, _, _ in FEET:
        one, other = (
            forward_kinematics(each).rotations[:, foot] for each in (result, expected)
        )
        cosines = (rotate(one, -ACROSS[[1, 0, 2]]) * rotate(other, -ACROSS[[1, 0, 2]])).sum(
            axis=1
        )
        assert np.degrees(np.arccos(np.median(cosines))) < 20.0
