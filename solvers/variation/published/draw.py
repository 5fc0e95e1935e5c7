"""Draw variants frame by frame, many at once [ZH14, section 4.4].

As published, every frame of every joint is drawn from its predictive distribution. White noise
in every frame causes jerk, and limbs drawn independently lose their coordination. In the
coregionalized form each variant therefore follows one draw of all functions (Wilson et al.
2020, Efficiently sampling functions from Gaussian process posteriors, on the sparse basis).
Residuals come from the examples' own, mixed with slowly changing weights. Each step stays
within the examples' range at that time and is pulled a little toward their mixture.
"""

from typing import TYPE_CHECKING

import numpy as np

from ...arrays import Array
from ..curves import ROOT_ROW, clamp_softly
from .features import ROOT_TRIPLE, compute_step_features, curves_from_states

if TYPE_CHECKING:
    from .model import StepwiseModel

Deviations = tuple[Array, Array, Array, Array]
"""Those of joints, root, log warp rates and contact state."""

RANGE_MARGIN = 0.05
"""Fraction of a channel's range over all times by which a variant may exceed, with saturation,
the range of the examples at the same time. Chosen by hand, as the paper gives no value."""
PULL_FRACTION = 0.2
"""Fraction of the distance to the mixture of examples that each step is pulled back. Chosen by
hand, as the paper gives no value."""


def draw_stepwise_deviations(
    model: "StepwiseModel",
    mixture: Deviations,
    weights: Array,
    rng: np.random.Generator,
) -> Deviations:
    """Draw deviations of joints, root, log warp rates and contact state.

    As published, joints and root deviate from the mean of the examples, and contacts are
    unknown. Otherwise they deviate from the mixture, which also determines the motion between
    the steps.

    Parameters
    ----------
    model : StepwiseModel
    mixture : four arrays
        The deviations of mixtures: see `mix_deviations`.
    weights : shape (6, n_variants, n_samples, n_examples)
        Of examples in these mixtures.
    rng : numpy.random.Generator
    """
    joints, root, log_warp_rates, contact_state = mixture
    n_samples, n_steps = weights.shape[2], model.states.shape[1]
    mean = model.states.mean(axis=0)
    if model.published:
        states = _draw_published(model, weights.shape[1], rng) - mean
        drawn = curves_from_states(model.body, states, joints.shape[2], n_samples)
        return *drawn, log_warp_rates, np.full_like(contact_state, np.nan)
    at_steps = _weights_at_steps(model, weights, n_steps)
    mixed = np.einsum("gvsn,nsgk->vsgk", at_steps, model.states - mean)
    states = _draw_coregionalized(model, at_steps, mean + mixed, rng) - mean - mixed
    more_joints, more_root = curves_from_states(model.body, states, joints.shape[2], n_samples)
    return joints + more_joints, root + more_root, log_warp_rates, contact_state


def _draw_published(model: "StepwiseModel", n: int, rng: np.random.Generator) -> Array:
    n_steps = model.states.shape[1]
    states = np.zeros((n, n_steps, *model.states.shape[2:]))
    no_state, no_features = np.zeros_like(states[:, 0]), np.zeros((n, 0))
    for depth in range(max(len(chain) for chain in model.body.above)):
        at_depth = [len(chain) == depth + 1 for chain in model.body.above]
        features = compute_step_features((states[:, 0], no_state, no_state), no_features)
        states[:, 0, at_depth] = model.first[0].draw_outputs(features, rng)[:, at_depth]
    features = compute_step_features((states[:, 0], no_state, no_state), no_features)
    states[:, 1] = model.first[1].draw_outputs(features, rng)
    features = compute_step_features((states[:, 1], states[:, 0], no_state), no_features)
    states[:, 2] = model.first[2].draw_outputs(features, rng)
    for step in range(3, n_steps):
        before = states[:, step - 1], states[:, step - 2], states[:, step - 3]
        states[:, step] = model.steps.draw_outputs(
            compute_step_features(before, no_features), rng
        )
    return states


def _draw_coregionalized(
    model: "StepwiseModel", weights: Array, mixed: Array, rng: np.random.Generator
) -> Array:
    """Return states that start as mixed examples do.

    Parameters
    ----------
    model : StepwiseModel
    weights : shape (n_triples, n_variants, n_steps, n_examples)
    mixed : shape (n_variants, n_steps, n_triples, 3)
    rng : numpy.random.Generator
    """
    functions = model.steps.draw_functions(len(mixed), rng)
    margin = RANGE_MARGIN * np.ptp(model.states, axis=(0, 1))
    low, high = model.states.min(axis=0) - margin, model.states.max(axis=0) + margin
    innovations = np.einsum("gvsn,nsgk->vsgk", weights, model.residuals)
    states = mixed.copy()
    for step in range(3, states.shape[1]):
        before = states[:, step - 1], states[:, step - 2], states[:, step - 3]
        extra = model.extra(before[0], step / (states.shape[1] - 1))
        predicted = model.steps.evaluate_functions(
            compute_step_features(before, extra), functions
        )
        predicted += innovations[:, step]
        predicted += PULL_FRACTION * (mixed[:, step] - predicted)
        states[:, step] = clamp_softly(predicted, low[step], high[step], margin)
    return states


def _weights_at_steps(model: "StepwiseModel", weights: Array, n_steps: int) -> Array:
    """Return the weights of each triple, shape (n_triples, n_variants, n_steps, n_examples)."""
    rows = np.round(np.linspace(0, weights.shape[2] - 1, n_steps)).astype(int)
    partition_rows = np.where(
        np.arange(model.body.n_triples) == ROOT_TRIPLE, ROOT_ROW, model.body.partition
    )
    return np.asarray(weights[:, :, rows][partition_rows])
