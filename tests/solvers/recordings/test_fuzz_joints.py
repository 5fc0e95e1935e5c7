"""Damaged joint recordings are read or refused: see test_fuzz.py, whose bounds hold here."""

import pytest
from damage import damaged, read_or_refuse, searching
from hypothesis import given
from whole_files import JOINT_FILES, JOINT_TOKENS

from solvers.recordings import read_recording

EXAMPLES = 60


@pytest.mark.parametrize("kind", JOINT_FILES)
def test_undamaged_files_are_read_and_detected_by_content(kind, tmp_path):
    read, whole = JOINT_FILES[kind]
    (tmp_path / "take").write_bytes(whole)

    one, other = read(tmp_path / "take"), read_recording(tmp_path / "take")

    assert type(one) is type(other)
    assert one.n_frames == other.n_frames > 2


@pytest.mark.parametrize("kind", JOINT_FILES)
def test_damaged_files(kind, tmp_path):
    read, whole = JOINT_FILES[kind]
    path = tmp_path / "take"

    @searching(EXAMPLES)
    @given(damaged(whole, JOINT_TOKENS))
    def search(content: bytes) -> None:
        path.write_bytes(content)
        read_or_refuse(lambda: read(path))
        read_or_refuse(lambda: read_recording(path))

    search()


@pytest.mark.parametrize("kind", JOINT_FILES)
def test_progress_rises_to_the_end(kind, tmp_path):
    read, whole = JOINT_FILES[kind]
    (tmp_path / "take").write_bytes(whole)
    told = []

    read(tmp_path / "take", progress=lambda fraction, message="": told.append(fraction))

    assert told == sorted(told)
    assert told[-1] == pytest.approx(1.0)
