"""What Import asks about a take, rather than guess."""

import re
from pathlib import Path

from solvers.motion import Motion
from solvers.recordings import FloorPlacement, questions_of, read_bvh, write_bvh
from solvers.samples import GaitSettings, walking_gait


def walk_with_offsets(folder: Path, factor: float) -> Motion:
    """Write a walk whose bones have another unit than its positions, and read it."""
    path = folder / "walk.bvh"
    write_bvh(walking_gait(GaitSettings(duration=2.0, frame_rate=30.0)), path)
    text = re.sub(
        r"OFFSET (.+)",
        lambda match: (
            "OFFSET " + " ".join(f"{factor * float(x):.5f}" for x in match[1].split())
        ),
        path.read_text(),
    )
    path.write_text(text)
    return read_bvh(path)


def test_offsets_in_meters_and_positions_in_centimeters_are_queried(tmp_path):
    asked = questions_of(walk_with_offsets(tmp_path, 0.01), FloorPlacement.AUTO)

    assert any(
        "positions and bone lengths of the file have different units" in a for a in asked
    )


def test_walk_in_one_unit_is_not_queried(tmp_path):
    assert questions_of(walk_with_offsets(tmp_path, 1.0), FloorPlacement.AUTO) == []
