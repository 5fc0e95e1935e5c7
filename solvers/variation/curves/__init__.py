"""Curves of a motion in common time: their channels, sampling, and the parts of a body."""

from .curve_sampling import sample_curves, sample_linearly
from .motion_curves import (
    HEIGHT_COLUMN,
    MAX_FRAME_ROTATION_RAD,
    N_ROOT_CHANNELS,
    MotionCurves,
    curves_from_motion,
    headings_from_motion,
    motion_from_curves,
    remove_heading,
    unwrap_rotation_vectors,
)
from .partitions import LEG_ROWS, ROOT_ROW, Partition, partition_joints
from .soft_clamp import clamp_softly

__all__ = [
    "HEIGHT_COLUMN",
    "LEG_ROWS",
    "MAX_FRAME_ROTATION_RAD",
    "N_ROOT_CHANNELS",
    "ROOT_ROW",
    "MotionCurves",
    "Partition",
    "clamp_softly",
    "curves_from_motion",
    "headings_from_motion",
    "motion_from_curves",
    "partition_joints",
    "remove_heading",
    "sample_curves",
    "sample_linearly",
    "unwrap_rotation_vectors",
]
