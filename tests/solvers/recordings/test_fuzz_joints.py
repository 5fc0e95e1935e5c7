"""Damaged joint recordings are read or refused: see test_fuzz.py, whose bounds hold here."""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from damage import damaged, read_or_refuse, searching
from hypothesis import given
from joint_files import (
    azure_columns,
    azure_json,
    azure_lines,
    irds,
    kinect_csv,
    moving,
    msr,
    npy,
    ntu,
    ui_prmd,
)

from solvers.motion import JointRecording, Sensor, Tracks
from solvers.recordings import (
    read_azure_csv,
    read_azure_json,
    read_freemocap,
    read_irds,
    read_joint_csv,
    read_joint_json,
    read_kinect_csv,
    read_msr_action3d,
    read_ntu_skeleton,
    read_recording,
    read_ui_prmd,
    write_joints,
)

EXAMPLES = 60


def written(ending: str) -> bytes:
    tracks = Tracks(("head", "hand"), moving(6, 2)[..., :3], 30.0, np.full((6, 2), 0.5))
    recording = JointRecording(tracks, np.full((6, 2), 2), Sensor.KINECT_V2)
    with TemporaryDirectory() as folder:
        path = Path(folder) / f"take{ending}"
        write_joints(recording, path)
        return path.read_bytes()


V2, V3 = moving(4, 25), 1000 * moving(4, 32)
V3[..., 3] = 2
TICKS = [89810293609 + 333333 * frame for frame in range(4)]
WHOLE = {
    "ntu": (read_ntu_skeleton, ntu([{"72": frame, "9": frame} for frame in V2]).encode()),
    "irds": (read_irds, irds(V2).encode()),
    "kinect table": (read_kinect_csv, kinect_csv(V2).encode()),
    "kinect table with times": (read_kinect_csv, kinect_csv(V2, TICKS).encode()),
    "azure lines": (read_azure_csv, azure_lines([{1: frame} for frame in V3]).encode()),
    "azure columns": (read_azure_csv, azure_columns(V3).encode()),
    "azure json": (read_azure_json, azure_json([{1: frame} for frame in V3]).encode()),
    "azure json on one line": (
        read_azure_json,
        azure_json([{1: frame} for frame in V3], sorted_keys=False).encode(),
    ),
    "msr": (read_msr_action3d, msr(moving(3, 20) / 4).encode()),
    "ui prmd": (read_ui_prmd, ui_prmd()),
    "npy": (read_freemocap, npy(moving(5, 33)[..., :3])),
    "csv": (read_joint_csv, written(".csv")),
    "json": (read_joint_json, written(".json")),
    "csv with times": (
        read_joint_csv,
        b"mocap-assist-joints,1,units=mm,up=y\ntime,A.x,A.y,A.z,A.state\n"
        + b"".join(b"%d.5,%d,2,3,2\n" % (n, n) for n in range(9)),
    ),
}
TOKENS = [
    b"", b"0", b"1", b"-1", b"999999999", b"1e308", b"-1e308", b"1e-308", b"nan", b"inf", b"{",
    b"}", b"[", b"]", b"null", b"true", b'"', b"'", b"\n", b"\r", b",", b"(", b")", b"=", b"\0",
    b"\xff", b"\n25\n", b"[[", b"frames", b"positions", b"'<f8'", b"'|O8'", b"(9, 9, 9)",
    b"9" * 400, b"1" * 5000, b"\x1c", b"-", b".", b" ", b"1_0", b"time",
]  # fmt: skip


@pytest.mark.parametrize("kind", WHOLE)
def test_whole_files_are_read_and_known_by_their_content(kind, tmp_path):
    read, whole = WHOLE[kind]
    (tmp_path / "take").write_bytes(whole)

    one, other = read(tmp_path / "take"), read_recording(tmp_path / "take")

    assert type(one) is type(other)
    assert one.n_frames == other.n_frames > 2


@pytest.mark.parametrize("kind", WHOLE)
def test_damaged_files(kind, tmp_path):
    read, whole = WHOLE[kind]
    path = tmp_path / "take"

    @searching(EXAMPLES)
    @given(damaged(whole, TOKENS))
    def search(content: bytes) -> None:
        path.write_bytes(content)
        read_or_refuse(lambda: read(path))
        read_or_refuse(lambda: read_recording(path))

    search()


@pytest.mark.parametrize("kind", WHOLE)
def test_progress_rises_to_the_end(kind, tmp_path):
    read, whole = WHOLE[kind]
    (tmp_path / "take").write_bytes(whole)
    told = []

    read(tmp_path / "take", progress=lambda fraction, message="": told.append(fraction))

    assert told == sorted(told)
    assert told[-1] == pytest.approx(1.0)
