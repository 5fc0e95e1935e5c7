"""What becomes of every recording of ../shared/data, and whether it is right.

    make bench-import-corpus
    make bench-import-corpus ARGUMENTS=--docs    # into docs/benchmarks/importing.md

Each file is read as Import reads it, FBX, glTF, USD and Collada by Blender's importers. Of a
body the table says whether it stands, how tall it is, how far its feet are from the floor, how
far it travels, how many roles were found with what confidence, and at what rate it plays; of a
refusal the sentence. `TRUTH` holds what is known of the files, the joints of the limbs too.
Wrong is what differs from it without a message about it.
"""

import argparse
import re
import sys
from collections.abc import Mapping, Sequence
from pathlib import Path
from time import perf_counter
from typing import Any
from warnings import catch_warnings, simplefilter

import numpy as np

from ..shared.clips import DATA
from ..shared.report import Report
from ..shared.tables import table
from .bench_scene_io import CHECKOUT, load_checkout
from .corpus_truth import FOOT_MARKERS, TOP_MARKERS, Truth, faults_of, truth_of


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "--docs", action="store_true", help="rewrite docs/benchmarks/importing.md"
    )
    arguments = parser.parse_args()
    started = perf_counter()
    load_checkout()
    rows, wrong, n_read = {}, [], 0
    for path in recordings():
        name = path.relative_to(DATA).as_posix().removeprefix("corpus/")
        for take, row, faults in read(path, truth_of(name)):
            rows[f"{name} {take}".strip()] = [*row, ", ".join(faults)]
            n_read += row[0] == "read"
            wrong += [name] * bool(faults)
    header = [
        "file", "", "upright", "height, m", "lowest, m", "travel, m", "roles", "Hz", "message",
        "wrong",
    ]  # fmt: skip
    verdict = f"{n_read} takes read, {len(rows) - n_read} files refused, {len(wrong)} wrong."
    text = f"**{verdict}**\n\n{table(header, rows)}\n"
    Report(arguments.docs, CHECKOUT / "docs" / "benchmarks" / "importing.md").part(
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
    from mocap_ext.solvers.recordings import FloorPlacement

    try:
        contents = read_takes(path, Conversion(floor=FloorPlacement.AUTO))
    except MocapAssistError as error:
        sentence = str(error).replace(str(path), path.name).replace("|", "/")
        faults = ["refused"] * bool(truth and not truth.refused and truth.height_m)
        return [("", ["refused", *["-"] * 6, sentence], faults)]
    found = []
    for content in contents:
        sentence = ". ".join(content.warnings)
        takes = [
            (content.take, content.recording),
            *((take.name, take.motion) for take in content.others),
        ]
        for take, recording in takes:
            figures, joints = measure(recording)
            faults = faults_of(figures, joints, truth, sentence)
            found.append((take, ["read", *shown(figures), sentence], faults))
    return found


def measure(recording: Any) -> tuple[dict[str, float], dict[str, str]]:
    """Return direction, height, floor and travel in meters, and the joint of each role."""
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
        score, joints = found.score, dict(found.joints)
        names = recording.skeleton.names
    elif hasattr(recording, "tracks") or hasattr(recording, "positions"):
        tracks = recording.tracks if isinstance(recording, JointRecording) else recording
        points, rate, score, names = tracks.positions, tracks.frame_rate, np.nan, tracks.names
        joints = roles_by_name(names) if isinstance(recording, JointRecording) else {}
    else:
        return {"rate": recording.frame_rate, "roles": 0.0}, {}
    roles = {role: names.index(name) for role, name in joints.items()}
    observed = points[np.isfinite(points).any(axis=(1, 2))]
    if not len(observed):
        return {"rate": rate, "roles": 0.0}, joints
    low, high = np.nanmin(observed[..., 2], axis=1), np.nanmax(observed[..., 2], axis=1)
    center = observed[:, roles["hips"]] if "hips" in roles else np.nanmean(observed, axis=1)
    figures = {
        "rate": rate, "roles": float(len(roles)), "score": score,
        "height": float(np.median(high - low)), "low": float(np.median(low)),
        "travel": float(np.linalg.norm(np.nanmax(center, axis=0) - np.nanmin(center, axis=0))),
    }  # fmt: skip
    trunk = direction_of_trunk(observed, roles, names)
    if trunk is not None:
        up = trunk[:, 2] / np.linalg.norm(trunk, axis=1)
        if np.isfinite(up).any():
            figures["upright"] = float(np.nanmedian(up))
    return figures, joints


def direction_of_trunk(
    positions: np.ndarray, roles: Mapping[str, int], names: Sequence[str]
) -> np.ndarray | None:
    """Return the vectors from hips to head or, of markers, from the feet to the shoulders."""
    if {"head", "hips"} <= roles.keys():
        return np.asarray(positions[:, roles["head"]] - positions[:, roles["hips"]])
    plain = [name.rpartition(":")[2].replace(" ", "").lower() for name in names]
    top = [k for k, name in enumerate(plain) if re.fullmatch(TOP_MARKERS, name)]
    feet = [k for k, name in enumerate(plain) if re.fullmatch(FOOT_MARKERS, name)]
    if roles or not top or not feet:
        return None
    with catch_warnings():
        simplefilter("ignore")  # frames without any of them
        above = np.nanmean(positions[:, top], axis=1)
        return np.asarray(above - np.nanmean(positions[:, feet], axis=1))


def shown(figures: dict[str, float]) -> list[str]:
    """Return the cells of a row."""
    cells = [
        f"{figures[key]:.2f}" if key in figures else "-"
        for key in ("upright", "height", "low", "travel")
    ]
    sure = f" ({figures['score']:.0%})" if np.isfinite(figures.get("score", np.nan)) else ""
    return [*cells, f"{figures['roles']:.0f}{sure}", f"{figures['rate']:g}"]


if __name__ == "__main__":
    main()
