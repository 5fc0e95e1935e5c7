"""Estimate up axis and stature of an actor from markers whose names show head and feet."""

import re
from collections.abc import Sequence
from itertools import pairwise
from typing import NamedTuple
from warnings import catch_warnings, simplefilter

import numpy as np

from ...arrays import Array

HEAD_MARKERS = re.compile(r"(top\.?)?head|nose|[lr][fb]hd|[lr]\.?temple")
SHOULDER_MARKERS = re.compile(r"c7|cv7|clav|[lr]?\.?acr(omi(on|um))?|[lr]\.?sho(uld(er)?)?")
FOOT_MARKERS = re.compile(
    r"[lr]\.?(ank(le)?|mall?|hee(l)?|toe(\.tip)?|bigtoe|cal|foot?|met)|[lr]f[lt]1"
)
"""Names of markers on head, upper trunk and feet, without blanks, in lower case."""
KNEE_MARKERS = re.compile(r"[lr]\.?(m?kne(e)?(\.?(lat|med)(ial|eral)?)?|[lm]fc)")
HIP_MARKERS = re.compile(r"[lr][._]?([ap]sis?|[fb]wt|hip|hjc|gtr?|tro(ch)?)")
"""Names of markers between feet and upper trunk, in the same form."""
HEAD_TO_FEET, SHOULDERS_TO_FEET = 0.897, 0.779
"""Height of the eyes, and of the acromion, above the ankle, relative to the stature: 0.936 and
0.818 less 0.039 in Winter 2009, Biomechanics and motor control of human movement, figure
4.1."""
STANDING_PERCENTILE = 90.0
"""Percentile over the frames of the distance from feet to head, which is that of standing where
some frames do. Chosen by hand: crouching is shorter, and few frames are outliers."""
MIN_UPRIGHT_COSINE = 0.8
"""Cosine of the angle between an axis and the direction from feet to head, from which the actor
stands along it. Chosen by hand: 37 degrees, more than a walker leans and less than the 45 at
which two axes are equally near."""
SIDE_INITIALS = "lr"
"""First letter of names on the left and on the right."""


class _Trunk(NamedTuple):
    """From the feet to the top of the markers."""

    top: Array
    """Position of head or shoulders, shape (n_frames, 3); NaN where missing."""
    vectors: Array
    """From the feet to the top, shape (n, 3), of the n frames with both."""
    statures: float
    """Length of these vectors in an actor who stands, relative to the stature."""


def axis_of_named_markers(names: Sequence[str], points: Array) -> str:
    """Return the axis from feet to head in most frames, such as `-Y`; empty if unclear.

    Parameters
    ----------
    names : sequence of str
        Labels in the file, with or without an actor's prefix.
    points : float array, shape (n_frames, n_points, 3)
        NaN where missing.
    """
    median = direction_of_named_markers(names, points)
    if median is None:
        return ""
    axis = int(np.argmax(np.abs(median)))
    if abs(median[axis]) < MIN_UPRIGHT_COSINE:
        return ""
    return ("-" if median[axis] < 0.0 else "+") + "XYZ"[axis]


def direction_of_named_markers(names: Sequence[str], points: Array) -> Array | None:
    """Return the direction from feet to head in most frames; None if names show neither.

    Its components are medians over the frames, so that it is shorter than 1 where it changes.
    Points have the shape (n_frames, n_points, 3).
    """
    trunk = _from_feet_to_top(names, points)
    if trunk is None:
        return None
    directions = trunk.vectors / np.linalg.norm(trunk.vectors, axis=1, keepdims=True)
    return np.asarray(np.median(directions, axis=0))


def position_of_feet(names: Sequence[str], points: Array) -> Array:
    """Return where the feet are in most frames, shape (3,); NaN if no name shows one."""
    with catch_warnings():
        simplefilter("ignore", RuntimeWarning)
        return np.asarray(np.nanmedian(_mean_of_named(names, points, FOOT_MARKERS), axis=0))


def stature_of_markers(names: Sequence[str], points: Array) -> float | None:
    """Return the stature of the actor, meters; None where names show no head or no feet.

    It follows from the paths from the feet to the head, over knees and hips where names show
    them: a posture only shortens the distance between their ends. Points have the shape
    (n_frames, n_points, 3), meters.
    """
    trunk = _from_feet_to_top(names, points)
    if trunk is None:
        return None
    paths = [_lengths_of_paths(names, points, trunk.top, side) for side in SIDE_INITIALS]
    lengths = [max(each) for each in paths if each] or [_standing(trunk.vectors)]
    return float(np.mean(lengths)) / trunk.statures


def _lengths_of_paths(
    names: Sequence[str], points: Array, top: Array, side: str
) -> list[float]:
    """Return the length of each path from a foot over observed joints of its leg to the top."""
    foot, knee, hip = (
        _mean_of_named(names, points, pattern, side)
        for pattern in (FOOT_MARKERS, KNEE_MARKERS, HIP_MARKERS)
    )
    paths = (foot, top), (foot, knee, top), (foot, hip, top), (foot, knee, hip, top)
    segments = [[_standing(end - start) for start, end in pairwise(path)] for path in paths]
    return [sum(each) for each in segments if min(each) > 0.0]


def _standing(vectors: Array) -> float:
    """Return the typical maximum length of vectors, shape (n, 3); zero if unobserved."""
    lengths = np.linalg.norm(vectors, axis=1)
    observed = lengths[np.isfinite(lengths)]
    return float(np.percentile(observed, STANDING_PERCENTILE)) if len(observed) else 0.0


def _from_feet_to_top(names: Sequence[str], points: Array) -> _Trunk | None:
    """Return what is between feet and head, or shoulders; None where names show neither."""
    feet = _mean_of_named(names, points, FOOT_MARKERS)
    for pattern, statures in (
        (HEAD_MARKERS, HEAD_TO_FEET),
        (SHOULDER_MARKERS, SHOULDERS_TO_FEET),
    ):
        top = _mean_of_named(names, points, pattern)
        vectors = top - feet
        observed = vectors[np.linalg.norm(vectors, axis=1) > 0.0]
        if len(observed):
            return _Trunk(top, observed, statures)
    return None


def _mean_of_named(
    names: Sequence[str], points: Array, pattern: re.Pattern[str], side: str = ""
) -> Array:
    """Return the mean position of the markers with such a name, shape (n_frames, 3)."""
    plain = [name.rpartition(":")[2].replace(" ", "").lower() for name in names]
    chosen = [
        index
        for index, name in enumerate(plain[: points.shape[1]])
        if name.startswith(side) and pattern.fullmatch(name)
    ]
    with catch_warnings():
        simplefilter("ignore", RuntimeWarning)  # frames without any of them
        return np.asarray(np.nanmean(points[:, chosen], axis=1))
