"""From the common time of the examples to the frames of a variant."""

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from ..rotations import normalize, unroll
from .curve_sampling import between_frames, sample_curves
from .motion_curves import HEIGHT, MotionCurves

Array = NDArray[np.float64]


def in_own_time(course: MotionCurves, durations: Array) -> MotionCurves:
    """Let each moment last for so many frames, and return what is seen at whole frames.

    Parameters
    ----------
    course : Course
    durations : shape (n_moments,), frames
    """
    steps = (durations[1:] + durations[:-1]) / 2.0
    ends = np.concatenate([[0.0], np.cumsum(steps)])
    n_frames = max(round(ends[-1]), 1) + 1
    ends *= (n_frames - 1) / ends[-1]
    moments = PchipInterpolator(ends, np.arange(len(ends)))(np.arange(n_frames))
    times = np.clip(moments, 0.0, len(ends) - 1.0)
    ways = np.cumsum(course.root[:, :HEIGHT], axis=0)
    told = [ways, course.root[:, HEIGHT:], course.joints.reshape(len(ways), -1)]
    seen = sample_curves(np.concatenate(told, axis=1), times)
    root = np.diff(seen[:, :HEIGHT], axis=0, prepend=seen[:1, :HEIGHT])
    joints = seen[:, HEIGHT + 1 :].reshape(n_frames, *course.joints.shape[1:])
    footing = None if course.footing is None else between_frames(course.footing, times)
    carrier = course.carrier
    if carrier is not None:
        carrier = normalize(sample_curves(unroll(carrier), times))
    return MotionCurves(np.column_stack([root, seen[:, HEIGHT]]), joints, footing, carrier)
