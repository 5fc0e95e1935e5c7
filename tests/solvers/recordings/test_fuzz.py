"""Damaged files are read or refused: never a crash, a hang, or more memory than the file.

The bytes that are damaged are made here. To search long:
`MOCAP_FUZZ=20000 python -m pytest tests/solvers/recordings/test_fuzz.py`.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pytest
from acclaim_files import LEG
from damage import damaged, read_or_refuse, searching
from hypothesis import given

from solvers.motion import Motion, Skeleton, Tracks
from solvers.recordings import read_acclaim, read_recording, write_bvh, write_c3d, write_trc

EXAMPLES = 100

SKELETON = LEG.encode()
RECORDING = b":FULLY-SPECIFIED\n:DEGREES\n" + b"".join(
    b"%d\nroot 0 17 %d 0 5 0\nthigh %d 2 3\nshank %d\n" % (frame, frame, frame, 2 * frame)
    for frame in range(1, 12)
)


def bvh_bytes() -> bytes:
    names = ("hips", "thigh", "shank", "shank_end", "spine")
    offsets = np.array([[0, 0, 0.9], [0.1, 0, 0], [0, 0, -0.4], [0, 0, -0.4], [0, 0, 0.5]])
    skeleton = Skeleton(names, (-1, 0, 1, 2, 0), offsets)
    turns = np.tile([1.0, 0, 0, 0], (12, 5, 1))
    motion = Motion(skeleton, turns, np.tile([0, 0, 0.9], (12, 1)), 30.0)
    return _written(lambda path: write_bvh(motion, path))


def tracks() -> Tracks:
    positions = np.random.default_rng(3).normal(size=(20, 4, 3))
    positions[2:5, 1] = np.nan
    return Tracks(("LASI", "RASI", "C7", "HEAD"), positions, 100.0)


def _written(write) -> bytes:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "take"
        write(path)
        return path.read_bytes()


WHOLE = {
    "bvh": bvh_bytes(),
    "c3d": _written(lambda path: write_c3d(tracks(), path)),
    "trc": _written(lambda path: write_trc(tracks(), path)),
    "amc": RECORDING,
    "asf": SKELETON,
}
TOKENS = [
    b"", b"0", b"-1", b"999999999", b"1e308", b"nan", b"inf", b"{", b"}", b"\n", b"\0", b"\xff",
    b"JOINT", b"ROOT x", b"End Site", b"CHANNELS 6", b"OFFSET", b":bonedata", b"begin", b"end",
    b"root", b"thigh", b"dof rx", b"axis", b"\x1c", b"\xff\xff", b"\x7f\xff", b"\x00\x80",
    b"\t", b"\t" * 300, b"Frame#\tTime\t", b"\nDataRate\t", b",", b"\r", b"mm", b"1\t0.01\t",
]  # fmt: skip


@pytest.mark.parametrize("kind", ["bvh", "c3d", "trc", "amc"])
def test_a_damaged_recording(kind, tmp_path):
    path = tmp_path / f"take.{kind}"
    (tmp_path / "take.asf").write_bytes(SKELETON)

    @searching(EXAMPLES)
    @given(damaged(WHOLE[kind], TOKENS))
    def search(content: bytes) -> None:
        path.write_bytes(content)
        read_or_refuse(lambda: read_recording(path))

    search()


def test_a_damaged_skeleton(tmp_path):
    (tmp_path / "take.amc").write_bytes(RECORDING)

    @searching(EXAMPLES)
    @given(damaged(SKELETON, TOKENS))
    def search(content: bytes) -> None:
        (tmp_path / "take.asf").write_bytes(content)
        read_or_refuse(lambda: read_acclaim(tmp_path / "take.amc"))

    search()
