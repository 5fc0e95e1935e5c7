"""A BVH file read here and imported by Blender is the same motion."""

import importlib.util
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.motion import forward_kinematics
from solvers.recordings import read_bvh, write_bvh

SCRIPT = Path(__file__).with_name("import_in_blender.py")
STEP = 25
SINGLE_PRECISION = 2e-4

pytestmark = pytest.mark.skipif(
    importlib.util.find_spec("bpy") is None, reason="there is no Blender here (module bpy)"
)


@pytest.fixture
def in_blender(tmp_path):
    """Import a file in a Blender of its own; returns names and positions of all bones."""

    def imported(path: Path) -> tuple[list[str], np.ndarray]:
        target = tmp_path / "found.npz"
        command = [sys.executable, SCRIPT, path, target, str(STEP)]
        subprocess.run(command, check=True, capture_output=True, timeout=500)
        with np.load(target) as found:
            return found["names"].tolist(), found["positions"]

    return imported


@pytest.mark.parametrize(
    ("file", "unit", "tolerance"),
    [
        ("mocap/cmu_walk/07_12.bvh", 0.0254 / 0.45, SINGLE_PRECISION),
        ("formats/bvh/xsens_walk.bvh", 0.001, SINGLE_PRECISION),
        ("formats/bvh/milad.bvh", 0.01, 0.03),  # Its hips and shoulders stretch, ours do not.
    ],
)
def test_joints_are_where_blender_puts_them(recordings, in_blender, file, unit, tolerance):
    path = recordings / file

    names, theirs = in_blender(path)

    motion = read_bvh(path)
    joints = [motion.skeleton.index(name) for name in names]
    ours = forward_kinematics(motion).positions[::STEP, joints]
    assert len(joints) > 18
    assert_allclose(ours, unit * theirs, atol=tolerance)


def test_what_we_write_blender_reads(swinging_leg, in_blender, tmp_path):
    write_bvh(swinging_leg, tmp_path / "leg.bvh")

    names, theirs = in_blender(tmp_path / "leg.bvh")

    assert names == ["hip", "knee", "ankle"]
    ours = forward_kinematics(swinging_leg).positions[::STEP, :3]
    assert_allclose(0.01 * theirs, ours, atol=1e-5)
