"""Clips that the posture library that is shipped is made of: CMU, and UI-PRMD's true postures.

The data used in this project was obtained from mocap.cs.cmu.edu. The database was created with
funding from NSF EIA-0196217. UI-PRMD (Vakanski et al. 2018) is published as ODC-PDDL.
"""

from collections.abc import Iterable
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np

from solvers.motion import Motion, joint_parents, motion_from_points
from solvers.reconstruction import PostureLibrary, PostureLibrarySettings, build_posture_library
from solvers.reconstruction.pose_library.posture_library import merge_posture_libraries
from solvers.recordings import read_acclaim, read_bvh
from solvers.signals.linear_gaps import fill_gaps

from .kinect_pairs import Pair

MOCAP = Path(__file__).parents[4] / "shared/data/mocap"
CMU_METERS = 0.0254 / 0.45
FOLDERS = ("cmu_walk", "cmu_hop")
EXERCISES = ("13_29", "13_30")
"""Jumping jacks, twists, bends and squats."""
CMU_WORDS = "CMU mocap: walks, hops, runs, jumps and exercises"
CMU = PostureLibrarySettings(spacing=0.012, n_postures=2500)
TAUGHT = ("e01", "e04", "e07")
"""Repetitions of each exercise of UI-PRMD."""
UI_PRMD_WORDS = "UI-PRMD: exercises of rehabilitation"
UI_PRMD = PostureLibrarySettings(spacing=0.012, n_postures=2000)


@cache
def cmu_library(folder: Path = MOCAP, without: str = "none") -> PostureLibrary:
    """Return postures of the CMU captures, but for those of one subject."""
    motions = [
        _without_t_pose(read_bvh(path, scale=CMU_METERS))
        for part in FOLDERS
        for path in sorted((folder / part).glob("*.bvh"))
        if not path.stem.startswith(without)
    ]
    motions += [exercise(name, folder) for name in EXERCISES if not name.startswith(without)]
    return build_posture_library(motions, settings=CMU, trained_on=CMU_WORDS)


def exercise(name: str, folder: Path = MOCAP) -> Motion:
    """Read one of `EXERCISES`, whose skeleton is another actor's with the same bones."""
    return read_acclaim(folder / "cmu_jumping_jack" / f"{name}.amc", folder / "05.asf")


def exercise_library(pairs: Iterable[Pair]) -> PostureLibrary:
    """Return true postures of some repetitions among these takes of UI-PRMD.

    Without twists: they were not measured, and elbows and knees are where their markers are, on
    the skin, so that the planes of small bends lie aslant.
    """
    motions = []
    for pair in pairs:
        is_complete = np.isfinite(pair.truth.positions).any(axis=(0, 2)).all()
        if pair.name[-3:] in TAUGHT and is_complete:
            complete = pair.truth.with_positions(fill_gaps(pair.truth.positions))
            motions.append(motion_from_points(complete, joint_parents(complete.names)))
    library = build_posture_library(motions, settings=UI_PRMD, trained_on=UI_PRMD_WORDS)
    return replace(library, twists=None)


def joined(one: PostureLibrary, other: PostureLibrary) -> PostureLibrary:
    """Put two libraries together."""
    return merge_posture_libraries(one, other, "{}; {}")


def _without_t_pose(motion: Motion) -> Motion:
    return motion.slice(1, motion.n_frames)
