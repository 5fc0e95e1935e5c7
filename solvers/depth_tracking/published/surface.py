"""The surface term of [LOU12]: visible points match close points of similar color."""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array, Integers
from ...depth_scene import DepthRecording
from ..body import CAPSULE_SEGMENTS, SurfaceRows, rows_toward_targets
from ..terms import Hypothesis, Observation, subsampling_step

WINDOW_RADIUS_PX = 7
"""Half size of the search window at 320 columns: 15 x 15 pixels."""
GRID_STEP_PX = 4
"""Spacing of the matched points at 320 columns."""
COLOR_WEIGHT_M = 1e-4
"""Distance equivalent to an intensity difference of 1 (of 255). [LOU12] section 3.4.1."""


@dataclass(frozen=True, eq=False)
class ColoredFrame:
    """The observed actor, with colors.

    Attributes
    ----------
    observation : Observation
    intensities : shape (height * width,)
        Brightness of all pixels, 0 to 255; NaN without color.
    """

    observation: Observation
    intensities: Array


def read_intensities(depth: DepthRecording, frame: int, image_width: int) -> Array:
    """Return the brightness (n,) of the pixels that `observe` keeps; NaN without color."""
    step = subsampling_step(depth.camera, image_width)
    color = depth.color(frame)
    if color is None:
        camera = depth.camera.every(step)
        return np.full(camera.width * camera.height, np.nan)
    gray: Array = color[::step, ::step].astype(np.float64).mean(axis=2).ravel()
    return gray


@dataclass(frozen=True, eq=False)
class PreviousFrame:
    """The previous frame: segment transforms and colors.

    Attributes
    ----------
    frames : shape (17, 4, 4)
        camera_from_segment of each segment.
    colored : ColoredFrame
    """

    frames: Array
    colored: ColoredFrame


def surface_term(
    hypothesis: Hypothesis,
    colored: ColoredFrame,
    previous: PreviousFrame | None,
    weight: float,
) -> SurfaceRows:
    """Return the rows of the surface term of [LOU12]_, eq. 3.4 to 3.7.

    Points on a grid of pixels match the closest observed point in a window of 15 x 15 pixels
    (at 320 columns). The cost is the distance plus 0.0001 times the difference in intensity. A
    point takes its intensity from the previous frame. Without color, or if the point was
    occluded, only the distance counts.

    Parameters
    ----------
    hypothesis : Hypothesis
    colored : ColoredFrame
    previous : PreviousFrame or None
    weight : float, per square meter

    References
    ----------
    .. [LOU12] Lou (2012). Acquiring 3D full-body motion from noisy and ambiguous input. PhD
       dissertation, Texas A&M University, section 3.4.1.
    """
    observation, camera = colored.observation, colored.observation.camera
    scale = camera.width / 320.0
    rows, columns = np.divmod(hypothesis.image.pixels, camera.width)
    step = max(1, round(GRID_STEP_PX * scale))
    chosen = np.flatnonzero((rows % step == 0) & (columns % step == 0))
    pixels = window_pixels(
        rows[chosen], columns[chosen], observation, round(WINDOW_RADIUS_PX * scale)
    )
    points = hypothesis.points[chosen]
    offsets = observation.points_at(pixels.ravel()).reshape(*pixels.shape, 3)
    offsets -= points[:, np.newaxis]
    costs = np.sqrt(np.einsum("nki,nki->nk", offsets, offsets))
    if previous is not None:
        costs += COLOR_WEIGHT_M * _color_differences(
            hypothesis, chosen, colored.intensities[pixels], previous
        )
    costs[observation.flat[pixels] == 0.0] = np.inf
    best = costs.argmin(axis=1)
    each = np.arange(len(chosen))
    has_match = np.isfinite(costs[each, best])
    targets = points + offsets[each, best]
    return rows_toward_targets(
        points[has_match], targets[has_match], np.full(int(has_match.sum()), weight),
        hypothesis.image.capsules[chosen[has_match]],
    )  # fmt: skip


def window_pixels(
    rows: Integers, columns: Integers, observation: Observation, radius: int
) -> Integers:
    """Return the pixels (n, k) of square windows around positions, clipped at the border."""
    camera = observation.camera
    offsets = np.arange(-radius, radius + 1)
    down = np.clip(rows[:, np.newaxis] + offsets, 0, camera.height - 1)
    across = np.clip(columns[:, np.newaxis] + offsets, 0, camera.width - 1)
    pixels = down[:, :, np.newaxis] * camera.width + across[:, np.newaxis, :]
    flat: Integers = pixels.reshape(len(rows), -1)
    return flat


def _color_differences(
    hypothesis: Hypothesis,
    chosen: Integers,
    current: Array,
    previous: PreviousFrame,
) -> Array:
    """Return the intensity differences (n, k) to the previous frame; 0 if unknown."""
    previous_values = previous_intensities(hypothesis, chosen, previous)
    differences: Array = np.abs(current - previous_values[:, np.newaxis])
    return np.nan_to_num(differences)


def previous_intensities(
    hypothesis: Hypothesis, chosen: Integers, previous: PreviousFrame
) -> Array:
    """Return the intensities, (n,), of points in the previous frame, NaN if occluded."""
    segments = CAPSULE_SEGMENTS[hypothesis.image.capsules[chosen]]
    current, previous_frames = hypothesis.frames[segments], previous.frames[segments]
    local = np.einsum(
        "nji,nj->ni", current[:, :3, :3], hypothesis.points[chosen] - current[:, :3, 3]
    )
    before = (
        np.einsum("nij,nj->ni", previous_frames[:, :3, :3], local) + previous_frames[:, :3, 3]
    )
    observation = previous.colored.observation
    camera = observation.camera
    columns, rows = np.nan_to_num(np.rint(camera.project(before)), nan=-1.0).astype(int).T
    inside = (columns >= 0) & (rows >= 0) & (columns < camera.width) & (rows < camera.height)
    pixels = np.where(inside, rows * camera.width + columns, 0)
    visible = inside & (observation.flat[pixels] > 0.0)
    return np.where(visible, previous.colored.intensities[pixels], np.nan)
