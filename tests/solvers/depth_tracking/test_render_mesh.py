"""Compare the z-buffer with ray casting and analytic shapes."""

import numpy as np
import pytest
from box_person import box_person
from hypothesis import given, settings
from hypothesis import strategies as st

from solvers.depth_scene.camera import Camera
from solvers.depth_tracking.forest_training.render_mesh import NO_PART, render_mesh

CAMERA = Camera(30.0, 32.0, 14.5, 11.5, 31, 24)


def by_rays(vertices, triangles, labels, camera):
    """Intersect every ray with every triangle (Möller and Trumbore 1997)."""
    depth = np.zeros((camera.height, camera.width))
    observed = np.full(depth.shape, NO_PART, dtype=np.uint8)
    for pixel, ray in zip(np.ndindex(depth.shape), camera.rays().reshape(-1, 3), strict=True):
        for corners in triangles:
            a, b, c = vertices[corners]
            normal = np.cross(ray, c - a)
            scale = (b - a) @ normal
            if abs(scale) < 1e-15:
                continue
            u = -a @ normal / scale
            side = np.cross(-a, b - a)
            v = ray @ side / scale
            z = (c - a) @ side / scale
            if min(u, v, 1.0 - u - v) >= 0.0 and z > 0.0 and not 0.0 < depth[pixel] <= z:
                depth[pixel] = z
                observed[pixel] = labels[corners[np.argmax([1.0 - u - v, u, v])]]
    return depth, observed


@settings(max_examples=12)
@given(seed=st.integers(0, 10_000))
def test_render_mesh_equals_ray_casting(seed):
    rng = np.random.default_rng(seed)
    vertices = rng.uniform([-1, -1, 0.5], [1, 1, 3], (12, 3))
    triangles = rng.permuted(np.tile(np.arange(12), (8, 1)), axis=1)[:, :3]
    labels = rng.integers(0, 20, 12).astype(np.uint8)
    image = render_mesh(vertices, triangles, labels, CAMERA)
    depth, observed = by_rays(vertices, triangles, labels, CAMERA)
    np.testing.assert_allclose(image.depth, depth, rtol=1e-5)
    np.testing.assert_array_equal(image.labels, observed)


def test_fine_ball_has_the_depth_of_a_sphere():
    camera = Camera(140.0, 140.0, 39.5, 29.5, 80, 60)
    across, around = np.meshgrid(np.linspace(0, np.pi, 120), np.linspace(0, 2 * np.pi, 241))
    directions = [
        np.sin(across) * np.cos(around),
        np.sin(across) * np.sin(around),
        np.cos(across),
    ]
    vertices = 0.3 * np.stack(directions, axis=-1).reshape(-1, 3) + [0.05, -0.02, 2.0]
    first = (np.arange(240)[:, None] * 120 + np.arange(119)).reshape(-1)
    second = first + 120
    halves = [first, first + 1, second], [first + 1, second + 1, second]
    triangles = np.concatenate([np.stack(half, axis=1) for half in halves])
    image = render_mesh(vertices, triangles, np.zeros(len(vertices), np.uint8), camera)
    rays = camera.rays()
    center = np.array([0.05, -0.02, 2.0])
    square, along = (rays**2).sum(-1), rays @ center
    inside = along**2 - square * (center @ center - 0.3**2)
    exact = np.where(inside > 0, (along - np.sqrt(np.maximum(inside, 0))) / square, 0.0)
    well_inside = inside > 0.02
    np.testing.assert_allclose(image.depth[well_inside], exact[well_inside], atol=3e-4)
    assert (image.depth[inside < 0] == 0).all()
    np.testing.assert_array_equal(image.labels == NO_PART, image.depth == 0)


def test_triangles_outside_of_the_view_are_not_rendered():
    vertices = np.array([[-1, -1, 1], [1, -1, 1], [0, 1, 1.0]])
    labels = np.zeros(3, np.uint8)
    triangle = np.array([[0, 1, 2]])
    assert render_mesh(vertices, triangle, labels, CAMERA).depth.any()
    for move in ([0, 0, -2], [0, 0, -1], [50, 0, 0], [0, -50, 0]):
        assert not render_mesh(vertices + move, triangle, labels, CAMERA).depth.any()
    edge_on = np.array([[0, -1, 1], [0, 1, 1], [0, 0, 2.0]])
    assert not render_mesh(edge_on, triangle, labels, CAMERA).depth.any()


@pytest.mark.parametrize("step", [2, 3])
def test_coarser_camera_has_a_subset_of_the_pixels(step):
    person = box_person()
    x, y, z = person.vertices.T
    observed = np.stack([x, 0.95 - z, y + 2.5], axis=1)
    camera = Camera(140.0, 140.0, 79.5, 59.5, 160, 120)
    fine = render_mesh(observed, person.triangles, person.vertex_parts, camera)
    coarse = render_mesh(observed, person.triangles, person.vertex_parts, camera.every(step))
    np.testing.assert_allclose(coarse.depth, fine.depth[::step, ::step], rtol=1e-6)
