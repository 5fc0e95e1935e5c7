"""Read and write skeletons with rotations: BVH, Acclaim, SMPL, Kimodo and others."""

from .acclaim import find_skeleton, read_acclaim
from .bvh import open_bvh, read_bvh, write_bvh
from .kimodo import is_kimodo, open_kimodo
from .motion_x import is_motion_x, read_motion_x
from .mvnx import is_mvnx, open_mvnx
from .opensim_json import is_opensim_json, read_opensim_json
from .segment_recordings import recording_from_segments
from .smpl import is_frame_smpl, is_smpl, open_smpl
from .smpl_json import is_frame_smpl_json, is_smpl_json, open_smpl_json
from .vrma import is_vrma, read_vrma

__all__ = [
    "find_skeleton",
    "is_frame_smpl",
    "is_frame_smpl_json",
    "is_kimodo",
    "is_motion_x",
    "is_mvnx",
    "is_opensim_json",
    "is_smpl",
    "is_smpl_json",
    "is_vrma",
    "open_bvh",
    "open_kimodo",
    "open_mvnx",
    "open_smpl",
    "open_smpl_json",
    "read_acclaim",
    "read_bvh",
    "read_motion_x",
    "read_opensim_json",
    "read_vrma",
    "recording_from_segments",
    "write_bvh",
]
