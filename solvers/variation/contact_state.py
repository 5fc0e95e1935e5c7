"""Represent foot contacts as curves that can be mixed like poses.

The times of touch-down and lift-off are mixed, as constraints are in motion blending (Kovar,
Gleicher 2003, Flexible automatic motion blending with registration curves, section 4.4). One
foot stands from 1.0 s on, another from 1.2 s on: their equal mixture stands from 1.1 s on.
"""

import numpy as np
from numpy.typing import NDArray

from ..arrays import Array
from ..errors import InvalidMotionError
from ..motion import Motion
from ..motion.humanoid import detect_contacts

MAX_CONTACT_TIME_S = 0.25
"""Seconds; the distance to a contact change saturates here. It guards feet that always stand,
whose distance is infinite."""
N_FEET = 2


def measure_contact_state(motion: Motion) -> Array:
    """Return the signed time to the nearest contact change, shape (n_frames, 2), seconds.

    Columns are the left and right foot. Values above 0 mean contact; the magnitude is the time
    to the next change or since the last. NaN where the skeleton does not have two feet.
    """
    try:
        contacts = detect_contacts(motion)
    except InvalidMotionError:
        return np.full((motion.n_frames, N_FEET), np.nan)
    return np.stack(
        [_signed_change_times(foot, motion.frame_rate) for foot in contacts.T], axis=-1
    )


def contacts_from_state(contact_state: Array) -> NDArray[np.bool_] | None:
    """Return the frames of contact, shape (n_frames, 2); None where the state is unknown."""
    return None if np.isnan(contact_state).any() else contact_state > 0.0


def _signed_change_times(in_contact: NDArray[np.bool_], frame_rate: float) -> Array:
    changes = np.flatnonzero(in_contact[1:] != in_contact[:-1]) + 0.5
    frames = np.arange(len(in_contact))
    distances = np.abs(frames[:, None] - changes).min(axis=1, initial=np.inf) / frame_rate
    return np.asarray(
        np.where(in_contact, 1.0, -1.0) * np.minimum(distances, MAX_CONTACT_TIME_S)
    )
