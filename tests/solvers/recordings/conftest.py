"""What the tests of BVH share."""

import pytest

from solvers.recordings import read_bvh


@pytest.fixture
def read(tmp_path):
    """Read a BVH file of this text."""

    def read_text(text: str | bytes, **options):
        path = tmp_path / "take.bvh"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return read_bvh(path, **options)

    return read_text
