"""OpenCap's JSON of an OpenSim model: positions and angles of segments, Y up, facing +X."""

import json

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.spatial.transform import Rotation

from solvers.errors import InvalidFileError
from solvers.motion import find_humanoid_map, world_poses
from solvers.recordings import read_recording

F = 40
SEGMENTS = {
    "pelvis": ("", (0.0, 0.95, 0.0)), "torso": ("pelvis", (-0.1, 0.08, 0.0)),
    "humerus": ("torso", (0.0, 0.4, 0.17)), "ulna": ("humerus", (0.01, -0.28, -0.01)),
    "radius": ("ulna", (0.0, -0.01, 0.02)), "hand": ("radius", (-0.01, -0.24, 0.01)),
    "femur": ("pelvis", (-0.06, -0.08, 0.08)), "tibia": ("femur", (0.0, -0.41, 0.0)),
    "talus": ("tibia", (0.0, -0.4, 0.0)), "calcn": ("talus", (-0.05, -0.04, 0.01)),
    "toes": ("calcn", (0.18, 0.0, 0.0)),
}  # fmt: skip
"""Parent and offset of each segment in the neutral pose, of the right side at +Z."""
CENTER = ("pelvis", "torso")


def opencap(rng, rate=60.0, n_frames=F):
    """Return the JSON of a model that moves, and the positions of its segments."""
    names = [
        name + side for name in SEGMENTS for side in ([""] if name in CENTER else ["_r", "_l"])
    ]
    rotations, positions, bodies = {}, {}, {}
    times = np.arange(n_frames) / rate
    for name in names:
        part, _, side = name.partition("_")
        parent, offset = SEGMENTS[part]
        above = parent if parent in CENTER or not parent else f"{parent}_{side}"
        angles = 0.4 * np.sin(3.0 * times[:, None] + rng.uniform(0.0, 6.0, 3))
        own = Rotation.from_euler("xyz", angles)
        mirrored = np.array(offset) * (1.0, 1.0, -1.0 if side == "l" else 1.0)
        if parent:
            rotations[name] = rotations[above] * own
            positions[name] = positions[above] + rotations[above].apply(mirrored)
        else:
            rotations[name] = own
            positions[name] = mirrored + times[:, None] * (1.2, 0.0, 0.0)
        bodies[name] = {
            "attachedGeometries": [f"{name}.vtp"],
            "scaleFactors": [1.0, 1.0, 1.0],
            "rotation": rotations[name].as_euler("XYZ").tolist(),
            "translation": positions[name].tolist(),
        }
    knee = {**bodies["tibia_r"], "translation": (positions["tibia_r"] + 0.05).tolist()}
    bodies["patella_r"] = knee
    return {"time": times.tolist(), "bodies": bodies}, positions


def saved(path, content):
    path.write_text(json.dumps(content))
    return path


def test_segments_are_where_the_file_has_them(tmp_path, rng):
    content, positions = opencap(rng)

    motion = read_recording(saved(tmp_path / "take.json", content))

    assert motion.frame_rate == 60.0
    assert "patella_r" not in motion.skeleton.names
    poses = world_poses(motion.skeleton, motion.rotations, motion.root_positions).positions
    for index, name in enumerate(motion.skeleton.names):
        x, y, z = positions[name].T
        assert_allclose(poses[:, index], np.stack([x, -z, y], axis=1), atol=1e-6)


def test_the_rest_pose_stands_and_faces_the_front_with_all_limbs(tmp_path, rng):
    motion = read_recording(saved(tmp_path / "take.json", opencap(rng)[0]))

    rest = dict(zip(motion.skeleton.names, motion.skeleton.rest_positions, strict=True))
    assert_allclose(rest["femur_l"] - rest["femur_r"], (0.16, 0.0, 0.0), atol=1e-6)
    assert_allclose(rest["toes_r"] - rest["calcn_r"], (0.0, -0.18, 0.0), atol=1e-6)
    found = find_humanoid_map(motion.skeleton)
    assert found.score > 0.9
    assert found.joint("leftFoot") == "talus_l" and found.joint("rightHand") == "hand_r"
    assert found.joint("leftLowerArm") == "ulna_l" and found.joint("spine") == "torso"


def test_times_that_fill_the_first_bytes_hide_no_segments(tmp_path, rng):
    content, _ = opencap(rng, n_frames=1500)

    assert read_recording(saved(tmp_path / "take.json", content)).n_frames == 1500


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (lambda content: content["bodies"]["toes_l"].pop("rotation"), "rotation of toes_l"),
        (lambda content: content["time"].pop(), "numbers are required"),
        (lambda content: content["bodies"].update(ulna_r=3), "translation of ulna_r"),
    ],
)
def test_incomplete_files_are_refused(tmp_path, rng, damage, words):
    content, _ = opencap(rng)
    damage(content)

    with pytest.raises(InvalidFileError, match=words):
        read_recording(saved(tmp_path / "take.json", content))
