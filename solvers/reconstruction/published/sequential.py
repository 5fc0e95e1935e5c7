"""Postures one after the other: each goes on from those of the frames before it."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..pose_space import EnergyTargets, PostureSpaces, posture_energy

Array = NDArray[np.float64]
Chooser = Callable[[PostureSpaces, EnergyTargets, Array | None, int], Array]
"""Of one frame: its space, what is asked, the posture before it, its number; coordinates."""


def choose_sequentially(
    spaces: PostureSpaces, demands: EnergyTargets, choose: Chooser, before: Array | None = None
) -> tuple[Array, Array]:
    """Choose the postures of a take, with the continuity term of [SHJT13], eq. 14.

    Parameters
    ----------
    spaces : PostureSpaces
    demands : Demands
    choose : Chooser
    before : shape (0 to 2, 20, 3), metres
        The last postures before these frames.

    Returns
    -------
    postures : shape (n_frames, 20, 3), metres
    energies : shape (n_frames,)
    """
    past = list(np.zeros((0, *demands.observed.shape[1:])) if before is None else before)
    energies = np.empty(len(spaces.means))
    n_before = len(past)
    for frame in range(len(energies)):
        one = slice(frame, frame + 1)
        space, asked = spaces.at(one), demands.at(one)
        if len(past) > 1:
            asked = replace(asked, expected=(2.0 * past[-1] - past[-2])[None])
        last = past[-1][None] if past else None
        posture = space.postures(choose(space, asked, last, frame))
        energies[frame] = posture_energy(posture, asked)[0]
        past.append(posture[0])
    return np.array(past[n_before:]), energies
