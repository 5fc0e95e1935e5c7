"""Build a motion from joint positions without needless rotations."""

import numpy as np
import pytest
from kinect_walks import true_positions
from numpy.testing import assert_allclose
from upright_positions import POSITIONS

from solvers import samples
from solvers.errors import InvalidMotionError
from solvers.motion import (
    SENSOR_JOINTS,
    Motion,
    Sensor,
    Tracks,
    find_humanoid_map,
    forward_kinematics,
    joint_parents,
    motion_from_points,
)
from solvers.motion.humanoid import posture_joints
from solvers.reconstruction.joint_rotations.motion_from_positions import motion_from_positions
from solvers.recordings import read_recording
from solvers.rotations.representations import angle_between, rotate

NAMES = SENSOR_JOINTS[Sensor.KINECT_V1]
PARENTS = joint_parents(NAMES)
REAL = (
    "irds/215_18_0_5_1_stand.txt",
    "kimore/JointPositionExercise1.csv",
    "laban/Ges01_wavehand.csv",
    "msr_action3d/a01_s01_e01_skeleton3D.txt",
    "azure/joints_sync_1.csv",
    "ui_prmd/m01_s01_e04.npz",
)


def as_tracks(positions: np.ndarray) -> Tracks:
    return Tracks(NAMES, positions, 30.0)


@pytest.fixture(scope="module")
def walk() -> np.ndarray:
    return true_positions(samples, posture_joints)


def visible_positions(motion: Motion, tracks: Tracks) -> list[str]:
    return [name for name in motion.skeleton.names if name in tracks.names]


def position_errors(motion: Motion, tracks: Tracks) -> np.ndarray:
    """Distance of each joint from its tracked position, shape (n_frames, n_joints), meters."""
    own = [motion.skeleton.index(name) for name in visible_positions(motion, tracks)]
    reference = [tracks.names.index(name) for name in visible_positions(motion, tracks)]
    positions = forward_kinematics(motion).positions[:, own]
    return np.linalg.norm(positions - tracks.positions[:, reference], axis=-1)


def with_bone_lengths(positions, skeleton):
    """Move joints along their bones, from the root, to the lengths of the skeleton."""
    result = positions.copy()
    for joint, parent in enumerate(skeleton.parents[1:], start=1):
        bone = positions[:, joint] - positions[:, parent]
        length = np.linalg.norm(bone, axis=-1, keepdims=True)
        result[:, joint] = (
            result[:, parent] + np.linalg.norm(skeleton.offsets[joint]) / length * bone
        )
    return result


def test_joints_of_constant_lengths_keep_their_positions(walk):
    motion = motion_from_positions(as_tracks(walk), PARENTS)

    assert position_errors(motion, as_tracks(walk)).mean() < 0.003


@pytest.mark.parametrize("file", REAL)
def test_real_cameras_have_no_swaps(recordings, file):
    """Tracked shoulders and hips shift on the trunk; a rigid trunk misses them by up to 45 mm.

    Palms, fingertips and thumbs are noisy and are smoothed.
    """
    recording = read_recording(recordings / "kinect" / file)
    parents, tracks = recording.parents, recording.tracks
    body = motion_from_points(tracks, parents).skeleton
    order = [tracks.names.index(name) for name in body.names]
    smooth = np.array(tracks.positions)
    smooth[:, order] = with_bone_lengths(tracks.positions[:, order], body)
    smooth = tracks.with_positions(smooth)

    motion = motion_from_positions(smooth, parents)

    firm = [
        not name.startswith(("Hand", "Thumb")) for name in visible_positions(motion, smooth)
    ]
    assert np.nanmean(position_errors(motion, smooth)[:, firm]) < 0.005


def test_bone_lengths_are_constant_and_from_reliable_frames(walk):
    tracks, reliability = as_tracks(walk.copy()), np.ones((90, 20))
    wrist = NAMES.index("WristLeft")
    tracks.positions[40:, wrist] += (0.3, 0.0, 0.0)
    reliability[40:, wrist] = 0.1

    motion = motion_from_positions(tracks, PARENTS, reliability)

    true = np.linalg.norm(walk[0, wrist] - walk[0, NAMES.index("ElbowLeft")])
    offset = motion.skeleton.offsets[motion.skeleton.index("WristLeft")]
    assert np.linalg.norm(offset) == pytest.approx(true, abs=0.003)


