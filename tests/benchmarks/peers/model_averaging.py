"""Model averaging for missing markers (Tits, Tilmanne, Dutoit 2018), after reading its program.

"Robust and automatic motion-capture data recovery using soft skeleton constraints and model
averaging", doi:10.1371/journal.pone.0199744: five estimates of each gap (interpolation,
quadratic regression and kernel regression in the frame of three markers that keep their
distances; linear regression on all such markers; PMA-R2), each pulled to the gap's borders,
averaged by how likely they make the distances to the three. Its pre-filtering is left out (our
takes are clean), and filled markers do not help to fill others.
"""

import numpy as np
from numpy.typing import NDArray

from solvers.arrays import Array
from solvers.signals import find_runs

from .marker_fillers import principal_markers

MAX_DISTANCE_CHANGE_M = 0.05
"""Meters: markers whose distance varies more do not enter the global regression."""
KERNEL_WIDTH = 0.3
"""Width of the kernel regression, for standardized predictors."""
MAX_FRAMES = 1000
SHELL = (0.01, 0.99)
"""Quantiles of the distances outside which estimates are pulled back."""


def model_averaging(gapped: Array, frame_rate: float) -> Array:
    """Fill every gap; works relative to the mean marker (see `marker_fillers.centered`)."""
    filled = gapped.copy()
    missing = np.isnan(gapped).any(axis=2)
    by_components = principal_markers(gapped, frame_rate)
    for marker in np.flatnonzero(missing.any(axis=0)):
        gaps = [slice(*run) for run in find_runs(missing[:, marker])]
        for gap in gaps:
            with_ends = slice(max(gap.start - 1, 0), gap.stop + 1)
            present = ~missing[with_ends].any(axis=0)
            present[marker] = False
            filled[gap, marker] = _averaged(gapped, marker, gap, present, by_components)
    return filled


