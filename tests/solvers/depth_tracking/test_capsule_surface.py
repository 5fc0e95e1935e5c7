"""The displayed surface equals the tracked one."""

import numpy as np
from drawn_bodies import posed
from numpy.testing import assert_allclose

from solvers.depth_tracking.body.capsule_surface import capsule_surface
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.segment_kinematics import segment_frames
from solvers.depth_tracking.body.tables import CAPSULES
from solvers.depth_tracking.terms.hypothesis import capsule_normals, capsule_offsets

BODY = default_body()


def surface_in_pose():
    pose = posed(leftHumerusZ=0.8, rightFemurX=0.4)
    frames = segment_frames(BODY, pose)
    surface = capsule_surface(BODY)
    return surface, frames, *surface.at_pose(frames)


def test_vertices_are_on_their_capsule_with_the_same_normals():
    _, frames, vertices, normals = surface_in_pose()
    capsules = np.repeat(np.arange(len(CAPSULES)), vertices.shape[1])

    sizes, _ = capsule_offsets(BODY, frames, vertices.reshape(-1, 3), capsules)
    expected = capsule_normals(BODY, frames, vertices.reshape(-1, 3), capsules)

    assert_allclose(sizes, 1.0, atol=1e-9)
    assert_allclose(normals.reshape(-1, 3), expected, atol=1e-9)


def test_triangles_close_each_capsule_and_face_outward():
    """By the divergence theorem, the volume equals that of a closed surface and is positive."""
    surface, _, vertices, _ = surface_in_pose()

    a, b, c = (vertices[:, surface.triangles[:, corner]] for corner in range(3))
    found = np.einsum("cti,cti->c", a, np.cross(b, c)) / 6.0

    across, deep = BODY.radii.T
    direction = (BODY.capsule_ends[:, 1] - BODY.capsule_ends[:, 0]) / BODY.radii[:, [0, 1, 1]]
    stretched = np.pi * np.linalg.norm(direction, axis=-1) + 4.0 / 3.0 * np.pi
    assert_allclose(found, across * deep * deep * stretched, rtol=0.12)
