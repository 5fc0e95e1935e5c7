"""What becomes of every recording of ../shared/data, and whether it is right.

    make bench-import-corpus
    make bench-import-corpus ARGUMENTS=--docs    # into docs/benchmarks_importing.md

Each file is read as Import reads it, FBX, glTF, USD and Collada by Blender's importers. Of a
body the table says whether it stands, how tall it is, how far its feet are from the floor, how
far it travels, which roles were found and at what rate it plays; of a refusal the sentence.
`TRUTH` holds what is known of the files. Wrong is what differs from it without a message.
"""

import argparse
import sys
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

from ..shared.clips import DATA
from ..shared.report import Report
from ..shared.tables import table
from .bench_scene_io import CHECKOUT, load_checkout

HEIGHT_TOLERANCE = 0.15
MIN_UPRIGHT = 0.8
"""Cosine between the trunk and the vertical in most frames of an actor who stands."""


@dataclass(frozen=True)
class Truth:
    """What is known of a file."""

    height_m: float | None = None
    """Of the tallest joint above the lowest in most frames; None where it is no body."""
    rate_hz: float | None = None
    stands: bool = True
    refused: bool = False


REFUSED = Truth(refused=True)
TRUTH = {
    "bvh/assimp_boxing_toes/*": Truth(1.62, 100.0),
    "bvh/bandai_namco/*": Truth(1.38, 30.0),
    "bvh/dme_*/*": Truth(1.38, 120.0),
    "bvh/ganimator_crab/*": Truth(),
    "bvh/mixamo_bvh_joe/*": Truth(1.9, 60.0),
    "bvh/olympe_*/*": Truth(1.67, 24.0),
    "bvh/pybvh_test1/*": Truth(1.64, 30.0),
    "bvh/pybvh_test3/*": Truth(1.62, 120.0),
    "bvh/smpl_*/*": Truth(1.42, 60.0),
    "bvh/xsens_mvn/*": Truth(1.53, 60.0),
    "dae/*": Truth(),
    "fbx/assimp_skeleton/*": Truth(),
    "fbx/max7_skin/*": Truth(),
    "fbx/mixamo_web/Rolling.fbx": Truth(0.9, 30.0, stands=False),
    "fbx/mixamo_web/*": Truth(1.9, 30.0),
    "fbx/ue4_mannequin/*": REFUSED,
    "glb/khronos_cesiumman/*": Truth(1.13, 24.0),
    "glb/mixamo_blender/*": Truth(1.68, 30.0),
    "glb/khronos_riggedsimple/*": Truth(),
    "glb/m2m_quadruped_fox/*": Truth(),
    "lab/c3d_bts/*": Truth(1.5, 100.0),
    "lab/c3d_qualisys/*": Truth(1.47, 200.0),
    "lab/c3d_rotation/*": Truth(1.65, 85.0),
    "lab/openpose_json/*": REFUSED,
    "lab/pose2sim/*.trc": Truth(1.67, 60.0),
    "lab/pose2sim/*": REFUSED,
    "lab/pyomeca_csv/markers.csv": Truth(1.05, 100.0, stands=False),
    "lab/pyomeca_csv/*": Truth(),
    "smpl/aist_pkl/*": REFUSED,
    "smpl/humanml3d_263/*": REFUSED,
    "smpl/kimodo_soma_npz/*": Truth(1.6, 30.0),
    "udp/*": REFUSED,
    "usd/*": Truth(),
    "vrm/vrma_pixiv/*": Truth(1.56, 30.0),
    "vrm/*": REFUSED,
}
"""By path below the corpus; of other files nothing is known."""


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--docs", action="store_true", help="rewrite docs/benchmarks_importing.md"
    )
    arguments = parser.parse_args()
    started = perf_counter()
    load_checkout()
    rows, wrong, n_read = {}, [], 0
    for path in recordings():
        name = path.relative_to(DATA).as_posix().removeprefix("corpus/")
        truth = next(
            (truth for pattern, truth in TRUTH.items() if fnmatch(name, pattern)), None
        )
        for take, row, faults in read(path, truth):
            rows[f"{name} {take}".strip()] = [*row, ", ".join(faults)]
            n_read += row[0] == "read"
            wrong += [name] * bool(faults)
    header = [
        "file", "", "upright", "height, m", "lowest, m", "travel, m", "roles", "Hz", "said",
        "wrong",
    ]  # fmt: skip
    verdict = f"{n_read} takes read, {len(rows) - n_read} files refused, {len(wrong)} wrong."
    text = f"**{verdict}**\n\n{table(header, rows)}\n"
    Report(arguments.docs, CHECKOUT / "docs" / "benchmarks_importing.md").part(
        "corpus", [text], perf_counter() - started
    )
    sys.exit(bool(wrong))


