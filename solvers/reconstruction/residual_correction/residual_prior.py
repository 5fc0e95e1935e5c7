"""Residual prior: Gaussian processes from observed poses to the errors of a sensor."""

from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ...archives import ArchiveLayout
from ...arrays import Array
from ...motion.humanoid import MIRROR_JOINTS, N_JOINTS, POSTURE_JOINTS, mirror_postures
from ...npz_members import flags, numbers, words
from .confidence import IDENTITY_CALIBRATION, Calibration, probability_within
from .inputs import (
    N_NEIGHBORHOOD_FEATURES,
    SmoothedPostures,
    fill_missing,
    neighborhood_features,
)
from .kernel import Kernel, proximity, squared_distances
from .movement_process import MEMBERS, MovementProcess, movement_from_arrays
from .prediction import Prediction, interpolate_prediction
from .sparse_process import basis_values, cholesky_root, shared_design

MOVEMENT_PREFIX = "movement_"
"""Prefix of the movement process's array names in a file."""
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
KEYS = {"mean_pose": "usual", "pose_points": "whole_points", "smoothing": "calm"}
"""Keys of fields in a file, where they differ."""
MOVEMENT_FRACTION = 0.6
"""Fraction of the movement process in a prediction; the rest comes from joints and poses. Half
and twice gain less than 1 % (`make sensitivity`)."""
PREDICTION_RATE_HZ = 15.0
"""Rate (Hz) of predictions. Errors change slowly, so frames in between are interpolated. It
bounds the run time of long takes: x0.1 gains 0.2 %."""

LOCAL_COVERAGE_M, POSTURE_COVERAGE_M = (0.15, 0.1), (0.35, 0.15)
"""Feature distance (m) from the nearest inducing point up to which poses count as covered, and
the fall-off beyond. Actors outside the training set are almost always covered. Half and twice
are no better (`make sensitivity`)."""


