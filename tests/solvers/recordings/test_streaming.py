"""Large text files are read block by block; where the borders fall must not be seen."""

import tracemalloc
from itertools import chain, pairwise

import numpy as np
import pytest
from complete_files import COMPLETE, JOINT_FILES, JOINT_TOKENS, SKELETON, TOKENS
from damage import damaged, searching
from hypothesis import given
from hypothesis import strategies as st

from solvers.errors import InvalidFileError, InvalidMotionError
from solvers.motion import JointRecording, Motion
from solvers.recordings import read_acclaim, read_bvh, read_recording, read_trc
from solvers.recordings.containers import line_reader
from solvers.recordings.containers.growing_table import GrowingTable
from solvers.recordings.containers.line_reader import Block, LineReader
from solvers.recordings.marker_files import trc
from solvers.recordings.skeleton_files import acclaim

FILES = {
    "bvh": (read_bvh, COMPLETE["bvh"], TOKENS),
    "trc": (read_trc, COMPLETE["trc"], TOKENS),
    "amc": (read_acclaim, COMPLETE["amc"], TOKENS),
} | {
    kind: (*JOINT_FILES[kind], JOINT_TOKENS)
    for kind in (
        "csv", "csv with times", "kinect table", "kinect table with times", "azure lines",
        "azure columns",
    )
}  # fmt: skip
ENDS = {"unix": b"\n", "windows": b"\r\n", "old mac": b"\r"}


@pytest.fixture
def message(tmp_path, monkeypatch):
    """What a reader makes of some bytes, in blocks of a size: figures, or its sentence."""
    (tmp_path / "take.asf").write_bytes(SKELETON)
    path = tmp_path / "take.amc"
    monkeypatch.setattr(acclaim, "LINES_OF_HEAD", 3)  # else a small file is all head
    monkeypatch.setattr(trc, "MAX_HEADER_LINES", 8)

    def read_or_error(read, content, size):
        monkeypatch.setattr(line_reader, "BLOCK_BYTES", size)
        path.write_bytes(content)
        try:
            return figures(read(path))
        except (InvalidFileError, InvalidMotionError) as error:
            return str(error)

    return read_or_error


def figures(recording):
    """The content of a recording, comparable with ==."""
    if isinstance(recording, Motion):
        skeleton = recording.skeleton
        arrays = (skeleton.offsets, recording.rotations, recording.root_positions)
        return (skeleton.names, recording.frame_rate, *map(np.ndarray.tobytes, arrays))
    tracks = recording.tracks if isinstance(recording, JointRecording) else recording
    return (tracks.names, tracks.frame_rate, np.ascontiguousarray(tracks.positions).tobytes())


@pytest.mark.parametrize("end", ENDS)
@pytest.mark.parametrize("kind", FILES)
def test_result_is_independent_of_block_borders(kind, end, message):
    read, complete, _ = FILES[kind]
    if kind.startswith("kinect"):
        complete = complete.replace(b"\r\n", b"\n")
    complete = b"\n".join(complete.splitlines()[:60]).replace(b"\n", ENDS[end])
    expected = message(read, complete, len(complete) + 1)
    assert not isinstance(expected, str)

    for size in range(1, 40):
        assert message(read, complete, size) == expected


@pytest.mark.parametrize("kind", FILES)
def test_refusal_is_independent_of_block_borders(kind, message):
    read, complete, tokens = FILES[kind]

    @searching(40)
    @given(damaged(complete, tokens), st.integers(1, 200))
    def search(content, size):
        one, other = message(read, content, size), message(read, content, 1 << 22)
        if kind == "amc" and isinstance(
            one, str
        ):  # of two faults it may read_or_error the second
            one = other if isinstance(other, str) else one
        assert one == other

    search()


@pytest.mark.parametrize("size", [1, 30, 1 << 22])
def test_later_line_of_a_bone_in_a_frame_is_used(size, message):
    complete = COMPLETE["amc"]
    twice = complete.replace(b"thigh 5 2 3\n", b"thigh 80 8 8\nshank 4\nthigh 5 2 3\n")
    assert twice != complete

    assert message(read_acclaim, twice, size) == message(read_acclaim, complete, size)


@given(st.lists(st.sampled_from([b"a", b"\n", b"\r", b"\r\n", b"12 "])), st.integers(1, 5))
def test_lines_are_those_of_splitlines(tmp_path_factory, words, size):
    content = b"".join(words)
    path = tmp_path_factory.mktemp("lines") / "file"
    path.write_bytes(content)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(line_reader, "BLOCK_BYTES", size)
        reader = LineReader(path)
        assert reader.peek(2) == content.splitlines()[:2]
        head = reader.take(1)
        blocks = list(reader.rest())

    assert head + [line for block in blocks for line in block.lines] == content.splitlines()
    numbers = [block.first + at for block in blocks for at in range(len(block.lines))]
    assert numbers == list(range(2, 2 + len(numbers)))
    shares = [share for block in blocks for share in (block.start, block.stop)]
    assert shares == sorted(shares) and all(share <= 1.0 for share in shares)


def test_parts_of_a_block_count_on():
    block = Block(11, [b"long line of words", b"b", b"", b"d", b"e"], 0.2, 0.6)

    parts = list(block.parts(2))

    assert [part.first for part in parts] == [11, 13, 15]
    assert list(chain(*(part.lines for part in parts))) == block.lines
    assert parts[0].start == 0.2 and parts[-1].stop == pytest.approx(0.6)
    assert all(one.stop == other.start for one, other in pairwise(parts))
    assert parts[0].stop > 0.4, "by bytes, not by lines"


def test_a_line_that_never_ends_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr(line_reader, "MAX_LINE_BYTES", 1 << 20)
    monkeypatch.setattr(line_reader, "BLOCK_BYTES", 1 << 16)
    path = tmp_path / "take.csv"
    path.write_bytes(b"mocap-assist-joints,1\n" + b"x" * (5 << 20))

    with pytest.raises(InvalidFileError, match="a line of more than 1 MB"):
        read_recording(path)


@pytest.mark.parametrize("share", [0.0, 0.01, 0.5, 1.0])
def test_table_holds_all_rows_for_any_fraction_read(share, rng):
    blocks = [rng.normal(size=(n_rows, 3)) for n_rows in (1, 0, 7, 300, 2)]
    table = GrowingTable(3)

    for block in blocks:
        table.add(block, share)

    np.testing.assert_array_equal(table.rows(), np.concatenate(blocks))


def test_an_empty_table_has_its_width():
    assert GrowingTable(4).rows().shape == (0, 4)


@pytest.mark.parametrize("kind", ["bvh", "trc", "amc", "csv"])
def test_text_is_never_completely_in_memory(kind, tmp_path, monkeypatch):
    """Only a block is added to three times the numbers, which the readers work on."""
    read, complete, _ = FILES[kind]
    monkeypatch.setattr(line_reader, "BLOCK_BYTES", 1 << 16)
    (tmp_path / "take.asf").write_bytes(SKELETON)
    path = tmp_path / "take.amc"
    lines = complete.splitlines(keepends=True)
    n_frame, blanks = (4 if kind == "amc" else 1), b" " * 1000
    frames = [line.rstrip() + blanks + b"\n" for line in lines[-6 * n_frame :]]
    path.write_bytes(b"".join(lines[: -6 * n_frame]) + b"".join(frames) * 1500)

    tracemalloc.start()
    recording = read(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()

    assert recording.n_frames >= 6 * 1500
    assert path.stat().st_size > 9e6 > peak
