"""Gaussian processes that know how a sensor errs: from what it saw to where the joint was."""

from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...archives import ArchiveLayout
from ...motion.humanoid import MIRROR_IMAGES, N_JOINTS, POSTURE_JOINTS, mirrored
from ...npz_members import flags, numbers, words
from .confidence import IDENTITY_CALIBRATION, Calibration, chance_within
from .inputs import (
    N_NEIGHBORHOOD_FEATURES,
    SmoothedPostures,
    fill_missing,
    neighborhood_features,
)
from .kernel import Kernel, proximity
from .movement_process import MEMBERS, MovementProcess, movement_from_arrays
from .prediction import Prediction, interpolate_prediction
from .sparse_process import basis_functions, cholesky_root, shared_design

Array = NDArray[np.float64]

MOVEMENT_PREFIX = "movement_"
"""What the names of the movement process's arrays begin with in a file."""
LAYOUT = ArchiveLayout(
    "residual prior",
    2,
    {
        "joints": words("joints"),
        "usual": numbers(N_JOINTS, 3),
        "components": numbers(3 * (N_JOINTS - 1), "components"),
        "local_points": numbers("joints", "local", N_NEIGHBORHOOD_FEATURES),
        "whole_points": numbers("whole", "components"),
        "kernels": numbers("joints", 9),
        "means": numbers("joints", "weights", 3),
        "covariances": numbers("joints", "weights", "weights"),
        "calm": numbers(minimum=0.0, maximum=10.0),
        "mirrored": flags(),
        "source": words(),
        "calibration": numbers(2, 3, optional=True),
        **{MOVEMENT_PREFIX + name: values for name, values in MEMBERS.items()},
    },
    holds="a damaged prior",
    remedy="Learn it again.",
)
MOVEMENT_FRACTION = 0.6
"""Share of the movement process in what is foretold; the rest is of joints and postures."""
PREDICTION_RATE_HZ = 15.0
"""Hertz. Errors change slowly: what lies between is interpolated."""

LOCAL_COVERAGE_M, POSTURE_COVERAGE_M = (0.15, 0.1), (0.35, 0.15)
"""Metres of features from the nearest inducing point up to which postures count as known, and
how fast they become unknown beyond. Actors who were left out lie within nearly always."""


