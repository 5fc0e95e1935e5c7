"""Damaged joint recordings are read or refused: see test_fuzz.py, whose bounds hold here."""

import pytest
from complete_files import JOINT_FILES, JOINT_TOKENS
from damage import damaged, read_or_refuse, searching
from hypothesis import given

from solvers.recordings import read_recording

EXAMPLES = 30


@pytest.mark.parametrize("kind", JOINT_FILES)
def test_undamaged_files_are_read_and_detected_by_content(kind, tmp_path):
    read, complete = JOINT_FILES[kind]
    (tmp_path / "take").write_bytes(complete)

    one, other = read(tmp_path / "take"), read_recording(tmp_path / "take")

    assert type(one) is type(other)
    assert one.n_frames == other.n_frames > 2


@pytest.mark.parametrize("kind", JOINT_FILES)
def test_damaged_joint_files_are_read_or_refused(kind, tmp_path):
    read, complete = JOINT_FILES[kind]
    path = tmp_path / "take"

    @searching(EXAMPLES)
    @given(damaged(complete, JOINT_TOKENS))
    def search(content: bytes) -> None:
        path.write_bytes(content)
        read_or_refuse(lambda: read(path))
        read_or_refuse(lambda: read_recording(path))

    search()


@pytest.mark.parametrize("kind", JOINT_FILES)
def test_progress_rises_to_the_end(kind, tmp_path):
    read, complete = JOINT_FILES[kind]
    (tmp_path / "take").write_bytes(complete)
    messages = []

    read(tmp_path / "take", progress=lambda fraction, message="": messages.append(fraction))

    assert messages == sorted(messages)
    assert messages[-1] == pytest.approx(1.0)
