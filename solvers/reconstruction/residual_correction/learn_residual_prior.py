"""Learn how a sensor errs from takes that another system saw as well."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from ...errors import InvalidMotionError
from ...motion import JointRecording, Tracks
from ...motion.humanoid import (
    MIRROR_IMAGES,
    N_JOINTS,
    POSTURE_JOINTS,
    mirrored,
    posture_positions,
    turned,
)
from ...progress import Progress, unwatched
from ...settings import Choice, Settings, setting
from .inputs import calm_postures, filled, neighbourhood
from .kernel import Kernel, learn_kernel
from .learn_movement_process import Take, learn_movement_process
from .prior import ResidualPrior, whole_posture
from .sparse_process import basis, inducing_points, posterior, shared_columns

Array = NDArray[np.float64]
Numbers = NDArray[np.int64]

N_COMPONENTS = 15
ALONE = 2.5
"""Seconds after which errors of one take tell something new; nearer frames repeat it."""
MEDIAN_OF_SQUARES = 2.366
"""Median of the squared length of a normal vector in space whose axes have variance 1."""
FEWEST = 20
"""Frames in which a joint must be known to be learned."""


class ResidualMethod(Choice):
    """How errors are learned."""

    HIERARCHICAL = "hierarchical", "Learn from neighboring joints and from the whole pose"
    PUBLISHED = (
        "published",
        "Learn from neighboring joints only, as Zhou et al. (2014)",
        "Zhou et al. 2014",
    )


@dataclass(frozen=True, kw_only=True)
class ResidualPriorSettings(Settings):
    """How the prior is learned."""

    method: ResidualMethod = setting(
        ResidualMethod.HIERARCHICAL,
        "How sensor errors are learned",
    )
    local_points: int = setting(
        60, "Inducing points of each joint and its neighbors; more is finer and slower",
        minimum=5, maximum=500, advanced=True,
    )  # fmt: skip
    whole_points: int = setting(
        100, "Inducing points of whole poses; more is finer and slower",
        minimum=5, maximum=500, advanced=True,
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
        True,
        "Also learn each error with left and right exchanged; turn off for a sensor at the"
        " side",
    )  # fmt: skip
    calm: float = setting(
        1 / 30, "Width of the Gaussian that smooths recordings first; 0 as published",
        unit="s", minimum=0.0, maximum=0.5, advanced=True,
    )  # fmt: skip
    seed: int = setting(
        0, "Random seed of frames and first clusters", minimum=0, maximum=2**31 - 1,
        advanced=True,
    )  # fmt: skip


@dataclass(frozen=True, eq=False)
class _Examples:
    """All frames that are learned from: features, errors, and whose they are."""

    features: Array
    errors: Array
    takes: Numbers
    actors: Numbers


def learn_residual_prior(
    pairs: Sequence[tuple[JointRecording, Tracks]],
    *,
    actors: Sequence[str] | None = None,
    settings: ResidualPriorSettings = ResidualPriorSettings(),
    progress: Progress = unwatched,
) -> ResidualPrior:
    """Learn the offset from where a sensor saw each joint to where it was.

    Parameters
    ----------
    pairs : sequence of (JointRecording, Tracks)
        What the sensor saw, and the true joints under the same names or under humanoid roles,
        frame by frame at the same time, in the same world, Z up.
    actors : sequence of str, length n_pairs, optional
        Who was recorded. Takes of one actor err alike; told so, the prior takes less of one
        actor's build for a rule. One actor for each take where it is not given.
    settings : ResidualPriorSettings
    progress : Progress

    Returns
    -------
    ResidualPrior

    Raises
    ------
    InvalidMotionError
        There is no pair, a pair's lengths differ, or no joint is known in both.
    SolveCancelled
        Raised by `progress`.

    References
    ----------
    .. [ZH14] Zhou (2014). Modeling of single character motions with temporal sparse
       representation and Gaussian processes. PhD thesis, City University of Hong Kong, 5.2.1.
    """
    people = _checked(pairs, actors)
    takes = _read(pairs, people, settings.calm)
    examples, usual = _gathered(takes, settings)
    centred = (examples.features - usual)[:, 1:].reshape(len(examples.takes), -1)
    n_components = min(N_COMPONENTS, *centred.shape)
    components = np.linalg.svd(centred, full_matrices=False)[2][:n_components].T
    whole = whole_posture(examples.features, usual, components)
    whole_points = inducing_points(whole, settings.whole_points, settings.seed)
    learned: dict[int, tuple[Array, Kernel, Array, Array]] = {}
    for joint in range(N_JOINTS):
        progress(joint / N_JOINTS, "Learning how the sensor errs")
        known = np.isfinite(examples.errors[:, joint]).all(axis=-1)
        right = settings.mirror and MIRROR_IMAGES[joint] < joint
        if known.sum() >= FEWEST and not right:
            learned[joint] = _learn_joint(examples, joint, known, whole, whole_points, settings)
    if not learned:
        raise InvalidMotionError("No joint is known in both recordings of any pair.")
    movement = None
    if settings.method is ResidualMethod.HIERARCHICAL:
        whole_takes = [replace(one, features=filled(one.features, usual)) for one in takes]
        movement = learn_movement_process(
            whole_takes, settings.frame_rate, settings.movement_points, settings.mirror
        )
    progress(1.0, "Learned")
    return ResidualPrior(
        np.array([POSTURE_JOINTS[joint] for joint in learned]),
        usual,
        components,
        np.stack([points for points, *_ in learned.values()]),
        whole_points,
        np.array([_row(kernel) for _, kernel, *_ in learned.values()]),
        np.stack([mean for *_, mean, _ in learned.values()]),
        np.stack([covariance for *_, covariance in learned.values()]),
        np.array(settings.calm),
        np.array(settings.mirror),
        np.array(f"{len(pairs)} takes of {len(set(people))} actors"),
        movement,
    )


def _checked(
    pairs: Sequence[tuple[JointRecording, Tracks]], actors: Sequence[str] | None
) -> list[str]:
    """Return who is seen in each pair."""
    if not pairs:
        raise InvalidMotionError("There is no pair of recordings to learn from; give some.")
    people = [str(take) for take in range(len(pairs))] if actors is None else list(actors)
    if len(people) != len(pairs):
        raise InvalidMotionError(f"There are {len(pairs)} pairs but {len(people)} actors.")
    for take, (seen, true) in enumerate(pairs):
        if (seen.n_frames, seen.frame_rate) != (true.n_frames, true.frame_rate):
            raise InvalidMotionError(
                f"Pair {take}: {seen.n_frames} frames at {seen.frame_rate:g} Hz do not fit"
                f" {true.n_frames} at {true.frame_rate:g} Hz; resample one of them."
            )
    return people


def _read(
    pairs: Sequence[tuple[JointRecording, Tracks]], people: Sequence[str], calm: float
) -> list[Take]:
    """Calm all recordings; errors are told without heading."""
    takes = []
    for (seen, true), actor in zip(pairs, people, strict=True):
        found = calm_postures(seen, calm)
        off = posture_positions(true) - found.positions
        errors = turned(off, -found.normalised.headings)
        takes.append(Take(found.features, errors, seen.frame_rate, actor))
    return takes


def _gathered(
    all_takes: Sequence[Take], settings: ResidualPriorSettings
) -> tuple[_Examples, Array]:
    """Thin all takes out and put their frames together; also the mean posture."""
    features, errors, takes = [], [], []
    for number, one in enumerate(all_takes):
        step = max(round(one.frame_rate / settings.frame_rate), 1)
        features.append(one.features[step // 2 :: step])
        errors.append(one.errors[step // 2 :: step])
        takes += [number] * len(features[-1])
    people = [one.actor for one in all_takes]
    names = sorted(set(people))
    actors = [names.index(people[take]) for take in takes]
    if settings.mirror:
        features += [mirrored(one) for one in features]
        errors += [mirrored(one) for one in errors]
        takes += [len(people) + take for take in takes]
        actors += [len(names) + actor for actor in actors]
    together = np.concatenate(features)
    known = np.isfinite(together).all(axis=-1)
    usual = np.where(known[..., None], together, 0.0).sum(axis=0)
    usual /= np.maximum(known.sum(axis=0), 1)[:, None]
    examples = filled(together, usual)
    return _Examples(examples, np.concatenate(errors), np.array(takes), np.array(actors)), usual


def _learn_joint(
    examples: _Examples,
    joint: int,
    known: NDArray[np.bool_],
    whole: Array,
    whole_points: Array,
    settings: ResidualPriorSettings,
) -> tuple[Array, Kernel, Array, Array]:
    """Return inducing points, hyper-parameters, and mean and covariance of the weights."""
    local = neighbourhood(examples.features, joint)[known]
    whole, errors = whole[known], examples.errors[known, joint]
    takes, actors = (
        np.unique(one[known], return_inverse=True)[1]
        for one in (examples.takes, examples.actors)
    )
    chosen = np.random.default_rng(settings.seed).permutation(len(errors))[: settings.sample]
    published = settings.method is ResidualMethod.PUBLISHED
    kernel = learn_kernel(
        (local[chosen], whole[chosen]), errors[chosen], takes[chosen], actors[chosen], published
    )
    points = inducing_points(local, settings.local_points, settings.seed)
    points = np.pad(points, ((0, settings.local_points - len(points)), (0, 0)), mode="edge")
    bases = (
        basis(local, points, kernel.lengths[0]),
        basis(whole, whole_points, kernel.lengths[1]),
    )
    repeats = 1.0 if published else max(ALONE * settings.frame_rate, 1.0)
    mean, covariance = posterior(bases, errors, takes, actors, kernel, repeats)
    return points, honest(kernel, bases, errors, mean, covariance), mean, covariance


def honest(
    kernel: Kernel, bases: tuple[Array, Array], errors: Array, mean: Array, covariance: Array
) -> Kernel:
    """Return the kernel with what no posture tells as large as the usual error calls for.

    Errors of sensors have heavy tails: their variance says more than half of them are. The
    variances of actor, take, noise and personal functions are multiplied so that half of the
    examples lie within the median that the normal distribution has.
    """
    columns = shared_columns(bases, kernel)
    known = np.einsum("ni,ni->n", columns @ covariance, columns)
    off = ((errors - columns @ mean) ** 2).sum(axis=1)
    lasting = sum(kernel.personal) + kernel.take + kernel.actor + kernel.noise
    wanted = float(np.median(off)) / MEDIAN_OF_SQUARES - float(np.median(known))
    share = float(np.clip(wanted / lasting, 0.01, 10.0))
    return replace(
        kernel,
        personal=(share * kernel.personal[0], share * kernel.personal[1]),
        take=share * kernel.take,
        actor=share * kernel.actor,
        noise=share * kernel.noise,
    )


def _row(kernel: Kernel) -> list[float]:
    """Return the hyper-parameters as `ResidualPrior.kernels` keeps them."""
    pairs = (*kernel.lengths, *kernel.shared, *kernel.personal)
    return [*pairs, kernel.take, kernel.actor, kernel.noise]
