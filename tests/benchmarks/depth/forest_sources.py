"""Poses and bodies that the shipped pixel forest is trained on, and those held out.

The data used in this project was obtained from mocap.cs.cmu.edu. The database was created with
funding from NSF EIA-0196217. UI-PRMD (Vakanski et al. 2018) is published as ODC-PDDL. The
bodies are CC0.
"""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from solvers.depth_tracking.forest_training.skinned_body import SkinnedBody, load_skinned_body
from solvers.motion import Motion, joint_parents, motion_from_points, resample
from solvers.recordings import read_acclaim, read_bvh
from solvers.signals.linear_gaps import fill_gaps

from ..reconstruction.kinect_pairs import read_pairs

DATA = Path(__file__).parents[4] / "shared/data"
CMU_METERS = 0.0254 / 0.45
FRAME_RATE = 15.0
"""Poses looked at per second."""

TRUTH = {
    "walk_front": ("cmu_walk/07_01.bvh", 13, "male_average"),
    "walk_side": ("cmu_walk/35_01.bvh", 13, "female_average"),
    "walk_diagonal": ("cmu_walk/07_05.bvh", 13, "male_heavy"),
    "hop": ("cmu_hop/49_02.bvh", 961, "female_slim"),
    "jump": ("cmu_hop/49_03.bvh", 241, "male_average"),
}
"""What each take of depth/truth was rendered from: clip, its first frame, body. Found by their
joints, which agree to a micrometer; every fourth frame was taken."""
HELD_OUT = ("05_01", "49_02", "49_03")
"""Clips that no model is trained on; all clips of the walkers 07 and 35 too."""
HELD_OUT_WALKERS = ("07", "35")
TAUGHT = ("e01", "e06")
"""Repetitions of each exercise of UI-PRMD."""
WORDS = (
    "CMU mocap (walks, hops, runs, jumps, exercises, dance) and UI-PRMD (exercises of"
    " rehabilitation), mixed and loosened, on four CC0 bodies, seen from all around with the"
    " noise of a Kinect; without the clips of depth/truth and walkers 07 and 35"
)


def taught_motions(folder: Path = DATA) -> list[Motion]:
    """Return the clips to learn poses from, at `FRAME_RATE`."""
    motions = [*cmu_motions(folder), *exercises(folder)]
    return [resample(motion, FRAME_RATE) for motion in motions]


def cmu_motions(folder: Path = DATA, but: tuple[str, ...] = ()) -> list[Motion]:
    """Return the clips of CMU to learn from, without those of some actors besides."""
    mocap = folder / "mocap"
    paths = [
        *sorted((mocap / "cmu_walk").glob("*.bvh")),
        *sorted((mocap / "cmu_hop").glob("*")),
    ]
    motions = [
        _without_t_pose(read_bvh(path, scale=CMU_METERS))
        for path in paths
        if _is_taught(path) and not path.stem.startswith(but)
    ]
    acclaim = [*sorted((mocap / "cmu_jumping_jack").glob("*.amc")), mocap / "05_13.amc"]
    return motions + [read_acclaim(path, mocap / "05.asf") for path in acclaim]


def held_out_motions(folder: Path = DATA) -> list[Motion]:
    """Return clips of HDM05: other actors, and a license under which nothing may ship."""
    mocap = folder / "mocap" / "hdm05"
    return [
        resample(read_acclaim(path, mocap / f"{path.name[:6]}.asf"), FRAME_RATE)
        for path in sorted(mocap.glob("*_001_120.amc"))
    ]


def all_bodies(folder: Path = DATA) -> list[SkinnedBody]:
    """Return the skinned bodies."""
    return [load_skinned_body(path) for path in sorted((folder / "body").glob("*.npz"))]


def _is_taught(path: Path) -> bool:
    return path.stem not in HELD_OUT and not path.stem.startswith(HELD_OUT_WALKERS)


def exercises(folder: Path = DATA, which: tuple[str, ...] = TAUGHT) -> Iterator[Motion]:
    """Yield those exercises of UI-PRMD whose names end so."""
    for pair in read_pairs(folder / "kinect" / "ui_prmd"):
        positions = pair.truth.positions
        if pair.name.endswith(which) and np.isfinite(positions).any(axis=(0, 2)).all():
            complete = pair.truth.with_positions(fill_gaps(positions))
            yield motion_from_points(complete, joint_parents(complete.names))


def _without_t_pose(motion: Motion) -> Motion:
    return motion.slice(1, motion.n_frames)
