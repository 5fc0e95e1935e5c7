"""The model that synthesizes variants frame by frame [ZH14, section 4.3]."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np

from ...arrays import Array, Integers
from ...motion import Skeleton
from ...npz_members import Values, numbers
from ...progress import Progress, unwatched, within
from .draw import Deviations, draw_stepwise_deviations
from .features import (
    N_CONTEXT,
    STEP_RATE_HZ,
    TIME_WEIGHT,
    MovingBody,
    compute_step_features,
    find_moving_body,
    select_feature_columns,
    states_from_curves,
)
from .process import N_PACKED, Hyperparameters
from .stack import ProcessStack, learn_stack

MIN_STEPS = 5
"""Minimum steps of an example."""


@dataclass(frozen=True, eq=False)
class StepwiseModel:
    """Conditional distributions of all joints.

    Attributes
    ----------
    body : MovingBody
    states : shape (n_examples, n_steps, n_triples, 3)
        Of the examples.
    published : bool
        As written in the paper; otherwise outputs covary and joints use the complete body.
    steps : ProcessStack
        Of the fourth frame and all after it (eq. 4.2).
    first : tuple of ProcessStack
        As published: of the first three frames. Otherwise empty: these are mixed.
    axes : shape (5, 3 n_triples)
        Principal components of the complete body, which all joints use.
    residuals : shape (n_examples, n_steps, n_triples, 3)
        What `steps` leaves unexplained in the examples.
    hyperparameters : tuple of tuple of Hyperparameters
        Of `steps` and `first`; all else follows from them.
    """

    body: MovingBody
    states: Array
    published: bool
    steps: ProcessStack
    first: tuple[ProcessStack, ...]
    axes: Array
    residuals: Array
    hyperparameters: tuple[tuple[Hyperparameters, ...], ...]

    SAVED: ClassVar[Values] = numbers("stacks", "triples", N_PACKED, or_empty=True)
    """Description of what `pack` returns, in a saved file."""

    @classmethod
    def learn(
        cls,
        skeleton: Skeleton,
        joints: Array,
        root: Array,
        frame_rate: float,
        published: bool,
        hyperparameters: tuple[tuple[Hyperparameters, ...], ...] = (),
        progress: Progress = unwatched,
    ) -> Self:
        """Learn the distributions of all joints from examples in common time.

        Parameters
        ----------
        skeleton : Skeleton
        joints : shape (n_examples, n_samples, n_joints, 3)
        root : shape (n_examples, n_samples, 4)
        frame_rate : float, hertz
        published : bool
        hyperparameters : tuple of tuple of Hyperparameters
            Known ones; without them they are learned.
        progress : Progress
        """
        body = find_moving_body(skeleton, joints)
        n_samples = joints.shape[1]
        n_steps = max(
            min(round((n_samples - 1) / frame_rate * STEP_RATE_HZ) + 1, n_samples), MIN_STEPS
        )
        states = states_from_curves(
            body, joints, root, np.linspace(0.0, n_samples - 1.0, n_steps)
        )
        axes = np.zeros((0, 3 * body.n_triples)) if published else _principal_axes(states)
        targets = states[:, 3:].reshape(-1, body.n_triples, 3)
        features = _compute_features(states, axes)
        columns = select_feature_columns(
            body, (0, 1, 2, 3), features.shape[1] - 12 * body.n_triples, own=True
        )
        weights = np.ones(features.shape[1])
        if not published:
            weights[-1] = TIME_WEIGHT
        initial: Sequence[list[Hyperparameters] | None]
        initial = [list(each) for each in hyperparameters] or [None] * 4
        steps, learned = learn_stack(
            features,
            targets,
            columns,
            weights,
            published,
            initial[0],
            within(progress, 0.0, 0.8),
        )
        progress(0.8, "Learning start poses")
        residuals = np.zeros_like(states)
        residuals[:, 3:] = (targets - steps.predict(features)).reshape(states[:, 3:].shape)
        first = []
        for index, stage in enumerate(_build_first_stages(body, states) if published else ()):
            stack, learned_first = learn_stack(*stage, published, initial[index + 1])
            first.append((stack, learned_first))
        return cls(
            body, states, published, steps, tuple(stack for stack, _ in first), axes, residuals,
            (tuple(learned), *(tuple(learned_first) for _, learned_first in first)),
        )  # fmt: skip

    def pack(self) -> Array:
        """Return all hyperparameters, shape (n_stacks, n_triples, 18); all else follows."""
        return np.array([
            [each.to_vector() for each in stack] for stack in self.hyperparameters
        ])

    @classmethod
    def restore(
        cls, packed: Array, skeleton: Skeleton, joints: Array, root: Array, frame_rate: float
    ) -> Self | None:
        """Return the model of packed hyperparameters, None if there are none.

        See `learn` for the other parameters.
        """
        hyperparameters = tuple(
            tuple(Hyperparameters.from_vector(each) for each in stack) for stack in packed
        )
        if not hyperparameters:
            return None
        published = len(hyperparameters) > 1
        return cls.learn(skeleton, joints, root, frame_rate, published, hyperparameters)

    def draw(self, mixture: Deviations, weights: Array, rng: np.random.Generator) -> Deviations:
        """Draw deviations of joints, root, log warp rates and contact state.

        See `draw_stepwise_deviations`.
        """
        return draw_stepwise_deviations(self, mixture, weights, rng)

    def extra(self, last: Array, time: float) -> Array:
        """Return features of a step that all joints use, shape (n, n_extra); none as published.

        Parameters
        ----------
        last : shape (n, n_triples, 3)
            States of the frame before.
        time : float
            Normalized time of the step, from 0 to 1.
        """
        return _extra_features(last, time, self.axes)


def _build_first_stages(
    body: MovingBody, states: Array
) -> list[tuple[Array, Array, Integers, Array]]:
    """Return features, outputs, columns and weights of frames 1, 2 and 3 (eq. 4.2)."""
    nothing, none = np.zeros_like(states[:, 0]), np.zeros((len(states), 0))
    first, second, third = states[:, 0], states[:, 1], states[:, 2]
    stages = []
    for frames, targets, blocks, own in (
        ((first, nothing, nothing), first, (0,), False),
        ((first, nothing, nothing), second, (0,), True),
        ((second, first, nothing), third, (0, 1, 2), True),
    ):
        features = compute_step_features(frames, none)
        columns = select_feature_columns(body, blocks, 0, own)
        stages.append((features, targets, columns, np.ones(features.shape[1])))
    return stages


def _compute_features(states: Array, axes: Array) -> Array:
    """Return the features of all steps of all examples from the fourth frame on."""
    n, steps = states.shape[:2]
    first, second, third = (
        states[:, 3 - back : steps - back].reshape(-1, *states.shape[2:]) for back in (1, 2, 3)
    )
    times = np.tile(np.arange(3, steps) / (steps - 1), n)
    return compute_step_features((first, second, third), _extra_features(first, times, axes))


def _extra_features(last: Array, time: float | Array, axes: Array) -> Array:
    if not len(axes):
        return np.zeros((len(last), 0))
    scores = last.reshape(len(last), -1) @ axes.T
    return np.column_stack([scores, np.broadcast_to(time, len(last))])


def _principal_axes(states: Array) -> Array:
    """Return the axes along which complete bodies differ most, shape (5, 3 n_triples)."""
    flat = states[:, :, 2:].reshape(-1, 3 * (states.shape[2] - 2))
    flat = flat - flat.mean(axis=0)
    _, _, axes = np.linalg.svd(flat, full_matrices=False)
    return np.pad(axes[:N_CONTEXT], ((0, 0), (6, 0)))
