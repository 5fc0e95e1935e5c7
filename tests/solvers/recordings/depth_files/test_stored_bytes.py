"""Parts of packed bytes are those of the whole, in whatever order they are asked for."""

import pickle
import tracemalloc
import zlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from solvers.errors import InvalidFileError
from solvers.recordings.containers import stored_bytes
from solvers.recordings.containers.stored_bytes import ByteSlice, PackedBytes, PlainBytes

BEFORE = 11


@pytest.fixture(scope="module")
def complete() -> bytes:
    """Six megabytes that can be packed to less than half."""
    return np.random.default_rng(2).integers(0, 12, 6_000_000).astype(np.uint8).tobytes()


@pytest.fixture(scope="module")
def packed(complete, tmp_path_factory) -> PackedBytes:
    content = zlib.compress(complete, 1)
    path = tmp_path_factory.mktemp("packed") / "bytes"
    path.write_bytes(b"?" * BEFORE + content + b"behind it")
    return PackedBytes(path, BEFORE, len(content), len(complete), 15)


def test_any_range_is_read_in_any_order(complete, packed, monkeypatch):
    monkeypatch.setattr(stored_bytes, "MIN_CHECKPOINT_SPACING", 100_000)
    fresh = pickle.loads(pickle.dumps(packed))

    @given(st.integers(0, len(complete) - 1), st.integers(0, 300_000))
    def part(start: int, count: int) -> None:
        count = min(count, len(complete) - start)
        assert fresh.read(start, count) == complete[start : start + count]

    part()


def test_slice_of_a_slice_is_read(complete, packed):
    inner = ByteSlice(ByteSlice(packed, 100, 5000), 20, 50)

    assert inner.read(3, 7) == complete[123:130]


def test_sequential_reading_needs_little_memory(complete, packed):
    """The marks, and one part: not what was read before."""
    fresh = pickle.loads(pickle.dumps(packed))
    tracemalloc.start()
    for start in range(0, len(complete), 100_000):
        assert fresh.read(start, 100_000) == complete[start : start + 100_000]
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()

    assert peak < 1_500_000


def test_range_beyond_the_end_is_refused_as_truncated(complete, packed, tmp_path):
    with pytest.raises(InvalidFileError, match="is cut short"):
        packed.read(len(complete) - 5, 6)
    (tmp_path / "plain").write_bytes(b"12345")
    with pytest.raises(InvalidFileError, match="is cut short"):
        PlainBytes(tmp_path / "plain", 2, 9).read(0, 4)
    assert PlainBytes(tmp_path / "plain", 2, 3).read(1, 2) == b"45"


def test_bytes_that_belie_their_checksum_are_found_at_once(packed, tmp_path):
    packed.check()
    content = bytearray(packed.path.read_bytes())
    content[BEFORE + packed.packed - 1] ^= 1
    (tmp_path / "altered").write_bytes(content)

    altered = PackedBytes(tmp_path / "altered", BEFORE, packed.packed, packed.size, 15)

    with pytest.raises(zlib.error):
        altered.check()
