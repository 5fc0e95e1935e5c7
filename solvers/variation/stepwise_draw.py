"""Variants drawn frame after frame, many at once [ZH14, section 4.4].

As published, every frame of every joint is drawn from its predictive distribution. White noise
in every frame jerks, and limbs that know nothing of each other fall out of step. In the
coregionalised form each variant therefore follows one draw of all functions (Wilson et al.
2020, Efficiently sampling functions from Gaussian process posteriors, on the sparse basis);
what the functions leave open is taken from the examples' own residuals, mixed with shares that
change slowly; and what each step arrives at stays within the examples' range at that moment
and is drawn a little towards the mixture of them that it began as.
"""

import numpy as np
from numpy.typing import NDArray

from .mixtures import COMMON
from .soft_limits import softly_within
from .stepwise_features import WAY, curves_of, step_features
from .stepwise_model import StepwiseModel

Array = NDArray[np.float64]

GUARD = 0.05
"""Part of a channel's whole range by which a variant may leave, more and more slowly, the range
that examples have at the same moment."""
PULL = 0.2
"""Part of the way to the mixture of examples that each step is drawn back."""


def stepwise_deviations(
    model: StepwiseModel, shares: Array, n_joints: int, rng: np.random.Generator
) -> tuple[Array, Array]:
    """Return by how much joints and root deviate: as published, from the mean of the examples,
    otherwise from their mixture with the same shares, which goes on between the steps too.

    Parameters
    ----------
    model : StepwiseModel
    shares : shape (6, n_variants, n_moments, n_examples)
        Of examples in mixtures: see `draw_shares`.
    n_joints : int
    rng : numpy.random.Generator

    Returns
    -------
    joints : shape (n_variants, n_moments, n_joints, 3), radians
    root : shape (n_variants, n_moments, 4)
    """
    n_moments, n_steps = shares.shape[2], model.states.shape[1]
    middle = model.states.mean(axis=0)
    if model.published:
        beside = _published(model, shares.shape[1], rng) - middle
    else:
        at_steps = _at_steps(model, shares, n_steps)
        mixed = np.einsum("gvsn,nsgk->vsgk", at_steps, model.states - middle)
        beside = _coregionalised(model, at_steps, middle + mixed, rng) - middle - mixed
    return curves_of(model.body, beside, n_joints, n_moments)


def _published(model: StepwiseModel, n: int, rng: np.random.Generator) -> Array:
    n_steps = model.states.shape[1]
    states = np.zeros((n, n_steps, *model.states.shape[2:]))
    nothing, none = np.zeros_like(states[:, 0]), np.zeros((n, 0))
    for depth in range(max(len(chain) for chain in model.body.above)):
        there = [len(chain) == depth + 1 for chain in model.body.above]
        features = step_features((states[:, 0], nothing, nothing), none)
        states[:, 0, there] = model.first[0].sampled(features, rng)[:, there]
    features = step_features((states[:, 0], nothing, nothing), none)
    states[:, 1] = model.first[1].sampled(features, rng)
    features = step_features((states[:, 1], states[:, 0], nothing), none)
    states[:, 2] = model.first[2].sampled(features, rng)
    for step in range(3, n_steps):
        before = states[:, step - 1], states[:, step - 2], states[:, step - 3]
        states[:, step] = model.steps.sampled(step_features(before, none), rng)
    return states


def _coregionalised(
    model: StepwiseModel, shares: Array, mixed: Array, rng: np.random.Generator
) -> Array:
    """Return states that begin as mixed examples do.

    Parameters
    ----------
    model : StepwiseModel
    shares : shape (n_triples, n_variants, n_steps, n_examples)
    mixed : shape (n_variants, n_steps, n_triples, 3)
    rng : numpy.random.Generator
    """
    functions = model.steps.draw_functions(len(mixed), rng)
    beyond = GUARD * np.ptp(model.states, axis=(0, 1))
    low, high = model.states.min(axis=0) - beyond, model.states.max(axis=0) + beyond
    innovations = np.einsum("gvsn,nsgk->vsgk", shares, model.residuals)
    states = mixed.copy()
    for step in range(3, states.shape[1]):
        before = states[:, step - 1], states[:, step - 2], states[:, step - 3]
        extra = model.extra(before[0], step / (states.shape[1] - 1))
        wanted = model.steps.followed(step_features(before, extra), functions)
        wanted += innovations[:, step]
        wanted += PULL * (mixed[:, step] - wanted)
        states[:, step] = softly_within(wanted, low[step], high[step], beyond)
    return states


def _at_steps(model: StepwiseModel, shares: Array, n_steps: int) -> Array:
    """Return the shares of each triple, shape (n_triples, n_variants, n_steps, n_examples)."""
    rows = np.round(np.linspace(0, shares.shape[2] - 1, n_steps)).astype(int)
    places = np.where(np.arange(model.body.n_triples) == WAY, COMMON, model.body.partition)
    return np.asarray(shares[:, :, rows][places])
