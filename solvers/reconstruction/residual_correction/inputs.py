"""What the residual prior looks at: calm postures of a usual size, normalised."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...motion import JointRecording, Tracks
from ...motion.humanoid import (
    N_JOINTS,
    PARENTS,
    USUAL_LENGTHS,
    Normalised,
    body_lengths,
    normalise,
    posture_positions,
    turned,
)
from ...signals import bridged, steadied

Array = NDArray[np.float64]

NEIGHBORHOODS = tuple(
    tuple(
        [joint]
        + [child for child in range(N_JOINTS) if PARENTS[child] == joint]
        + ([PARENTS[joint]] if PARENTS[joint] >= 0 else [])
    )
    for joint in range(N_JOINTS)
)
"""A joint and those that it shares a bone with [ZH14, section 5.2.1]."""
N_NEIGHBORHOOD_FEATURES = 3 * max(len(joints) for joints in NEIGHBORHOODS)


@dataclass(frozen=True, eq=False)
class SmoothedPostures:
    """A recording as the residual prior sees it.

    Attributes
    ----------
    positions : shape (n_frames, 20, 3), metres, world
        Calmed and without gaps, except joints that are never seen, which are NaN.
    normalised : Normalised
        The same without heading and place.
    features : shape (n_frames, 20, 3)
        The same for a body of usual size; NaN where `normalised` is.
    frame_rate : float, hertz
    """

    positions: Array
    normalised: Normalised
    features: Array
    frame_rate: float

    def turn_back(self, offsets: Array) -> Array:
        """Return offsets of these frames as the world sees them, (n_frames, n, 3)."""
        return turned(offsets, self.normalised.headings)


def smooth_postures(
    recording: JointRecording | Tracks,
    calm: float,
    weights: Array | None = None,
    *,
    ahead: bool = True,
) -> SmoothedPostures:
    """Calm a recording with a Gaussian of `calm` seconds, bridge gaps, and normalise it.

    Without `ahead` a frame knows of no later one but the actor's size.
    """
    positions = bridged(posture_positions(recording), ahead=ahead)
    seen = np.isfinite(positions).all(axis=(0, 2))
    rate = recording.frame_rate
    positions[:, seen] = steadied(positions[:, seen], calm * rate, ahead=ahead)
    normal = normalise(positions, rate, weights, ahead=ahead)
    length = body_lengths(positions).sum()
    if length == 0.0:
        raise InvalidMotionError(
            "The joints are all in one place; choose a recording of an actor who was tracked."
        )
    usual = normal.postures * USUAL_LENGTHS.sum() / length
    return SmoothedPostures(positions, normal, usual, rate)


def fill_missing(features: Array, usual: Array) -> Array:
    """Return features with the usual posture, shape (20, 3), where a joint is never seen."""
    return np.where(np.isfinite(features), features, usual)


def neighborhood_features(features: Array, joint: int) -> Array:
    """Return a joint's features and its neighbours', shape (n_frames, 15), filled up with 0."""
    found = features[:, list(NEIGHBORHOODS[joint])].reshape(len(features), -1)
    return np.pad(found, ((0, 0), (0, N_NEIGHBORHOOD_FEATURES - found.shape[1])))
