"""What is learned to synthesise variants frame after frame [ZH14, section 4.3]."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ..motion import Skeleton
from ..progress import Progress, unwatched, within
from .stepwise_features import (
    CLOCK,
    N_CONTEXT,
    RATE,
    Body,
    Indices,
    columns_of,
    moving_body,
    states_of,
    step_features,
)
from .stepwise_process import Hyperparameters
from .stepwise_stack import ProcessStack, learn_stack

Array = NDArray[np.float64]

FEWEST = 5
"""Steps that examples must have."""


@dataclass(frozen=True, eq=False)
class StepwiseModel:
    """Conditional distributions of all joints.

    Attributes
    ----------
    body : Body
    states : shape (n_examples, n_steps, n_triples, 3)
        The examples.
    published : bool
        As written in the paper; otherwise outputs covary and joints see the whole body.
    steps : ProcessStack
        Of the fourth frame and all after it (eq. 4.2).
    first : tuple of ProcessStack
        As published: of the first three frames. Otherwise none: they are mixed.
    axes : shape (5, 3 n_triples)
        Of the whole body: its principal components, of which all joints know.
    residuals : shape (n_examples, n_steps, n_triples, 3)
        What `steps` does not tell of the examples.
    hyperparameters : tuple of tuple of Hyperparameters
        Of `steps` and `first`, from which all else follows.
    """

    body: Body
    states: Array
    published: bool
    steps: ProcessStack
    first: tuple[ProcessStack, ...]
    axes: Array
    residuals: Array
    hyperparameters: tuple[tuple[Hyperparameters, ...], ...]

    def extra(self, last: Array, moment: float) -> Array:
        """Return what all joints know of a step, shape (n, n_extra); nothing as published.

        Parameters
        ----------
        last : shape (n, n_triples, 3)
            The frame before.
        moment : float
            Of the step in common time, from 0 to 1.
        """
        return _extra(last, moment, self.axes)


def learn_stepwise(
    skeleton: Skeleton,
    joints: Array,
    root: Array,
    frame_rate: float,
    published: bool,
    found: tuple[tuple[Hyperparameters, ...], ...] = (),
    progress: Progress = unwatched,
) -> StepwiseModel:
    """Learn the distributions of all joints from examples in common time.

    Parameters
    ----------
    skeleton : Skeleton
    joints : shape (n_examples, n_moments, n_joints, 3)
    root : shape (n_examples, n_moments, 4)
    frame_rate : float, hertz
    published : bool
    found : tuple of tuple of Hyperparameters
        Learned before; without them they are learned.
    progress : Progress
    """
    body = moving_body(skeleton, joints)
    moments = joints.shape[1]
    n_steps = max(min(round((moments - 1) / frame_rate * RATE) + 1, moments), FEWEST)
    states = states_of(body, joints, root, np.linspace(0.0, moments - 1.0, n_steps))
    axes = np.zeros((0, 3 * body.n_triples)) if published else _axes(states)
    wanted = states[:, 3:].reshape(-1, body.n_triples, 3)
    features = _features(states, axes)
    columns = columns_of(body, (0, 1, 2, 3), features.shape[1] - 12 * body.n_triples, own=True)
    weights = np.ones(features.shape[1])
    if not published:
        weights[-1] = CLOCK
    given: Sequence[list[Hyperparameters] | None]
    given = [list(one) for one in found] or [None] * 4
    steps, learned = learn_stack(
        features, wanted, columns, weights, published, given[0], within(progress, 0.0, 0.8)
    )
    progress(0.8, "Learning first frames")
    residuals = np.zeros_like(states)
    residuals[:, 3:] = (wanted - steps.expected(features)).reshape(states[:, 3:].shape)
    first = []
    for place, stage in enumerate(_first_stages(body, states) if published else ()):
        stack, known = learn_stack(*stage, published, given[place + 1])
        first.append((stack, known))
    return StepwiseModel(
        body, states, published, steps, tuple(stack for stack, _ in first), axes, residuals,
        (tuple(learned), *(tuple(known) for _, known in first)),
    )  # fmt: skip


def _first_stages(body: Body, states: Array) -> list[tuple[Array, Array, Indices, Array]]:
    """Return features, outputs, columns and weights of frames 1, 2 and 3 (eq. 4.2)."""
    nothing, none = np.zeros_like(states[:, 0]), np.zeros((len(states), 0))
    one, two, three = states[:, 0], states[:, 1], states[:, 2]
    stages = []
    for frames, wanted, blocks, own in (
        ((one, nothing, nothing), one, (0,), False),
        ((one, nothing, nothing), two, (0,), True),
        ((two, one, nothing), three, (0, 1, 2), True),
    ):
        features = step_features(frames, none)
        columns = columns_of(body, blocks, 0, own)
        stages.append((features, wanted, columns, np.ones(features.shape[1])))
    return stages


def _features(states: Array, axes: Array) -> Array:
    """Return the features of all steps of all examples from the fourth frame on."""
    n, steps = states.shape[:2]
    one, two, three = (
        states[:, 3 - back : steps - back].reshape(-1, *states.shape[2:]) for back in (1, 2, 3)
    )
    moments = np.tile(np.arange(3, steps) / (steps - 1), n)
    return step_features((one, two, three), _extra(one, moments, axes))


def _extra(last: Array, moment: float | Array, axes: Array) -> Array:
    if not len(axes):
        return np.zeros((len(last), 0))
    seen = last.reshape(len(last), -1) @ axes.T
    return np.column_stack([seen, np.broadcast_to(moment, len(last))])


def _axes(states: Array) -> Array:
    """Return the axes along which whole bodies differ most, shape (5, 3 n_triples)."""
    flat = states[:, :, 2:].reshape(-1, 3 * (states.shape[2] - 2))
    flat = flat - flat.mean(axis=0)
    _, _, axes = np.linalg.svd(flat, full_matrices=False)
    return np.pad(axes[:N_CONTEXT], ((0, 0), (6, 0)))