def flexing_arm(angles: np.ndarray, plane: float) -> Tracks:
    """A body with a hanging left arm whose elbow flexes by these angles, radians.

    The elbow flexes forward (-Y), rotated about the upper arm by `plane` toward the body.
    """
    still = np.zeros((len(angles), 20, 3))
    for name, position in POSITIONS.items():
        still[:, NAMES.index(name)] = position
    direction = np.stack(
        [-np.sin(angles) * np.sin(plane), -np.sin(angles) * np.cos(plane), -np.cos(angles)],
        axis=-1,
    )
    still[:, NAMES.index("WristLeft")] = still[:, NAMES.index("ElbowLeft")] + 0.25 * direction
    still[:, NAMES.index("HandLeft")] = still[:, NAMES.index("ElbowLeft")] + 0.35 * direction
    return as_tracks(still)


def hinge_directions(
    motion: Motion, joint: str, axis: tuple[float, float, float]
) -> np.ndarray:
    """World direction of a hinge axis given in the T-pose, shape (n_frames, 3)."""
    return rotate(
        forward_kinematics(motion).rotations[:, motion.skeleton.index(joint)], np.array(axis)
    )


@pytest.mark.parametrize("plane", np.radians([-30.0, 0.0, 60.0]))
def test_upper_arm_twist_follows_the_flexion_plane_of_the_elbow(plane):
    motion = motion_from_positions(flexing_arm(np.full(60, np.radians(80)), plane), PARENTS)

    elbow = motion.rotations[:, motion.skeleton.index("ElbowLeft")]
    axis = elbow[:, 1:] / np.linalg.norm(elbow[:, 1:], axis=-1, keepdims=True)
    assert_allclose(np.abs(axis[:, 2]), 1.0, atol=0.02)  # Z is the hinge of a T-pose's elbow
    assert_allclose(np.degrees(angle_between(elbow, [1.0, 0, 0, 0])), 80.0, atol=1.0)


def test_straight_arm_keeps_the_twist_of_adjacent_flexion():
    """The arm is straight for a fifth of a second; noise there must not rotate it."""
    angles = np.full(60, np.radians(60.0))
    angles[27:33] = 0.0
    tracks = flexing_arm(angles, np.radians(60.0))
    tracks.positions[27:33, NAMES.index("WristLeft")] += np.random.default_rng(1).normal(
        scale=0.005, size=(6, 3)
    )

    motion = motion_from_positions(tracks, PARENTS)

    hinge = hinge_directions(motion, "ShoulderLeft", (0.0, 0.0, 1.0))
    rotated = np.degrees(np.arccos(np.clip(hinge @ hinge[0], -1.0, 1.0)))
    assert rotated.max() < 10.0


def test_an_arm_without_flexion_has_no_axial_rotation():
    motion = motion_from_positions(flexing_arm(np.zeros(30), 0.0), PARENTS)

    hinge = hinge_directions(motion, "ShoulderLeft", (0.0, 0.0, 1.0))
    assert_allclose(hinge, np.tile((1.0, 0.0, 0.0), (30, 1)), atol=0.02)


def test_no_joint_jumps_while_a_body_rotates_by_360_degrees(walk):
    angles = np.linspace(0.0, 4.0 * np.pi, len(walk))
    cos, sin = np.cos(angles)[:, None], np.sin(angles)[:, None]
    x, y, z = np.moveaxis(walk, -1, 0)
    rotating = np.stack([cos * x - sin * y, sin * x + cos * y, z], axis=-1)

    still, motion = (
        motion_from_positions(as_tracks(each), PARENTS) for each in (walk, rotating)
    )

    steps = angle_between(still.rotations[1:, 1:], still.rotations[:-1, 1:])
    assert np.degrees(steps.max()) < 20.0
    assert_allclose(
        angle_between(motion.rotations[:, 1:], still.rotations[:, 1:]), 0.0, atol=1e-4
    )


def test_the_spine_distributes_the_twist_of_the_trunk():
    tracks = flexing_arm(np.full(5, 1.0), 0.0)
    above = [
        name for name in NAMES if not name.startswith(("Hip", "Knee", "Ankle", "Foot", "Sp"))
    ]
    positions = tracks.positions
    for name in above:  # rotated by 60 degrees to the left
        x, y = positions[:, NAMES.index(name), :2].T.copy()
        positions[:, NAMES.index(name), 0] = 0.5 * x - np.sqrt(0.75) * y
        positions[:, NAMES.index(name), 1] = np.sqrt(0.75) * x + 0.5 * y

    motion = motion_from_positions(tracks, PARENTS)

    spine = motion.rotations[:, motion.skeleton.index("Spine")]
    chest = motion.rotations[:, motion.skeleton.index("ShoulderCenter")]
    assert 10.0 < np.degrees(angle_between(spine, [1.0, 0, 0, 0])).mean() < 50.0
    assert np.degrees(angle_between(chest, [1.0, 0, 0, 0])).mean() < 40.0


