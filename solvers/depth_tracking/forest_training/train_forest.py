"""Train the pixel forest on motions and skinned bodies."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...motion import Motion
from ...progress import Progress, unwatched, within
from ...settings import setting
from ..forest import (
    N_PARTS,
    PixelFeatures,
    PixelForest,
    TreeSettings,
    grow_tree,
    pad_depth_image,
    pixel_features,
)
from .render_mesh import NO_PART, RenderedMesh
from .skinned_body import SkinnedBody
from .training_images import (
    CAMERA,
    IMAGES_PER_BODY,
    ImageSource,
    TrainingImagesSettings,
    image_source,
)


@dataclass(frozen=True, kw_only=True)
class PixelForestSettings(TrainingImagesSettings, TreeSettings):
    """Settings of the forest and its training data."""

    n_trees: int = setting(
        3, "Number of trees; more are more accurate and slower", minimum=1, maximum=100
    )
    n_pixels: int = setting(
        120, "Training pixels per image and tree", minimum=1, maximum=20_000
    )
    seed: int = setting(0, "Seed of the random images and tests", minimum=0)


class LabeledImages(NamedTuple):
    """Training images with part labels."""

    images: NDArray[np.uint16]
    """Of `pad_depth_image`, (n_images, height + 2, width + 2)."""
    labels: NDArray[np.uint8]
    """(n_images, height, width)."""


def train_pixel_forest(
    poses: Sequence[Motion],
    bodies: Sequence[SkinnedBody],
    settings: PixelForestSettings = PixelForestSettings(),
    *,
    trained_on: str = "",
    progress: Progress = unwatched,
) -> PixelForest:
    """Train a forest that classifies the body part of depth pixels.

    Diverse poses of the clips are mixed. The posed bodies are rendered from all around, with
    and without sensor noise. Randomized trees over depth differences are grown on them [1]_.

    Parameters
    ----------
    poses : sequence of Motion
        Any humanoids.
    bodies : sequence of SkinnedBody
        Bodies with the same joints.
    settings : PixelForestSettings
    trained_on : str
        Description of the poses and bodies, stored in the forest.
    progress : Progress

    Raises
    ------
    InvalidMotionError
        There are no poses, no bodies, or bodies of different joints.

    References
    ----------
    .. [1] Wei, Zhang, Chai (2012). Accurate realtime full-body motion capture using a single
       depth camera. ACM Transactions on Graphics 31(6), section 4.1.
       doi:10.1145/2366145.2366207
    """
    source = image_source(poses, bodies, settings, settings.seed)
    images = draw_images(source, range(-(-settings.n_images // IMAGES_PER_BODY)))
    progress(0.2, "Growing trees")
    grown = []
    for number in range(settings.n_trees):
        rng = np.random.default_rng((settings.seed, number, 1))
        views, parts = draw_pixels(images, settings.n_pixels, rng)
        start, stop = 0.2 + 0.8 * np.array([number, number + 1]) / settings.n_trees
        grown.append(
            grow_tree(views, parts, settings, rng, progress=within(progress, start, stop))
        )
    return PixelForest(tuple(grown), trained_on)


def draw_images(source: ImageSource, blocks: Sequence[int]) -> LabeledImages:
    """Render some blocks of training images."""
    drawn: list[RenderedMesh] = [one for block in blocks for one in source.render(block)]
    return LabeledImages(
        np.stack([pad_depth_image(image.depth) for image in drawn]),
        np.stack([image.labels for image in drawn]),
    )


def draw_pixels(
    images: LabeledImages, n_pixels: int, rng: np.random.Generator
) -> tuple[PixelFeatures, NDArray[np.uint8]]:
    """Sample pixels and their parts from each image, with more weight on small parts.

    A part of k pixels is sampled in proportion to the square root of k.
    """
    positions = []
    area = images.labels.shape[1] * images.labels.shape[2]
    for number, labels in enumerate(images.labels.reshape(len(images.labels), -1)):
        body = np.flatnonzero(labels != NO_PART)
        if not len(body):
            continue
        sizes = np.bincount(labels[body], minlength=N_PARTS)
        # Exponential races: the first n are a weighted sample without replacement.
        races = rng.standard_exponential(len(body)) * np.sqrt(sizes[labels[body]])
        first = min(n_pixels, len(body)) - 1
        positions.append(number * area + body[np.argpartition(races, first)[: first + 1]])
    if not positions:
        raise InvalidMotionError("No training image shows a body.")
    samples = np.concatenate(positions)
    number, rest = np.divmod(samples, area)
    rows, columns = np.divmod(rest, images.labels.shape[2])
    views = pixel_features(images.images, number, rows, columns, CAMERA)
    return views, images.labels.reshape(-1)[samples]
