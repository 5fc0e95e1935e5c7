"""Rendered capsules equal ray marching and closed forms."""

import numpy as np
from drawn_bodies import segment_image
from numpy.testing import assert_allclose, assert_array_equal

from solvers.depth_scene.camera import Camera
from solvers.depth_tracking.body.model import default_body
from solvers.depth_tracking.body.ray_capsules import cast_rays
from solvers.depth_tracking.body.segment_kinematics import segment_frames
from solvers.depth_tracking.body.tables import CAPSULE_SEGMENTS, CAPSULES, SEGMENTS

CAMERA = Camera(140.0, 150.0, 39.5, 31.0, 80, 60)


def standing(**root):
    pose = np.zeros(36)
    pose[2], pose[3] = root.get("away", 3.0), root.get("yaw", 0.0)
    return pose


def marched(body, frames, camera):
    """March along each ray, and test at each step whether it is inside a capsule."""
    rays = camera.rays()
    depth = np.zeros(rays.shape[:2])
    capsule = np.full(rays.shape[:2], -1)
    for pixel in np.ndindex(depth.shape):
        steps = np.arange(1.9, 4.1, 0.005)
        inside = distances(body, frames, steps[:, None] * rays[pixel]) < 0.0
        if not inside.any():
            continue
        high = steps[inside.any(axis=1).argmax()]
        low = high - 0.005
        for _ in range(30):
            middle = 0.5 * (low + high)
            if (distances(body, frames, middle * rays[pixel][None]) < 0.0).any():
                high = middle
            else:
                low = middle
        depth[pixel] = high
        capsule[pixel] = distances(body, frames, high * rays[pixel][None])[0].argmin()
    return depth, capsule


def distances(body, frames, points):
    """Distance outside each capsule, in units of its radius, shape (n, 19)."""
    found = np.empty((len(points), len(CAPSULES)))
    for i, segment in enumerate(CAPSULE_SEGMENTS):
        scale = 1.0 / body.radii[i, [0, 1, 1]]
        local = (points - frames[segment, :3, 3]) @ frames[segment, :3, :3] * scale
        start, stop = body.capsule_ends[i] * scale
        axis = stop - start
        along = np.clip((local - start) @ axis / (axis @ axis), 0.0, 1.0)
        found[:, i] = np.linalg.norm(local - start - along[:, None] * axis, axis=1) - 1.0
    return found


def test_cast_rays_equals_marching_along_every_ray(rng):
    body, pose = default_body(), rng.normal(scale=0.5, size=36)
    pose[:3] = (0.1, 0.1, 2.9)
    frames = segment_frames(body, pose)

    camera = CAMERA.every(2)

    image = cast_rays(body, frames, camera)

    depth, capsule = marched(body, frames, camera)
    observed = depth > 0.0
    assert observed.sum() > 70
    # A ray that only grazes a capsule may pass between two steps of ray marching.
    assert (observed != (image.depth_image() > 0.0)).sum() <= 3
    both = observed & (image.depth_image() > 0.0)
    errors = np.abs(depth - image.depth_image())[both]
    assert (errors < 1e-6).mean() > 0.99
    segments = np.where(capsule >= 0, CAPSULE_SEGMENTS[capsule], -1)
    assert (segments == segment_image(image))[both].mean() > 0.99


def test_ball_on_the_axis_is_its_radius_nearer_than_its_center():
    """The head, shrunk to a ball, in the pixel through its center.

    A body has no part shorter than a millimeter, which bounds how near the two can be.
    """
    body = default_body().with_lengths(head=1e-3)
    radii = body.radii.copy()
    radii[CAPSULES.index("head")] = 0.1
    body = type(body)(body.lengths, radii)
    pose = standing()
    head = segment_frames(body, pose)[SEGMENTS.index("head"), :3, 3]
    pose[:2] = -head[:2]
    camera = Camera(400.0, 400.0, 20.0, 20.0, 41, 41)

    image = cast_rays(body, segment_frames(body, pose), camera)

    assert_allclose(image.depth_image()[20, 20], head[2] - 0.1, atol=1e-3)
    # The outline of a ball is where rays touch it: sine of the half angle = radius / distance.
    tangent = np.tan(np.arcsin(0.1 / head[2]))
    visible_height = (image.depth_image()[:20, 20] > 0.0).sum()
    assert visible_height == np.floor(400.0 * tangent)


def test_straight_limb_is_its_radius_nearer_than_its_axis():
    """An upper leg parallel to the image: in its middle column, depth = axis - radius."""
    body, pose = default_body(), standing()
    frames = segment_frames(body, pose)
    knee = frames[SEGMENTS.index("leftLowerLeg"), :3, 3]
    hip = frames[SEGMENTS.index("leftUpperLeg"), :3, 3]
    pose[:2] = -(0.3 * hip + 0.7 * knee)[:2]
    camera = Camera(400.0, 400.0, 5.0, 5.0, 11, 11)

    image = cast_rays(body, segment_frames(body, pose), camera)

    radius = body.radii[CAPSULES.index("leftUpperLeg"), 1]
    assert_allclose(image.depth_image()[:, 5], hip[2] - radius, atol=1e-9)


def test_elliptic_chest_is_wider_than_deep():
    body = default_body()
    front, side = (
        segment_image(cast_rays(body, segment_frames(body, standing(yaw=yaw)), CAMERA)) == 2
        for yaw in (0.0, np.pi / 2)
    )
    # From the side the arm covers the chest, so compare hips, spine and head.
    assert front.any(axis=0).sum() > side.any(axis=0).sum()


def test_pixels_are_unique_and_subsampling_keeps_depths():
    body, frames = default_body(), segment_frames(default_body(), standing(yaw=0.5))
    fine, coarse = (cast_rays(body, frames, camera) for camera in (CAMERA, CAMERA.every(2)))

    assert len(np.unique(fine.pixels)) == len(fine.pixels)
    assert (np.diff(fine.capsules) >= 0).all()
    assert_allclose(coarse.depth_image(), fine.depth_image()[::2, ::2], atol=1e-12)


def test_cast_rays_is_empty_outside_of_the_image():
    body = default_body()
    for position in ((30.0, 0.0, 3.0), (0.0, 0.0, -3.0), (0.0, 0.0, 0.1)):
        pose = standing()
        pose[:3] = position
        assert_array_equal(cast_rays(body, segment_frames(body, pose), CAMERA).pixels, [])
