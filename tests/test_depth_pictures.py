"""The pictures of `make bench-depth` are what Blender sees, and move as they are said to."""

import importlib.util

import numpy as np
import pytest
from box_person import box_person
from numpy.testing import assert_allclose

from solvers.depth_scene.camera import Camera
from solvers.motion import Motion
from solvers.rotations.representations import quaternion_from_rotation_vector
from tests.benchmarks.depth.blender_depth import blender_depth, difference, our_depth
from tests.benchmarks.depth.depth_extra_sequences import (
    TAKES,
    before_camera,
    body_of,
    more_sequence,
    view_center,
)

CAMERA = Camera(150.0, 120.0, 70.0, 65.5, 160, 120)
"""Pixels that are not square, and a principal point off the center."""
BLENDER = pytest.mark.skipif(
    importlib.util.find_spec("bpy") is None, reason="there is no Blender here (module bpy)"
)


@BLENDER
def test_blender_renders_the_same_depth_images():
    body = box_person()
    names = body.skeleton.names
    angles = np.random.default_rng(3).normal(0.0, 0.4, (3, len(names), 3))
    rotations = quaternion_from_rotation_vector(angles)
    roots = body.skeleton.rest_positions[0] + [[0, 0, 0], [0.2, 0.1, 0.05], [-0.3, 0, -0.1]]
    motion = Motion(body.skeleton, rotations, roots, 30.0)
    level = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    tilt = np.array([[1.0, 0.0, 0.0], [0.0, 0.96, 0.28], [0.0, -0.28, 0.96]])
    given = body, motion, np.array([level, level @ tilt, level]), np.array([0, 0.9, 2.7])

    ours, blender = our_depth(*given, CAMERA), blender_depth(*given, CAMERA)

    assert (ours > 0.0).sum(axis=(1, 2)).min() > 1000
    found = difference(ours, blender)
    assert found.covered < 0.005
    assert np.quantile(found.millimeters, 0.99) < 0.5
    moved = difference(np.roll(ours, 1, axis=2), blender)
    assert moved.covered > 0.02 and np.quantile(moved.millimeters, 0.99) > 5.0


def test_differences_compare_pixels_of_both_images():
    ours, others = np.zeros((2, 1, 4, 4))
    ours[0, 1, :3], others[0, 1, 1:] = 2.0, 2.005

    found = difference(ours, others)

    assert_allclose(found.millimeters, [5.0, 5.0])
    assert found.covered == pytest.approx(0.5)


@pytest.mark.usefixtures("recordings")
def test_actors_rotate_sit_and_cross_arms_as_described():
    def joints(name):
        body = body_of(name)
        motion, rotations = before_camera(body, TAKES[name])
        indices = body.humanoid.indices(body.skeleton)
        poses = zip(motion.rotations, motion.root_positions, rotations, strict=True)
        positions = [body.pose(pose, root)[1] @ rotation for pose, root, rotation in poses]
        return {role: np.array(positions)[:, joint] for role, joint in indices.items()}

    sitting = joints("seated")
    thigh = sitting["leftLowerLeg"] - sitting["leftUpperLeg"]
    assert (thigh[:, 2] < -0.25).all()
    crossed = joints("crossed arms")
    hands = crossed["leftHand"][25:] - crossed["rightHand"][25:]
    shoulders = crossed["leftUpperArm"][25:] - crossed["rightUpperArm"][25:]
    assert (np.einsum("fa,fa->f", hands, shoulders) < 0.0).all()
    rotated = joints("walk, rotated by 360")
    across = rotated["leftUpperLeg"] - rotated["rightUpperLeg"]
    angle = np.unwrap(np.arctan2(across[:, 2], across[:, 0]))
    assert abs(angle[-1] - angle[0]) > np.radians(330.0)


@pytest.mark.usefixtures("recordings")
def test_joints_of_a_sequence_are_inside_the_visible_body(monkeypatch, tmp_path):
    monkeypatch.setattr("tests.benchmarks.depth.depth_extra_sequences.BUILD", tmp_path)
    sequence = more_sequence.__wrapped__("seated, side")

    depth = sequence.depth.frame(10)
    columns, rows = sequence.depth.camera.project(sequence.joints[10]).round().astype(int).T
    surface = depth[rows, columns]
    behind = sequence.joints[10, :, 2] - surface
    inside = (surface > 0.0) & (behind > -0.03)
    assert inside.mean() > 0.85
    assert view_center(TAKES["seated, side"])[2] == pytest.approx(np.median(surface), abs=0.5)
