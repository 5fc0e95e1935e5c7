"""Choose poses sequentially with a continuity term."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from ...arrays import Array
from ..pose_space import EnergyTargets, PostureSpaces, posture_energy

Chooser = Callable[[PostureSpaces, EnergyTargets, Array | None, int], Array]
"""Function from the space, targets, previous pose and index of a frame to coordinates."""


def choose_sequentially(
    spaces: PostureSpaces, targets: EnergyTargets, choose: Chooser, before: Array | None = None
) -> tuple[Array, Array]:
    """Choose the poses of a take with the continuity term of [SHJT13], eq. 14.

    Parameters
    ----------
    spaces : PostureSpaces
    targets : EnergyTargets
    choose : Chooser
    before : shape (0 to 2, 20, 3), meters
        The last poses before these frames.

    Returns
    -------
    postures : shape (n_frames, 20, 3), meters
    energies : shape (n_frames,)
    """
    past = list(np.zeros((0, *targets.observed.shape[1:])) if before is None else before)
    energies = np.empty(len(spaces.means))
    n_before = len(past)
    for frame in range(len(energies)):
        single = slice(frame, frame + 1)
        space, frame_targets = spaces.at(single), targets.at(single)
        if len(past) > 1:
            frame_targets = replace(frame_targets, expected=(2.0 * past[-1] - past[-2])[None])
        last = past[-1][None] if past else None
        posture = space.postures(choose(space, frame_targets, last, frame))
        energies[frame] = posture_energy(posture, frame_targets)[0]
        past.append(posture[0])
    return np.array(past[n_before:]), energies