def recordings() -> list[Path]:
    """Return all files of the corpus and of other makers' formats, without the notes."""
    folders = (DATA / "corpus", DATA / "formats")
    files = [path for folder in folders for path in sorted(folder.rglob("*")) if path.is_file()]
    return [path for path in files if path.suffix.lower() not in {".md", ".asf"}]


def read(path: Path, truth: Truth | None) -> list[tuple[str, list[str], list[str]]]:
    """Return name, row and faults of each take of a file, or of its refusal."""
    from mocap_ext.mocap_assist.importing.solve_reading import Conversion, read_takes
    from mocap_ext.solvers.errors import MocapAssistError

    try:
        takes = read_takes(path, Conversion())
    except MocapAssistError as error:
        sentence = str(error).replace(str(path), path.name).replace("|", "/")
        faults = ["refused"] * bool(truth and not truth.refused and truth.height_m)
        return [("", ["refused", *["-"] * 6, sentence], faults)]
    found = []
    for take in takes:
        figures, sentence = measure(take.recording), ". ".join(take.warnings)
        faults = [] if truth is None or take.warnings else faults_of(figures, truth)
        found.append((take.take, ["read", *shown(figures), sentence], faults))
    return found


def measure(recording: Any) -> dict[str, float]:
    """Return what a body does: direction, height, floor and travel in meters."""
    from mocap_ext.solvers.motion import (
        JointRecording,
        Motion,
        find_humanoid_map,
        roles_by_name,
        world_poses,
    )

    if isinstance(recording, Motion):
        step = max(1, recording.n_frames // 200)
        poses = world_poses(
            recording.skeleton, recording.rotations[::step], recording.root_positions[::step]
        )
        points, rate = poses.positions, recording.frame_rate
        found = find_humanoid_map(recording.skeleton)
        score, roles = found.score, found.indices(recording.skeleton)
    elif hasattr(recording, "tracks") or hasattr(recording, "positions"):
        tracks = recording.tracks if isinstance(recording, JointRecording) else recording
        points, rate, score = tracks.positions, tracks.frame_rate, np.nan
        named = roles_by_name(tracks.names) if isinstance(recording, JointRecording) else {}
        roles = {role: tracks.names.index(name) for role, name in named.items()}
    else:
        return {"rate": recording.frame_rate, "roles": 0.0}
    observed = points[np.isfinite(points).any(axis=(1, 2))]
    if not len(observed):
        return {"rate": rate, "roles": 0.0}
    low, high = np.nanmin(observed[..., 2], axis=1), np.nanmax(observed[..., 2], axis=1)
    center = observed[:, roles["hips"]] if "hips" in roles else np.nanmean(observed, axis=1)
    figures = {
        "rate": rate, "roles": float(len(roles)), "score": score,
        "height": float(np.median(high - low)), "low": float(np.median(low)),
        "travel": float(np.linalg.norm(np.nanmax(center, axis=0) - np.nanmin(center, axis=0))),
    }  # fmt: skip
    if {"head", "hips"} <= roles.keys():
        trunk = observed[:, roles["head"]] - observed[:, roles["hips"]]
        up = trunk[:, 2] / np.linalg.norm(trunk, axis=1)
        figures["upright"] = float(np.nanmedian(up))
    return figures


def faults_of(figures: dict[str, float], truth: Truth) -> list[str]:
    """Return what differs from the truth."""
    if truth.refused:
        return ["read"]
    if truth.height_m is None:
        return ["taken for a person"] * (figures.get("score", 0.0) >= 0.5)
    height = figures.get("height", np.nan)
    faults = ["height"] * (not abs(height / truth.height_m - 1.0) <= HEIGHT_TOLERANCE)
    faults += ["lies"] * (truth.stands and figures.get("upright", 1.0) < MIN_UPRIGHT)
    faults += ["rate"] * (truth.rate_hz not in {None, round(figures["rate"], 3)})
    return faults


def shown(figures: dict[str, float]) -> list[str]:
    """Return the cells of a row."""
    cells = [
        f"{figures[key]:.2f}" if key in figures else "-"
        for key in ("upright", "height", "low", "travel")
    ]
    return [*cells, f"{figures['roles']:.0f}", f"{figures['rate']:g}"]


if __name__ == "__main__":
    main()
