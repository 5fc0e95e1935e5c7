"""Plant what bears on the floor in one window of a take."""

from collections.abc import Sequence

import numpy as np
import scipy

from ..arrays import Array, Flags
from ..motion import Motion
from ..motion.humanoid import SIDES
from ..motion_fitting import FittedMotion, fit_motion
from ..progress import Progress, within
from ..rotations import inverse, multiply, rotation_vector_from_quaternion
from ..signals import smooth_gaussian
from .foot_goals import planting_goals
from .limb_goals import LimbContact, limb_tolerances
from .plant_settings import PlantSettings
from .sole import SMOOTHING_S
from .sole_contact import FootContact

MAX_CHANGE_RAD = np.radians(20.0)
"""Radians by which a joint of a leg may turn to hold its foot in place. It guards legs whose
capture jumps (`test_glitch_of_one_frame_does_not_twist_a_leg`). With 15 degrees feet of clean
takes drift by 12 mm in their contacts, with 20 by 0.9."""
MAX_ROOT_CHANGE_M = 0.06
"""Meters, for a leg of 0.9 m, by which the root may move to hold feet in place. Sweep on the
same takes: 0.04 lets feet drift by 80 mm in place of 23 where the travel is too long for the
steps; `make sensitivity` varies it."""
MAX_EXCESS = 1.05
"""Ratio of a change to the largest allowed one that is good enough. It bounds the run time."""
YIELD_S = 0.25
"""Seconds before and after a frame in which a foot is held as little as there. It guards feet
that move, which would stand and then jump
(`test_body_that_glides_is_not_pulled_back_and_its_feet_do_not_jump`)."""
MAX_FITS = 6
"""Number of fits of a window. It bounds the run time."""


def plant_in_window(
    motion: Motion,
    feet: Sequence[FootContact],
    limbs: Sequence[LimbContact],
    ankle_weights: Array,
    settings: PlantSettings,
    may_yield: Flags,
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
    may_yield : bool, shape (n_frames, 2), left and right
        Where feet may be held less; not in contacts that an animator keyed. The root counts
        only where no foot is in such a contact.
    progress : Progress
    """
    legs = [foot.leg for foot in feet]
    joints = [joint for leg in legs for joint in (*leg.chain, leg.toe) if joint is not None]
    joints += limb_tolerances(limbs)
    start = FittedMotion(motion, motion, tuple(joints), settings.move_root)
    weights = [ankle_weights[:, SIDES.index(leg.side)] for leg in legs]
    yields = [np.ones(motion.n_frames) for _ in feet]
    may = [may_yield[:, SIDES.index(leg.side)] for leg in legs]
    keyed = [foot.contact & ~each for foot, each in zip(feet, may, strict=True)]
    is_root_free = ~np.any(keyed, axis=0)
    for index in range(MAX_FITS):
        held = [foot.held_less(factors) for foot, factors in zip(feet, yields, strict=True)]
        goals = planting_goals(start, held, limbs, settings, weights)
        step = within(progress, 1.0 - 0.5**index, 1.0 - 0.5 ** (index + 1))
        planted = fit_motion(start, goals, step, "Planting the feet").motion
        changes = [
            _change(motion, planted, foot, is_root_free) * each
            for foot, each in zip(feet, may, strict=True)
        ]
        if not feet or np.max(changes) <= MAX_EXCESS:
            break
        yields = [
            np.where(
                each, _spread(np.maximum(factors * change**2, 1.0), motion.frame_rate), 1.0
            )
            for factors, change, each in zip(yields, changes, may, strict=True)
        ]
    progress(1.0, "Planted the feet")
    return planted


def _change(before: Motion, after: Motion, foot: FootContact, is_root_free: Flags) -> Array:
    """Return the change of a foot's leg and of the root, relative to the largest allowed one.

    Shape (n_frames,). Jitter, which planting takes out of a foot, does not count, and the root
    only in frames in which it `is_root_free`.
    """
    leg, n_frames = list(foot.leg.chain), before.n_frames
    turns = multiply(after.rotations[:, leg], inverse(before.rotations[:, leg]))
    rotations = rotation_vector_from_quaternion(turns).reshape(n_frames, -1)
    moves = after.root_positions - before.root_positions
    both = smooth_gaussian(np.hstack([rotations, moves]), SMOOTHING_S * before.frame_rate)
    turned = np.linalg.norm(both[:, :-3].reshape(n_frames, -1, 3), axis=2).max(axis=1)
    moved = np.linalg.norm(both[:, -3:], axis=1) * is_root_free
    return np.asarray(
        np.maximum(turned / MAX_CHANGE_RAD, moved / (MAX_ROOT_CHANGE_M * foot.size))
    )


def _spread(factors: Array, frame_rate: float) -> Array:
    """Return the largest factors of all frames near each: a foot moves gently, not at once."""
    width = 2 * round(YIELD_S * frame_rate) + 1
    return np.asarray(scipy.ndimage.maximum_filter1d(factors, width, mode="nearest"))
