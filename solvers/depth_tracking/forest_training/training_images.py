"""Depth pictures with known parts: posed bodies of many shapes before cameras all around."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

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

Array = NDArray[np.float64]

CAMERA = Camera(142.8, 142.8, 79.5, 59.5, 160, 120)
"""Half the resolution of a Kinect of the first kind."""
CLOTHED = np.array([0.3 if part.endswith(("Hand", "neck")) else 1.0 for part in PARTS])
"""How much of the thickness of clothes each part may have; hair counts as such."""
FLOOR = 0.12
"""Metres above the lowest point that may be taken for the floor."""
IMAGES_PER_BODY = 10
"""Pictures of a block, which show the same body."""
AHEAD = 1.1
"""Radians to either side. Half of the bodies face the camera so nearly, the others anyhow."""


@dataclass(frozen=True, kw_only=True)
class TrainingImagesSettings(Settings):
    """Which poses, shapes and views there are."""

    n_pictures: int = setting(
        4000, "Pictures to learn from; more learns more poses and views, and takes longer",
        minimum=10, maximum=1_000_000,
    )  # fmt: skip
    spacing: float = setting(
        0.1, "Least difference of two poses, of the joint that differs most; more keeps fewer",
        unit="m", minimum=0.0, maximum=2.0,
    )  # fmt: skip
    n_poses: int = setting(
        3000, "Most poses kept, the most different ones", minimum=1, maximum=1_000_000
    )
    loose: float = setting(
        0.35, "How often an arm goes anywhere, or legs are those of another pose",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    shape: float = setting(
        0.08, "Standard deviation of the scale of height and of girth of a body",
        minimum=0.0, maximum=0.3,
    )  # fmt: skip
    clothes: float = setting(
        0.035, "How far clothes may hang off a body; more knows looser clothes",
        unit="m", minimum=0.0, maximum=0.2,
    )  # fmt: skip
    lost_feet: float = setting(
        0.3, "Share of pictures in which the lowest 12 cm or less went with the floor",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    nearest: float = setting(
        1.3, "Least distance of the camera", unit="m", minimum=0.3, maximum=20.0
    )
    farthest: float = setting(
        4.5, "Largest distance of the camera", unit="m", minimum=0.3, maximum=20.0
    )
    noise: float = setting(
        0.7, "Share of pictures as a noisy sensor sees them; the others are exact",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class ImageSource:
    """Draws pictures, block by block, each a pure function of its number and the seed."""

    mixer: PoseMixer
    bodies: tuple[SkinnedBody, ...]
    settings: TrainingImagesSettings
    seed: int

    def pictures(self, block: int) -> list[RenderedMesh]:
        """Return pictures by `CAMERA`, (120, 160), of one shape of body in random poses."""
        rng = np.random.default_rng((self.seed, block))
        body = vary_body(self.bodies, rng, self.settings)
        drawn = [self.mixer.draw(rng, self.settings.loose) for _ in range(IMAGES_PER_BODY)]
        poses = from_canonical(np.stack(drawn), body.skeleton, body.humanoid)
        return [self._picture(body, pose, rng) for pose in poses]

    def _picture(
        self, body: SkinnedBody, pose: Array, rng: np.random.Generator
    ) -> RenderedMesh:
        vertices, _ = body.pose(pose, np.zeros(3))
        triangles = body.triangles
        if rng.random() < self.settings.lost_feet:
            above = vertices[:, 2] > vertices[:, 2].min() + rng.uniform(0.0, FLOOR)
            triangles = triangles[above[triangles].all(axis=1)]
        vertices = _before_camera(vertices, rng, self.settings)
        picture = render_mesh(vertices, triangles, body.vertex_parts, CAMERA)
        if rng.random() >= self.settings.noise:
            return picture
        usual, strength = SensorNoiseSettings(), rng.uniform(0.5, 1.5)
        noise = replace(
            usual,
            jitter=0.5 * usual.jitter * strength,
            disparity=usual.disparity * strength,
            edge_holes=usual.edge_holes * strength,
        )
        return add_sensor_noise(picture, CAMERA, rng, noise)


def image_source(
    poses: Sequence[Motion],
    bodies: Sequence[SkinnedBody],
    settings: TrainingImagesSettings,
    seed: int,
) -> ImageSource:
    """Gather the different poses of some motions for bodies of the same joints.

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
    kept = select_diverse_poses(first, upright, settings.spacing, settings.n_poses)
    still = Motion(first.skeleton, kept, np.zeros((len(kept), 3)), 1.0)
    mixer = PoseMixer(first, canonical_rotations(still, first.humanoid))
    return ImageSource(mixer, tuple(bodies), settings, seed)


def vary_body(
    bodies: Sequence[SkinnedBody], rng: np.random.Generator, settings: TrainingImagesSettings
) -> SkinnedBody:
    """Return a body between two of these where their meshes are alike, resized and dressed."""
    body = bodies[rng.integers(len(bodies))]
    other = bodies[rng.integers(len(bodies))]
    share = rng.random()
    girth, height = np.exp(settings.shape * rng.standard_normal(2))
    scale = np.array([girth, girth, height])
    vertices, offsets = body.vertices, body.skeleton.offsets
    if other.vertices.shape == vertices.shape:
        vertices = (1.0 - share) * vertices + share * other.vertices
        offsets = (1.0 - share) * offsets + share * other.skeleton.offsets
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
    """Turn a body about the vertical and put it before a camera, x right, y down, z ahead.

    The camera is at any height of a person's, and looks at a point near the middle of the body,
    tilted and rolled as that takes and a little besides.
    """
    yaw = rng.uniform(-AHEAD, AHEAD) if rng.random() < 0.5 else rng.uniform(-np.pi, np.pi)
    turn = _turn(yaw, 2)
    lowest, highest = vertices[:, 2].min(), vertices[:, 2].max()
    middle = np.array([0.0, 0.0, (lowest + highest) / 2.0])
    points = (vertices - middle) @ turn.T
    seen = np.stack([points[:, 0], -points[:, 2], points[:, 1]], axis=1)
    distance = rng.uniform(settings.nearest, settings.farthest)
    height = rng.uniform(-0.6, 1.1)
    tilt = np.arctan2(height, distance) * rng.uniform(0.3, 1.1) + 0.05 * rng.standard_normal()
    seen += [0.0, height, distance]
    seen = seen @ (_turn(tilt, 0) @ _turn(0.05 * rng.standard_normal(), 2)).T
    aside = rng.uniform(-0.3, 0.3) * distance + 0.02 * rng.standard_normal()
    shift = np.array([aside, 0.05 * distance * rng.standard_normal(), 0.0])
    return np.asarray(seen + shift)


def _turn(angle: float, axis: int) -> Array:
    """Return the matrix of a turn about a coordinate axis."""
    first, second = (axis + 1) % 3, (axis + 2) % 3
    turn = np.eye(3)
    turn[[first, second], [first, second]] = np.cos(angle)
    turn[second, first], turn[first, second] = np.sin(angle), -np.sin(angle)
    return turn
