"""The evidence of [LC10] for its own filter again: figures 2.2 and 2.9 (b) of [LOU12].

Figure 2.2 is the error of clean windows of walks that are rebuilt from a number of filter
bases, by cross-validation. Figure 2.9 (b) is the error of a filled gap in a jumping sequence by
the length of the window: in the thesis it drops where the window holds a whole jump.
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from solvers.arrays import Array
from solvers.denoising import (
    DenoiseMethod,
    DenoiseSettings,
    FilterBases,
    FilterBasesSettings,
    denoise,
    learn_filter_bases,
)
from solvers.denoising.channels import encode
from solvers.denoising.window_priors import LagProducts, find_leading_eigenpairs
from solvers.motion import Motion, Skeleton, find_humanoid_map

from ..sensitivity.takes import pruned, variety
from ..shared import clips
from ..shared.noise import angle_error, learn_channels
from ..shared.tables import Scores
from .cases import Case, Level
from .part_denoise import leave_one_out

ALMOST_ALL = 0.9999
"""Fraction of the movement in the most bases that are tried."""
N_OWN = 5
"""Walks of the same person to learn from: so many has [LC10]."""
COUNTS = (1, 2, 5, 10, 20, 50, 100, 200)
LEVELS = (Level(3.0), Level(3.0, 0.10))
N_FILTERED = 3
"""Clips that are filtered, which takes longer than rebuilding windows."""
FRAMES = (10, 20, 30, 45, 60, 75)
"""Lengths of the windows at 30 Hz."""
JUMPS, LONG_WALK = "01_01", "05_01"
"""A take of ten jumps, one in about two seconds, half a turn between some; and a walk."""
SEQUENCES = {
    (1.0, 7.6): (2.1, 3.7, 5.1, 6.7),
    (9.8, 16.2): (10.9, 13.1, 15.0),
    (17.4, 22.9): (18.6, 20.4),
}
"""Seconds of the three rows of jumps, and of the jumps in them."""
ARMS = ("leftShoulder", "rightShoulder")
MISSING_S = 1.0
PUBLISHED = DenoiseSettings(method=DenoiseMethod.PUBLISHED)


def compare_counts(names: Sequence[str]) -> list[Scores | str]:
    """Return the error by number of bases, of clean windows and of the filter on noise."""
    rebuilt = Scores("Filter bases, clean windows of walks", "mean absolute error, degrees")
    filtered = Scores("Filter bases, noisy walks filtered", "mean absolute error, degrees")
    sizes: dict[str, list[int]] = {}
    for kind, case in _cases(names):
        bases = learn_filter_bases(case.training)
        sizes.setdefault(kind, []).append(len(bases.vectors))
        bases = with_almost_all(bases, case.training)
        errors = rebuilding_errors(bases, case.truth, COUNTS)
        for count, error in zip(COUNTS, errors, strict=True):
            rebuilt.add(kind, count, case.name, error)
        if case.name in names[:N_FILTERED] and kind == "all other walks":
            for level in LEVELS:
                _filter(filtered, replace(case, level=level), bases)
        print(f"  {case.name} from bases of {kind}", flush=True)
    held = "; ".join(f"{kind}: {np.mean(size):.0f}" for kind, size in sizes.items())
    return [rebuilt, f"Bases that hold 99 % of the movement, as published: {held}.\n", filtered]


def _cases(names: Sequence[str]) -> Iterator[tuple[str, Case]]:
    """Yield walks with the clips to learn from: of the person, all others, of other people."""
    walks = clips.walks()
    for name in names:
        own = [one for one in walks if one.split("_")[0] == name.split("_")[0]]
        if len(own) > N_OWN:
            few = {name: walks[name]} | {
                one: walks[one] for one in [one for one in own if one != name][:N_OWN]
            }
            yield f"{N_OWN} walks of the person", leave_one_out(few, [name], LEVELS)[0]
    for kind, other_subjects in (
        ("all other walks", False),
        ("walks of other people", True),
    ):
        for case in leave_one_out(walks, names, LEVELS[:1], other_subjects=other_subjects):
            yield kind, case


def _filter(scores: Scores, case: Case, bases: FilterBases) -> None:
    for count in COUNTS:
        few = replace(bases, vectors=bases.vectors[:count], values=bases.values[:count])
        done = denoise(case.noisy_motion, few, settings=PUBLISHED).recording
        assert isinstance(done, Motion)
        scores.add(f"[LC10] at {case.level}", count, case.name, case.error(case.values(done)))


def with_almost_all(bases: FilterBases, training: Sequence[Motion]) -> FilterBases:
    """Return the bases with more patterns of the same clips: ALMOST_ALL of their movement."""
    products = LagProducts(len(bases.moving), bases.window)
    for clip in training:
        values = _values(bases, clip)
        if len(values) >= bases.window:
            products.add(values[:, bases.moving])
    values, vectors = find_leading_eigenpairs(products.total(), ALMOST_ALL)
    patterns = np.zeros((len(values), bases.window, len(bases.mean)))
    patterns[:, :, bases.moving] = vectors.T.reshape(len(values), bases.window, -1)
    return replace(bases, vectors=patterns, values=values)


def rebuilding_errors(bases: FilterBases, motion: Motion, counts: Sequence[int]) -> list[float]:
    """Return the mean error of the angles in all windows, degrees, by count; eq. 2.6."""
    values = _values(bases, motion)
    windows = np.lib.stride_tricks.sliding_window_view(values, bases.window, axis=0)
    rest = windows.transpose(0, 2, 1).copy()
    angles = np.intersect1d(bases.moving, np.arange(values.shape[1] - 3))
    used, errors = 0, []
    for count in counts:
        some = bases.vectors[used:count]
        rest -= np.tensordot(np.tensordot(rest, some, axes=((1, 2), (1, 2))), some, axes=1)
        errors.append(float(np.abs(rest[:, :, angles]).mean()))
        used = count
    return errors


def _values(bases: FilterBases, motion: Motion) -> Array:
    channels = encode(motion, bases.reference_of)
    assert channels.keys == tuple(map(str, bases.keys))
    return np.asarray(channels.flat - bases.mean)


def compare_cycles() -> list[Scores]:
    """Return the error of missing arms by length of the window, in jumps and in a walk.

    Heads, hands and toes are left out: about as many channels as in [LC10] remain.
    """
    scores = Scores(
        "[LC10], both arms missing for 1 s, by frames of the window at 30 Hz",
        "geodesic angle, degrees",
    )
    jumps = pruned(clips.every(variety(JUMPS), clips.STEP))
    rows = {
        span: jumps.slice(*(round(each * jumps.frame_rate) for each in span))
        for span in SEQUENCES
    }
    walks = {name: pruned(motion) for name, motion in clips.walks().items()}
    walk = walks.pop(LONG_WALK)
    middle = walk.n_frames / walk.frame_rate / 2.0
    for window in FRAMES:
        for span, times in SEQUENCES.items():
            others = [motion for other, motion in rows.items() if other != span]
            middles = [time - span[0] for time in times]
            _fill(scores, "jumps", window, f"{span}", rows[span], others, middles)
        _fill(scores, "walk", window, LONG_WALK, walk, list(walks.values()), [middle])
        print(f"  windows of {window} frames", flush=True)
    return [scores]


def _fill(
    scores: Scores,
    kind: str,
    window: int,
    name: str,
    truth: Motion,
    training: Sequence[Motion],
    middles: Sequence[float],
) -> None:
    """Add the mean error of gaps about these seconds."""
    settings = FilterBasesSettings(window=window / clips.FRAME_RATE)
    bases = learn_filter_bases(training, settings=settings)
    moving = learn_channels([truth]).joints
    joints = [joint for joint in _limbs(truth.skeleton) if moving[joint]]
    errors = []
    for middle in middles:
        start = max(round((middle - MISSING_S / 2.0) * truth.frame_rate), 0)
        frames = np.arange(start, start + round(MISSING_S * truth.frame_rate))
        rotations = truth.rotations.copy()
        rotations[np.ix_(frames, joints)] = np.nan
        done = denoise(truth.with_poses(rotations), bases, settings=PUBLISHED).recording
        assert isinstance(done, Motion)
        errors.append(float(angle_error(done, truth, joints)[frames].mean()))
    scores.add(kind, window, name, float(np.mean(errors)))


def _limbs(skeleton: Skeleton) -> list[int]:
    roles = find_humanoid_map(skeleton).joints
    return [joint for top in ARMS for joint in skeleton.subtree(skeleton.index(roles[top]))]