@dataclass(frozen=True, eq=False)
class ResidualPrior:
    """Learned errors of a sensor, joint by joint [ZH14, section 5.2.1].

    Attributes
    ----------
    joints : shape (n,), str
        Which of `POSTURE_JOINTS` were learned.
    mean_pose : shape (20, 3), meters
        Mean pose, for joints that are missing from a recording.
    components : shape (57, n_components)
        Principal components of the complete pose without the hips.
    local_points : shape (n, n_local, 15)
        Inducing points of each joint and its neighbors.
    pose_points : shape (n_whole, n_components)
        Inducing points of complete poses.
    kernels : shape (n, 9)
        Hyper-parameters (`Kernel`): lengths, shared, personal, take, actor, noise.
    means, covariances : shapes (n, n_weights, 3) and (n, n_weights, n_weights)
        Of the weights of the shared functions and the mean error.
    smoothing : shape (), seconds
        Standard deviation of the Gaussian that smooths recordings before prediction.
    mirrored : shape (), bool
        Whether right limbs, not in `joints`, use the mirrored errors of left limbs.
    source : shape (), str
        Description of the training recordings.
    movement : MovementProcess, optional
        Process over each pose and the poses before and after it.
    calibration : shape (2, 3)
        `Calibration` of the variances for new actors, with the constant offset and without
        it. The identity in files that have none.
    """

    joints: NDArray[np.str_]
    mean_pose: Array
    components: Array
    local_points: Array
    pose_points: Array
    kernels: Array
    means: Array
    covariances: Array
    smoothing: Array
    mirrored: NDArray[np.bool_]
    source: NDArray[np.str_]
    movement: MovementProcess | None = None
    calibration: Array = field(
        default_factory=lambda: np.array([IDENTITY_CALIBRATION, IDENTITY_CALIBRATION])
    )

    def save(self, path: Path | str) -> None:
        """Write the prior to a file that `load_residual_prior` reads."""
        arrays = {
            KEYS.get(name, name): np.asarray(getattr(self, name)) for name in PRIOR_FIELDS
        }
        if self.movement is not None:
            movement = self.movement.arrays()
            arrays |= {MOVEMENT_PREFIX + name: one for name, one in movement.items()}
        LAYOUT.write(path, arrays)

    @cached_property
    def _cholesky_roots(self) -> list[tuple[Array, Array]]:
        """Roots for local and complete-pose inducing points, joint by joint."""
        roots = []
        for index, points in enumerate(self.local_points):
            near, far = self.kernel(index).lengths
            roots.append((cholesky_root(points, near), cholesky_root(self.pose_points, far)))
        return roots

    @cached_property
    def _kernels(self) -> list[Kernel]:
        return [Kernel.from_logs(logs) for logs in np.log(self.kernels)]

    def kernel(self, index: int) -> Kernel:
        """Return the hyper-parameters of one of the joints."""
        return self._kernels[index]

    def predict(self, smoothed: SmoothedPostures, *, causal: bool = False) -> Prediction:
        """Predict true minus observed position of every joint.

        If `causal`, each frame is predicted separately. Otherwise some frames of each second
        are predicted, the others interpolated, and the movement process contributes. Joints
        without training data, such as fingertips, are ignored.
        """
        has_model = (self.mean_pose != 0.0).any(axis=-1, keepdims=True)
        features = np.where(has_model, fill_missing(smoothed.features, self.mean_pose), 0.0)
        step = 1 if causal else max(round(smoothed.frame_rate / PREDICTION_RATE_HZ), 1)
        last = len(features) - 1
        frames = np.unique(np.append(np.arange(0, last + 1, step), last))
        prediction = self._predict_static(features[frames])
        if not causal and self.movement is not None:
            prediction = self._blend_movement(
                prediction, *self.movement.predict(features, smoothed.frame_rate, frames)
            )
        return (
            prediction
            if len(frames) == len(features)
            else interpolate_prediction(prediction, frames)
        )

    def _blend_movement(
        self, static: Prediction, offsets: Array, nearness: Array
    ) -> Prediction:
        """Blend the predictions from poses and from movements for the same frames."""
        assert self.movement is not None
        known = np.zeros(N_JOINTS, dtype=np.bool_)
        known[self.movement.joints] = True
        known &= np.isfinite(static.variances).all(axis=0)
        weight = np.where(known, MOVEMENT_FRACTION, 0.0)[:, None]
        near = np.where(known, nearness[:, None], 1.0)
        return Prediction(
            weight * offsets + (1.0 - weight) * static.offsets,
            static.variances,
            near * static.coverage,
        )

    def _predict_static(self, features: Array) -> Prediction:
        """Predict from each pose separately."""
        if not self.mirrored:
            return self._predict_learned(features)
        both = self._predict_learned(np.concatenate([features, mirror_postures(features)]))
        prediction, mirror_image = both.halves()
        counterparts = list(MIRROR_JOINTS)
        weight = np.where(
            np.arange(N_JOINTS) == counterparts, 0.5, np.arange(N_JOINTS) < counterparts
        )
        own = np.where(np.isfinite(prediction.variances), weight, 0.0)
        variances = np.where(
            own > 0.0, prediction.variances, mirror_image.variances[:, counterparts]
        )
        return Prediction(
            own[..., None] * prediction.offsets
            + (1.0 - own)[..., None] * mirror_postures(mirror_image.offsets),
            variances,
            own * prediction.coverage + (1.0 - own) * mirror_image.coverage[:, counterparts],
        )

    def _predict_learned(self, features: Array) -> Prediction:
        """Predict only the joints that were learned."""
        shape = features.shape
        offsets, variances = np.zeros(shape), np.full(shape[:2], np.inf)
        coverage = np.zeros(shape[:2])
        pose_features = posture_components(features, self.mean_pose, self.components)
        pose_distances = squared_distances(pose_features, self.pose_points)
        near = proximity(pose_distances, POSTURE_COVERAGE_M)
        for index, name in enumerate(self.joints):
            joint, kernel = POSTURE_JOINTS.index(str(name)), self.kernel(index)
            local = neighborhood_features(features, joint)
            distances = squared_distances(local, self.local_points[index]), pose_distances
            bases = [*map(basis_values, distances, kernel.lengths, self._cholesky_roots[index])]
            columns = shared_design(bases, kernel)
            offsets[:, joint] = columns @ self.means[index]
            variance = np.einsum("ni,ni->n", columns @ self.covariances[index], columns)
            for one, shared in zip(bases, kernel.shared, strict=True):
                variance += shared * np.maximum(1.0 - (one**2).sum(axis=1), 0.0)
            variances[:, joint] = variance
            coverage[:, joint] = near * proximity(distances[0], LOCAL_COVERAGE_M)
        return Prediction(offsets, variances, coverage)

    def constant_variances(self, constant: bool = True) -> Array:
        """Return variances independent of the pose, shape (20,), square meters.

        They include personal functions and noise, and with `constant` also the constant offsets
        of an actor and a take.
        """
        result = np.full(N_JOINTS, np.inf)
        for kernel, name in zip(self._kernels, self.joints, strict=True):
            joint = POSTURE_JOINTS.index(str(name))
            mirrored_joints = [joint, MIRROR_JOINTS[joint]] if self.mirrored else [joint]
            result[mirrored_joints] = (
                sum(kernel.personal)
                + kernel.noise
                + (kernel.take + kernel.actor if constant else 0.0)
            )
        return result

    def confidence(
        self, variances: Array, distance: float, constant: bool, level: float | None = None
    ) -> Array:
        """Return the probability that joints of a new actor are near their mean.

        `constant`: with the constant offset. `level`: mean log variance of the take."""
        calibration = Calibration(*map(float, self.calibration[0 if constant else 1]))
        return probability_within(variances, distance, calibration, level)


