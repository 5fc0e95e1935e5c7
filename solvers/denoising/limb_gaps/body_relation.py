"""The covariance of people's joints across gaps, which is learned and shipped."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from ...archives import ArchiveLayout
from ...arrays import Array
from ...errors import InvalidMotionError
from ...motion import Motion
from ...motion.humanoid import SIDES
from ...npz_members import covariances, words
from ...rotations import inverse, rotate
from ..channels import BODY_POSITION, Channels, encode
from .bridges import N_FEATURES, Bridge

SHIPPED = Path(__file__).parent / "bodies.npz"
RIDGE = 10.0
"""Square degrees: variance that other people's movement does not explain. Sweep on the
development takes of the first press: x10 costs 5 %."""
MIN_EIGENVALUE_RATIO = -1e-6
"""Fraction of the largest moment: rounding in single precision. By definition."""
MAX_MOMENT = -0.5 * RIDGE / MIN_EIGENVALUE_RATIO
"""Square degrees. By definition the largest whose rounding is below the ridge, so that every
regression has a solution; people's are 500."""
LAYOUT = ArchiveLayout(
    "body relation",
    1,
    {
        "keys": words("parts"),
        "moments": covariances(
            "features",
            "features",
            minimum=-MAX_MOMENT,
            maximum=MAX_MOMENT,
            least_eigenvalue=MIN_EIGENVALUE_RATIO,
        ),
        "trained_on": words(),
    },
    holds="a damaged body relation",
    remedy="Learn it again.",
)
SIDED_PARTS = ("UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot")
KEYS = (
    "hips", "spine", "chest", "neck", "head", "leftShoulder", "rightShoulder",
    *(side + name for side in SIDES for name in SIDED_PARTS), BODY_POSITION,
)  # fmt: skip
"""Humanoid roles, and the position of the body: all that every recording has."""
GAP_S, HOP_S = 1.0, 0.25
"""Length of the gaps that are learned from, and time from one to the next, seconds. First
chosen by hand on the development takes of the first press: x0.5 costs 1.5 %, x2 costs 0.8 %.
The second bounds the run time of learning."""
MIRRORED_ROTATION, MIRRORED_POSITION = np.array([1.0, -1.0, -1.0]), np.array([-1.0, 1.0, 1.0])
"""A mirror swaps left and right. By definition of rotation vectors and of the path's frame."""


@dataclass(frozen=True, eq=False)
class BodyRelation:
    """Second moments of the features of all joints over many gaps.

    Attributes
    ----------
    keys : tuple of str, length n_parts
    moments : shape (n_features, n_features), square degrees
        Features outermost to innermost: missing or observed (`Bridge`), which of the three,
        part, axis. Those of the body's position are in centimeters.
    trained_on : str
    """

    keys: tuple[str, ...]
    moments: Array
    trained_on: str = ""

    def knows(self, keys: Sequence[str]) -> bool:
        """Return whether any of these is a joint of the relation."""
        return not set(self.keys).isdisjoint(set(keys) - {BODY_POSITION})

    def regress(
        self, missing: Sequence[str], observed: Sequence[str], ridge: float = RIDGE
    ) -> Array:
        """Return the mean of missing parts' deviations, given features, as a linear map.

        Parameters
        ----------
        missing, observed : sequence of str
            Keys. Unknown ones are independent of all others.
        ridge : float, square degrees

        Returns
        -------
        Array
            Shape (3 * 3 * (n_missing + n_observed), 3 * n_missing): of the missing parts'
            features, then of the observed parts', to deviations.
        """
        indices, targets = self._features_and_targets(missing, observed)
        result = np.zeros((len(indices), len(targets)))
        rows, columns = np.flatnonzero(indices >= 0), np.flatnonzero(targets >= 0)
        known, wanted = indices[rows], targets[columns]
        block = self.moments[np.ix_(known, known)] + ridge * np.eye(len(known))
        result[np.ix_(rows, columns)] = np.linalg.solve(
            block, self.moments[np.ix_(known, wanted)]
        )
        return result

    def error_variance(
        self, missing: Sequence[str], observed: Sequence[str], regression: Array
    ) -> Array:
        """Return the mean squared error of predictions in the gaps that were learned from.

        Parameters
        ----------
        missing, observed : sequence of str
            Keys. Unknown missing ones deviate as all known joints do on average.
        regression : Array
            As `regress` returns.

        Returns
        -------
        Array
            Shape (3 * n_missing,), square degrees.
        """
        indices, targets = self._features_and_targets(missing, observed)
        power = np.diag(self.moments)
        joints = [key for key in self.keys if key != BODY_POSITION]
        mean = power[self._numbers(self._number[1, 0], joints)].mean()
        result = np.full(len(targets), mean)
        rows, columns = np.flatnonzero(indices >= 0), np.flatnonzero(targets >= 0)
        known, wanted = indices[rows], targets[columns]
        used = regression[np.ix_(rows, columns)]
        explained = self.moments[np.ix_(known, known)] @ used
        explained -= 2.0 * self.moments[np.ix_(known, wanted)]
        result[columns] = power[wanted] + (used * explained).sum(axis=0)
        return np.asarray(np.maximum(result, 0.0))

    @property
    def _number(self) -> NDArray[np.intp]:
        """The number of each feature among the moments, shape (2, 3, n_parts, 3)."""
        shape = (2, N_FEATURES, len(self.keys), 3)
        return np.arange(len(self.moments)).reshape(shape)

    def _features_and_targets(
        self, missing: Sequence[str], observed: Sequence[str]
    ) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Return the numbers of the features and of the deviations, -1 where unknown."""
        number = self._number
        features = [
            self._numbers(number[kind, feature], keys)
            for kind, keys in enumerate((missing, observed))
            for feature in range(N_FEATURES)
        ]
        return np.concatenate(features), self._numbers(number[1, 0], missing)

    def _numbers(self, number: NDArray[np.intp], keys: Sequence[str]) -> NDArray[np.intp]:
        """Return the numbers (n_parts, 3) of some parts' features, -1 where unknown, flat."""
        index = {key: part for part, key in enumerate(self.keys)}
        found = [number[index[key]] if key in index else np.full(3, -1) for key in keys]
        return np.concatenate(found).astype(np.intp) if found else np.zeros(0, dtype=np.intp)

    def save(self, path: Path | str) -> None:
        """Write an archive that `load_body_relation` reads."""
        LAYOUT.write(
            path,
            {
                "keys": np.array(self.keys),
                "moments": self.moments.astype(np.float32),
                "trained_on": np.array(self.trained_on),
            },
        )


