"""Arms and legs of source and target, measured for placing feet and hands."""

from dataclasses import dataclass

import numpy as np

from ..arrays import Array, Flags
from ..motion import WorldPoses
from .body import HumanoidBody
from .placement import HipPlacement
from .stances import Stance

Limb = tuple[int, int, int]
BLEND_S = 0.5
"""Seconds over which the correction of a limb begins and ends. 0.3 s makes knees jerk a tenth
more in walks. Half and twice are no better (`make sensitivity`)."""
LIMB_SMOOTHING_S = 0.1
"""Standard deviation of the Gaussian that smooths what a limb of the source shows: the speed of
its hand, and the axis about which it bends. It guards a hand that turns in a sweep over the
ground, where it stands for an instant as if it supported the body
(`test_hand_that_sweeps_over_the_ground_does_not_support_where_it_turns`), and limbs that are
nearly straight, whose axis is noise."""


@dataclass(frozen=True, eq=False)
class Transfer:
    """Source, target and measured quantities for placing limbs."""

    source: HumanoidBody
    target: HumanoidBody
    source_poses: WorldPoses
    """World poses of the source."""
    placement: HipPlacement
    frame_rate: float
    contacts: Flags | None
    """Contacts of the source's feet, shape (n_frames, 2)."""
    stances: tuple[Stance, Stance] | None
    """Stances of the source's feet, if the rest pose does not show them."""


def limb_extension(body: HumanoidBody, world: WorldPoses, limb: Limb) -> Array:
    """Return the extension of a limb: 1 for fully straight, shape (n_frames,)."""
    path = world.positions[:, limb[2]] - world.positions[:, limb[0]]
    return np.asarray(np.linalg.norm(path, axis=1) / body.limb_length(limb))
