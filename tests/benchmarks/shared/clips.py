"""Which recordings the benchmarks use, and which of them a method may be tuned on.

Settings are chosen on the clips of DEV_SUBJECTS only; every published figure is computed on the
other subjects. This is the only file that lists them.
"""

from functools import cache
from pathlib import Path

from solvers.motion import Motion
from solvers.recordings import read_acclaim, read_bvh

DATA = Path(__file__).resolve().parents[3].parent / "shared" / "data"
WALKS = DATA / "mocap" / "cmu_walk"
HOPS = DATA / "mocap" / "cmu_hop"
HDM05 = DATA / "mocap" / "hdm05"

DEV_SUBJECTS = frozenset({"07", "10", "26", "27", "32"})
"""CMU subjects for development."""
DEV_ACTORS = frozenset({"bd"})
"""HDM05 actors for development."""
QUICK = ("05_01", "06_01", "29_01", "35_01", "35_12", "35_30")
"""Scored walks of the default run; `--full` scores all walks outside DEV_SUBJECTS."""
QUICK_DEV = ("07_03", "10_04", "26_01", "27_01", "32_01", "07_11")

FRAME_RATE = 30.0
STEP = 4
"""Recordings are at 120 Hz; every fourth frame is used, as in [LC10]."""
CMU_METERS = 0.0254 / 0.45
"""CMU lengths are inches times 0.45."""


@cache
def walks() -> dict[str, Motion]:
    """All CMU walks by name, at 30 Hz, without the T-pose of frame 1."""
    return {path.stem: read_cmu(path) for path in sorted(WALKS.glob("*.bvh"))}


@cache
def hops() -> dict[str, Motion]:
    """Hops, jumps and runs of CMU subject 49, at 30 Hz."""
    return {path.stem: read_cmu(path) for path in sorted(HOPS.glob("*.bvh"))}


def read_cmu(path: Path, step: int = STEP) -> Motion:
    """Read a CMU walk in BVH, which starts with a T-pose that is left out."""
    motion = read_bvh(path, scale=CMU_METERS)
    return every(motion.slice(1, motion.n_frames), step)


def every(motion: Motion, step: int) -> Motion:
    """Keep every `step`-th frame."""
    return Motion(
        motion.skeleton,
        motion.rotations[::step],
        motion.root_positions[::step],
        motion.frame_rate / step,
    )


@cache
def hdm05(motion_class: str) -> dict[str, Motion]:
    """All clips of one HDM05 class by "actor_number", at 30 Hz."""
    found = {}
    for path in sorted(HDM05.glob(f"HDM_*_{motion_class}_*_120.amc")):
        _, actor, _, number, _ = path.stem.split("_")
        found[f"{actor}_{number}"] = every(read_acclaim(path), STEP)
    return found


@cache
def hdm05_classes() -> tuple[str, ...]:
    """Names of the HDM05 classes."""
    return tuple(sorted({path.stem.split("_")[2] for path in HDM05.glob("HDM_*_120.amc")}))


def scored(full: bool) -> list[str]:
    """Names of the walks that figures are published of."""
    if full:
        return [name for name in walks() if name.split("_")[0] not in DEV_SUBJECTS]
    return list(QUICK)


def development(full: bool) -> list[str]:
    """Names of the walks that settings may be chosen on."""
    if full:
        return [name for name in walks() if name.split("_")[0] in DEV_SUBJECTS]
    return list(QUICK_DEV)
