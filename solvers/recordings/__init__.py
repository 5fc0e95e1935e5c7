"""One reader per file format of recorded motion, and writers for those worth writing.

>>> from pathlib import Path
>>> from tempfile import TemporaryDirectory
>>> from solvers.recordings import read_recording, write_bvh
>>> from solvers.samples import GaitSettings, walking_gait
>>> with TemporaryDirectory() as folder:
...     path = Path(folder) / "walk.bvh"
...     write_bvh(walking_gait(GaitSettings(duration=1.0, frame_rate=30.0)), path)
...     walk = read_recording(path)
>>> walk.n_frames, walk.frame_rate
(30, 30.0)
"""

from .acclaim import read_acclaim
from .bvh import read_bvh
from .bvh_writing import write_bvh
from .c3d import read_c3d
from .c3d_writing import write_c3d
from .irds import read_irds
from .read_recording import read_motion_or_tracks, read_recording

__all__ = [
    "read_acclaim",
    "read_bvh",
    "read_c3d",
    "read_irds",
    "read_motion_or_tracks",
    "read_recording",
    "write_bvh",
    "write_c3d",
]
