"""Find parts among misclassified pixels, fit poses to them and score the poses."""

import numpy as np
import pytest

from solvers.depth_scene.camera import Camera
from solvers.depth_tracking.body.coordinates import COORDINATES, N_COORDINATES
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.segment_kinematics import joint_positions, segment_frames
from solvers.depth_tracking.body.tables import CAPSULE_SEGMENTS, CAPSULES, JOINTS
from solvers.depth_tracking.detection.labeled_fit import (
    capsule_distances,
    first_pose,
    fit_parts,
    fit_pixels,
)
from solvers.depth_tracking.detection.part_capsules import (
    PART_CAPSULES,
    PART_SEGMENTS,
    PART_SPANS,
    part_axes,
)
from solvers.depth_tracking.detection.pose_score import pose_score
from solvers.depth_tracking.detection.pose_trials import swap_orders, trial_poses
from solvers.depth_tracking.detection.robust_parts import FoundParts, find_parts
from solvers.depth_tracking.forest.parts import MIRRORED_PARTS, N_PARTS, PARTS
from solvers.depth_tracking.forest.pixel_forest import PixelParts
from solvers.depth_tracking.terms.hypothesis import render_hypothesis
from solvers.depth_tracking.terms.observation import Observation

CAMERA = Camera(142.8, 142.8, 79.5, 59.5, 160, 120)
BODY = default_body()


def standing(**angles: float):
    """A pose at 2.8 m whose left elbow is flexed, so that left and right differ."""
    pose = np.zeros(N_COORDINATES)
    pose[:3] = 0.05, 0.0, 2.8
    default_angles = {
        "leftHumerusX": 0.7,
        "leftRadius": 1.2,
        "rightHumerusZ": 0.6,
        "rightFemurX": 0.4,
    }
    for name, angle in (default_angles | angles).items():
        pose[COORDINATES.index(name)] = angle
    return pose


def visible_parts(pose):
    """Visible surface of the body: points, parts, rows and columns."""
    image = render_hypothesis(BODY, pose, CAMERA).image
    rows, columns = np.divmod(image.pixels, CAMERA.width)
    points = CAMERA.rays()[rows, columns] * image.depths[:, None]
    frames = segment_frames(BODY, pose)
    parts = np.zeros(len(points), dtype=int)
    for index, point in enumerate(points):
        parts[index] = part_at(image.capsules[index], point, frames)
    return points, parts, rows, columns


def part_at(capsule, point, frames):
    """Part by brute force: of this capsule, on the nearer half of its axis."""
    of_it = [part for part in range(N_PARTS) if PART_CAPSULES[part] == capsule]
    if len(of_it) == 1:
        return of_it[0]
    frame = frames[PART_SEGMENTS[of_it[0]]]
    middles = [
        frame[:3, :3] @ part_axes(BODY)[part].mean(axis=0) + frame[:3, 3] for part in of_it
    ]
    return of_it[int(np.argmin([np.linalg.norm(point - middle) for middle in middles]))]


def joint_error(pose, true):
    frames, exact = segment_frames(BODY, pose), segment_frames(BODY, true)
    distances = joint_positions(BODY, frames) - joint_positions(BODY, exact)
    return float(np.linalg.norm(distances, axis=1).mean())


def test_every_part_has_a_capsule_and_halves_are_complete():
    assert {CAPSULES[capsule] for capsule in PART_CAPSULES} == set(CAPSULES)
    covered = np.zeros(len(CAPSULES))
    np.add.at(covered, PART_CAPSULES, PART_SPANS[:, 1] - PART_SPANS[:, 0])
    np.testing.assert_array_equal(covered, 1.0)


@pytest.mark.parametrize("wrong", [0.0, 0.35])
def test_find_parts_is_robust_to_wrong_labels(rng, wrong):
    """A third of the labels are random; centers change by a few centimeters."""
    true = standing()
    points, parts, _, _ = visible_parts(true)
    labels = np.where(
        rng.random(len(parts)) < wrong, rng.integers(0, N_PARTS, len(parts)), parts
    )
    found = find_parts(points, labels, BODY, rng)
    frames = segment_frames(BODY, true)
    for part in ("head", "rightUpperArm", "leftLowerLeg", "rightUpperLegEnd"):
        index = PARTS.index(part)
        assert found.weights[index] >= 0.4
        capsule = PART_CAPSULES[index]
        distance = capsule_distances(BODY, frames, found.centers[index][None])[0, capsule]
        assert distance < 0.03
    true_part = {point.tobytes(): part for point, part in zip(points, parts, strict=True)}
    right = [
        true_part[point.tobytes()] == label
        for point, label in zip(found.points, found.labels, strict=True)
    ]
    assert 1.0 - np.mean(right) <= 0.6 * (1.0 - (labels == parts).mean())


def test_find_parts_returns_nan_for_missing_parts(rng):
    points, parts, _, _ = visible_parts(standing())
    left = np.char.startswith(np.array(PARTS), "left")[parts]
    found = find_parts(points[~left], parts[~left], BODY, rng)
    assert not found.weights[np.char.startswith(np.array(PARTS), "left")].any()
    assert np.isnan(found.centers[PARTS.index("leftFoot")]).all()


