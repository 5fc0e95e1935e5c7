"""Damaged files are read or refused: never a crash, a hang, or more memory than the file.

The bytes that are damaged are made here. To search long:
`MOCAP_FUZZ=20000 python -m pytest tests/solvers/recordings/test_fuzz.py`.
"""

import pytest
from complete_files import COMPLETE, RECORDING, SKELETON, TOKENS
from damage import damaged, read_or_refuse, searching
from hypothesis import given

from solvers.recordings import read_acclaim, read_recording

EXAMPLES = 50


@pytest.mark.parametrize("kind", ["bvh", "c3d", "trc", "amc"])
def test_a_damaged_recording(kind, tmp_path):
    path = tmp_path / f"take.{kind}"
    (tmp_path / "take.asf").write_bytes(SKELETON)

    @searching(EXAMPLES)
    @given(damaged(COMPLETE[kind], TOKENS))
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