@lru_cache(maxsize=2)
def load_body_relation(path: Path | str = SHIPPED) -> BodyRelation:
    """Read what `BodyRelation.save` wrote; without a path, the relation that is shipped.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or holds something else.
    """
    arrays = LAYOUT.read(path)
    keys, moments = tuple(map(str, arrays["keys"])), arrays["moments"].astype(float)
    if not keys or len(moments) != 2 * N_FEATURES * 3 * len(keys):
        raise LAYOUT.damaged(path, "the moments are not those of the keys")
    return BodyRelation(keys, moments, str(arrays["trained_on"]))


def learn_body_relation(motions: Iterable[Motion], *, trained_on: str = "") -> BodyRelation:
    """Return the moments over gaps of all parts at once, of motions and their mirror images.

    Parameters
    ----------
    motions : iterable of Motion
        Complete; of different lengths and rigs.
    trained_on : str
        Description of the recordings.

    Raises
    ------
    InvalidMotionError
        No motion is longer than two gaps.
    """
    total, n_frames = np.zeros((2 * N_FEATURES * 3 * len(KEYS),) * 2), 0
    for motion in motions:
        values = canonical_values(encode(motion))
        gap, hop = (round(seconds * motion.frame_rate) for seconds in (GAP_S, HOP_S))
        if len(values) < 2 * gap:
            continue
        for side in (values, _mirror(values)):
            flat = side.reshape(len(side), -1)
            for start in range(1, len(flat) - gap, hop):
                bridge = Bridge(start, start + gap, motion.frame_rate)
                features = np.concatenate(
                    [bridge.missing_features(flat), bridge.observed_features(flat)], axis=1
                ).reshape(gap, -1)
                total += features.T @ features
                n_frames += gap
    if not n_frames:
        raise InvalidMotionError("The recordings are too short to learn from.")
    return BodyRelation(KEYS, total / n_frames, trained_on)


def canonical_values(channels: Channels) -> Array:
    """Return the channels of `KEYS` as if the rig's rest pose were the T-pose.

    Shape (n_frames, n_keys, 3); zero where the recording lacks the part.
    """
    result = np.zeros((len(channels.values), len(KEYS), 3))
    index = {key: part for part, key in enumerate(channels.keys)}
    for column, key in enumerate(KEYS):
        if key in index:
            values = channels.values[:, index[key]]
            is_rotation = key != BODY_POSITION
            alignment = channels.references[key][8:12] if is_rotation else None
            result[:, column] = (
                values if alignment is None else rotate(inverse(alignment), values)
            )
    return result


def _mirror(values: Array) -> Array:
    """Return the mirror image of channels in the order of KEYS."""
    swap = {"left": "right", "right": "left"}
    other = [
        KEYS.index(next((swap[s] + key[len(s) :] for s in swap if key.startswith(s)), key))
        for key in KEYS
    ]
    mirrored = values[:, other] * MIRRORED_ROTATION
    mirrored[:, -1] = values[:, -1] * MIRRORED_POSITION
    return np.asarray(mirrored)