def _averaged(
    gapped: Array, marker: int, gap: slice, present: NDArray[np.bool_], by_components: Array
) -> Array:
    complete = ~np.isnan(gapped).any(axis=(1, 2))
    learned = np.flatnonzero(complete)[:: max(complete.sum() // MAX_FRAMES, 1)]
    distances = np.linalg.norm(gapped - gapped[:, [marker]], axis=2)
    varies = np.where(present, distances[learned].std(axis=0), np.inf)
    nearest = np.argsort(varies)[:3]
    origin, frames = _local_frames(gapped[:, nearest])
    local = np.einsum("fji,fj->fi", frames, gapped[:, marker] - origin)
    shape = _shape_of(gapped[:, nearest])
    locals_ = [
        np.full_like(local, np.nan),
        _regression(_quadratic(shape), local, learned),
        _kernel_regression(shape, local, learned, gap),
    ]
    estimates = []
    for number, each in enumerate(locals_):
        joined = _interpolated(local, gap) if number == 0 else _joined(each, local, gap)
        estimates.append(origin[gap] + np.einsum("fij,fj->fi", frames[gap], joined))
    rigid = np.flatnonzero(varies < max(MAX_DISTANCE_CHANGE_M, np.sort(varies)[2] * 1.01))
    others = gapped[:, rigid].reshape(len(gapped), -1)
    linear = _regression(others, gapped[:, marker], learned)
    estimates.append(_joined(linear, gapped[:, marker], gap))
    estimates.append(_joined(by_components[:, marker], gapped[:, marker], gap, outside=False))
    references = gapped[gap][:, nearest]
    samples = distances[learned][:, nearest]
    return _within_shells(
        _weighted(np.array(estimates), references, samples), references, samples
    )


def _weighted(estimates: Array, references: Array, samples: Array) -> Array:
    weights = np.ones(estimates.shape[:2])
    for index in range(3):
        distances = np.linalg.norm(estimates - references[:, index], axis=2)
        weights *= _density(samples[:, index], distances)
    weights = np.maximum(weights, 1e-200)
    weights /= weights.sum(axis=0)
    return np.einsum("ef,efi->fi", weights, estimates)


def _density(samples: Array, where: Array) -> Array:
    width = max(1.06 * samples.std() * len(samples) ** -0.2, 1e-5)
    distances = (where[..., None] - samples) / width
    return np.asarray(np.exp(-0.5 * distances**2).mean(axis=-1) / width)


def _within_shells(estimate: Array, references: Array, samples: Array) -> Array:
    low, high = np.quantile(samples, SHELL, axis=0)
    for _ in range(10):
        for index in range(3):
            arm = estimate - references[:, index]
            length = np.linalg.norm(arm, axis=1, keepdims=True)
            wanted = np.clip(length, low[index], high[index])
            estimate = references[:, index] + arm * wanted / length
    return estimate


def _regression(predictors: Array, wanted: Array, learned: NDArray[np.intp]) -> Array:
    design = np.column_stack([np.ones(len(predictors)), _standard(predictors, learned)])
    usable = np.isfinite(design).all(axis=1)
    coefficients = np.linalg.lstsq(design[learned], wanted[learned], rcond=1e-6)[0]
    result = np.full((len(design), 3), np.nan)
    result[usable] = design[usable] @ coefficients
    return result


def _kernel_regression(
    shape: Array, wanted: Array, learned: NDArray[np.intp], gap: slice
) -> Array:
    points = _standard(shape, learned)
    rows = np.arange(max(gap.start - 1, 0), min(gap.stop + 1, len(shape)))
    squared = ((points[rows][:, None] - points[learned][None]) ** 2).sum(axis=2)
    squared -= squared.min(axis=1, keepdims=True)
    weights = np.exp(-squared * (np.log(2.0) / KERNEL_WIDTH**2))
    result = np.full_like(wanted, np.nan)
    result[rows] = weights @ wanted[learned] / weights.sum(axis=1, keepdims=True)
    return result


def _standard(values: Array, learned: NDArray[np.intp]) -> Array:
    deviation = values[learned].std(axis=0)
    return (values - values[learned].mean(axis=0)) / np.where(deviation > 0, deviation, 1.0)


def _quadratic(values: Array) -> Array:
    first, second = np.triu_indices(values.shape[1])
    return np.hstack([values, values[:, first] * values[:, second]])


def _local_frames(three: Array) -> tuple[Array, Array]:
    """Origin and axes (columns) of the frame that three markers span."""
    a, b, c = three[:, 0], three[:, 1], three[:, 2]
    x = (b - a) / np.linalg.norm(b - a, axis=1, keepdims=True)
    z = np.cross(x, c - a)
    z /= np.linalg.norm(z, axis=1, keepdims=True)
    return a, np.stack([x, np.cross(z, x), z], axis=2)


def _shape_of(three: Array) -> Array:
    """Three numbers that say the shape of the triangle."""
    sides = [three[:, 1] - three[:, 0], three[:, 2] - three[:, 0], three[:, 2] - three[:, 1]]
    return np.stack([np.linalg.norm(side, axis=1) for side in sides], axis=1)


def _interpolated(track: Array, gap: slice) -> Array:
    frames = np.arange(len(track))
    complete = np.isfinite(track).all(axis=1)
    columns = [np.interp(frames[gap], frames[complete], column[complete]) for column in track.T]
    return np.stack(columns, axis=1)


def _joined(estimate: Array, track: Array, gap: slice, outside: bool = True) -> Array:
    """Add a ramp so that the estimate meets the track at both ends of the gap."""
    ends = [gap.start - 1, gap.stop]
    inner = ends if outside else [gap.start, gap.stop - 1]
    misses = [
        track[end] - estimate[near] if 0 <= end < len(track) else None
        for end, near in zip(ends, inner, strict=True)
    ]
    start, stop = (
        next((miss for miss in order if miss is not None), np.zeros(3))
        for order in (misses, misses[::-1])
    )
    weight = (np.arange(gap.stop - gap.start) + 1.0)[:, None] / (gap.stop - gap.start + 1)
    return np.asarray(estimate[gap] + (1 - weight) * start + weight * stop)
