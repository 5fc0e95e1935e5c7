"""When feet stand, told so that it can be mixed as poses are.

The moments at which a foot comes down and lifts off are mixed, as constraints are in motion
blending (Kovar, Gleicher 2003, Flexible automatic motion blending with registration curves,
section 4.4): half of one example that stands from 1.0 s on and half of another that does from
1.2 s on stand from 1.1 s on.
"""

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidMotionError
from ..motion import Motion
from ..motion.humanoid import detect_contacts

Array = NDArray[np.float64]

FAR = 0.25
"""Seconds: a change that is farther away does not count."""
SIDES = 2


def footing_of(motion: Motion) -> Array:
    """Return by how much feet stand, shape (n_frames, 2), left and right, seconds.

    Above 0 the foot stands; how far from 0 is how long it is until that changes, or since it
    did. NaN where the skeleton has not two feet.
    """
    try:
        contacts = detect_contacts(motion)
    except InvalidMotionError:
        return np.full((motion.n_frames, SIDES), np.nan)
    return np.stack([_to_changes(foot, motion.frame_rate) for foot in contacts.T], axis=-1)


def contacts_from(footing: Array) -> NDArray[np.bool_] | None:
    """Return when feet stand, shape (n_frames, 2); None where that is not known."""
    return None if np.isnan(footing).any() else footing > 0.0


def _to_changes(stands: NDArray[np.bool_], frame_rate: float) -> Array:
    changes = np.flatnonzero(stands[1:] != stands[:-1]) + 0.5
    frames = np.arange(len(stands))
    away = np.abs(frames[:, None] - changes).min(axis=1, initial=np.inf) / frame_rate
    return np.asarray(np.where(stands, 1.0, -1.0) * np.minimum(away, FAR))
