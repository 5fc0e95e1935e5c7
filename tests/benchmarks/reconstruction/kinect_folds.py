"""UI-PRMD without one subject at a time; models of the others are cached in build/reconstruct.

Delete that folder after a change of how priors are learned.
"""

from collections.abc import Callable
from functools import cache
from pathlib import Path

from solvers.arrays import Array
from solvers.motion.humanoid.posture_joints import posture_positions
from solvers.reconstruction import (
    PostureLibrary,
    ResidualMethod,
    ResidualPrior,
    ResidualPriorSettings,
    learn_residual_prior,
    load_posture_library,
    load_residual_prior,
)
from solvers.reconstruction.residual_correction.learn_confidence import (
    predicted_and_measured,
    with_calibration,
)

from .kinect_pairs import Pair, read_pairs
from .posture_sources import cmu_library, exercise_library, joined

CACHE = Path(__file__).resolve().parents[3] / "build" / "reconstruct"
SUBJECTS = ("s01", "s02", "s03", "s04", "s05")
PRIORS = {
    ResidualMethod.HIERARCHICAL: ResidualPriorSettings(),
    ResidualMethod.PUBLISHED: ResidualPriorSettings(
        method=ResidualMethod.PUBLISHED, smoothing=0.0, mirror=False
    ),
}


@cache
def pairs() -> tuple[Pair, ...]:
    """All takes."""
    return tuple(read_pairs())


def takes_of(subject: str, n_repetitions: int, after: int = 0) -> list[Pair]:
    """Takes of a subject: of each exercise some repetitions after the first few."""
    found: dict[str, list[Pair]] = {}
    for pair in pairs():
        if pair.subject == subject:
            found.setdefault(pair.name[:3], []).append(pair)
    return [pair for same in found.values() for pair in same[after : after + n_repetitions]]


def others(*subjects: str) -> list[Pair]:
    """Takes of everyone else that one can learn from."""
    return [pair for pair in pairs() if pair.subject not in subjects and pair.matched]


@cache
def residual_prior(subject: str, method: ResidualMethod) -> ResidualPrior:
    """What all takes of the others teach of the sensor's errors."""
    return _taught(method, (subject,))


@cache
def confident_prior(subject: str) -> ResidualPrior:
    """Return the same with a confidence that was learned by leaving each of the others out."""
    path = CACHE / f"confident_{subject}.npz"
    if not path.exists():
        found = [_tried(subject, one) for one in SUBJECTS if one != subject]
        prior = residual_prior(subject, ResidualMethod.HIERARCHICAL)
        with_calibration(prior, found).save(path)
    return load_residual_prior(path)


def _tried(subject: str, other: str) -> Array:
    """What those who are neither of two teach, tried on the other one."""
    without = tuple(sorted((subject, other)))
    own = [pair for pair in pairs() if pair.subject == other and pair.matched]
    return predicted_and_measured(
        _taught(ResidualMethod.HIERARCHICAL, without),
        [(pair.kinect, pair.truth) for pair in own],
    )


def _taught(method: ResidualMethod, without: tuple[str, ...]) -> ResidualPrior:
    path = CACHE / f"{method.value}_{'_'.join(without)}.npz"
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        teachers = others(*without)
        learn_residual_prior(
            [(pair.kinect, pair.truth) for pair in teachers],
            actors=[pair.subject for pair in teachers],
            settings=PRIORS[method],
        ).save(path)
    return load_residual_prior(path)


@cache
def posture_library(subject: str, others_too: bool = True) -> PostureLibrary:
    """Return the library that is shipped as it would be without this subject.

    Or, without the others too, its CMU captures alone.
    """
    if not others_too:
        return _cached("cmu", cmu_library)
    mine = _cached(
        f"exercises_{subject}", lambda: exercise_library(_postures_of_others(subject))
    )
    return joined(_cached("cmu", cmu_library), mine)


def _postures_of_others(subject: str) -> list[Pair]:
    """Their true postures are true whatever the Kinect saw meanwhile."""
    return [pair for pair in pairs() if pair.subject != subject]


def _cached(name: str, build: Callable[[], PostureLibrary]) -> PostureLibrary:
    path = CACHE / f"{name}.npz"
    if not path.exists():
        path.parent.mkdir(parents=True, exist_ok=True)
        build().save(path)
    return load_posture_library(path)


def truth_of(pair: Pair) -> Array:
    """Return the true joints of postures, (n_frames, 20, 3); NaN where unknown."""
    return posture_positions(pair.truth)


def observed_postures(pair: Pair) -> Array:
    """Return what the Kinect saw of them."""
    return posture_positions(pair.kinect)
