"""Solve joint centers and rotations from markers, and compare with simulated bodies."""

import numpy as np
import pytest
from marked_bodies import markers_on
from numpy.testing import assert_allclose

from solvers.errors import InvalidMotionError
from solvers.markers import SolveSettings, solve_skeleton
from solvers.motion import Motion, Tracks, find_humanoid_map, forward_kinematics
from solvers.recordings import read_acclaim, read_c3d
from solvers.recordings.joint_files.ui_prmd import read_ui_prmd_pair
from solvers.rotations.representations import angle_between
from solvers.samples import GaitSettings, walking_gait

LIMBS = [
    side + part
    for side in ("left", "right")
    for part in ("UpperLeg", "LowerLeg", "Foot", "UpperArm", "LowerArm", "Hand")
]
ALL_PARTS = ("hips", "spine", "chest", "neck", "head", *LIMBS)


@pytest.fixture(scope="module")
def walk() -> Motion:
    return walking_gait(GaitSettings(duration=4.0, frame_rate=60.0))


def joint_errors(solved, truth: Motion, parts=LIMBS) -> np.ndarray:
    """Distance of each joint from the truth, (n_frames, n_parts), meters."""
    joints = find_humanoid_map(truth.skeleton).indices(truth.skeleton)
    true = forward_kinematics(truth).positions[:, [joints[part] for part in parts]]
    indices = [solved.joint_centers.names.index(part) for part in parts]
    return np.linalg.norm(solved.joint_centers.positions[:, indices] - true, axis=-1)


@pytest.mark.parametrize(("noise", "skin"), [(0.0, 0.0), (0.001, 0.0), (0.001, 0.006)])
def test_joint_centers_of_a_walk_are_accurate(walk, noise, skin):
    solved = solve_skeleton(markers_on(walk, noise=noise, skin=skin))

    assert joint_errors(solved, walk).mean() < 0.022
    knees = joint_errors(
        solved, walk, ["leftLowerLeg", "rightLowerLeg", "leftFoot", "rightFoot"]
    )
    assert knees.mean() < 0.015
    assert np.nanmean(solved.error) < 0.002 + noise + 1.5 * skin


def test_flexion_of_knees_and_elbows_is_accurate(walk):
    """Flexion does not depend on the definition of the bone axes."""
    solved = solve_skeleton(markers_on(walk))
    reference = forward_kinematics(walk).positions
    joints = find_humanoid_map(walk.skeleton).indices(walk.skeleton)
    found = solved.joint_centers
    result = {name: found.positions[:, index] for index, name in enumerate(found.names)}

    for start, middle, end in (
        ("UpperLeg", "LowerLeg", "Foot"),
        ("UpperArm", "LowerArm", "Hand"),
    ):
        for side in ("left", "right"):
            names = [side + part for part in (start, middle, end)]
            true = flexion(*(reference[:, joints[name]] for name in names))
            found = flexion(*(result[name] for name in names))
            differences = found - true
            assert np.degrees(np.abs(differences - np.median(differences))).mean() < 2.5


def flexion(start, middle, end) -> np.ndarray:
    upper, lower = middle - start, end - middle
    cosine = np.einsum("fi,fi->f", upper, lower)
    return np.arccos(cosine / np.linalg.norm(upper, axis=1) / np.linalg.norm(lower, axis=1))


def test_skeleton_is_a_humanoid_in_t_pose(walk):
    solved = solve_skeleton(markers_on(walk))
    skeleton = solved.motion.skeleton

    humanoid = find_humanoid_map(skeleton)
    assert humanoid.score == 1.0
    assert all(humanoid.joint(part) == part for part in ALL_PARTS)
    rest = dict(zip(skeleton.names, skeleton.rest_positions, strict=True))
    assert rest["leftHand"][0] > rest["leftLowerArm"][0] > rest["leftUpperArm"][0] > 0.1
    assert_allclose(rest["leftHand"], rest["rightHand"] * (-1.0, 1.0, 1.0), atol=1e-9)
    assert rest["leftToes"][1] < rest["leftFoot"][1] - 0.08
    assert abs(rest["leftToes"][2]) < 0.06
    assert_allclose(
        forward_kinematics(solved.motion).positions, solved.joint_centers.positions, atol=1e-9
    )


def test_child_stands_on_the_floor_at_rest(walk):
    """It is 0.6 times as tall."""
    take = markers_on(walk.slice(0, 60))
    adult, child = (
        solve_skeleton(take.with_positions(size * take.positions)).motion.skeleton
        for size in (1.0, 0.6)
    )

    ankle = adult.names.index("leftFoot")

    heights = [each.rest_positions[ankle, 2] for each in (adult, child)]
    assert_allclose(heights, [0.07, 0.042], atol=0.005)


def test_bones_keep_their_lengths_and_rotations_are_smooth(walk):
    solved = solve_skeleton(markers_on(walk))

    knee = solved.motion.rotations[:, solved.motion.skeleton.index("leftLowerLeg")]
    assert np.degrees(angle_between(knee[1:], knee[:-1])).max() < 15.0


def test_missing_marker_hardly_matters_and_missing_limb_is_nan(walk):
    complete = markers_on(walk)
    positions = complete.positions.copy()
    positions[50:90, complete.names.index("LKNE")] = np.nan
    for name in complete.names:
        if name in {"RELB", "RUPA", "RFRM", "RWRA", "RWRB", "RFIN"}:
            positions[100:140, complete.names.index(name)] = np.nan

    solved = solve_skeleton(complete.with_positions(positions))

    assert joint_errors(solved, walk, ["leftLowerLeg"])[50:90].max() < 0.03
    missing = [solved.motion.skeleton.index(f"right{part}") for part in ("LowerArm", "Hand")]
    observed = solved.motion.observed
    assert not observed[100:140, missing].any()
    assert observed[:100].all() and observed[140:].all()
    assert np.isnan(solved.joint_centers.positions[100:140, missing[1]]).all()


