"""Noise and outliers on whole clips: every peer and ours on the same damaged takes."""

from collections.abc import Iterable, Mapping, Sequence
from time import perf_counter

from solvers.motion import Motion

from ..shared.noise import METERS_PER_DEGREE, angle_error, learn_channels
from ..shared.tables import Scores
from .cases import Case, Level
from .methods import PEERS, Blender, Method


def leave_one_out(
    clips: Mapping[str, Motion],
    names: Iterable[str],
    levels: Sequence[Level],
    clean_root: bool = False,
    other_subjects: bool = False,
) -> list[Case]:
    """Return the cases of each named clip, with all other clips to learn from.

    With `other_subjects`, the clips of the same subject ("subject_number") are left out too.
    """
    cases = []
    for name in names:
        left_out = f"{name.split('_')[0]}_" if other_subjects else name
        training = tuple(
            motion for other, motion in clips.items() if not other.startswith(left_out)
        )
        channels = learn_channels(training)
        cases += [
            Case(name, level, clips[name], training, channels, clean_root) for level in levels
        ]
    return cases


def compare(cases: list[Case], methods: Mapping[str, Method], title: str) -> list[Scores]:
    """Run all methods on all cases; channel error, angle error and error of the root."""
    found = [
        Scores(f"{title}: angle channels", "mean absolute error, degrees"),
        Scores(f"{title}: local rotations", "geodesic angle, degrees"),
        Scores(f"{title}: root position", "mean absolute error per axis, millimeters"),
    ]
    for case in cases:
        started = perf_counter()
        for name, method in methods.items():
            estimate = method(case)
            angles = angle_error(case.motion(estimate), case.truth, case.channels.joints)
            root = abs(estimate[:, -3:] - case.clean[:, -3:]).mean() * METERS_PER_DEGREE
            figures = (case.error(estimate), angles.mean(), 1000.0 * root)
            for scores, figure in zip(found, figures, strict=True):
                scores.add(name, case.level, case.name, float(figure), case.level.follows)
        print(f"  {case.name} at {case.level}: {perf_counter() - started:.1f} s", flush=True)
    return found


def peers(cases: list[Case], blender: bool = True) -> dict[str, Method]:
    """Return all peers; Blender's operators run at once for all cases."""
    return {**PEERS, **(Blender(cases).methods() if blender else {})}
