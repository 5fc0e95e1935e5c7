"""What a Kinect of the first kind makes of exact depth: steps, jitter, shadows and holes."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...depth_scene import Camera
from ...settings import Settings, setting
from .render_mesh import NO_PART, RenderedMesh

Array = NDArray[np.float64]
DISPARITY = 351.3
"""Steps of disparity times metres [1]_: a step is z^2 / 351.3, 2.6 cm at 3 m."""


@dataclass(frozen=True, kw_only=True)
class SensorNoiseSettings(Settings):
    """How bad the sensor is; all zero leaves depth as it is."""

    jitter: float = setting(
        0.5, "Standard deviation of where a pixel looks; more frays edges",
        unit="pixels", minimum=0.0, maximum=10.0,
    )  # fmt: skip
    disparity: float = setting(
        1.0 / 6.0, "Standard deviation of disparity; more makes surfaces rough",
        unit="steps", minimum=0.0, maximum=10.0,
    )  # fmt: skip
    step: float = setting(
        1.0, "Step in which disparity is told; more makes stairs, as z squared",
        unit="steps", minimum=0.0, maximum=10.0,
    )  # fmt: skip
    baseline: float = setting(
        0.075, "Way from the projector to the camera; more widens the shadows beside arms",
        unit="m", minimum=0.0, maximum=1.0,
    )  # fmt: skip
    edge_holes: float = setting(
        0.15, "Share of the pixels at edges that see nothing; more frays outlines",
        minimum=0.0, maximum=1.0,
    )  # fmt: skip
    holes: float = setting(
        0.002, "Share of the other pixels that see nothing", minimum=0.0, maximum=1.0,
    )  # fmt: skip


NO_NOISE = SensorNoiseSettings(
    jitter=0.0, disparity=0.0, step=0.0, baseline=0.0, edge_holes=0.0, holes=0.0
)
EDGE_STEP_M = 0.05
"""Metres between neighbours beyond which one of them occludes the other."""


def add_sensor_noise(
    picture: RenderedMesh,
    camera: Camera,
    rng: np.random.Generator,
    settings: SensorNoiseSettings = SensorNoiseSettings(),
) -> RenderedMesh:
    """Return the picture as a structured-light sensor would tell it.

    Pixels look a little aside, disparity is rough and told in steps [1]_, what the projector to
    the right of the camera does not light is unseen, and so are pixels here and there, more of
    them at edges. Labels move along.

    References
    ----------
    .. [1] Handa, Whelan, McDonald, Davison (2014). A benchmark for RGB-D visual odometry, 3D
       reconstruction and SLAM. ICRA, section IV. doi:10.1109/ICRA.2014.6907054
    """
    depth, labels = _looked_aside(picture, settings.jitter, rng)
    unseen = _in_shadow(depth, camera, settings.baseline)
    draw = rng.random(depth.shape, dtype=np.float32)
    unseen |= draw < np.where(_at_edge(depth), settings.edge_holes, settings.holes)
    depth = _told(depth, settings, rng)
    unseen |= depth <= 0.0
    return RenderedMesh(
        np.where(unseen, np.float32(0.0), depth), np.where(unseen, np.uint8(NO_PART), labels)
    )


def _looked_aside(
    picture: RenderedMesh, jitter: float, rng: np.random.Generator
) -> tuple[NDArray[np.float32], NDArray[np.uint8]]:
    height, width = picture.depth.shape
    if not jitter:
        return picture.depth, picture.labels
    aside = np.rint(jitter * rng.standard_normal((2, height, width), dtype=np.float32))
    rows = np.arange(height)[:, None] + aside[0].astype(np.int64)
    columns = np.arange(width) + aside[1].astype(np.int64)
    spots = np.clip(rows, 0, height - 1), np.clip(columns, 0, width - 1)
    return picture.depth[spots], picture.labels[spots]


def _told(
    depth: NDArray[np.float32], settings: SensorNoiseSettings, rng: np.random.Generator
) -> NDArray[np.float32]:
    """Return depth from disparity that is rough and stepped."""
    if not (settings.disparity or settings.step):
        return depth
    seen = depth > 0.0
    disparity = DISPARITY / np.where(seen, depth, np.float32(1.0))
    disparity += settings.disparity * rng.standard_normal(depth.shape, dtype=np.float32)
    if settings.step:
        disparity = np.rint(disparity / settings.step) * settings.step
    told = DISPARITY / np.maximum(disparity, 1.0)
    return np.where(seen, told, 0.0).astype(np.float32)


def _in_shadow(
    depth: NDArray[np.float32], camera: Camera, baseline: float
) -> NDArray[np.bool_]:
    """Tell which pixels see what the projector does not light, for something is nearer to it.

    Light of one direction falls on all points of a row with equal u - f b / z.
    """
    if not baseline:
        return np.zeros(depth.shape, dtype=np.bool_)
    rows, columns = np.nonzero(depth)
    z = depth[rows, columns]
    shift = camera.fx * baseline / z
    widest = int(shift.max(initial=0.0)) + 2
    beam = rows * (camera.width + widest) + np.rint(columns - shift).astype(np.int64) + widest
    nearest = np.full(camera.height * (camera.width + widest) + 1, np.inf, dtype=np.float32)
    np.minimum.at(nearest, beam, z)
    unlit = np.zeros(depth.shape, dtype=np.bool_)
    unlit[rows, columns] = z > nearest[beam] + EDGE_STEP_M
    return unlit


def _at_edge(depth: NDArray[np.float32]) -> NDArray[np.bool_]:
    """Tell which pixels have a neighbour in their row or column at quite another depth."""
    edge = np.zeros(depth.shape, dtype=np.bool_)
    across = np.abs(np.diff(depth, axis=1)) > EDGE_STEP_M
    down = np.abs(np.diff(depth, axis=0)) > EDGE_STEP_M
    edge[:, 1:] |= across
    edge[:, :-1] |= across
    edge[1:] |= down
    edge[:-1] |= down
    return edge