def test_frames_without_markers_are_missing(walk):
    complete = markers_on(walk)
    positions = complete.positions.copy()
    positions[60:80] = np.nan

    solved = solve_skeleton(complete.with_positions(positions))

    assert not solved.motion.observed[60:80].any()
    assert np.isnan(solved.error[60:80]).all()
    assert joint_errors(solved, walk)[85:].mean() < 0.022


def test_one_outlier_marker_has_little_effect(walk):
    complete = markers_on(walk)
    positions = complete.positions.copy()
    positions[50:60, complete.names.index("LTHI")] += 0.5

    moved = solve_skeleton(complete.with_positions(positions)).joint_centers
    still = solve_skeleton(complete).joint_centers

    index = still.names.index("leftLowerLeg")
    errors = np.linalg.norm(moved.positions - still.positions, axis=-1)[50:60, index]
    assert errors.max() < 0.02


def test_markers_of_legs_give_a_skeleton_of_legs(walk):
    landmarks = ("FWT", "BWT", "THI", "KNE", "SHN", "ANK", "HEE", "TOE", "MT5")
    keep = frozenset(side + landmark for side in "LR" for landmark in landmarks)

    solved = solve_skeleton(markers_on(walk, keep=keep))

    assert "chest" not in solved.motion.skeleton.names
    assert (
        joint_errors(
            solved, walk, [part for part in LIMBS if "L" in part and "eg" in part]
        ).mean()
        < 0.03
    )


def test_subject_selects_its_markers(walk):
    one = markers_on(walk)
    names = tuple(f"Anna:{name}" for name in one.names) + tuple(f"Ben:{n}" for n in one.names)
    both = np.concatenate((one.positions, one.positions + np.array([2.0, 0.0, 0.0])), axis=1)

    ben = solve_skeleton(
        Tracks(names, both, one.frame_rate), settings=SolveSettings(subject="Ben")
    )

    assert ben.markers[0].startswith("Ben:")
    assert ben.motion.root_positions[0, 0] - walk.root_positions[0, 0] == pytest.approx(
        2, abs=0.1
    )


def test_solve_skeleton_names_missing_markers(walk):
    complete = markers_on(walk)
    positions = complete.positions.copy()
    positions[:, complete.names.index("LKNE")] = np.nan
    unnamed = Tracks(tuple(f"p{n}" for n in range(complete.n_points)), positions, 60.0)

    with pytest.raises(InvalidMotionError, match="pelvis: LKNE\\. It looks like CMU 41"):
        solve_skeleton(complete.with_positions(positions))
    with pytest.raises(InvalidMotionError, match="LASI, RASI"):
        solve_skeleton(unnamed)


def test_solve_skeleton_raises_for_a_pelvis_of_size_zero(walk):
    complete = markers_on(walk)

    with pytest.raises(InvalidMotionError, match="one point or on one line"):
        solve_skeleton(complete.with_positions(np.ones_like(complete.positions)))


def test_solve_skeleton_needs_a_frame_with_a_complete_leg(walk):
    complete = markers_on(walk)
    positions = complete.positions.copy()
    positions[::2, complete.names.index("LKNE")] = np.nan
    positions[1::2, complete.names.index("LANK")] = np.nan

    with pytest.raises(InvalidMotionError, match="No frame shows all of"):
        solve_skeleton(complete.with_positions(positions))


def test_solve_skeleton_accepts_one_frame(walk):
    solved = solve_skeleton(markers_on(walk).slice(30, 31))

    assert solved.motion.n_frames == 1
    assert joint_errors(solved, walk.slice(30, 31)).mean() < 0.04


def test_cmu_dance_agrees_with_the_published_joints(recordings):
    folder = recordings / "mocap"
    dance = read_acclaim(folder / "05_13.amc", folder / "05.asf")
    solved = solve_skeleton(read_c3d(folder / "05_13.c3d"))

    rotated = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    reference = forward_kinematics(dance).positions @ rotated
    roles = {"UpperLeg": "femur", "LowerLeg": "tibia", "Foot": "foot",
             "UpperArm": "humerus", "LowerArm": "radius", "Hand": "hand"}  # fmt: skip
    for part, bone in roles.items():
        for side in ("left", "right"):
            index = solved.joint_centers.names.index(side + part)
            joint = reference[:, dance.skeleton.index(side[0] + bone)]
            errors = np.linalg.norm(solved.joint_centers.positions[:, index] - joint, axis=1)
            assert errors.mean() < 0.07, side + part
    assert solved.motion.observed.all()
    assert np.nanmean(solved.error) < 0.006


def test_plug_in_gait_take_agrees_with_kinect_joints(recordings):
    kinect, markers = read_ui_prmd_pair(recordings / "kinect/ui_prmd/m01_s01_e01.npz")

    solved = solve_skeleton(markers)

    reference = dict(
        zip(kinect.tracks.names, kinect.tracks.positions.swapaxes(0, 1), strict=True)
    )
    for role, name in (("leftLowerLeg", "LLowLeg"), ("rightLowerArm", "RForeArm")):
        index = solved.joint_centers.names.index(role)
        differences = solved.joint_centers.positions[:, index] - reference[name]
        assert np.linalg.norm(np.nanmedian(differences, axis=0)) < 0.15
