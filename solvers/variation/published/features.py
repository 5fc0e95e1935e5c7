"""Compute the features that predict the next frame of a joint [ZH14, section 4.2].

The state of a frame is a set of triples: the displacement of the root (left, back and rotation,
from the frame before), the height of the hips, and the rotation vector of each moving joint.
Velocities are those of the triples; the paper's are of positions.
"""

from dataclasses import dataclass

import numpy as np

from ...arrays import Array, Integers
from ...motion import Skeleton
from ..curves import HEIGHT_COLUMN, partition_joints, sample_curves

STEP_RATE_HZ = 30.0
"""Rate of the steps. By definition that of depth cameras and of most video."""
MIN_RANGE_RAD = 1e-3
"""Minimum range of a joint's angle in the examples; joints below it are not predicted. It
guards against joints without variance."""
ROOT_TRIPLE, HEIGHT_TRIPLE, N_ROOT_TRIPLES = 0, 1, 2
N_CONTEXT = 5
TIME_WEIGHT = 2.0
"""Weight of the normalized time relative to the other features. Chosen by hand, as the paper
gives no value."""


@dataclass(frozen=True, eq=False)
class MovingBody:
    """The triples of a body, and the dependencies between them.

    Attributes
    ----------
    joints : shape (n_moving,)
        Joint of each triple after the two of the root.
    above : tuple of tuple of int
        For each triple, its ancestors in the same partition, followed by itself.
    partition : shape (n_triples,)
    """

    joints: Integers
    above: tuple[tuple[int, ...], ...]
    partition: Integers

    @property
    def n_triples(self) -> int:
        """Number of triples per frame."""
        return len(self.above)


def find_moving_body(skeleton: Skeleton, joints: Array) -> MovingBody:
    """Find the joints that move in examples, shape (n_examples, n_samples, n_joints, 3)."""
    is_moving = np.ptp(joints, axis=(0, 1)).max(axis=-1) > MIN_RANGE_RAD
    is_moving[0] = True
    moving = np.flatnonzero(is_moving)
    triples = {int(joint): N_ROOT_TRIPLES + row for row, joint in enumerate(moving)}
    partitions = partition_joints(skeleton).argmax(axis=0)
    chains: list[tuple[int, ...]] = [
        (HEIGHT_TRIPLE, triples[0], ROOT_TRIPLE),
        (triples[0], HEIGHT_TRIPLE),
    ]
    for joint in moving:
        chain, ancestor = [triples[int(joint)]], skeleton.parents[joint]
        while ancestor >= 0:
            if partitions[ancestor] == partitions[joint] and ancestor in triples:
                chain.append(triples[ancestor])
            ancestor = skeleton.parents[ancestor]
        chains.append(tuple(chain[::-1]))
    return MovingBody(
        moving, tuple(chains), np.concatenate([[0, 0], partitions[moving]]).astype(np.int64)
    )


def states_from_curves(body: MovingBody, joints: Array, root: Array, steps: Array) -> Array:
    """Return the states at given samples, shape (n_examples, n_steps, n_triples, 3).

    Parameters
    ----------
    body : MovingBody
    joints : shape (n_examples, n_samples, n_joints, 3)
    root : shape (n_examples, n_samples, 4)
    steps : shape (n_steps,), samples
    """
    n = len(joints)
    states = np.zeros((n, len(steps), body.n_triples, 3))
    for example in range(n):
        states[example, :, N_ROOT_TRIPLES:] = sample_curves(
            joints[example][:, body.joints], steps
        )
        displacements = sample_curves(
            np.cumsum(root[example, :, :HEIGHT_COLUMN], axis=0), steps
        )
        states[example, :, ROOT_TRIPLE] = np.diff(
            displacements, axis=0, prepend=displacements[:1]
        )
        states[example, :, HEIGHT_TRIPLE, 0] = sample_curves(
            root[example, :, HEIGHT_COLUMN], steps
        )
    return states


def curves_from_states(
    body: MovingBody, states: Array, n_joints: int, n_samples: int
) -> tuple[Array, Array]:
    """Return joints, (n, n_samples, n_joints, 3), and root, (n, n_samples, 4), of states.

    It is the inverse of `states_from_curves`.
    """
    n, steps = states.shape[:2]
    samples = np.linspace(0.0, steps - 1.0, n_samples)
    channels = np.concatenate([np.cumsum(states[:, :, :1], axis=1), states[:, :, 1:]], axis=2)
    sampled = np.moveaxis(sample_curves(np.moveaxis(channels, 1, 0), samples), 0, 1)
    joints, root = np.zeros((n, n_samples, n_joints, 3)), np.zeros((n, n_samples, 4))
    joints[:, :, body.joints] = sampled[:, :, N_ROOT_TRIPLES:]
    root[..., :HEIGHT_COLUMN] = np.diff(
        sampled[:, :, ROOT_TRIPLE], axis=1, prepend=sampled[:, :1, ROOT_TRIPLE]
    )
    root[..., HEIGHT_COLUMN] = sampled[:, :, HEIGHT_TRIPLE, 0]
    return joints, root


def compute_step_features(before: tuple[Array, Array, Array], extra: Array) -> Array:
    """Return all features of the step after three frames, the latest first.

    Parameters
    ----------
    before : three of shape (n, n_triples, 3)
    extra : shape (n, n_extra)
    """
    first, second, third = (frame.reshape(len(frame), -1) for frame in before)
    return np.concatenate([first, second, first - second, second - third, extra], axis=1)


def select_feature_columns(
    body: MovingBody, blocks: tuple[int, ...], n_extra: int, own: bool
) -> Integers:
    """Return the feature columns of each triple, shape (n_triples, n_most), padded with -1.

    Parameters
    ----------
    body : MovingBody
    blocks : tuple of int
        Blocks of 3 n_triples features to use: configurations and velocities.
    n_extra : int
        Number of features after all four blocks, which all triples use.
    own : bool
        Whether a triple uses itself, or its ancestors alone.
    """
    size, rows = 3 * body.n_triples, []
    for chain in body.above:
        visible = chain if own else chain[:-1]
        row = [
            block * size + 3 * triple + axis
            for block in blocks
            for triple in visible
            for axis in range(3)
        ]
        rows.append(row + list(range(4 * size, 4 * size + n_extra)))
    n_most = max(1, *(len(row) for row in rows))
    return np.array([row + [-1] * (n_most - len(row)) for row in rows], dtype=np.int64)