def test_the_skeleton_is_recognized_as_a_humanoid(walk):
    motion = motion_from_positions(as_tracks(walk), PARENTS)

    assert {"ClavicleLeft", "ClavicleRight", "SpineLow"} <= set(motion.skeleton.names)
    found = find_humanoid_map(motion.skeleton)
    assert found.score > 0.9
    assert found.joint("leftUpperArm") == "ShoulderLeft"


def test_motion_uses_the_given_skeleton(walk):
    body = motion_from_points(as_tracks(walk), PARENTS).skeleton

    motion = motion_from_positions(as_tracks(walk), PARENTS, skeleton=body)

    assert motion.skeleton is body
    assert motion.observed.all()


def test_error_of_a_rigid_trunk_does_not_reach_the_hand(walk):
    """The shoulder is 5 cm too high; the arm compensates at elbow and wrist."""
    body = motion_from_points(as_tracks(walk), PARENTS).skeleton
    arm = [NAMES.index(f"{part}Left") for part in ("Shoulder", "Elbow", "Wrist")]
    shrugging = walk.copy()
    shrugging[:, arm[0], 2] += 0.05

    motion = motion_from_positions(as_tracks(shrugging), PARENTS, skeleton=body)

    order = [motion.skeleton.index(NAMES[joint]) for joint in arm]
    positions = forward_kinematics(motion).positions[:, order]
    shoulder, _, wrist = np.linalg.norm(positions - shrugging[:, arm], axis=-1).mean(axis=0)
    assert shoulder > 0.03
    assert wrist < 0.4 * shoulder


def test_fingertips_are_smoothed(walk):
    """Fingertips are noisy by 3 cm on bones of 9 cm; true flexion remains."""
    rng = np.random.default_rng(5)
    noisy, tip = walk.copy(), NAMES.index("HandLeft")
    noisy[:, tip] += rng.normal(scale=0.03, size=(len(walk), 3))

    motion = motion_from_positions(as_tracks(noisy), PARENTS)

    wrist = motion.rotations[:, motion.skeleton.index("WristLeft")]
    assert np.degrees(angle_between(wrist[1:], wrist[:-1])).mean() < 8.0
    tips = forward_kinematics(motion).positions[:, motion.skeleton.index("HandLeft")]
    assert np.linalg.norm(tips - walk[:, tip], axis=-1).mean() < 0.03


def test_coincident_joints_are_ignored(walk):
    tracks = as_tracks(walk.copy())
    tracks.positions[20, NAMES.index("HandLeft")] = walk[20, NAMES.index("WristLeft")]

    motion = motion_from_positions(tracks, PARENTS)

    assert motion.observed.all()


def test_gaps_remain_missing(walk):
    tracks = as_tracks(walk.copy())
    tracks.positions[10:20, NAMES.index("KneeLeft")] = np.nan

    motion = motion_from_positions(tracks, PARENTS)

    assert not motion.observed[10:20, motion.skeleton.index("HipLeft")].any()
    assert motion.observed[:, motion.skeleton.index("HipRight")].all()
    assert motion.observed[:10].all()


def test_motion_from_positions_does_not_modify_its_input(walk):
    tracks = as_tracks(walk)
    before = tracks.positions.copy()

    motion_from_positions(tracks, PARENTS, np.full((90, 20), 0.4))

    assert_allclose(tracks.positions, before, rtol=0, atol=0)


def test_motion_from_positions_raises_for_invalid_input(walk):
    body = motion_from_points(as_tracks(walk), PARENTS).skeleton
    fewer = Tracks(NAMES[:-1], walk[:, :-1], 30.0)

    with pytest.raises(InvalidMotionError, match="not tracked: FootRight"):
        motion_from_positions(fewer, PARENTS[:-1], skeleton=body)
    with pytest.raises(InvalidMotionError, match="Reliability needs shape"):
        motion_from_positions(as_tracks(walk), PARENTS, np.ones((3, 20)))
