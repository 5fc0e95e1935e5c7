"""Read optical markers, and write them as C3D and TRC."""

from .c3d import open_c3d, read_c3d
from .c3d_writing import write_c3d
from .motive_csv import is_motive_csv, open_motive_csv
from .qualisys_tsv import is_qualisys_tsv, open_qualisys_tsv
from .trc import open_trc, read_trc
from .trc_writing import write_trc
from .vicon_csv import is_vicon_csv, open_vicon_csv

__all__ = [
    "is_motive_csv",
    "is_qualisys_tsv",
    "is_vicon_csv",
    "open_c3d",
    "open_motive_csv",
    "open_qualisys_tsv",
    "open_trc",
    "open_vicon_csv",
    "read_c3d",
    "read_trc",
    "write_c3d",
    "write_trc",
]
