"""Poses of segments in C3D files of Theia3D: a body stands, gaps are NaN, damage is refused."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from solvers.errors import InvalidFileError
from solvers.motion import Motion, Tracks, find_humanoid_map, world_poses
from solvers.recordings import read_recording
from solvers.recordings.containers import C3dFile

FIRST_POSE = 5 * 512
POSE_BYTES = 17 * 4


@pytest.fixture
def path(recordings):
    return recordings / "corpus/lab/c3d_rotation/C3DRotationExample.c3d"


def origins(path):
    """Return the translations of the file, shape (340, 21, 3), meters, as they are."""
    words = np.frombuffer(path.read_bytes(), "<f4", 340 * 21 * 17, FIRST_POSE)
    return 0.001 * words.reshape(340, 21, 17)[..., 12:15].astype(float)


def test_the_segments_of_a_body_become_its_motion(path):
    motion = read_recording(path)

    assert isinstance(motion, Motion)
    assert (motion.n_frames, motion.frame_rate) == (340, 85.0)
    assert "worldbody" not in motion.skeleton.names
    found = find_humanoid_map(motion.skeleton)
    assert found.score > 0.9
    assert found.joints["leftUpperArm"] == "l_uarm"
    poses = world_poses(motion.skeleton, motion.rotations, motion.root_positions)
    labels = [
        label.removesuffix("_4X4").lower() for label in C3dFile(path).texts("ROTATION:LABELS")
    ]
    file = origins(path)
    for name in ("l_thigh", "r_foot", "r_hand", "head", "l_toes"):
        ours = poses.positions[:, motion.skeleton.names.index(name)]
        distance = np.linalg.norm(ours - file[:, labels.index(name)], axis=-1)
        assert np.nanmax(distance) < 0.03, name  # The trunk bends between its two segments.
        assert np.isfinite(distance).sum() > 330


def test_the_rest_pose_stands_and_faces_us(path):
    motion = read_recording(path)

    rest = dict(zip(motion.skeleton.names, motion.skeleton.rest_positions, strict=True))
    assert rest["head"][2] > rest["pelvis"][2] > rest["l_foot"][2]
    assert rest["l_thigh"][0] > rest["r_thigh"][0]
    assert rest["l_toes"][1] < rest["l_foot"][1]


def test_poses_with_a_negative_residual_are_gaps(path, tmp_path):
    content = bytearray(path.read_bytes())
    pelvis = FIRST_POSE + (100 * 21 + 1) * POSE_BYTES
    content[pelvis + 64 : pelvis + 68] = np.float32(-1.0).tobytes()
    (tmp_path / "gap.c3d").write_bytes(content)

    motion = read_recording(tmp_path / "gap.c3d")

    assert np.isnan(motion.root_positions[100]).all()
    assert np.isfinite(motion.root_positions[[99, 101]]).all()


def test_segments_of_no_body_become_points_with_a_report(path, tmp_path, collected_messages):
    content = path.read_bytes()
    for number, label in enumerate((b"thigh", b"shank", b"uarm", b"larm", b"foot", b"hand")):
        content = content.replace(label, (b"q%d" % number).ljust(len(label), b"z"))
    (tmp_path / "props.c3d").write_bytes(content)

    tracks = read_recording(tmp_path / "props.c3d", progress=collected_messages[1])

    assert isinstance(tracks, Tracks)
    assert tracks.n_points == 21
    assert any("come in as points" in message for message in collected_messages[0])
    assert_allclose(tracks.positions[100, 1], origins(path)[100, 1], atol=1e-5)


@pytest.mark.parametrize("n_bytes", [600, FIRST_POSE - 10, FIRST_POSE + 5000])
def test_a_file_cut_short_is_refused(path, tmp_path, n_bytes):
    (tmp_path / "cut.c3d").write_bytes(path.read_bytes()[:n_bytes])

    with pytest.raises(InvalidFileError, match=r"cut short|damaged|has no points"):
        read_recording(tmp_path / "cut.c3d")


def test_a_scale_replaces_the_unit(path):
    larger = read_recording(path, scale=0.002)

    assert larger.skeleton.height == pytest.approx(2.0 * read_recording(path).skeleton.height)
