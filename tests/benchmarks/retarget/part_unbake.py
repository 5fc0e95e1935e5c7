"""Unbaking a motion on the rig that it was given to, against Blender's Decimate."""

from time import perf_counter

import numpy as np

from solvers.motion import Motion, find_humanoid_map
from solvers.retargeting import reduce_keys, retarget
from tests.fixtures.rigs import with_all_fingers

from ..shared import clips
from ..shared.tables import number, table

TOLERANCES = (0.0025, 0.005, 0.01, 0.02)
CLIPS = {False: ("05_01", "29_01", "35_12"), True: ("10_04", "26_01", "07_03")}
"""By whether they are for tuning."""
STEP_FRAMES = 2
"""Clips are at 60 Hz."""


def unbaked(dev: bool, decimate: bool) -> str:
    """Return the table of keys that are left at each tolerance."""
    rows: dict[str, list[str]] = {}
    for name in CLIPS[dev]:
        motion = on_fingered_rig(clips.read_cmu(clips.WALKS / f"{name}.bvh", STEP_FRAMES))
        theirs = _decimated(motion) if decimate else [{} for _ in TOLERANCES]
        for tolerance, other in zip(TOLERANCES, theirs, strict=True):
            rows[f"{name}, {100 * tolerance:g} cm"] = _row(motion, tolerance, other)
    header = ["clip, tolerance", "baked keys", "keys", "error cm", "seconds"]
    if decimate:
        header += ["Decimate: keys", "error cm", "seconds", "times our keys"]
    return (
        f"**Keys (each channel counted) of walks on a rig of {motion.n_joints} bones, at a"
        " given maximum error of any joint at any frame**, 60 Hz; Decimate's two margins, of"
        " rotations and positions, are searched for; its seconds are those of one run\n\n"
        + table(header, rows)
        + "\n"
    )


def on_fingered_rig(motion: Motion) -> Motion:
    """Return the motion as a Mixamo rig with all fingers makes it; the fingers rest."""
    rig = with_all_fingers()
    return retarget(motion, find_humanoid_map(motion.skeleton), rig, find_humanoid_map(rig))


def to_and_fro(motion: Motion, n_frames: int) -> Motion:
    """Return a longer take: the motion, then backwards in time, and so on, without jumps."""
    once = np.arange(motion.n_frames)
    frames = np.resize(np.concatenate([once, once[-2:0:-1]]), n_frames)
    return Motion(
        motion.skeleton,
        motion.rotations[frames],
        motion.root_positions[frames],
        motion.frame_rate,
    )


def _row(motion: Motion, tolerance: float, other: dict[str, float]) -> list[str]:
    start = perf_counter()
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
    return cells


def _decimated(motion: Motion) -> list[dict[str, float]]:
    from ..peers.blender_decimate import decimate_in_blender

    return decimate_in_blender(motion, TOLERANCES)
