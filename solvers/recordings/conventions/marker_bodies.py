"""Estimate up axis and stature of an actor from markers whose names show head and feet."""

import re
from collections.abc import Sequence
from warnings import catch_warnings, simplefilter

import numpy as np

from ...arrays import Array

HEAD_MARKERS = re.compile(r"(top\.?)?head|nose|[lr][fb]hd|[lr]\.?temple")
SHOULDER_MARKERS = re.compile(r"c7|cv7|clav|[lr]?\.?acr(omi(on|um))?|[lr]\.?sho(uld(er)?)?")
FOOT_MARKERS = re.compile(
    r"[lr]\.?(ank(le)?|mall?|hee(l)?|toe(\.tip)?|bigtoe|cal|foot|met)|[lr]f[lt]1"
)
"""Names of markers on head, upper trunk and feet, without blanks, in lower case."""
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
    """
    trunk = _from_feet_to_top(names, points)
    if trunk is None:
        return None
    directions = trunk[0] / np.linalg.norm(trunk[0], axis=1, keepdims=True)
    return np.asarray(np.median(directions, axis=0))


def stature_of_markers(names: Sequence[str], points: Array) -> float | None:
    """Return the stature of the actor, meters; None where names show no head or no feet."""
    trunk = _from_feet_to_top(names, points)
    if trunk is None:
        return None
    lengths = np.linalg.norm(trunk[0], axis=1)
    return float(np.percentile(lengths, STANDING_PERCENTILE)) / trunk[1]


def _from_feet_to_top(names: Sequence[str], points: Array) -> tuple[Array, float] | None:
    """Return the vectors from feet to head, or to shoulders, and their length in statures.

    Vectors have the shape (n, 3), of the n frames with both.
    """
    feet = _mean_of_named(names, points, FOOT_MARKERS)
    for pattern, length in (
        (HEAD_MARKERS, HEAD_TO_FEET),
        (SHOULDER_MARKERS, SHOULDERS_TO_FEET),
    ):
        vectors = _mean_of_named(names, points, pattern) - feet
        observed = vectors[np.linalg.norm(vectors, axis=1) > 0.0]
        if len(observed):
            return observed, length
    return None


def _mean_of_named(names: Sequence[str], points: Array, pattern: re.Pattern[str]) -> Array:
    """Return the mean position of the markers with such a name, shape (n_frames, 3)."""
    plain = [name.rpartition(":")[2].replace(" ", "").lower() for name in names]
    chosen = [
        index for index, name in enumerate(plain[: points.shape[1]]) if pattern.fullmatch(name)
    ]
    with catch_warnings():
        simplefilter("ignore", RuntimeWarning)  # frames without any of them
        return np.asarray(np.nanmean(points[:, chosen], axis=1))
