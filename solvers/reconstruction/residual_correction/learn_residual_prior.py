"""Learn a sensor's errors from simultaneous takes of a better system."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...arrays import Array, Integers
from ...errors import InvalidMotionError
from ...motion import JointRecording, Tracks
from ...motion.humanoid import (
    MIRROR_JOINTS,
    N_JOINTS,
    POSTURE_JOINTS,
    mirror_postures,
    posture_positions,
    rotate_about_vertical,
)
from ...progress import Progress, unwatched
from ...settings import Choice, Settings, setting
from .inputs import fill_missing, neighborhood_features, smooth_postures
from .kernel import Kernel, learn_kernel
from .learn_movement_process import TrainingTake, learn_movement_process
from .residual_prior import ResidualPrior, posture_components
from .sparse_process import basis_functions, inducing_points, posterior, shared_design

N_COMPONENTS = 15
CORRELATION_TIME_S = 2.5
"""Time (s) after which errors of one take are independent. Chosen by hand; used in training."""
MEDIAN_SQUARED_LENGTH = 2.366
"""Ratio of the median squared length of a normal 3D vector to its variance, by definition."""
MIN_FRAMES = 20
"""Minimum number of frames with a known joint to learn it."""


class ResidualMethod(Choice):
    """Method that learns errors."""

    HIERARCHICAL = "hierarchical", "Learn from neighboring joints and from the complete pose"
    PUBLISHED = (
        "published",
        "Learn from neighboring joints only, as Zhou et al. (2014)",
        "Zhou et al. 2014",
    )


@dataclass(frozen=True, kw_only=True)
class ResidualPriorSettings(Settings):
    """Settings of `learn_residual_prior`."""

    method: ResidualMethod = setting(
        ResidualMethod.HIERARCHICAL, "Choose how to learn sensor errors"
    )
    local_points: int = setting(
        60, "Inducing points of each joint and its neighbors; more is finer and slower",
        minimum=5, maximum=500, advanced=True,
    )  # fmt: skip
    pose_points: int = setting(
        100, "Inducing points of complete poses; more is finer and slower",
        minimum=5, maximum=500, advanced=True, former="whole_points",
    )  # fmt: skip
    movement_points: int = setting(
        1500, "Movements to compare errors with; more is finer, slower and larger",
        minimum=20, maximum=5000, advanced=True,
    )  # fmt: skip
    sample: int = setting(
        500, "Frames to learn the hyperparameters from; more is more accurate and slower",
        minimum=50, maximum=3000, advanced=True,
    )  # fmt: skip
    frame_rate: float = setting(
        6.0, "Frames per second to thin the examples to",
        unit="Hz", minimum=0.5, maximum=120.0, advanced=True,
    )  # fmt: skip
    mirror: bool = setting(
        True, "Also learn each error with left and right swapped; off for a sensor at the side"
    )  # fmt: skip
    smoothing: float = setting(
        1 / 30, "Width of the Gaussian that smooths recordings first; 0 as published",
        unit="s", minimum=0.0, maximum=0.5, advanced=True, former="calm",
    )  # fmt: skip
    seed: int = setting(
        0, "Random seed of frames and first clusters", minimum=0, maximum=2**31 - 1,
        advanced=True,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class _TrainingFrames:
    """Training frames: features, errors, take and actor indices."""

    features: Array
    errors: Array
    takes: Integers
    actors: Integers


def learn_residual_prior(
    pairs: Sequence[tuple[JointRecording, Tracks]],
    *,
    actors: Sequence[str] | None = None,
    settings: ResidualPriorSettings = ResidualPriorSettings(),
    progress: Progress = unwatched,
) -> ResidualPrior:
    """Learn the offset from the observed to the true position of each joint.

    Parameters
    ----------
    pairs : sequence of (JointRecording, Tracks)
        Recording of the sensor, and the true joints under the same names or under humanoid
        roles, synchronous frame by frame, in the same world, Z up.
    actors : sequence of str, length n_pairs, optional
        The actor of each pair. With actor labels, the prior separates actor-specific from
        sensor-specific errors. By default each take is another actor.
    settings : ResidualPriorSettings
    progress : Progress

    Returns
    -------
    ResidualPrior

    Raises
    ------
    InvalidMotionError
        There is no pair, the lengths of a pair differ, or no joint is known in both.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [ZH14] Zhou (2014). Modeling of single character motions with temporal sparse
       representation and Gaussian processes. PhD thesis, City University of Hong Kong, 5.2.1.
    """
    actor_names = _check_pairs(pairs, actors)
    takes = _read_takes(pairs, actor_names, settings.smoothing)
    examples, mean_pose = _gather_examples(takes, settings)
    centered = (examples.features - mean_pose)[:, 1:].reshape(len(examples.takes), -1)
    n_components = min(N_COMPONENTS, *centered.shape)
    components = np.linalg.svd(centered, full_matrices=False)[2][:n_components].T
    pose_features = posture_components(examples.features, mean_pose, components)
    pose_points = inducing_points(pose_features, settings.pose_points, settings.seed)
    learned: dict[int, tuple[Array, Kernel, Array, Array]] = {}
    for joint in range(N_JOINTS):
        progress(joint / N_JOINTS, "Learning sensor errors")
        known = np.isfinite(examples.errors[:, joint]).all(axis=-1)
        is_mirror_image = settings.mirror and MIRROR_JOINTS[joint] < joint
        if known.sum() >= MIN_FRAMES and not is_mirror_image:
            learned[joint] = _learn_joint(
                examples, joint, known, pose_features, pose_points, settings
            )
    if not learned:
        raise InvalidMotionError(
            "No joint is observed in both recordings of any pair. Check the joint names."
        )
    movement = None
    if settings.method is ResidualMethod.HIERARCHICAL:
        filled = [replace(one, features=fill_missing(one.features, mean_pose)) for one in takes]
        movement = learn_movement_process(
            filled, settings.frame_rate, settings.movement_points, settings.mirror
        )
    progress(1.0, "Learned")
    return ResidualPrior(
        np.array([POSTURE_JOINTS[joint] for joint in learned]),
        mean_pose,
        components,
        np.stack([points for points, *_ in learned.values()]),
        pose_points,
        np.array([_kernel_row(kernel) for _, kernel, *_ in learned.values()]),
        np.stack([mean for *_, mean, _ in learned.values()]),
        np.stack([covariance for *_, covariance in learned.values()]),
        np.array(settings.smoothing),
        np.array(settings.mirror),
        np.array(f"{len(pairs)} takes of {len(set(actor_names))} actors"),
        movement,
    )


def _check_pairs(
    pairs: Sequence[tuple[JointRecording, Tracks]], actors: Sequence[str] | None
) -> list[str]:
    """Return the actor of each pair, after checking the pairs."""
    if not pairs:
        raise InvalidMotionError("There are no pairs of recordings to learn from. Add one.")
    actor_names = [str(take) for take in range(len(pairs))] if actors is None else list(actors)
    if len(actor_names) != len(pairs):
        raise InvalidMotionError(f"There are {len(pairs)} pairs but {len(actor_names)} actors.")
    for take, (observed, true) in enumerate(pairs):
        if (observed.n_frames, observed.frame_rate) != (true.n_frames, true.frame_rate):
            raise InvalidMotionError(
                f"Pair {take}: {observed.n_frames} frames at {observed.frame_rate:g} Hz do not"
                f" fit {true.n_frames} at {true.frame_rate:g} Hz. Resample one of them."
            )
    return actor_names


def _read_takes(
    pairs: Sequence[tuple[JointRecording, Tracks]], actor_names: Sequence[str], smoothing: float
) -> list[TrainingTake]:
    """Smooth all recordings; errors are relative to the heading."""
    takes = []
    for (observed, true), actor in zip(pairs, actor_names, strict=True):
        smoothed = smooth_postures(observed, smoothing)
        off = posture_positions(true) - smoothed.positions
        errors = rotate_about_vertical(off, -smoothed.normalized.headings)
        takes.append(TrainingTake(smoothed.features, errors, observed.frame_rate, actor))
    return takes


def _gather_examples(
    all_takes: Sequence[TrainingTake], settings: ResidualPriorSettings
) -> tuple[_TrainingFrames, Array]:
    """Subsample and concatenate all takes; also return the mean pose."""
    features, errors, takes = [], [], []
    for number, one in enumerate(all_takes):
        step = max(round(one.frame_rate / settings.frame_rate), 1)
        features.append(one.features[step // 2 :: step])
        errors.append(one.errors[step // 2 :: step])
        takes += [number] * len(features[-1])
    actor_names = [one.actor for one in all_takes]
    names = sorted(set(actor_names))
    actors = [names.index(actor_names[take]) for take in takes]
    if settings.mirror:
        features += [mirror_postures(one) for one in features]
        errors += [mirror_postures(one) for one in errors]
        takes += [len(actor_names) + take for take in takes]
        actors += [len(names) + actor for actor in actors]
    all_features = np.concatenate(features)
    known = np.isfinite(all_features).all(axis=-1)
    mean_pose = np.where(known[..., None], all_features, 0.0).sum(axis=0)
    mean_pose /= np.maximum(known.sum(axis=0), 1)[:, None]
    examples = fill_missing(all_features, mean_pose)
    return _TrainingFrames(
        examples, np.concatenate(errors), np.array(takes), np.array(actors)
    ), mean_pose


def _learn_joint(
    examples: _TrainingFrames,
    joint: int,
    known: NDArray[np.bool_],
    pose_features: Array,
    pose_points: Array,
    settings: ResidualPriorSettings,
) -> tuple[Array, Kernel, Array, Array]:
    """Return inducing points, hyper-parameters, and mean and covariance of the weights."""
    local = neighborhood_features(examples.features, joint)[known]
    pose_features, errors = pose_features[known], examples.errors[known, joint]
    takes, actors = (
        np.unique(one[known], return_inverse=True)[1]
        for one in (examples.takes, examples.actors)
    )
    chosen = np.random.default_rng(settings.seed).permutation(len(errors))[: settings.sample]
    published = settings.method is ResidualMethod.PUBLISHED
    kernel = learn_kernel(
        (local[chosen], pose_features[chosen]),
        errors[chosen],
        takes[chosen],
        actors[chosen],
        published,
    )
    points = inducing_points(local, settings.local_points, settings.seed)
    points = np.pad(points, ((0, settings.local_points - len(points)), (0, 0)), mode="edge")
    bases = (
        basis_functions(local, points, kernel.lengths[0]),
        basis_functions(pose_features, pose_points, kernel.lengths[1]),
    )
    repeats = 1.0 if published else max(CORRELATION_TIME_S * settings.frame_rate, 1.0)
    mean, covariance = posterior(bases, errors, takes, actors, kernel, repeats)
    return points, match_median_error(kernel, bases, errors, mean, covariance), mean, covariance


def match_median_error(
    kernel: Kernel, bases: tuple[Array, Array], errors: Array, mean: Array, covariance: Array
) -> Kernel:
    """Scale the pose-independent variances of a kernel to match the median error.

    Sensor errors have heavy tails, so their variance overstates most of them. The variances of
    actor, take, noise and personal functions are scaled to match the median error.
    """
    columns = shared_design(bases, kernel)
    known = np.einsum("ni,ni->n", columns @ covariance, columns)
    off = ((errors - columns @ mean) ** 2).sum(axis=1)
    constant_variance = sum(kernel.personal) + kernel.take + kernel.actor + kernel.noise
    target_variance = float(np.median(off)) / MEDIAN_SQUARED_LENGTH - float(np.median(known))
    scale = float(np.clip(target_variance / constant_variance, 0.01, 10.0))
    return replace(
        kernel,
        personal=(scale * kernel.personal[0], scale * kernel.personal[1]),
        take=scale * kernel.take,
        actor=scale * kernel.actor,
        noise=scale * kernel.noise,
    )


def _kernel_row(kernel: Kernel) -> list[float]:
    """Return the hyper-parameters in the layout of `ResidualPrior.kernels`."""
    pairs = (*kernel.lengths, *kernel.shared, *kernel.personal)
    return [*pairs, kernel.take, kernel.actor, kernel.noise]
