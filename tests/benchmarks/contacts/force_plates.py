"""Walks over force plates: contacts that were weighed, in C3D files of gait laboratories.

ezc3d reads the plates, our reader the markers. A foot is in contact while its plate carries
more than 20 N, and in the air for 0.2 s before and after: a swing takes twice as long.
"""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from scipy.ndimage import binary_closing

from solvers.arrays import Array, Flags
from solvers.motion import Tracks, resample
from solvers.recordings import read_c3d
from solvers.signals import find_runs

from ..shared.clips import DATA

MIN_LOAD_N = 20.0
"""Newtons, as gait laboratories define a contact."""
MIN_PEAK_N = 200.0
"""Newtons that someone who steps on a plate exceeds; less is noise."""
SWING_S = 0.2
GAP_S = 0.05
"""Seconds without load that are noise."""

WALKS: tuple[tuple[str, tuple[tuple[str, str], tuple[str, str]]], ...] = (
    ("formats/c3d/PiG_Motion3_FF.c3d", (("LANK", "LTOE"), ("RANK", "RTOE"))),
    ("formats/c3d/PiG_Motion-FlatFoot-Hole.c3d", (("LANK", "LTOE"), ("RANK", "RTOE"))),
    ("formats/c3d/PlugInC3D.c3d", (("LANK", "LTOE"), ("RANK", "RTOE"))),
    ("formats/c3d/type-2a.c3d", (("LANK", "LTOE"), ("RANK", "RTOE"))),
    ("formats/c3d/ADemo1_rewrite_c3d_pc_float.c3d",
     (("L.Ankle", "L.Toe"), ("R.Ankle", "R.Toe"))),
    ("formats/c3d/Eb015pi.c3d", (("LFT2", "LFT1"), ("RFT2", "RFT1"))),
    ("formats/c3d/test_walking.c3d", (("LCAL", "LMT1"), ("RCAL", "RMT1"))),
    ("corpus/lab/c3d_bts/BTS.c3d", (("l heel", "l met"), ("r heel", "r met"))),
    ("corpus/lab/c3d_qualisys/Qualisys.c3d", (("L_FAL", "L_FM1"), ("R_FAL", "R_FM1"))),
)  # fmt: skip
"""Files, and the markers of ankle (or heel) and toes of the left and the right foot."""


@dataclass(frozen=True, eq=False)
class WeighedWalk:
    """Feet (n_frames, 2, 2, 3) in meters, contacts and where they are known (n_frames, 2)."""

    name: str
    feet: Array
    contacts: Flags
    known: Flags
    frame_rate: float


def weighed_walks(frame_rate: float) -> Iterator[WeighedWalk]:
    """Return the walks at a frame rate; none without ezc3d."""
    try:
        import ezc3d
    except ImportError:
        return
    for name, markers in WALKS:
        path = DATA / name
        recording = read_c3d(path)
        assert isinstance(recording, Tracks)
        tracks = resample(recording, frame_rate)
        columns = [tracks.names.index(one) for foot in markers for one in foot]
        feet = tracks.positions[:, columns].reshape(-1, 2, 2, 3)
        contacts, known = (np.zeros((len(feet), 2), np.bool_) for _ in range(2))
        content = ezc3d.c3d(str(path), extract_forceplat_data=True)
        plate_rate = content["header"]["analogs"]["frame_rate"]
        for plate in content["data"]["platform"]:
            for start, stop in _loaded(plate["force"], plate_rate):
                window = slice(
                    max(round((start - SWING_S) * frame_rate), 0),
                    round((stop + SWING_S) * frame_rate),
                )
                frames = slice(
                    int(np.ceil(start * frame_rate)), int(np.ceil(stop * frame_rate))
                )
                foot = _standing_foot(feet[frames])
                contacts[frames, foot] = True
                known[window, foot] = True
        known &= np.isfinite(feet).all(axis=(2, 3))
        yield WeighedWalk(path.stem, feet, contacts, known, frame_rate)


def _loaded(forces: Array, rate: float) -> list[tuple[float, float]]:
    """Return start and end in seconds of each step on a plate, forces (3, n_samples)."""
    free = np.nan_to_num(forces)
    free = np.abs(free - np.median(free, axis=1, keepdims=True))
    load = free[free.max(axis=1).argmax()]
    loaded = binary_closing(load > MIN_LOAD_N, np.ones(2 * round(0.5 * GAP_S * rate) + 1))
    return [
        (start / rate, stop / rate)
        for start, stop in find_runs(loaded)
        if start > 0 and stop < len(load) and load[start:stop].max() > MIN_PEAK_N
    ]


def _standing_foot(feet: Array) -> int:
    """Return the foot that moves least in the middle of a step: the other one swings."""
    middle = feet[len(feet) // 3 : 2 * len(feet) // 3 + 1]
    spread = np.nanmax(middle, axis=0) - np.nanmin(middle, axis=0)
    travel = np.nanmean(np.linalg.norm(spread, axis=-1), axis=-1)
    return int(np.nanargmin(travel))
