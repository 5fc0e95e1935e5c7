"""One reader per file format of recorded motion, and writers for those worth writing."""

from .acclaim import read_acclaim
from .bvh import read_bvh
from .bvh_writing import write_bvh
from .c3d import read_c3d

__all__ = ["read_acclaim", "read_bvh", "read_c3d", "write_bvh"]
