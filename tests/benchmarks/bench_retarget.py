"""Retargeting against copying rotations, and unbaking against Blender's Decimate.

    make bench-retarget                              # about a minute
    make bench-retarget ARGUMENTS=--decimate         # and Blender's Decimate: ten minutes
    make bench-retarget ARGUMENTS="--decimate --docs"  # into docs/benchmarks_retargeting.md
    make bench-retarget ARGUMENTS=--dev              # clips to tune on

Foot: distance of the ankle's path from the source's, scaled by the legs, both from where they
begin. Hand: distance of the hand, seen from the shoulder, from the source's, scaled by the arm.
Slide: mean horizontal speed, in contact, of the slower of ankle and toes; that of the source is
scaled by the legs, contacts are those of the source. Flips: frames in which a joint turns, in
the world, by 30 degrees more than the source's does.
"""

import argparse
import sys
from collections.abc import Callable, Iterator
from time import perf_counter

import numpy as np
from numpy.typing import NDArray
from threadpoolctl import threadpool_limits

from solvers.motion import (
    HumanoidMap,
    Motion,
    Skeleton,
    detect_contacts,
    find_humanoid_map,
    foot_points,
    forward_kinematics,
    leg_length,
)
from solvers.motion.rotations import IDENTITY, angle_between
from solvers.recordings import read_acclaim
from solvers.retargeting import RetargetSettings, reduce_keys, retarget
from tests.fixtures.rigs import RIGS, with_all_fingers

from . import clips
from .report import DOCS, Report
from .tables import Scores, number, table

Array = NDArray[np.float64]
Giver = Callable[[Motion, HumanoidMap, Skeleton, HumanoidMap], Motion]

FLIP = np.radians(30.0)
TOLERANCES = (0.0025, 0.005, 0.01, 0.02)
LONG = 10_000
STEP = 2
"""Clips are at 60 Hz."""
ACTORS = ("bk", "dg")
PER_CLASS = 2
UNBAKED = {False: ("05_01", "29_01", "35_12"), True: ("10_04", "26_01", "07_03")}
"""By whether they are for tuning."""


