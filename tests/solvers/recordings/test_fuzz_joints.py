"""Damaged joint recordings are read or refused: see test_fuzz.py, whose bounds hold here."""

import os
import tracemalloc
from pathlib import Path
from tempfile import TemporaryDirectory
from time import perf_counter

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
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

from solvers.errors import InvalidFileError, InvalidMotionError
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

EXAMPLES = int(os.environ.get("MOCAP_FUZZ", "60"))
MOST_MEMORY = 64e6
MOST_SECONDS = 20.0
"""No measurement: only an endless loop takes so long for a file of some kilobytes."""


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


@st.composite
def damaged(draw, whole: bytes) -> bytes:
    """Cut, overwrite, insert, repeat, and swap numbers for tokens, a few times."""
    content = whole
    for _ in range(draw(st.integers(1, 4))):
        at = draw(st.integers(0, len(content)))
        length = draw(st.integers(0, 40))
        kind = draw(st.sampled_from(["cut", "replace", "insert", "noise", "repeat", "word"]))
        token = draw(st.sampled_from(TOKENS))
        if kind == "cut":
            content = content[:at]
        elif kind == "replace":
            content = content[:at] + token + content[at + len(token) :]
        elif kind == "insert":
            content = content[:at] + token + content[at:]
        elif kind == "noise":
            content = content[:at] + draw(st.binary(max_size=8)) + content[at + length :]
        elif kind == "word":
            content = content[:at] + token + content[at:].lstrip(b"-.0123456789e")
        else:
            content = content[: at + length] + content[at:]
    return content


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

    @settings(
        max_examples=EXAMPLES,
        deadline=None,
        derandomize="MOCAP_FUZZ" not in os.environ,
        database=None,
        suppress_health_check=list(HealthCheck),
    )
    @given(damaged(whole))
    def search(content: bytes) -> None:
        path.write_bytes(content)
        read_or_refuse(lambda: read(path))
        read_or_refuse(lambda: read_recording(path))

    search()


def read_or_refuse(read) -> None:
    """Read within bounds: a valid recording or a whole sentence comes out."""
    tracemalloc.start()
    started = perf_counter()
    try:
        found = read()
        assert isinstance(found, JointRecording | Tracks)
    except (InvalidFileError, InvalidMotionError) as error:
        assert str(error).endswith(".")
    finally:
        peak = tracemalloc.get_traced_memory()[1]
        tracemalloc.stop()
    assert peak < MOST_MEMORY
    assert perf_counter() - started < MOST_SECONDS


@pytest.mark.parametrize("kind", WHOLE)
def test_progress_rises_to_the_end(kind, tmp_path):
    read, whole = WHOLE[kind]
    (tmp_path / "take").write_bytes(whole)
    told = []

    read(tmp_path / "take", progress=lambda fraction, message="": told.append(fraction))

    assert told == sorted(told)
    assert told[-1] == pytest.approx(1.0)