@pytest.mark.parametrize("yaw", [0.0, 1.2, 3.0])
def test_fit_parts_recovers_the_pose(rng, yaw):
    true = standing(yaw=yaw)
    points, parts, _, _ = visible_parts(true)
    found = find_parts(points, parts, BODY, rng)
    start = first_pose(BODY, found)
    rotated = start[COORDINATES.index("yaw")] - yaw
    assert abs(np.angle(np.exp(1j * rotated))) < 0.5
    fractions = np.eye(N_PARTS, dtype=np.float32)[parts]
    pose = fit_parts(BODY, found, start)
    pose = fit_pixels(BODY, points[::3], fractions[::3], pose)
    assert joint_error(pose, true) < 0.05


def test_distances_to_round_capsules_are_exact(rng):
    pose = standing()
    frames = segment_frames(BODY, pose)
    points = rng.normal([0.05, 0.0, 2.8], 0.4, (50, 3))
    distances = capsule_distances(BODY, frames, points)
    index = CAPSULES.index("leftLowerLeg")
    frame = frames[CAPSULE_SEGMENTS[index]]
    start, stop = BODY.capsule_ends[index] @ frame[:3, :3].T + frame[:3, 3]
    along = np.clip((points - start) @ (stop - start) / ((stop - start) ** 2).sum(), 0, 1)
    exact = np.linalg.norm(points - start - along[:, None] * (stop - start), axis=1)
    np.testing.assert_allclose(distances[:, index], exact - BODY.radii[index, 0], atol=1e-9)


def test_true_pose_has_the_best_score(rng):
    true = standing()
    hypothesis = render_hypothesis(BODY, true, CAMERA)
    observation = Observation(CAMERA, hypothesis.image.depth_image())
    _, parts, rows, columns = visible_parts(true)
    order = np.argsort(rows * CAMERA.width + columns)
    fractions = np.eye(N_PARTS, dtype=np.float32)[parts[order]]
    pixels = PixelParts(rows[order], columns[order], fractions)
    score, overlap = pose_score(hypothesis, observation, pixels, 0.3)
    assert score == pytest.approx(1.0, abs=1e-6)
    assert overlap == 1.0
    for name, change in (("rootX", 0.05), ("leftRadius", -0.8), ("yaw", 0.4), ("rootZ", 0.05)):
        other = true.copy()
        other[COORDINATES.index(name)] += change
        worse, _ = pose_score(render_hypothesis(BODY, other, CAMERA), observation, pixels, 0.3)
        assert worse < score - 0.01
    offset_pose = true.copy()
    offset_pose[0] += 3.0
    assert (
        pose_score(render_hypothesis(BODY, offset_pose, CAMERA), observation, pixels, 0.3)[1]
        == 0.0
    )


def test_swap_orders_cover_all_combinations():
    orders = swap_orders()
    assert len({tuple(order) for order in orders}) == 4
    np.testing.assert_array_equal(orders[0], np.arange(N_PARTS))
    np.testing.assert_array_equal(orders[-1], MIRRORED_PARTS)
    for order in orders:
        np.testing.assert_array_equal(order[order], np.arange(N_PARTS))


def test_trial_poses_recover_swapped_legs(rng):
    true = standing(yaw=-1.3, leftFemurX=-0.3)
    points, parts, _, _ = visible_parts(true)
    legs = np.array([part.endswith(("Leg", "LegEnd", "Foot")) for part in PARTS])
    labels = np.where(legs[parts], MIRRORED_PARTS[parts], parts)
    fractions = np.eye(N_PARTS, dtype=np.float32)[labels]
    found = find_parts(points, labels, BODY, rng)
    errors = [
        joint_error(pose, true)
        for pose in trial_poses(BODY, found, points[::3], fractions[::3])
    ]
    assert min(errors) < 0.06


def test_swap_parts_permutes_centers_and_labels(rng):
    centers = rng.normal(size=(N_PARTS, 3))
    parts = FoundParts(centers, np.arange(N_PARTS) / N_PARTS, centers, np.arange(N_PARTS))
    other = parts.swap_parts(MIRRORED_PARTS)
    left, right = PARTS.index("leftFoot"), PARTS.index("rightFoot")
    np.testing.assert_array_equal(other.centers[left], centers[right])
    np.testing.assert_array_equal(other.labels[left], right)


def test_fit_pixels_reassigns_wrong_labels(rng):
    """The left shin is labeled mostly as the right one; the initial pose is the true one."""
    true = standing(rightFemurX=0.0)
    points, parts, _, _ = visible_parts(true)
    labels = parts.copy()
    for end in ("", "End"):
        shin = PARTS.index(f"leftLowerLeg{end}")
        labels[parts == shin] = MIRRORED_PARTS[shin]
    one_hot = np.eye(N_PARTS, dtype=np.float32)
    fractions = 0.7 * one_hot[labels] + 0.3 * one_hot[parts]
    pose = fit_pixels(BODY, points, fractions, true)
    ankles = [JOINTS.index(f"{side}Foot") for side in ("left", "right")]
    found, exact = (joint_positions(BODY, segment_frames(BODY, one)) for one in (pose, true))
    assert np.linalg.norm(found[ankles] - exact[ankles], axis=1).max() < 0.03
