"""Every method by name: the peers, and ours."""

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from functools import lru_cache, partial

import numpy as np

from solvers.arrays import Array
from solvers.motion import Motion

from ..peers import kalman, smoothers
from ..peers.blender_graph import CUTOFFS, DEFAULTS, WIDTHS, smooth_in_blender
from ..peers.lou_chai import filter_by_patterns, learn_patterns
from ..shared.noise import Channels
from .cases import Case, without_heading

Method = Callable[[Case], Array]
Smoother = Callable[[Array, float], Array]


@dataclass(frozen=True)
class Peer:
    """A filter of single channels; of the settings `tried`, the one nearest to the truth."""

    smoother: Callable[..., Array]
    tried: tuple[float, ...] = ()

    def __call__(self, case: Case) -> Array:
        """Filter the case."""
        rate = case.truth.frame_rate
        if not self.tried:
            return self.smoother(case.noisy, rate)
        return nearest(case, (self.smoother(case.noisy, rate, one) for one in self.tried))


def nearest(case: Case, estimates: Iterable[Array]) -> Array:
    """Return the estimate with the least error: a generous way to choose a setting."""
    return min(estimates, key=case.error)


def data_driven_kalman(case: Case, first: Smoother = smoothers.unchanged) -> Array:
    """Learned dynamics for the angles, constant velocity for the root's position."""
    rate = case.truth.frame_rate
    noisy = first(case.noisy, rate)
    angles, root = noisy[:, :-3], noisy[:, -3:]
    heading = np.median(angles[:, 0])
    angles = angles - np.eye(1, angles.shape[1]) * heading
    estimates = []
    for sigma in (1.0, 2.0, 4.0, 8.0, 16.0, 32.0):
        smooth = kalman.learned_dynamics(angles, rate, sigma, case.training_values)
        smooth[:, 0] += heading
        estimates.append(np.hstack([smooth, kalman.constant_velocity(root, rate, 0.3)]))
    return nearest(case, estimates)


INDEX_OF_DEFAULT = {
    "gaussian": WIDTHS.index(DEFAULTS["gaussian"]),
    "butterworth": CUTOFFS.index(DEFAULTS["butterworth"]),
}


def lou_chai(case: Case) -> Array:
    """[LC10] on the angle channels, constant velocity for the root's position."""
    angles, root = case.noisy[:, :-3], case.noisy[:, -3:]
    heading = np.median(angles[:, 0])
    angles = angles - np.eye(1, angles.shape[1]) * heading
    smooth = filter_by_patterns(angles, *_patterns(case))
    smooth[:, 0] += heading
    rate = case.truth.frame_rate
    return np.hstack([smooth, kalman.constant_velocity(root, rate, 0.3)])


@lru_cache(maxsize=2)
def _patterns_of(training: tuple[Motion, ...], channels: Channels) -> tuple[Array, Array]:
    return learn_patterns([without_heading(channels.values(motion)) for motion in training])


def _patterns(case: Case) -> tuple[Array, Array]:
    return _patterns_of(tuple(case.training), case.channels)


AGILITIES = tuple(np.geomspace(0.03, 3.0, 9))
PEERS: dict[str, Method] = {
    "noisy input": Peer(smoothers.unchanged),
    "Gaussian, width tuned on the truth": Peer(
        smoothers.gaussian, tuple(np.geomspace(0.4, 8.0, 16))
    ),
    "Savitzky-Golay, length tuned on the truth": Peer(
        smoothers.savitzky_golay, (5, 7, 9, 11, 13, 15, 19, 23, 27)
    ),
    "Hampel": Peer(smoothers.hampel),
    "GCV smoothing spline": Peer(smoothers.gcv_spline),
    "Hampel + GCV spline": Peer(smoothers.hampel_gcv_spline),
    "Kalman RTS, constant velocity, tuned on the truth": Peer(
        kalman.constant_velocity, AGILITIES
    ),
    "Kalman RTS, constant acceleration, tuned on the truth": Peer(
        kalman.constant_acceleration, AGILITIES
    ),
    "data-driven Kalman RTS, noise tuned on the truth": data_driven_kalman,
    "Hampel + data-driven Kalman RTS, tuned on the truth": partial(
        data_driven_kalman, first=smoothers.hampel
    ),
    "[LC10] written again for the benchmark": lou_chai,
}


class Blender:
    """Blender's operators on many cases in one child process."""

    def __init__(self, cases: list[Case]) -> None:
        takes = [case.noisy for case in cases]
        outputs = smooth_in_blender(takes, cases[0].truth.frame_rate) if cases else []
        self._outputs = dict(zip(map(id, cases), outputs, strict=True))

    def methods(self) -> dict[str, Method]:
        """Each operator as it comes, and with the setting that is nearest to the truth."""
        found: dict[str, Method] = {}
        for name in DEFAULTS:
            title = f"Blender {name.capitalize()} operator"
            found[f"{title}, default"] = partial(self._default, name)
            found[f"{title}, tuned on the truth"] = partial(self._tuned, name)
        return found

    def _default(self, name: str, case: Case) -> Array:
        return self._outputs[id(case)][name][INDEX_OF_DEFAULT[name]]

    def _tuned(self, name: str, case: Case) -> Array:
        return nearest(case, self._outputs[id(case)][name])
