"""Read and write BVH files."""

from .reading import open_bvh, read_bvh
from .writing import write_bvh

__all__ = ["open_bvh", "read_bvh", "write_bvh"]
