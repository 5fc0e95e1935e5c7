"""Regressions from postures to how far their numbers are off, and postures from examples.

Each learns from (n_examples, n_features) and gives back a function of new features.
"""

import warnings
from collections.abc import Callable

import numpy as np
from sklearn.ensemble import RandomForestRegressor
from sklearn.exceptions import ConvergenceWarning
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import RBF, WhiteKernel
from sklearn.gaussian_process.kernels import ConstantKernel as Constant
from sklearn.neighbors import NearestNeighbors

from solvers.arrays import Array

Predict = Callable[[Array], Array]

RIDGE = 10.0
N_TREES, LEAF = 60, 5
GP_POINTS, GP_TUNED_ON = 1000, 250
N_NEIGHBORS, N_COMPONENTS = 30, 20


def constant(features: Array, offsets: Array) -> Predict:
    """Always the mean."""
    mean = offsets.mean(axis=0)
    return lambda new: np.tile(mean, (len(new), 1))


def ridge(features: Array, offsets: Array) -> Predict:
    """Linear regression with ridge."""
    center, mean = features.mean(axis=0), offsets.mean(axis=0)
    X = features - center
    W = np.linalg.solve(X.T @ X + RIDGE * np.eye(X.shape[1]), X.T @ (offsets - mean))
    return lambda new: mean + (new - center) @ W


def random_forest(features: Array, offsets: Array) -> Predict:
    """Offsets by a regression forest, as Shen, Deng, Zhang, Ding, Zhang (CVPR 2012).

    Theirs also adapts to a subject from frame to frame; that is left out.
    """
    forest = RandomForestRegressor(
        N_TREES, min_samples_leaf=LEAF, max_features="sqrt", random_state=0, n_jobs=1
    )
    return forest.fit(features, offsets).predict


def gaussian_process(features: Array, offsets: Array) -> Predict:
    """Scikit-learn's Gaussian process on a random part of the examples.

    Its hyper-parameters are learned on a part of these: with all, one step takes seconds.
    """
    chosen = np.random.default_rng(0).permutation(len(features))[:GP_POINTS]
    few = chosen[:GP_TUNED_ON]
    scale = float(features.std(axis=0).mean()) * np.sqrt(features.shape[1])
    kernel = Constant(1.0) * RBF(scale) + WhiteKernel(0.5)
    tuned = GaussianProcessRegressor(kernel, normalize_y=True, random_state=0)
    with warnings.catch_warnings():  # with two threads its search may end within rounding
        warnings.simplefilter("ignore", ConvergenceWarning)
        tuned.fit(features[few], offsets[few])
    process = GaussianProcessRegressor(tuned.kernel_, optimizer=None, normalize_y=True)
    return process.fit(features[chosen], offsets[chosen]).predict


def nearest_mean(examples: Array) -> Predict:
    """Mean of the examples nearest to the observed joints."""
    search = NearestNeighbors(n_neighbors=N_NEIGHBORS).fit(examples)
    return lambda new: examples[search.kneighbors(new, return_distance=False)].mean(axis=1)


def principal_projection(examples: Array) -> Predict:
    """The observed joints, projected on the principal components of the examples."""
    mean = examples.mean(axis=0)
    axes = np.linalg.svd(examples - mean, full_matrices=False)[2][:N_COMPONENTS]
    return lambda new: mean + (new - mean) @ axes.T @ axes