@dataclass(frozen=True, eq=False)
class ResidualPrior:
    """What was learned of a sensor's errors, joint by joint [ZH14, section 5.2.1].

    Attributes
    ----------
    joints : shape (n,), str
        Which of `POSTURE_JOINTS` were learned.
    usual : shape (20, 3), metres
        The mean posture, for joints that a recording lacks.
    components : shape (57, n_components)
        Principal components of the whole posture without the hips.
    local_points : shape (n, n_local, 15)
        Inducing points of each joint and its neighbours.
    whole_points : shape (n_whole, n_components)
        Inducing points of whole postures.
    kernels : shape (n, 9)
        Hyper-parameters (`Kernel`): lengths, shared, personal, take, actor, noise.
    means, covariances : shapes (n, n_weights, 3) and (n, n_weights, n_weights)
        Of the weights of the shared functions and the mean error.
    calm : shape (), seconds
        Gaussian that recordings are calmed with before they are looked at.
    mirrored : shape (), bool
        Right limbs are not among the joints, but err as left ones do in a mirror.
    source : shape (), str
        What it was learned from.
    movement : MovementProcess, optional
        What postures tell together with where they come from and go to.
    calibration : shape (2, 3)
        How the variances of new actors follow (`Calibration`), with the constant offset and
        beside it. Files of before have none: variances are taken as they are told.
    """

    joints: NDArray[np.str_]
    usual: Array
    components: Array
    local_points: Array
    whole_points: Array
    kernels: Array
    means: Array
    covariances: Array
    calm: Array
    mirrored: NDArray[np.bool_]
    source: NDArray[np.str_]
    movement: MovementProcess | None = None
    calibration: Array = field(
        default_factory=lambda: np.array([IDENTITY_CALIBRATION, IDENTITY_CALIBRATION])
    )

    def save(self, path: Path | str) -> None:
        """Write the prior to a file; `load_residual_prior` reads it."""
        arrays = {name: np.asarray(getattr(self, name)) for name in PRIOR_FIELDS}
        if self.movement is not None:
            arrays |= {
                MOVEMENT_PREFIX + name: one for name, one in self.movement.arrays().items()
            }
        LAYOUT.write(path, arrays)

    @cached_property
    def _triangles(self) -> list[tuple[Array, Array]]:
        """Of local and whole inducing points, joint by joint."""
        found = []
        for place, points in enumerate(self.local_points):
            near, far = self.kernel(place).lengths
            found.append((cholesky_root(points, near), cholesky_root(self.whole_points, far)))
        return found

    def kernel(self, place: int) -> Kernel:
        """Return the hyper-parameters of one of the joints."""
        return Kernel.from_logs(np.log(self.kernels[place]))

    def predict(self, calm: SmoothedPostures, ahead: bool = True) -> Prediction:
        """Foretell true minus seen place of every joint.

        With `ahead` a few frames of each second are foretold, what lies between is
        interpolated, and where postures go to is looked at. Else each frame is foretold by
        itself. Joints that no teacher showed, as the ends of hands, are not looked at.
        """
        told_of = (self.usual != 0.0).any(axis=-1, keepdims=True)
        features = np.where(told_of, fill_missing(calm.features, self.usual), 0.0)
        step = max(round(calm.frame_rate / PREDICTION_RATE_HZ), 1) if ahead else 1
        last = len(features) - 1
        frames = np.unique(np.append(np.arange(0, last + 1, step), last))
        told = self._still(features[frames])
        if ahead and self.movement is not None:
            told = self._moving(
                told, *self.movement.foretell(features, calm.frame_rate, frames)
            )
        return told if len(frames) == len(features) else interpolate_prediction(told, frames)

    def _moving(self, still: Prediction, offsets: Array, nearness: Array) -> Prediction:
        """Bring together what postures tell, and what movements tell of the same frames."""
        assert self.movement is not None
        known = np.zeros(N_JOINTS, dtype=np.bool_)
        known[self.movement.joints] = True
        known &= np.isfinite(still.variances).all(axis=0)
        share = np.where(known, MOVEMENT_FRACTION, 0.0)[:, None]
        near = np.where(known, nearness[:, None], 1.0)
        return Prediction(
            share * offsets + (1.0 - share) * still.offsets,
            still.variances,
            near * still.coverage,
        )

    def _still(self, features: Array) -> Prediction:
        """Foretell from each posture alone."""
        told = self._foretell(features)
        if not self.mirrored:
            return told
        image = self._foretell(mirrored(features))
        other = list(MIRROR_IMAGES)
        share = np.where(np.arange(N_JOINTS) == other, 0.5, np.arange(N_JOINTS) < other)
        own = np.where(np.isfinite(told.variances), share, 0.0)
        variances = np.where(own > 0.0, told.variances, image.variances[:, other])
        return Prediction(
            own[..., None] * told.offsets + (1.0 - own)[..., None] * mirrored(image.offsets),
            variances,
            own * told.coverage + (1.0 - own) * image.coverage[:, other],
        )

    def _foretell(self, features: Array) -> Prediction:
        """Foretell of those joints alone that were learned."""
        shape = features.shape
        offsets, variances = np.zeros(shape), np.full(shape[:2], np.inf)
        coverage = np.zeros(shape[:2])
        whole = posture_components(features, self.usual, self.components)
        near = proximity(whole, self.whole_points, POSTURE_COVERAGE_M)
        for place, name in enumerate(self.joints):
            joint, kernel = POSTURE_JOINTS.index(str(name)), self.kernel(place)
            local, roots = neighborhood_features(features, joint), self._triangles[place]
            bases = (
                basis_functions(local, self.local_points[place], kernel.lengths[0], roots[0]),
                basis_functions(whole, self.whole_points, kernel.lengths[1], roots[1]),
            )
            columns = shared_design(bases, kernel)
            offsets[:, joint] = columns @ self.means[place]
            unknown = np.einsum("ni,ni->n", columns @ self.covariances[place], columns)
            for one, shared in zip(bases, kernel.shared, strict=True):
                unknown += shared * np.maximum(1.0 - (one**2).sum(axis=1), 0.0)
            variances[:, joint] = unknown
            coverage[:, joint] = near * proximity(
                local, self.local_points[place], LOCAL_COVERAGE_M
            )
        return Prediction(offsets, variances, coverage)

    def lasting_variances(self, constant: bool = True) -> Array:
        """Return variances that no posture tells of, shape (20,), square metres.

        Those of personal functions and noise, and where `constant` those of the constant
        offsets of an actor and a take.
        """
        result = np.full(N_JOINTS, np.inf)
        for place, name in enumerate(self.joints):
            kernel = self.kernel(place)
            joint = POSTURE_JOINTS.index(str(name))
            alike = [joint, MIRROR_IMAGES[joint]] if self.mirrored else [joint]
            result[alike] = (
                sum(kernel.personal)
                + kernel.noise
                + (kernel.take + kernel.actor if constant else 0.0)
            )
        return result

    def confidence(self, variances: Array, distance: float, constant: bool = True) -> Array:
        """Return the chance that joints of somebody new lie within a distance of their mean.

        `constant` says whether the variances have those of the constant offset.
        """
        calibration = Calibration(*map(float, self.calibration[0 if constant else 1]))
        return chance_within(variances, distance, calibration)