def main() -> None:
    """Print the tables."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").splitlines()[0])
    parser.add_argument("--dev", action="store_true", help="clips to tune on instead")
    parser.add_argument("--decimate", action="store_true", help="run Blender's Decimate too")
    parser.add_argument("--docs", action="store_true", help="rewrite the document")
    chosen = parser.parse_args()
    started = perf_counter()
    with threadpool_limits(1):
        tables = [
            _retargeted(title, list(motions)) for title, motions in _inputs(chosen.dev).items()
        ]
        tables.append(_speed())
    report = Report(chosen.docs, DOCS / "benchmarks_retargeting.md")
    report.part("retarget", tables, perf_counter() - started)
    started = perf_counter()
    unbaked = _unbaked(UNBAKED[chosen.dev], chosen.decimate)
    report.part("unbake", [unbaked], perf_counter() - started)


def _inputs(dev: bool) -> dict[str, Iterator[tuple[str, Motion]]]:
    names = (clips.development if dev else clips.scored)(False)
    walks = ((name, clips.read_cmu(clips.WALKS / f"{name}.bvh", STEP)) for name in names)
    return {"CMU walks": walks, "HDM05, all classes": _hdm05(dev)}


def _hdm05(dev: bool) -> Iterator[tuple[str, Motion]]:
    for actor in sorted(clips.DEV_ACTORS) if dev else ACTORS:
        for kind in clips.hdm05_classes():
            paths = sorted(clips.HDM05.glob(f"HDM_{actor}_{kind}_*_120.amc"))
            for path in paths[:PER_CLASS]:
                yield path.stem, clips.every(read_acclaim(path), STEP)


def _retargeted(title: str, motions: list[tuple[str, Motion]]) -> str:
    scores = Scores(
        f"{title}, {len(motions)} clips to {len(RIGS)} rigs: {', '.join(RIGS)}",
        "units in the header", "retargeted",
    )  # fmt: skip
    for name, motion in motions:
        source_map = find_humanoid_map(motion.skeleton)
        for family, rig in RIGS.items():
            target = rig()
            target_map = find_humanoid_map(target)
            for method, give in METHODS.items():
                given = give(motion, source_map, target, target_map)
                figures = _figures(motion, source_map, given, target_map)
                for column, figure in figures.items():
                    scores.add(method, column, f"{name} {family}", figure)
    print(f"Done: {title}", file=sys.stderr, flush=True)
    return scores.markdown()


def _figures(
    motion: Motion, source_map: HumanoidMap, given: Motion, target_map: HumanoidMap
) -> dict[str, float]:
    theirs, ours = source_map.indices(motion.skeleton), target_map.indices(given.skeleton)
    seen, got = forward_kinematics(motion), forward_kinematics(given)
    growth = leg_length(given.skeleton, target_map) / leg_length(motion.skeleton, source_map)
    feet, hands = [], []
    for side in ("left", "right"):
        a, b = seen.positions[:, theirs[f"{side}Foot"]], got.positions[:, ours[f"{side}Foot"]]
        feet.append((b - b[0]) - growth * (a - a[0]))
        a, b = (
            poses.positions[:, joints[f"{side}Hand"]]
            - poses.positions[:, joints[f"{side}UpperArm"]]
            for poses, joints in ((seen, theirs), (got, ours))
        )
        arm = _arm(given.skeleton, ours, side) / _arm(motion.skeleton, theirs, side)
        hands.append(b - arm * a)
    foot, hand = (100.0 * np.linalg.norm(each, axis=-1) for each in (feet, hands))
    contacts = detect_contacts(motion, source_map)
    flips = [
        _turns(got.rotations[:, ours[role]]) - _turns(seen.rotations[:, theirs[role]]) > FLIP
        for role in theirs
        if role in ours
    ]
    slides = [
        100.0 * scale * _slide(poses.positions[:, foot_points(body.skeleton, roles)], contacts)
        * motion.frame_rate
        for scale, poses, body, roles in (
            (growth, seen, motion, source_map), (1.0, got, given, target_map),
        )
    ]  # fmt: skip
    return {
        "foot cm": foot.mean(), "at most": foot.max(),
        "hand cm": hand.mean(), "hand at most": hand.max(),
        "slide of source cm/s": slides[0], "slide cm/s": slides[1],
        "flips": float(np.sum(flips)),
    }  # fmt: skip


def _arm(skeleton: Skeleton, joints: dict[str, int], side: str) -> float:
    roles = [f"{side}UpperArm", f"{side}LowerArm", f"{side}Hand"]
    places = skeleton.rest_positions[[joints[role] for role in roles]]
    return float(np.linalg.norm(np.diff(places, axis=0), axis=1).sum())


def _turns(rotations: Array) -> Array:
    return angle_between(rotations[1:], rotations[:-1])


def _slide(feet: Array, contacts: NDArray[np.bool_]) -> float:
    """Metres from one frame to the next in contact, of the slower of ankle and toes."""
    ways = np.linalg.norm(np.diff(feet[..., :2], axis=0), axis=-1).min(axis=-1)
    standing = contacts[1:] & contacts[:-1]
    return float(ways[standing].mean()) if standing.any() else float("nan")


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
    places = growth * motion.root_positions - (rest[ours["hips"]] - rest[0])
    return Motion(target, rotations, places, motion.frame_rate)


def turned_only(
    motion: Motion, source_map: HumanoidMap, target: Skeleton, target_map: HumanoidMap
) -> Motion:
    """Align the rest poses, but bring no limb anywhere."""
    settings = RetargetSettings(keep_feet=False, keep_hands=False)
    return retarget(motion, source_map, target, target_map, settings=settings)


METHODS: dict[str, Giver] = {
    "retargeted": retarget,
    "rest poses aligned, no limb IK": turned_only,
    "local rotations copied": copied,
}


def _speed() -> str:
    walk = clips.read_cmu(clips.WALKS / "05_01.bvh", 1)
    frames = np.arange(LONG) % walk.n_frames
    take = Motion(
        walk.skeleton, walk.rotations[frames], walk.root_positions[frames], walk.frame_rate
    )
    target = with_all_fingers()
    maps = find_humanoid_map(take.skeleton), find_humanoid_map(target)
    rows = {}
    for method, give in METHODS.items():
        start = perf_counter()
        give(take, maps[0], target, maps[1])
        rows[method] = [f"{perf_counter() - start:.2f}"]
    start = perf_counter()
    sparse = reduce_keys(take, 0.01)
    rows[f"unbaked to 1 cm: {sparse.n_keys} keys"] = [f"{perf_counter() - start:.2f}"]
    title = f"**{LONG} frames to a rig of {target.n_joints} bones**\n\n"
    return title + table(["what", "seconds"], rows) + "\n"


def _unbaked(names: tuple[str, ...], decimate: bool) -> str:
    rows: dict[str, list[str]] = {}
    for name in names:
        motion = clips.read_cmu(clips.WALKS / f"{name}.bvh", STEP)
        theirs = _decimated(motion) if decimate else [{} for _ in TOLERANCES]
        for tolerance, other in zip(TOLERANCES, theirs, strict=True):
            start = perf_counter()
            with threadpool_limits(1):
                sparse = reduce_keys(motion, tolerance)
            seconds = perf_counter() - start
            moving = sum(len(curve.frames) > 0 for curve in sparse.rotations)
            cells = [str(motion.n_frames * (4 * moving + 3)), str(sparse.n_keys)]
            cells += [f"{100 * sparse.error:.2f}", f"{seconds:.2f}"]
            if other:
                cells += [
                    f"{other['keys']:.0f}", f"{100 * other['error']:.2f}",
                    f"{other['seconds']:.1f}", number(other["keys"] / sparse.n_keys),
                ]  # fmt: skip
            rows[f"{name}, {100 * tolerance:g} cm"] = cells
    header = ["clip, tolerance", "baked keys", "keys", "error cm", "seconds"]
    if decimate:
        header += ["Decimate: keys", "error cm", "seconds", "times our keys"]
    return (
        "**Keys (each channel counted) at a given greatest error of any joint**, 60 Hz;"
        " Decimate's margin is found by bisection, its seconds are those of one run\n\n"
        + table(header, rows)
        + "\n"
    )


def _decimated(motion: Motion) -> list[dict[str, float]]:
    from .peers.blender_decimate import decimate_in_blender

    return decimate_in_blender(motion, TOLERANCES)


if __name__ == "__main__":
    main()
