"""Joint centers solved from markers, against CMU's own skeletons and simulated bodies."""

from collections.abc import Callable, Mapping
from time import perf_counter

import numpy as np

from solvers.arrays import Array
from solvers.markers import find_marker_set, solve_skeleton
from solvers.markers.joint_centers import joint_centers
from solvers.motion import Motion, Tracks, find_humanoid_map, forward_kinematics
from solvers.recordings import read_acclaim, read_c3d
from tests.fixtures.marked_bodies import markers_on

from ..shared import clips
from ..shared.tables import Scores, table

Solver = Callable[[Tracks], Mapping[str, Array]]
PARTS = {
    "hip": "UpperLeg", "knee": "LowerLeg", "ankle": "Foot",
    "shoulder": "UpperArm", "elbow": "LowerArm", "wrist": "Hand",
}  # fmt: skip
ACCLAIM = {
    "hip": "femur", "knee": "tibia", "ankle": "foot",
    "shoulder": "humerus", "elbow": "radius", "wrist": "hand",
}  # fmt: skip
JOINT_MARKERS = {
    "knee": "KNE",
    "ankle": "ANK",
    "shoulder": "SHO",
    "elbow": "ELB",
    "wrist": "WRA",
}
SPOILS = {"no noise": (0.0, 0.0), "1 mm": (0.001, 0.0), "1 mm, skin 6 mm": (0.001, 0.006)}
SCORED = ("06_01", "07_02", "27_01", "29_01", "32_01", "35_01")
"""Walks that no setting was chosen on; those were 05_01, 10_04, 26_01 and 49_02."""
C3D_FROM_AMC = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
"""CMU's C3D and AMC files of one take differ by a rotation of 90 degrees about the vertical."""


def _solved(tracks: Tracks) -> Mapping[str, Array]:
    centers = solve_skeleton(tracks).joint_centers
    return {name: centers.positions[:, point] for point, name in enumerate(centers.names)}


def _regressed(tracks: Tracks) -> Mapping[str, Array]:
    found = find_marker_set(tracks.names).markers
    point = {name: index for index, name in enumerate(tracks.names)}
    return joint_centers({s: tracks.positions[:, point[n]] for s, n in found.items()}).positions


METHODS: dict[str, Solver] = {
    "regressions and chords, frame by frame": _regressed,
    "ours": _solved,
}


def against_amc() -> list[str]:
    """Return tables for CMU 05_13, whose markers and skeleton were both published."""
    folder = clips.DATA / "mocap"
    dance = read_acclaim(folder / "05_13.amc", folder / "05.asf")
    markers = read_c3d(folder / "05_13.c3d")
    theirs = forward_kinematics(dance).positions @ C3D_FROM_AMC
    true = {
        side + part: theirs[:, dance.skeleton.index(side[0] + ACCLAIM[joint])]
        for side in ("left", "right")
        for joint, part in PARTS.items()
    }
    rows, spread = {}, {}
    for name, method in METHODS.items():
        started = perf_counter()
        found = method(markers)
        seconds = perf_counter() - started
        means = [_mean(found, true, part) for part in PARTS.values()]
        rows[name] = [f"{cm:.1f}" for cm in (*means, np.mean(means))] + [f"{seconds:.1f}"]
    spread["from the skeleton of the AMC"] = _wander(markers, true)
    spread["from ours"] = _wander(markers, _solved(markers))
    title = "**CMU 05_13, 1095 frames, 41 markers: distance to the joints of its AMC** (cm)\n\n"
    wander = (
        "**Variation of the distance from a joint to its nearest marker** (standard deviation,"
        " cm; nearly constant on a body. It shows how reliable the AMC itself is; ours"
        " minimizes it)\n\n"
    )
    return [
        title + table(["method", *PARTS, "all", "seconds"], rows) + "\n",
        wander + table(["", *JOINT_MARKERS], spread) + "\n",
    ]


def _mean(found: Mapping[str, Array], true: Mapping[str, Array], part: str) -> float:
    sides = [found[side + part] - true[side + part] for side in ("left", "right")]
    return 100.0 * float(np.nanmean([np.linalg.norm(off, axis=1) for off in sides]))


def _wander(markers: Tracks, joints: Mapping[str, Array]) -> list[str]:
    cells = []
    for joint, marker_name in JOINT_MARKERS.items():
        spreads = []
        for letter, side in (("L", "left"), ("R", "right")):
            marker = markers.positions[:, markers.names.index(letter + marker_name)]
            distances = np.linalg.norm(marker - joints[side + PARTS[joint]], axis=1)
            spreads.append(float(np.nanstd(distances)))
        cells.append(f"{100 * np.mean(spreads):.1f}")
    return cells


def against_simulated_bodies() -> list[Scores]:
    """Return scores on CMU walks to whose bodies markers were attached."""
    all_scores = []
    for spoil, (noise, skin) in SPOILS.items():
        scores = Scores(
            f"Markers on {len(SCORED)} CMU walks, {spoil}", "distance to the true joint, mm"
        )
        for clip in SCORED:
            body = clips.read_cmu(clips.WALKS / f"{clip}.bvh", 1)
            tracks = markers_on(body, noise=noise, skin=skin)
            true = _true_joints(body)
            for name, method in METHODS.items():
                found = method(tracks)
                for joint, part in PARTS.items():
                    scores.add(name, joint, clip, 10.0 * _mean(found, true, part))
        scores.add_overall()
        all_scores.append(scores)
        print(f"  Simulated bodies: {spoil}", flush=True)
    return all_scores


def _true_joints(body: Motion) -> dict[str, Array]:
    joints = find_humanoid_map(body.skeleton).indices(body.skeleton)
    positions = forward_kinematics(body).positions
    return {role: positions[:, joint] for role, joint in joints.items()}
