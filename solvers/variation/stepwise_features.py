"""What the next frame of a joint is foretold from [ZH14, section 4.2].

The state of a frame is a number of triples: the way of the root (left, back and turning, from
the frame before), the height of the hips, and the rotation vector of each joint that moves.
The velocities are those of the triples; the paper's are of positions.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..motion import Skeleton
from .curve_sampling import sample_curves
from .motion_curves import HEIGHT
from .partitions import partition_joints

Array = NDArray[np.float64]
Indices = NDArray[np.int64]

RATE = 30.0
"""Hertz of the steps."""
STILL = 1e-3
"""Radians by which a joint must vary to be foretold."""
WAY, UP, N_ROOT_TRIPLES = 0, 1, 2
N_CONTEXT = 5
CLOCK = 2.0
"""Weight of the moment in common time beside the other features."""


@dataclass(frozen=True, eq=False)
class Body:
    """Which triples there are, and which each depends upon.

    Attributes
    ----------
    joints : shape (n_moving,)
        Joint of each triple after the two of the root.
    above : tuple of tuple of int
        Of each triple, those of its ancestors in its partition, and last itself.
    partition : shape (n_triples,)
    """

    joints: Indices
    above: tuple[tuple[int, ...], ...]
    partition: Indices

    @property
    def n_triples(self) -> int:
        """Triples of a frame."""
        return len(self.above)


def moving_body(skeleton: Skeleton, joints: Array) -> Body:
    """Find the joints that move in examples, shape (n_examples, n_moments, n_joints, 3)."""
    moves = np.ptp(joints, axis=(0, 1)).max(axis=-1) > STILL
    moves[0] = True
    moving = np.flatnonzero(moves)
    place = {int(joint): N_ROOT_TRIPLES + row for row, joint in enumerate(moving)}
    parts = partition_joints(skeleton).argmax(axis=0)
    above: list[tuple[int, ...]] = [(UP, place[0], WAY), (place[0], UP)]
    for joint in moving:
        chain, at = [place[int(joint)]], skeleton.parents[joint]
        while at >= 0:
            if parts[at] == parts[joint] and at in place:
                chain.append(place[at])
            at = skeleton.parents[at]
        above.append(tuple(chain[::-1]))
    return Body(moving, tuple(above), np.concatenate([[0, 0], parts[moving]]).astype(np.int64))


def states_of(body: Body, joints: Array, root: Array, steps: Array) -> Array:
    """Return the states at some moments, shape (n_examples, n_steps, n_triples, 3).

    Parameters
    ----------
    body : Body
    joints : shape (n_examples, n_moments, n_joints, 3)
    root : shape (n_examples, n_moments, 4)
    steps : shape (n_steps,), moments
    """
    n = len(joints)
    states = np.zeros((n, len(steps), body.n_triples, 3))
    for one in range(n):
        states[one, :, N_ROOT_TRIPLES:] = sample_curves(joints[one][:, body.joints], steps)
        ways = sample_curves(np.cumsum(root[one, :, :HEIGHT], axis=0), steps)
        states[one, :, WAY] = np.diff(ways, axis=0, prepend=ways[:1])
        states[one, :, UP, 0] = sample_curves(root[one, :, HEIGHT], steps)
    return states


def curves_of(body: Body, states: Array, n_joints: int, n_moments: int) -> tuple[Array, Array]:
    """Return joints and root at all moments, from the states of steps: see `states_of`."""
    n, steps = states.shape[:2]
    moments = np.linspace(0.0, steps - 1.0, n_moments)
    told = np.concatenate([np.cumsum(states[:, :, :1], axis=1), states[:, :, 1:]], axis=2)
    seen = np.moveaxis(sample_curves(np.moveaxis(told, 1, 0), moments), 0, 1)
    joints, root = np.zeros((n, n_moments, n_joints, 3)), np.zeros((n, n_moments, 4))
    joints[:, :, body.joints] = seen[:, :, N_ROOT_TRIPLES:]
    root[..., :HEIGHT] = np.diff(seen[:, :, WAY], axis=1, prepend=seen[:, :1, WAY])
    root[..., HEIGHT] = seen[:, :, UP, 0]
    return joints, root


def step_features(before: tuple[Array, Array, Array], extra: Array) -> Array:
    """Return all features of the step after three frames, the last first.

    Parameters
    ----------
    before : three of shape (n, n_triples, 3)
    extra : shape (n, n_extra)
    """
    one, two, three = (frame.reshape(len(frame), -1) for frame in before)
    return np.concatenate([one, two, one - two, two - three, extra], axis=1)


def columns_of(body: Body, blocks: tuple[int, ...], n_extra: int, own: bool) -> Indices:
    """Return which features each triple sees, shape (n_triples, most), filled up with -1.

    Parameters
    ----------
    body : Body
    blocks : tuple of int
        Which stretches of 3 n_triples features count: configurations and velocities.
    n_extra : int
        Features after all four blocks, which all triples see.
    own : bool
        Whether a triple sees itself or its ancestors alone.
    """
    size, rows = 3 * body.n_triples, []
    for chain in body.above:
        seen = chain if own else chain[:-1]
        row = [
            block * size + 3 * one + axis
            for block in blocks
            for one in seen
            for axis in range(3)
        ]
        rows.append(row + list(range(4 * size, 4 * size + n_extra)))
    most = max(1, *(len(row) for row in rows))
    return np.array([row + [-1] * (most - len(row)) for row in rows], dtype=np.int64)