def posture_components(features: Array, mean_pose: Array, components: Array) -> Array:
    """Return principal components of poses, shape (n_frames, n_components)."""
    flat = (features - mean_pose)[:, 1:].reshape(len(features), -1)
    return np.asarray(flat @ components)


PRIOR_FIELDS = tuple(one.name for one in fields(ResidualPrior) if one.name != "movement")


def load_residual_prior(path: Path | str) -> ResidualPrior:
    """Read a prior from a file that `save` wrote.

    Raises
    ------
    InvalidFileError
        The file is missing, damaged, or holds something else.
    """
    arrays = LAYOUT.read(path)
    movement_arrays = {
        name.removeprefix(MOVEMENT_PREFIX): arrays.pop(name)
        for name in list(arrays)
        if name.startswith(MOVEMENT_PREFIX)
    }
    fault, movement = _find_fault(arrays), None
    if not fault and movement_arrays:
        fault, movement = movement_from_arrays(movement_arrays)
    if fault:
        raise LAYOUT.damaged(path, fault)
    joints, source = arrays.pop("joints"), arrays.pop("source")
    mirrored_joints = arrays.pop("mirrored").astype(np.bool_)
    names = {key: name for name, key in KEYS.items()}
    own = {names.get(key, key): one.astype(np.float64) for key, one in arrays.items()}
    return ResidualPrior(
        joints=joints, mirrored=mirrored_joints, source=source, movement=movement, **own
    )


def _find_fault(arrays: dict[str, NDArray[Any]]) -> str:
    """Return why these arrays cannot be used, or an empty string."""
    n_local, n_pose_points = arrays["local_points"].shape[1], len(arrays["whole_points"])
    if not (len(arrays["joints"]) and n_local and n_pose_points):
        return "it holds no learned joint"
    if arrays["means"].shape[1] != n_local + n_pose_points + 1:
        return "the shapes do not match, first that of means"
    if not set(map(str, arrays["joints"])) <= set(POSTURE_JOINTS):
        return "it names unknown joints"
    if not (arrays["kernels"] > 0.0).all():
        return "the hyper-parameters are not positive"
    if "calibration" in arrays and (arrays["calibration"][:, 1:] < 0.0).any():
        return "the calibration is negative"
    return ""
