"""Save a stepwise model with the variation model it belongs to."""

import numpy as np

from ...arrays import Array
from ...motion import Skeleton
from ...npz_members import numbers
from .model import StepwiseModel, learn_stepwise
from .process import N_PACKED, Hyperparameters

STEPWISE_MEMBER = numbers("stacks", "triples", N_PACKED, or_empty=True)


def pack_stepwise(stepwise: StepwiseModel | None) -> Array:
    """Return all hyperparameters, shape (n_stacks, n_triples, 18); all else follows."""
    stacks = stepwise.hyperparameters if stepwise else ()
    return np.array([[each.to_vector() for each in stack] for stack in stacks])


def restore_stepwise(
    packed: Array, skeleton: Skeleton, joints: Array, root: Array, frame_rate: float
) -> StepwiseModel | None:
    """Return the model of packed hyperparameters, None if there are none.

    See `learn_stepwise` for the other parameters.
    """
    hyperparameters = tuple(
        tuple(Hyperparameters.from_vector(each) for each in stack) for stack in packed
    )
    if not hyperparameters:
        return None
    return learn_stepwise(
        skeleton, joints, root, frame_rate, len(hyperparameters) > 1, hyperparameters
    )
