"""A BVH file means what other programs take it to mean, however its exporter spelled it."""

import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidFileError
from solvers.motion import forward_kinematics
from solvers.recordings import read_bvh

ARM = """HIERARCHY
ROOT shoulder
{
  OFFSET 0 140 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  JOINT elbow
  {
    OFFSET 30 0 0
    CHANNELS 3 Zrotation Xrotation Yrotation
    End Site
    {
      OFFSET 25 0 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.0333333
0 140 0  0 0 0  0 0 0
5 141 7  90 0 0  0 0 90
"""


@pytest.fixture
def read(tmp_path):
    """Read a BVH file of this text."""

    def read_text(text: str | bytes, **options):
        path = tmp_path / "take.bvh"
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        return read_bvh(path, **options)

    return read_text


def test_stands_up_and_faces_us(read):
    """Up (Y) becomes Z, and forward (Z) becomes -Y; centimetres become metres."""
    arm = read(ARM)

    assert arm.skeleton.names == ("shoulder", "elbow", "elbow_end")
    assert arm.skeleton.parents == (-1, 0, 1)
    assert_allclose(arm.skeleton.offsets, [[0, 0, 1.4], [0.3, 0, 0], [0.25, 0, 0]], atol=1e-12)
    assert arm.frame_rate == 30.0
    # The shoulder's 90 degrees about Z (towards us, -Y) lift the arm; the elbow's 90 degrees
    # about its own Y, now pointing to -X, turn the forearm from up to forward... by hand:
    # Rz(90) Ry(90) (25, 0, 0) = Rz(90) (0, 0, -25) = (0, 0, -25): backwards, +Y here.
    expected = [[0.05, -0.07, 1.41], [0.05, -0.07, 1.71], [0.05, 0.18, 1.71]]
    assert_allclose(forward_kinematics(arm).positions[1], expected, atol=1e-9)


def test_damaged_files_are_refused_with_the_line(read):
    with pytest.raises(InvalidFileError, match=r"take\.bvh, line 20: 8 numbers .* 9 belong"):
        read(ARM.rsplit(" ", 1)[0])
