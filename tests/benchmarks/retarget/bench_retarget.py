"""Retargeting against copying rotations, and unbaking against Blender's Decimate.

    make bench-retarget                              # about a minute
    make bench-retarget ARGUMENTS=--decimate         # and Blender's Decimate: minutes more
    make bench-retarget ARGUMENTS="--decimate --docs"  # into docs/benchmarks/retargeting.md
    make bench-retarget ARGUMENTS=--dev              # clips to tune on

What is measured says `retarget_measures`.
"""

import argparse
import sys
from collections.abc import Callable, Iterator
from time import perf_counter

import numpy as np

from solvers.motion import HumanoidMap, Motion, Skeleton, find_humanoid_map, leg_length
from solvers.recordings import read_acclaim
from solvers.retargeting import RetargetSettings, reduce_keys, retarget
from solvers.rotations.representations import IDENTITY
from tests.fixtures.rigs import RIGS, child, with_all_fingers

from ..shared import clips
from ..shared.report import DOCS, Report
from ..shared.tables import Scores, table
from .part_unbake import STEP_FRAMES, on_fingered_rig, to_and_fro, unbaked
from .retarget_measures import acted, ik_figures, world_figures

Giver = Callable[[Motion, HumanoidMap, Skeleton, HumanoidMap], Motion]

BODIES = {**RIGS, "Child": child}
OURS = "retargeted"
UNITS = "units in the header"
LONG_TAKE_FRAMES = 10_000
ACTORS = ("bk", "dg")
PER_CLASS = 2


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--dev", action="store_true", help="clips to tune on instead")
    parser.add_argument("--decimate", action="store_true", help="run Blender's Decimate too")
    parser.add_argument("--docs", action="store_true", help="rewrite the document")
    chosen = parser.parse_args()
    started = perf_counter()
    tables = [
        scores.markdown()
        for title, motions in _inputs(chosen.dev).items()
        for scores in _retargeted(title, list(motions))
    ]
    tables.append(_speed())
    report = Report(chosen.docs, DOCS / "benchmarks" / "retargeting.md")
    report.part("retarget", tables, perf_counter() - started)
    started = perf_counter()
    keys = unbaked(chosen.dev, chosen.decimate)
    report.part("unbake", [keys], perf_counter() - started)


def _inputs(dev: bool) -> dict[str, Iterator[tuple[str, Motion]]]:
    names = (clips.development if dev else clips.scored)(False)
    walks = ((name, clips.read_cmu(clips.WALKS / f"{name}.bvh", STEP_FRAMES)) for name in names)
    return {"CMU walks": walks, "HDM05, all classes": _hdm05(dev)}


def _hdm05(dev: bool) -> Iterator[tuple[str, Motion]]:
    for actor in sorted(clips.DEV_ACTORS) if dev else ACTORS:
        for kind in clips.hdm05_classes():
            paths = sorted(clips.HDM05.glob(f"HDM_{actor}_{kind}_*_120.amc"))
            for path in paths[:PER_CLASS]:
                yield path.stem, clips.every(read_acclaim(path), STEP_FRAMES)


def _retargeted(title: str, motions: list[tuple[str, Motion]]) -> list[Scores]:
    where = f"{title}, {len(motions)} clips to {len(BODIES)} rigs"
    pose_scores = Scores(f"{where}: poses in the world", UNITS, OURS)
    by_rig = Scores(f"{where}: poses in the world, {OURS}, by rig", UNITS)
    reached = Scores(f"{where}: what the solver aimed at", UNITS, OURS)
    for name, motion in motions:
        source = acted(motion, find_humanoid_map(motion.skeleton))
        for family, rig in BODIES.items():
            target = rig()
            roles = find_humanoid_map(target)
            for method, give in METHODS.items():
                given = acted(give(motion, source.humanoid, target, roles), roles)
                figures = world_figures(source, given)
                _add(pose_scores, method, f"{name} {family}", figures)
                if method == OURS:
                    _add(by_rig, family, name, figures)
                _add(reached, method, f"{name} {family}", ik_figures(source, given))
    print(f"Done: {title}", file=sys.stderr, flush=True)
    return [pose_scores, by_rig, reached]


def _add(scores: Scores, row: str, clip: str, figures: dict[str, float]) -> None:
    for column, figure in figures.items():
        scores.add(row, column, clip, figure)


def copied(
    motion: Motion, source_map: HumanoidMap, target: Skeleton, target_map: HumanoidMap
) -> Motion:
    """Copy local rotations from role to role, as Copy Rotation constraints do."""
    theirs, ours = source_map.indices(motion.skeleton), target_map.indices(target)
    rotations = np.tile(IDENTITY, (motion.n_frames, target.n_joints, 1))
    for role, joint in ours.items():
        if role in theirs:
            rotations[:, joint] = motion.rotations[:, theirs[role]]
    growth = leg_length(target, target_map) / leg_length(motion.skeleton, source_map)
    rest = target.rest_positions
    positions = growth * motion.root_positions - (rest[ours["hips"]] - rest[0])
    return Motion(target, rotations, positions, motion.frame_rate)


def rotated_only(
    motion: Motion, source_map: HumanoidMap, target: Skeleton, target_map: HumanoidMap
) -> Motion:
    """Align the rest poses, but bring no limb anywhere."""
    settings = RetargetSettings(keep_feet=False, keep_hands=False)
    return retarget(motion, source_map, target, target_map, settings=settings)


METHODS: dict[str, Giver] = {
    OURS: retarget,
    "rest poses aligned, no limb IK": rotated_only,
    "local rotations copied": copied,
}


def _speed() -> str:
    take = to_and_fro(clips.read_cmu(clips.WALKS / "05_01.bvh", 1), LONG_TAKE_FRAMES)
    target = with_all_fingers()
    maps = find_humanoid_map(take.skeleton), find_humanoid_map(target)
    rows = {}
    for method, give in METHODS.items():
        start = perf_counter()
        give(take, maps[0], target, maps[1])
        rows[method] = [f"{perf_counter() - start:.2f}"]
    fingered = on_fingered_rig(take)
    start = perf_counter()
    sparse = reduce_keys(fingered, 0.01)
    rows[f"unbaked on that rig to 1 cm: {sparse.n_keys} keys"] = [
        f"{perf_counter() - start:.2f}"
    ]
    title = f"**{LONG_TAKE_FRAMES} frames to a rig of {target.n_joints} bones**\n\n"
    return title + table(["what", "seconds"], rows) + "\n"


if __name__ == "__main__":
    main()
