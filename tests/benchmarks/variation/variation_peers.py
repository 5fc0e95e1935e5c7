"""Other methods to vary motions: copies, Perlin noise, and two written from their papers.

All work at 30 Hz on the curves of examples: the root's path and rotation vectors.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.distance import cdist

from solvers.motion import Motion, resample
from solvers.rotations.representations import mean_rotation
from solvers.variation import Partition
from solvers.variation.curves.motion_curves import (
    N_ROOT_CHANNELS,
    MotionCurves,
    curves_from_motion,
    headings_from_motion,
    motion_from_curves,
    remove_heading,
)
from solvers.variation.curves.partitions import partition_joints

RATE_HZ = 30.0
OCTAVES = ((1.0, 1.0), (2.0, 0.5), (4.0, 0.25))
"""Frequencies of Perlin noise in hertz, and their strengths."""
BANDWIDTH = 0.25
"""Bandwidth of the kernel regression, in median distances of examples."""
PATCH, COARSEST, GROWTH, ROUNDS, ALPHA = 11, 0.25, 1.35, 4, 0.01
"""Of generative motion matching: patch in frames, first part of the length, growth of stages,
rounds in a stage, completeness."""


@dataclass(frozen=True, eq=False)
class Flat:
    """Examples as rows of numbers at 30 Hz."""

    skeleton: object
    mean: np.ndarray
    rows: list[np.ndarray]
    """Each (n_frames, 4 + 3 n_joints)."""

    def motion(self, rows: np.ndarray) -> Motion:
        joints = rows[:, N_ROOT_CHANNELS:].reshape(len(rows), -1, 3)
        return motion_from_curves(
            MotionCurves(rows[:, :N_ROOT_CHANNELS], joints),
            self.skeleton,
            self.mean,
            RATE_HZ,
            np.zeros(3),
        )


def flatten(examples: Sequence[Motion]) -> Flat:
    motions = [resample(one, RATE_HZ) for one in examples]
    headings = [headings_from_motion(one) for one in motions]
    plain = [
        remove_heading(one, heading) for one, heading in zip(motions, headings, strict=True)
    ]
    mean = mean_rotation(np.concatenate(plain))
    rows = []
    for motion, heading in zip(motions, headings, strict=True):
        curves = curves_from_motion(motion, heading, mean)
        rows.append(np.column_stack([curves.root, curves.joints.reshape(motion.n_frames, -1)]))
    return Flat(examples[0].skeleton, mean, rows)


def copies(examples: Sequence[Motion], n: int, rng: np.random.Generator) -> list[Motion]:
    return [examples[index % len(examples)] for index in range(n)]


def perlin(examples: Sequence[Motion], n: int, rng: np.random.Generator) -> list[Motion]:
    """Add Perlin noise (1985) as strong as examples differ from their mean pose."""
    flat = flatten(examples)
    means = np.stack([rows.mean(axis=0) for rows in flat.rows])
    strength = means.std(axis=0)
    strength[:3] = 0.0
    made = []
    for index in range(n):
        rows = flat.rows[index % len(flat.rows)]
        times = np.arange(len(rows)) / RATE_HZ
        noise = sum(
            part * _gradient_noise(times * tone, rows.shape[1], rng) for tone, part in OCTAVES
        )
        made.append(flat.motion(rows + strength * noise / noise.std()))
    return made


def _gradient_noise(times: np.ndarray, n: int, rng: np.random.Generator) -> np.ndarray:
    slopes = rng.uniform(-1.0, 1.0, (int(times[-1]) + 2, n))
    lower = times.astype(int)
    part = (times - lower)[:, None]
    fade = part**3 * (part * (6.0 * part - 15.0) + 10.0)
    return (1.0 - fade) * slopes[lower] * part + fade * slopes[lower + 1] * (part - 1.0)


def lau(examples: Sequence[Motion], n: int, rng: np.random.Generator) -> list[Motion]:
    """Sample a second-order dynamic Bayesian network by kernel regression (Lau et al. 2009).

    Written from the description in [ZH14]; a node is a partition, the root with the trunk, and
    its parents are itself in the two frames before; the output is the change of a frame.
    """
    flat = flatten(examples)
    members = np.repeat(partition_joints(flat.skeleton), 3, axis=1)
    nodes = [
        np.concatenate([[row == 0] * N_ROOT_CHANNELS, one]) for row, one in enumerate(members)
    ]
    scale = np.concatenate(flat.rows).std(axis=0) + 1e-6
    before = np.concatenate([np.stack([r[1:-1], r[:-2]], axis=1) for r in flat.rows]) / scale
    change = np.concatenate([r[2:] - r[1:-1] for r in flat.rows])
    starts = rng.integers(len(flat.rows), size=(n, len(Partition)))
    lengths = [len(flat.rows[index]) for index in rng.integers(len(flat.rows), size=n)]
    states = np.zeros((n, max(lengths), before.shape[-1]))
    for node, start in zip(nodes, starts.T, strict=True):
        for one, index in enumerate(start):
            states[one, :2, node] = flat.rows[index][:2, node].T
        states_before = before[:, :, node].reshape(len(before), -1)
        width = BANDWIDTH * np.median(cdist(states_before[::7], states_before[::11]))
        for step in range(2, states.shape[1]):
            last = states[:, [step - 1, step - 2]][:, :, node] / scale[node]
            weights = (
                np.exp(-0.5 * (cdist(last.reshape(n, -1), states_before) / width) ** 2) + 1e-300
            )
            weights /= weights.sum(axis=1, keepdims=True)
            mean = weights @ change[:, node]
            spread = weights @ change[:, node] ** 2 - mean**2
            drawn = mean + np.sqrt(np.maximum(spread, 0.0)) * rng.normal(size=mean.shape)
            states[:, step, node] = states[:, step - 1, node] + drawn
    return [flat.motion(one[:length]) for one, length in zip(states, lengths, strict=True)]


def motion_matching(
    examples: Sequence[Motion], n: int, rng: np.random.Generator
) -> list[Motion]:
    """Match patches from coarse to fine (Li et al. 2023, Example-based motion synthesis via
    generative motion matching), written from the paper."""
    flat = flatten(examples)
    scale = np.concatenate(flat.rows).std(axis=0)
    scale = np.where(scale > 1e-3, scale, 1.0) * np.where(
        np.arange(len(scale)) < N_ROOT_CHANNELS, 0.3, 1
    )
    stages = [COARSEST]
    while stages[-1] * GROWTH < 1.0:
        stages.append(stages[-1] * GROWTH)
    stages.append(1.0)
    made = []
    for index in range(n):
        length = len(flat.rows[index % len(flat.rows)])
        found = np.zeros((0, 0))
        for part in stages:
            rows = [
                _stretched(one, max(round(part * len(one)), 2)) / scale for one in flat.rows
            ]
            size = max(round(part * length), 2)
            mean = np.concatenate(rows).mean(axis=0)
            first = mean + rng.normal(size=(size, len(scale)))
            found = _stretched(found, size) if len(found) else first
            patch = min(PATCH, size, *(len(one) for one in rows))
            keys = np.concatenate([_patches(one, patch) for one in rows])
            for _ in range(ROUNDS):
                found = _matched(found, keys, patch)
        made.append(flat.motion(found * scale))
    return made


def _matched(found: np.ndarray, keys: np.ndarray, patch: int) -> np.ndarray:
    """Replace each patch by the best example's, and average where they overlap."""
    queries = _patches(found, patch)
    distances = cdist(queries.reshape(len(queries), -1), keys.reshape(len(keys), -1)) ** 2
    distances /= ALPHA * distances.mean() + distances.min(axis=0)
    chosen = keys[distances.argmin(axis=1)]
    total, count = np.zeros_like(found), np.zeros((len(found), 1))
    for start, one in enumerate(chosen):
        total[start : start + patch] += one
        count[start : start + patch] += 1.0
    return total / count


def _patches(rows: np.ndarray, patch: int) -> np.ndarray:
    return np.stack([rows[start : start + patch] for start in range(len(rows) - patch + 1)])


def _stretched(rows: np.ndarray, size: int) -> np.ndarray:
    at = np.linspace(0.0, len(rows) - 1.0, size)
    low = np.minimum(at.astype(int), max(len(rows) - 2, 0))
    part = (at - low)[:, None]
    return rows[low] * (1.0 - part) + rows[np.minimum(low + 1, len(rows) - 1)] * part
