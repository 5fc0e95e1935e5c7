"""Read and write optical markers as C3D and TRC."""

from .c3d import open_c3d, read_c3d
from .c3d_writing import write_c3d
from .trc import read_trc
from .trc_writing import write_trc

__all__ = [
    "open_c3d",
    "read_c3d",
    "read_trc",
    "write_c3d",
    "write_trc",
]
