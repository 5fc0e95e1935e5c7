"""Optical markers: labels exchanged, rigid clusters, and joints of bodies that are known."""

import numpy as np

from solvers.arrays import Array
from solvers.markers import (
    constrain_clusters,
    find_rigid_clusters,
    solve_skeleton,
    unswap_markers,
)
from solvers.motion import Tracks, find_humanoid_map, forward_kinematics
from solvers.recordings import read_c3d
from tests.fixtures.marked_bodies import markers_on

from ...shared import clips
from ..takes import missed_or_false, point_error, variety

JOINTS = ("UpperLeg", "LowerLeg", "Foot", "UpperArm", "LowerArm", "Hand")
MARKERS = 41
"""Of CMU 05_13; what follows them in the file is computed."""


def prepare() -> dict[str, object]:
    """Put markers on a body; exchange labels of a real take, and shake it."""
    bodies = {"punch": clips.every(variety("02_05").slice(600, 900), clips.STEP)}
    solved = {}
    for name, motion in bodies.items():
        joints = find_humanoid_map(motion.skeleton).indices(motion.skeleton)
        positions = forward_kinematics(motion).positions
        truth = {
            f"{side}{part}": positions[:, joints[f"{side}{part}"]]
            for side in ("left", "right")
            for part in JOINTS
        }
        marked = markers_on(motion, noise=0.001, skin=0.006)
        holed = marked.positions.copy()
        rng = np.random.default_rng(2)
        for marker in rng.choice(marked.n_points, 10, replace=False):
            first = int(rng.integers(0, len(holed) - 20))
            holed[first : first + 15, marker] = np.nan
        solved[name] = marked.with_positions(holed), truth
    clean = _clean()
    return {"solved": solved, "swaps": _swaps(clean), "rigid": _shaken(clean)}


def measure(
    solved: dict[str, tuple[Tracks, dict[str, Array]]],
    swaps: dict[str, tuple[Tracks, Tracks]],
    rigid: tuple[Tracks, Tracks],
) -> dict[str, float]:
    """Distance to the joints, samples still wrong, and noise that the clusters leave."""
    figures = {}
    for name, (given, truth) in solved.items():
        centers = solve_skeleton(given).joint_centers
        for joint, where in truth.items():
            if joint.startswith("left") and joint in centers.names:
                found = centers.positions[:, centers.names.index(joint)]
                figures[f"{name}, {joint}: mm"] = point_error(found, where)
    for name, (given, truth) in swaps.items():
        result = unswap_markers(given).tracks.positions
        changed = _differ(result, given.positions)
        wrong = _differ(truth.positions, given.positions)
        figures[f"{name}: missed or false %"] = 1.0 + missed_or_false(changed, wrong)
    clean, noisy = rigid
    clusters = find_rigid_clusters(noisy)
    kept = constrain_clusters(noisy, clusters).tracks.positions
    figures["rigid: mm"] = point_error(kept, clean.positions)
    figures["rigid: markers in clusters"] = float(sum(len(each.names) for each in clusters))
    return figures


def _clean() -> Tracks:
    tracks = read_c3d(clips.DATA / "mocap" / "05_13.c3d").slice(200, 440)
    seen = np.flatnonzero(tracks.visible[:, :MARKERS].all(axis=0))
    names = tuple(tracks.names[point] for point in seen)
    return Tracks(names, tracks.positions[:, seen], tracks.frame_rate)


def _swaps(clean: Tracks) -> dict[str, tuple[Tracks, Tracks]]:
    """Exchange pairs of near markers, at 60 Hz, and at 30 Hz with gaps and noise."""
    slow = Tracks(clean.names, clean.positions[::4].copy(), clean.frame_rate / 4)
    fast = Tracks(clean.names, clean.positions[::2].copy(), clean.frame_rate / 2)
    rng = np.random.default_rng(3)
    for marker in range(slow.n_points):
        first = int(rng.integers(0, slow.n_frames - 12))
        slow.positions[first : first + int(rng.integers(3, 12)), marker] = np.nan
    slow.positions[:] += rng.normal(scale=0.001, size=slow.positions.shape)
    return {
        "swaps 60 Hz": (_exchanged(fast, 12, 4), fast),
        "swaps 30 Hz, gaps": (_exchanged(slow, 12, 5), slow),
    }


def _exchanged(tracks: Tracks, n_swaps: int, seed: int) -> Tracks:
    rng = np.random.default_rng(seed)
    positions = tracks.positions.copy()
    for number, length in enumerate(np.geomspace(0.04, 1.2, n_swaps)):
        first = int(rng.integers(tracks.n_points))
        apart = np.linalg.norm(tracks.positions - tracks.positions[:, [first]], axis=-1)
        near = np.argsort(np.nanmean(apart, axis=0))[1:5]
        pair = [first, int(rng.choice(near))]
        last = max(1, round(length * tracks.frame_rate))
        start = int(rng.integers(1, tracks.n_frames - last - 1))
        stop = tracks.n_frames if number == n_swaps - 1 else start + last
        positions[start:stop, pair] = positions[start:stop, pair[::-1]]
    return tracks.with_positions(positions)


def _shaken(clean: Tracks) -> tuple[Tracks, Tracks]:
    noise = np.random.default_rng(6).normal(scale=0.003, size=clean.positions.shape)
    positions = clean.positions + noise
    positions[100:160, clean.names.index("LFHD")] = np.nan
    return clean, clean.with_positions(positions)


def _differ(a: Array, b: Array) -> np.ndarray:
    return np.asarray((np.nan_to_num(a) != np.nan_to_num(b)).any(axis=-1))
