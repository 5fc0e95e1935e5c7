"""Noise model of a Kinect v1: disparity steps, jitter, shadows and holes."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import Camera
from ...settings import Settings, setting
from .render_mesh import NO_PART, RenderedMesh

DISPARITY_STEPS_M = 351.3
"""Steps of disparity times meters [1]_: a step is z^2 / 351.3, 2.6 cm at 3 m. Handa 2014,
section IV."""


@dataclass(frozen=True, kw_only=True)
class SensorNoiseSettings(Settings):
    """Strength of the sensor noise; all zero keeps the exact depth."""

    jitter: float = setting(
        0.5, "Standard deviation of the pixel position; higher frays edges",
        unit="pixels", minimum=0.0, maximum=10.0,
    )  # fmt: skip
    disparity: float = setting(
        1.0 / 6.0, "Standard deviation of disparity; higher makes surfaces rough",
        unit="steps", minimum=0.0, maximum=10.0,
    )  # fmt: skip
    step: float = setting(
        1.0, "Quantization step of disparity; higher gives larger depth steps",
        unit="steps", minimum=0.0, maximum=10.0,
    )  # fmt: skip
    baseline: float = setting(
        0.075, "Distance of projector and camera; higher widens the shadows next to arms",
        unit="m", minimum=0.0, maximum=1.0,
    )  # fmt: skip
    edge_holes: float = setting(
        0.15, "Fraction of edge pixels without reading; higher frays outlines",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    holes: float = setting(
        0.002, "Fraction of other pixels without reading", minimum=0.0, maximum=1.0,
    )  # fmt: skip


EDGE_STEP_M = 0.05
"""Depth step between neighbors at an occlusion. Chosen by hand; used in training only."""


def add_sensor_noise(
    image: RenderedMesh,
    camera: Camera,
    rng: np.random.Generator,
    settings: SensorNoiseSettings = SensorNoiseSettings(),
) -> RenderedMesh:
    """Return the image with the noise of a structured-light sensor.

    Pixel positions jitter, and disparity is noisy and quantized [1]_. Pixels in the shadow of
    the projector, to the right of the camera, have no reading. Neither do random pixels, more
    of them at edges. Labels move with their pixels.

    References
    ----------
    .. [1] Handa, Whelan, McDonald, Davison (2014). A benchmark for RGB-D visual odometry, 3D
       reconstruction and SLAM. ICRA, section IV. doi:10.1109/ICRA.2014.6907054
    """
    depth, labels = _jitter_pixels(image, settings.jitter, rng)
    invalid = _projector_shadow(depth, camera, settings.baseline)
    random_values = rng.random(depth.shape, dtype=np.float32)
    invalid |= random_values < np.where(_edge_mask(depth), settings.edge_holes, settings.holes)
    depth = _quantize_depth(depth, settings, rng)
    invalid |= depth <= 0.0
    return RenderedMesh(
        np.where(invalid, np.float32(0.0), depth), np.where(invalid, np.uint8(NO_PART), labels)
    )


def _jitter_pixels(
    image: RenderedMesh, jitter: float, rng: np.random.Generator
) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
    height, width = image.depth.shape
    if not jitter:
        return image.depth, image.labels
    offsets = np.rint(jitter * rng.standard_normal((2, height, width), dtype=np.float32))
    rows = np.arange(height)[:, None] + offsets[0].astype(np.int64)
    columns = np.arange(width) + offsets[1].astype(np.int64)
    pixels = np.clip(rows, 0, height - 1), np.clip(columns, 0, width - 1)
    return image.depth[pixels], image.labels[pixels]


def _quantize_depth(
    depth: NDArray[np.float32], settings: SensorNoiseSettings, rng: np.random.Generator
) -> NDArray[np.float32]:
    """Return depth from noisy, quantized disparity."""
    if not (settings.disparity or settings.step):
        return depth
    valid = depth > 0.0
    disparity = DISPARITY_STEPS_M / np.where(valid, depth, np.float32(1.0))
    disparity += settings.disparity * rng.standard_normal(depth.shape, dtype=np.float32)
    if settings.step:
        disparity = np.rint(disparity / settings.step) * settings.step
    noisy_depth = DISPARITY_STEPS_M / np.maximum(disparity, 1.0)
    return np.where(valid, noisy_depth, 0.0).astype(np.float32)


def _projector_shadow(
    depth: NDArray[np.float32], camera: Camera, baseline: float
) -> NDArray[np.bool_]:
    """Return the mask of pixels in the shadow of the projector.

    A light ray hits all points of a row with equal u - f b / z.
    """
    if not baseline:
        return np.zeros(depth.shape, dtype=np.bool_)
    rows, columns = np.nonzero(depth)
    z = depth[rows, columns]
    shift = camera.fx * baseline / z
    max_shift = int(shift.max(initial=0.0)) + 2
    beam = (
        rows * (camera.width + max_shift)
        + np.rint(columns - shift).astype(np.int64)
        + max_shift
    )
    nearest = np.full(camera.height * (camera.width + max_shift) + 1, np.inf, dtype=np.float32)
    np.minimum.at(nearest, beam, z)
    shadow = np.zeros(depth.shape, dtype=np.bool_)
    shadow[rows, columns] = z > nearest[beam] + EDGE_STEP_M
    return shadow


def _edge_mask(depth: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Return the mask of pixels with a depth step to a neighbor in their row or column."""
    edge = np.zeros(depth.shape, dtype=np.bool_)
    across = np.abs(np.diff(depth, axis=1)) > EDGE_STEP_M
    down = np.abs(np.diff(depth, axis=0)) > EDGE_STEP_M
    edge[:, 1:] |= across
    edge[:, :-1] |= across
    edge[1:] |= down
    edge[:-1] |= down
    return edge
