"""Gaps: joints missing for a quarter of a second up to complete clips, on clean CMU walks."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from solvers.arrays import Array
from solvers.denoising import DenoiseMethod
from solvers.motion import Motion
from solvers.rotations.representations import slerp, unroll

from ..peers import gap_fillers, kalman, smoothers
from ..shared.noise import METERS_PER_DEGREE, angle_error, seeded
from ..shared.tables import Scores
from .cases import Case, without_heading
from .ours import Ours

ARMS = ("LeftShoulder", "RightShoulder")
LEG = ("LeftUpLeg",)
COMPLETE_CLIP_S = 1e9
N_DRAWS = 3


@dataclass(frozen=True)
class Gap:
    """Which limbs are lost, and for how long."""

    title: str
    tops: tuple[str, ...]
    seconds: float

    def __str__(self) -> str:
        length = "complete clip" if self.seconds >= COMPLETE_CLIP_S else f"{self.seconds:g} s"
        return f"{self.title}, {length}"


GAPS = (
    *(Gap("both arms", ARMS, seconds) for seconds in (0.25, 0.5, 1.0, 2.0, COMPLETE_CLIP_S)),
    *(Gap("left leg", LEG, seconds) for seconds in (0.5, 1.0, 2.0)),
)
FIRST_OF_LIMB = (GAPS[0], GAPS[5])
Filler = Callable[[Case, Array], Array]
"""From a clean case and its channels with NaN to channels without."""


def compare_gaps(cases: list[Case], fillers: Mapping[str, Filler]) -> list[Scores]:
    """Fill the same gaps by all methods; error on what was lost."""
    scores = Scores("CMU walks with gaps: missing joints", "geodesic angle, degrees")
    for case in cases:
        for gap in GAPS:
            draws = 1 if gap.seconds >= COMPLETE_CLIP_S else N_DRAWS
            lost = [cut(case, gap, draw) for draw in range(draws)]
            for name, fill in fillers.items():
                figures = [score(case, fill, *one) for one in lost]
                follows = gap not in FIRST_OF_LIMB
                scores.add(name, gap, case.name, float(np.mean(figures)), follows)
        print(f"  {case.name} with gaps", flush=True)
    return [scores]


def cut(case: Case, gap: Gap, draw: int) -> tuple[NDArray[np.intp], slice]:
    """Return the lost joints and the lost frames; some frames are left at both ends."""
    skeleton = case.truth.skeleton
    joints = [joint for top in gap.tops for joint in skeleton.subtree(skeleton.index(top))]
    joints = [joint for joint in joints if case.channels.joints[joint]]
    length = min(round(gap.seconds * case.truth.frame_rate), case.truth.n_frames)
    spare = case.truth.n_frames - length
    edge = min(5, spare // 2)
    start = int(seeded(case.name, str(gap), draw).integers(edge, spare - edge + 1))
    return np.array(joints), slice(start, start + length)


def score(case: Case, fill: Filler, joints: NDArray[np.intp], frames: slice) -> float:
    gapped = case.clean.copy()
    rows = np.arange(len(gapped))[frames]
    gapped[np.ix_(rows, case.channels.of_joints(joints))] = np.nan
    filled = np.where(np.isfinite(gapped), gapped, fill(case, gapped))
    if not np.isfinite(filled).all():
        return float("nan")
    return float(angle_error(case.motion(filled), case.truth, joints)[frames].mean())


def _alone(smoother: Callable[[Array, float], Array]) -> Filler:
    return lambda case, gapped: smoother(gapped, case.truth.frame_rate)


def _slerp(case: Case, gapped: Array) -> Array:
    """Turn each lost joint from the last seen rotation to the next one by the shorter way."""
    filled = case.motion(np.where(np.isfinite(gapped), gapped, case.clean))
    rotations = filled.rotations.copy()
    for joint in np.flatnonzero(case.channels.joints):
        columns = case.channels.of_joints([joint])
        observed = np.flatnonzero(np.isfinite(gapped[:, columns]).all(axis=1))
        if 1 < len(observed) < len(gapped):
            rotations[:, joint] = _between(unroll(rotations[:, joint]), observed)
        elif not len(observed):
            return np.full_like(gapped, np.nan)
    return case.values(filled.with_poses(rotations))


def _between(rotations: Array, observed: NDArray[np.intp]) -> Array:
    frames = np.clip(np.arange(len(rotations)), observed[0], observed[-1])
    before = np.clip(np.searchsorted(observed, frames, side="right") - 1, 0, len(observed) - 2)
    start, stop = observed[before], observed[before + 1]
    return slerp(rotations[start], rotations[stop], (frames - start) / (stop - start))


def _mean_pose(case: Case, gapped: Array) -> Array:
    mean = np.concatenate(case.training_values).mean(axis=0)
    return np.hstack([np.broadcast_to(mean, gapped[:, :-3].shape), gapped[:, -3:]])


def _conditional(case: Case, gapped: Array) -> Array:
    angles = without_heading(gapped[:, :-3])
    filled = gap_fillers.conditional_pose(angles, 0.0, case.training_values)
    return np.hstack([filled, gapped[:, -3:]])


def _learned_dynamics(case: Case, gapped: Array) -> Array:
    angles = without_heading(gapped[:, :-3])
    filled = kalman.learned_dynamics(angles, 0.0, 0.5, case.training_values)
    return np.hstack([filled, gapped[:, -3:]])


def _soft_impute(case: Case, gapped: Array) -> Array:
    """Complete the take alone at several strengths and keep the best, judged by the truth."""
    tried = [gap_fillers.soft_impute(gapped[:, :-3], 0.0, one) for one in (0.003, 0.01, 0.03)]
    best = min(tried, key=lambda one: float(np.abs(one - case.clean[:, :-3]).mean()))
    return np.hstack([best, gapped[:, -3:]])


def gapped_motion(case: Case, gapped: Array) -> Motion:
    """Return the true motion without the joints that have a missing channel."""
    rotations = case.truth.rotations.copy()
    for joint in np.flatnonzero(case.channels.joints):
        missing = ~np.isfinite(gapped[:, case.channels.of_joints([joint])]).all(axis=1)
        rotations[missing, joint] = np.nan
    root = gapped[:, -3:] * METERS_PER_DEGREE
    return case.truth.with_poses(rotations, root)


def ours(denoiser: Ours) -> Filler:
    def fill(case: Case, gapped: Array) -> Array:
        done = denoiser.denoised(gapped_motion(case, gapped), case.training)
        return case.values(done.recording)

    return fill


FILLERS: Mapping[str, Filler] = {
    "mean pose of the training clips": _mean_pose,
    "linear interpolation": _alone(gap_fillers.linear),
    "slerp": _slerp,
    "PCHIP": _alone(gap_fillers.pchip),
    "cubic spline": _alone(gap_fillers.cubic),
    "GCV spline": _alone(smoothers.gcv_spline_over_gaps),
    "Kalman RTS, constant velocity": _alone(
        lambda gapped, rate: kalman.constant_velocity(gapped, rate, 1.0)
    ),
    "soft-impute of the take, tuned on the truth": _soft_impute,
    "Gaussian over poses of the training clips": _conditional,
    "data-driven Kalman RTS": _learned_dynamics,
    "[LC10] as published": ours(Ours(method=DenoiseMethod.PUBLISHED)),
    "ours": ours(Ours()),
    "ours, no prior": ours(Ours(prior=False)),
}
