"""Plant what bears on the floor in one window of a take."""

from collections.abc import Sequence

import numpy as np

from ..arrays import Array
from ..motion import Motion
from ..motion.humanoid import SIDES
from ..motion_fitting import FittedMotion, fit_motion
from ..progress import Progress, within
from ..rotations import angle_between
from .foot_goals import planting_goals
from .limb_goals import LimbContact, limb_tolerances
from .plant_settings import PlantSettings
from .sole_contact import FootContact

MAX_CHANGE_RAD = np.radians(20.0)
"""Radians by which a joint of a leg may turn to hold its foot in place. Chosen by hand on the
development takes: feet of clean takes drift by 0.9 mm in their contacts, with 15 degrees by 12;
`make sensitivity` varies it."""
MAX_ROOT_CHANGE_M = 0.06
"""Meters, for a leg of 0.9 m, by which the root may move to hold feet in place. Chosen by hand
on the same takes: 0.04 lets feet drift by 80 mm in place of 23 where the travel is too long for
the steps; `make sensitivity` varies it."""
MAX_FITS = 6
"""Number of fits of a window. It bounds the run time."""


def plant_in_window(
    motion: Motion,
    feet: Sequence[FootContact],
    limbs: Sequence[LimbContact],
    ankle_weights: Array,
    settings: PlantSettings,
    may_yield: bool,
    progress: Progress,
) -> Motion:
    """Return a window of a take with all that bears on the floor planted.

    A foot that is found in contact may move all the same: it shuffles, pivots, steps, or its
    capture jumps. Held in place, its leg would twist, or the body would be pulled aside. So
    each foot is held less where the root or a joint of its leg moves farther than allowed,
    until none does (iteratively reweighted least squares).

    Parameters
    ----------
    motion : Motion
    feet : sequence of FootContact
    limbs : sequence of LimbContact
    ankle_weights : shape (n_frames, 2), left and right
    settings : PlantSettings
    may_yield : bool
        Whether feet may be held less; not where an animator keyed the contacts.
    progress : Progress
    """
    legs = [foot.leg for foot in feet]
    joints = [joint for leg in legs for joint in (*leg.chain, leg.toe) if joint is not None]
    joints += limb_tolerances(limbs)
    start = FittedMotion(motion, motion, tuple(joints), settings.move_root)
    weights = [ankle_weights[:, SIDES.index(leg.side)] for leg in legs]
    for index in range(MAX_FITS):
        goals = planting_goals(start, feet, limbs, settings, weights)
        step = within(progress, 1.0 - 0.5**index, 1.0 - 0.5 ** (index + 1))
        planted = fit_motion(start, goals, step, "Planting the feet").motion
        changes = [_change(motion, planted, foot) for foot in feet]
        if not (may_yield and feet) or np.max(changes) <= 1.0:
            break
        feet = [
            foot.held_less(np.maximum(change, 1.0) ** 4)
            for foot, change in zip(feet, changes, strict=True)
        ]
    progress(1.0, "Planted the feet")
    return planted


def _change(before: Motion, after: Motion, foot: FootContact) -> Array:
    """Return the change of a foot's leg and of the root, relative to the largest allowed one.

    Shape (n_frames,).
    """
    leg = list(foot.leg.chain)
    turned = angle_between(before.rotations[:, leg], after.rotations[:, leg]).max(axis=1)
    moved = np.linalg.norm(after.root_positions - before.root_positions, axis=1)
    return np.maximum(turned / MAX_CHANGE_RAD, moved / (MAX_ROOT_CHANGE_M * foot.size))
