"""Read and write skeletons with rotations: BVH and Acclaim."""

from .acclaim import find_skeleton, read_acclaim
from .acclaim_limits import read_acclaim_limits
from .bvh import read_bvh
from .bvh_writing import write_bvh

__all__ = [
    "find_skeleton",
    "read_acclaim",
    "read_acclaim_limits",
    "read_bvh",
    "write_bvh",
]