def posture_components(features: Array, usual: Array, components: Array) -> Array:
    """Return principal components of postures, shape (n_frames, n_components)."""
    flat = (features - usual)[:, 1:].reshape(len(features), -1)
    return np.asarray(flat @ components)


PRIOR_FIELDS = tuple(one.name for one in fields(ResidualPrior) if one.name != "movement")


def load_residual_prior(path: Path | str) -> ResidualPrior:
    """Read a prior that `save` wrote.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or holds something else.
    """
    arrays = LAYOUT.read(path)
    moving = {
        name.removeprefix(MOVEMENT_PREFIX): arrays.pop(name)
        for name in list(arrays)
        if name.startswith(MOVEMENT_PREFIX)
    }
    fault, movement = _find_fault(arrays), None
    if not fault and moving:
        fault, movement = movement_from_arrays(moving)
    if fault:
        raise LAYOUT.damaged(path, fault)
    joints, source = arrays.pop("joints"), arrays.pop("source")
    alike = arrays.pop("mirrored").astype(np.bool_)
    own = {name: one.astype(np.float64) for name, one in arrays.items()}
    return ResidualPrior(joints=joints, mirrored=alike, source=source, movement=movement, **own)


def _find_fault(arrays: dict[str, NDArray[Any]]) -> str:
    """Return what keeps these arrays from being used, or nothing."""
    n_local, n_whole = arrays["local_points"].shape[1], len(arrays["whole_points"])
    if not (len(arrays["joints"]) and n_local and n_whole):
        return "nothing was learned"
    if arrays["means"].shape[1] != n_local + n_whole + 1:
        return "the shapes do not fit, first that of means"
    if not set(map(str, arrays["joints"])) <= set(POSTURE_JOINTS):
        return "they speak of unknown joints"
    if not (arrays["kernels"] > 0.0).all():
        return "their hyper-parameters are not positive"
    if "calibration" in arrays and (arrays["calibration"][:, 1:] < 0.0).any():
        return "their calibration is negative"
    return ""
