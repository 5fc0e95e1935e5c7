"""Variation for a single clip: borrowed from other behaviours, or from a generic model."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter1d

from ..errors import InvalidMotionError
from ..motion import Motion
from .curve_sampling import sample_curves
from .learn_variation import learn_variation_model
from .motion_curves import HEIGHT
from .partitions import partition_joints
from .variation_model import VariationModel

Array = NDArray[np.float64]

N_PAIRS = 5
"""Pairs of made-up examples; the two of a pair deviate to opposite sides."""
SWING = 0.2
"""By how much more or less than the clip a limb swings, as a part of its movement."""
DELAY = 0.04
"""Seconds by which a limb moves earlier or later."""
LEAN = 0.25
"""By how much poses are shifted, as a part of the joint's movement."""
HASTE = 0.1
"""Logarithm of how much faster or slower the whole goes."""
CALM = 0.05
"""Seconds over which movement is smoothed before it is enlarged: its noise is not."""
ALIKE = 0.7
"""Part of the variance that joints of a partition have in common."""
LEGS, STEADY = 0.5, 0.3
"""Part of all this for legs, whose feet stand on the ground, and for the root's way."""
WIDEST = 2.0
"""Times by which borrowed deviations are enlarged at most, where the clip moves more."""


def borrow_variation(motion: Motion, others: Sequence[VariationModel] = ()) -> VariationModel:
    """Return a model of which one clip is the example, and the rest is borrowed.

    From `others`, models of the same rig, the deviations of their examples are taken over, by
    the part of the behaviour that has passed and scaled by how much each joint moves here and
    there. Without others, each limb swings a little more or less, earlier or later and shifted,
    joints of a limb alike: so loops stay loops, and what stands still stays.

    Parameters
    ----------
    motion : Motion
    others : sequence of VariationModel

    Returns
    -------
    VariationModel
        Its `warning` says that the variation is borrowed.

    Raises
    ------
    InvalidMotionError
        The clip has gaps or less than two frames, or a model is of another rig.
    """
    alone = learn_variation_model([motion])
    for place, other in enumerate(others):
        if other.skeleton.names != alone.skeleton.names:
            raise InvalidMotionError(
                f"Model {place + 1} to borrow from is of another rig than the clip; retarget"
                " its examples first."
            )
    parts = [_borrowed(alone, other) for other in others if other.n_examples > 1]
    joints, root, haste = (
        (np.concatenate(one) for one in zip(*parts, strict=True)) if parts else _generic(alone)
    )
    return replace(
        alone,
        joints=np.concatenate([alone.joints, alone.joints + joints]),
        root=np.concatenate([alone.root, alone.root + root]),
        haste=np.concatenate([alone.haste, alone.haste + haste]),
        footing=np.repeat(alone.footing, 1 + len(joints), axis=0),
        warning="There is one example; how it varies is borrowed.",
    )


def _borrowed(alone: VariationModel, other: VariationModel) -> tuple[Array, Array, Array]:
    """Return deviations of another behaviour's examples as if they were of this one."""
    times = np.linspace(0.0, other.n_moments - 1.0, alone.n_moments)
    found = []
    for ours, theirs in ((alone.joints, other.joints), (alone.root, other.root)):
        beside = np.moveaxis(theirs - theirs.mean(axis=0), 0, 1)
        size = np.minimum(_movement(ours) / np.maximum(_movement(theirs), 1e-9), WIDEST)
        found.append(np.moveaxis(sample_curves(beside, times), 1, 0) * size)
    hastes = (other.haste - other.haste.mean(axis=0)).T
    return found[0], found[1], sample_curves(hastes, times).T


def _movement(curves: Array) -> Array:
    """Return how much curves, (n_examples, n_moments, ...), move: of a joint, all its axes."""
    spread = curves.std(axis=1).mean(axis=0)
    if spread.ndim > 1:
        spread = np.linalg.norm(spread, axis=-1, keepdims=True)
    return np.asarray(spread)


def _generic(alone: VariationModel) -> tuple[Array, Array, Array]:
    """Return deviations of made-up examples: joints, root and haste."""
    rng = np.random.default_rng(0)
    members = partition_joints(alone.skeleton)
    n_joints, moments = alone.skeleton.n_joints, alone.n_moments
    curve = alone.joints[0]
    swing, delay = (_alike(rng.normal(size=(2, N_PAIRS, n_joints)), members) for _ in range(2))
    own = rng.normal(size=(N_PAIRS, n_joints, 3))
    calm = gaussian_filter1d(curve, CALM * alone.frame_rate, axis=0, mode="nearest")
    moved, pace = calm - calm.mean(axis=0), np.gradient(calm, 1.0 / alone.frame_rate, axis=0)
    joints = SWING * swing[:, None, :, None] * moved
    joints += DELAY * delay[:, None, :, None] * pace
    joints += LEAN * own[:, None] * curve.std(axis=0)
    joints *= (np.array([1.0, 1.0, 1.0, LEGS, LEGS]) @ members)[:, None]
    way = alone.root[0].copy()
    way[:, HEIGHT] -= way[:, HEIGHT].mean()
    root = STEADY * SWING * rng.normal(size=(N_PAIRS, 1, 1)) * way
    haste = HASTE * rng.normal(size=(N_PAIRS, 1)) * np.ones(moments)
    return _to_both_sides(joints), _to_both_sides(root), _to_both_sides(haste)


def _alike(drawn: Array, members: NDArray[np.bool_]) -> Array:
    """Let joints of a partition have numbers alike, (n, n_joints), of two such arrays."""
    first = members.argmax(axis=1)[members.argmax(axis=0)]
    return np.asarray(np.sqrt(ALIKE) * drawn[0][:, first] + np.sqrt(1.0 - ALIKE) * drawn[1])


def _to_both_sides(beside: Array) -> Array:
    return np.concatenate([beside, -beside])
