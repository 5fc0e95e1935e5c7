"""The posture of least energy by Gauss-Newton steps in the natural posture space."""

import numpy as np

from solvers.arrays import Array
from solvers.motion.humanoid import N_JOINTS, PARENT_INDICES
from solvers.reconstruction.pose_space import (
    N_BONES,
    EnergyTargets,
    PostureSpaces,
    posture_energy,
    style_distances,
)
from solvers.reconstruction.published.sequential import choose_sequentially

N_STEPS = 6
MIN_GAIN = 1e-4
"""Fraction of the energy; a step that gains less is the last one."""
RIDGE = 1e-9


def solve_postures(spaces: PostureSpaces, demands: EnergyTargets, n_starts: int = 2) -> Array:
    """Return the coordinates of the postures of least energy, shape (n_frames, n_dimensions).

    But for the lengths of segments and for which neighbor is the nearest, the energy is a
    quadratic. It is minimised for one neighbor after another, in closed form; from the best of
    these minima Gauss-Newton steps follow, with lengths linearised and the nearest neighbor
    taken again before each. A step that does not gain is halved.

    Parameters
    ----------
    spaces : PostureSpaces
    demands : Demands
    n_starts : int
        Minima to go on from.
    """
    quadratic = _Quadratic(spaces, demands)
    starts = quadratic.minima(n_starts)
    best, least = starts[0], np.full(len(starts[0]), np.inf)
    for start in starts:
        z, energy = _descend(spaces, demands, quadratic, start)
        better = energy < least
        best, least = np.where(better[:, None], z, best), np.where(better, energy, least)
    return best


def solve_sequentially(
    spaces: PostureSpaces,
    demands: EnergyTargets,
    n_starts: int = 2,
    before: Array | None = None,
) -> tuple[Array, Array]:
    """Solve frame after frame; each goes on from the postures of the two before it.

    Returns
    -------
    postures : shape (n_frames, 20, 3), meters
    energies : shape (n_frames,)
    """

    def choose(
        space: PostureSpaces, targets: EnergyTargets, last: Array | None, frame: int
    ) -> Array:
        return solve_postures(space, targets, n_starts)

    return choose_sequentially(spaces, demands, choose, before)


class _Quadratic:
    """The terms of the energy that are quadratic in the coordinates."""

    def __init__(self, spaces: PostureSpaces, demands: EnergyTargets) -> None:
        w, axes = demands.weights, spaces.axes
        is_observed = np.isfinite(demands.observed).all(axis=-1)
        self.style = w.style / N_JOINTS
        control = np.repeat(
            w.control * np.where(is_observed, demands.reliability, 0.0), 3, axis=1
        )
        targets = np.nan_to_num(demands.observed).reshape(control.shape) - spaces.means
        weights, pull = control + self.style, control * targets
        if demands.expected is not None:
            is_expected = np.isfinite(demands.expected).all(axis=-1)
            going = np.repeat(is_expected * w.continuity / N_JOINTS, 3, axis=1)
            to = np.nan_to_num(demands.expected).reshape(control.shape) - spaces.means
            weights, pull = weights + going, pull + going * to
        transposed = axes.swapaxes(-1, -2)
        self.H = transposed @ (axes * weights[..., None]) + RIDGE * np.eye(axes.shape[-1])
        self.b = np.einsum("fji,fj->fi", axes, pull)
        self.off = spaces.neighbors - spaces.means[:, None]
        self.neighbor_coordinates = self.off @ axes
        """Coordinates of the neighbors."""

    def minima(self, n_starts: int) -> list[Array]:
        """Return the best minima over which neighbor is the nearest one."""
        right = self.b[..., None] + self.style * self.neighbor_coordinates.swapaxes(-1, -2)
        z = np.linalg.solve(self.H, right)
        energies = self.style * np.einsum("fni,fni->fn", self.off, self.off)
        energies -= np.einsum("fin,fin->fn", right, z)
        n_starts = min(n_starts, energies.shape[1])
        order = np.argsort(energies, axis=1, kind="stable")[:, :n_starts]
        return [
            np.take_along_axis(z, order[:, None, [start]], axis=2)[..., 0]
            for start in range(n_starts)
        ]


def _descend(
    spaces: PostureSpaces, demands: EnergyTargets, quadratic: _Quadratic, z: Array
) -> tuple[Array, Array]:
    """Gauss-Newton from one start; returns coordinates and energies."""
    bones = spaces.axes.reshape(len(z), N_JOINTS, 3, -1)
    bones = (bones - bones[:, PARENT_INDICES])[:, 1:]
    w = demands.weights.kinematics / N_BONES
    x = spaces.postures(z)
    energy = posture_energy(x, demands)
    for _ in range(N_STEPS):
        nearest = style_distances(x[:, None], demands)[:, 0].argmin(axis=-1)
        style_coordinates = np.take_along_axis(
            quadratic.neighbor_coordinates, nearest[:, None, None], axis=1
        )[:, 0]
        directions = (x - x[:, PARENT_INDICES])[:, 1:]
        sizes = np.maximum(np.linalg.norm(directions, axis=-1), 1e-9)
        J = np.einsum("fsk,fskd->fsd", directions / sizes[..., None], bones)
        long = sizes - demands.lengths[1:]
        H = quadratic.H + w * (J.swapaxes(-1, -2) @ J)
        slope = (
            quadratic.b
            + quadratic.style * style_coordinates
            - w * np.einsum("fsd,fs->fd", J, long)
        )
        slope -= np.einsum("fij,fj->fi", quadratic.H, z)
        step = np.linalg.solve(H, slope[..., None])[..., 0]
        before = energy
        z, x, energy = _step(spaces, demands, (z, x, energy), step)
        if (before - energy <= MIN_GAIN * before).all():
            break
    return z, energy


def _step(
    spaces: PostureSpaces, demands: EnergyTargets, at: tuple[Array, Array, Array], step: Array
) -> tuple[Array, Array, Array]:
    """Go the step, or half of it, or a quarter, where that lessens the energy."""
    z, x, energy = at
    for _ in range(3):
        there = z + step
        posture = spaces.postures(there)
        found = posture_energy(posture, demands)
        better = found < energy
        z = np.where(better[:, None], there, z)
        x = np.where(better[:, None, None], posture, x)
        energy = np.where(better, found, energy)
        if better.all():
            break
        step = np.where(better[:, None], 0.0, 0.5 * step)
    return z, x, energy
