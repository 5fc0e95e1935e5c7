"""Synthetic training images: posed bodies of many shapes, viewed from all around."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from ...arrays import Array
from ...depth_scene import Camera
from ...errors import InvalidMotionError
from ...motion import Motion, Skeleton, from_canonical
from ...motion.humanoid import canonical_rotations
from ...settings import Settings, setting
from ..forest import MIRRORED_PARTS, N_PARTS, PARTS
from .augmented_poses import PoseMixer, remove_heading, select_diverse_poses
from .render_mesh import RenderedMesh, render_mesh
from .sensor_noise import SensorNoiseSettings, add_sensor_noise
from .skinned_body import SkinnedBody

CAMERA = Camera(142.8, 142.8, 79.5, 59.5, 160, 120)
"""Half the resolution of a Kinect v1."""
CLOTHED = np.array([0.3 if part.endswith(("Hand", "neck")) else 1.0 for part in PARTS])
"""Relative thickness of clothes (or hair) on each part."""
MAX_FLOOR_HEIGHT_M = 0.12
"""Maximum height in meters removed with the floor. Chosen by hand; used in training only."""
IMAGES_PER_BODY = 10
"""Number of images per random body."""
MAX_HEADING_RAD = 1.1
"""Maximum heading offset, radians, for half of the bodies; the others have any heading. Chosen
by hand; used in training only."""


@dataclass(frozen=True, kw_only=True)
class TrainingImagesSettings(Settings):
    """Settings of poses, shapes and views of the training images."""

    n_images: int = setting(
        4000, "Number of training images; more cover more poses and views, and take longer",
        minimum=10, maximum=1_000_000,
    )  # fmt: skip
    spacing: float = setting(
        0.1, "Minimum distance of two poses (largest joint distance); higher keeps fewer",
        unit="m", minimum=0.0, maximum=2.0,
    )  # fmt: skip
    n_poses: int = setting(
        3000, "Maximum number of poses; the most diverse are kept", minimum=1, maximum=1_000_000
    )
    loose: float = setting(
        0.35, "Probability of a random arm, or of the legs of another pose",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    shape: float = setting(
        0.08, "Standard deviation of the scale of height and of girth of a body",
        minimum=0.0, maximum=0.3,
    )  # fmt: skip
    clothes: float = setting(
        0.035, "Maximum thickness of clothes; higher covers looser clothes",
        unit="m", minimum=0.0, maximum=0.2,
    )  # fmt: skip
    missing_feet: float = setting(
        0.3, "Fraction of images where up to 12 cm above the floor is removed",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    min_distance: float = setting(
        1.3, "Minimum distance of the camera", unit="m", minimum=0.3, maximum=20.0
    )
    max_distance: float = setting(
        4.5, "Maximum distance of the camera", unit="m", minimum=0.3, maximum=20.0
    )
    noise: float = setting(
        0.7, "Fraction of images with sensor noise; the others are exact",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class ImageSource:
    """Renders images in blocks, each a pure function of its number and the seed."""

    mixer: PoseMixer
    bodies: tuple[SkinnedBody, ...]
    settings: TrainingImagesSettings
    seed: int

    def render(self, block: int) -> list[RenderedMesh]:
        """Return images by `CAMERA`, (120, 160), of one shape of body in random poses."""
        rng = np.random.default_rng((self.seed, block))
        body = vary_body(self.bodies, rng, self.settings)
        drawn = [self.mixer.draw(rng, self.settings.loose) for _ in range(IMAGES_PER_BODY)]
        poses = from_canonical(np.stack(drawn), body.skeleton, body.humanoid)
        return [self._render_pose(body, pose, rng) for pose in poses]

    def _render_pose(
        self, body: SkinnedBody, pose: Array, rng: np.random.Generator
    ) -> RenderedMesh:
        vertices, _ = body.pose(pose, np.zeros(3))
        triangles = body.triangles
        if rng.random() < self.settings.missing_feet:
            above = vertices[:, 2] > vertices[:, 2].min() + rng.uniform(0.0, MAX_FLOOR_HEIGHT_M)
            triangles = triangles[above[triangles].all(axis=1)]
        vertices = _before_camera(vertices, rng, self.settings)
        image = render_mesh(vertices, triangles, body.vertex_parts, CAMERA)
        if rng.random() >= self.settings.noise:
            return image
        default, strength = SensorNoiseSettings(), rng.uniform(0.5, 1.5)
        noise = replace(
            default,
            jitter=0.5 * default.jitter * strength,
            disparity=default.disparity * strength,
            edge_holes=default.edge_holes * strength,
        )
        return add_sensor_noise(image, CAMERA, rng, noise)


def image_source(
    poses: Sequence[Motion],
    bodies: Sequence[SkinnedBody],
    settings: TrainingImagesSettings,
    seed: int,
) -> ImageSource:
    """Collect diverse poses of motions for bodies with the same joints.

    Raises
    ------
    InvalidMotionError
        There are no motions or bodies, or the bodies have different joints.
    """
    if not poses or not bodies:
        raise InvalidMotionError("Learning pixels needs at least one motion and one body.")
    first = bodies[0]
    if any(not first.skeleton.same_joints(body.skeleton) for body in bodies):
        raise InvalidMotionError("Bodies to learn pixels from must have the same joints.")
    rotations = np.concatenate([first.rotations_of(motion) for motion in poses])
    upright = remove_heading(rotations)
    selected = select_diverse_poses(first, upright, settings.spacing, settings.n_poses)
    still = Motion(first.skeleton, selected, np.zeros((len(selected), 3)), 1.0)
    mixer = PoseMixer(first, canonical_rotations(still, first.humanoid))
    return ImageSource(mixer, tuple(bodies), settings, seed)


def vary_body(
    bodies: Sequence[SkinnedBody], rng: np.random.Generator, settings: TrainingImagesSettings
) -> SkinnedBody:
    """Return a random blend of two compatible bodies, scaled and clothed."""
    body = bodies[rng.integers(len(bodies))]
    other = bodies[rng.integers(len(bodies))]
    fraction = rng.random()
    girth, height = np.exp(settings.shape * rng.standard_normal(2))
    scale = np.array([girth, girth, height])
    vertices, offsets = body.vertices, body.skeleton.offsets
    if other.vertices.shape == vertices.shape:
        vertices = (1.0 - fraction) * vertices + fraction * other.vertices
        offsets = (1.0 - fraction) * offsets + fraction * other.skeleton.offsets
    dressed = CLOTHED * rng.uniform(0.0, settings.clothes, N_PARTS)
    dressed = np.minimum(dressed, dressed[MIRRORED_PARTS])
    vertices = vertices + dressed[body.vertex_parts, np.newaxis] * body.vertex_normals
    skeleton = Skeleton(body.skeleton.names, body.skeleton.parents, offsets * scale)
    made = replace(body, skeleton=skeleton, vertices=vertices * scale)
    # Neither roles nor parts change with the shape, and both take long to find.
    made.__dict__.update(humanoid=body.humanoid, vertex_parts=body.vertex_parts)
    return made


def _before_camera(
    vertices: Array, rng: np.random.Generator, settings: TrainingImagesSettings
) -> Array:
    """Place a body with random heading in a camera frame, x right, y down, z forward.

    The camera has a random height and looks near the center of the body, with a small random
    tilt and roll.
    """
    yaw = (
        rng.uniform(-MAX_HEADING_RAD, MAX_HEADING_RAD)
        if rng.random() < 0.5
        else rng.uniform(-np.pi, np.pi)
    )
    rotation = _rotation_about(yaw, 2)
    lowest, highest = vertices[:, 2].min(), vertices[:, 2].max()
    middle = np.array([0.0, 0.0, (lowest + highest) / 2.0])
    points = (vertices - middle) @ rotation.T
    camera_points = np.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1)
    distance = rng.uniform(settings.min_distance, settings.max_distance)
    height = rng.uniform(-0.6, 1.1)
    tilt = np.arctan2(height, distance) * rng.uniform(0.3, 1.1) + 0.05 * rng.standard_normal()
    camera_points += [0.0, height, distance]
    camera_points = (
        camera_points
        @ (_rotation_about(tilt, 0) @ _rotation_about(0.05 * rng.standard_normal(), 2)).T
    )
    aside = rng.uniform(-0.3, 0.3) * distance + 0.02 * rng.standard_normal()
    shift = np.array([aside, 0.05 * distance * rng.standard_normal(), 0.0])
    return np.asarray(camera_points + shift)


def _rotation_about(angle: float, axis: int) -> Array:
    """Return the rotation matrix about a coordinate axis."""
    first, second = (axis + 1) % 3, (axis + 2) % 3
    rotation = np.eye(3)
    rotation[[first, second], [first, second]] = np.cos(angle)
    rotation[second, first], rotation[first, second] = np.sin(angle), -np.sin(angle)
    return rotation
