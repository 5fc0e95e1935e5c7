"""Joints in MATLAB files: any order of axes, the clearest name, and what is no joint."""

import numpy as np
import pytest
from scipy.io import savemat

from solvers.errors import InvalidFileError
from solvers.motion import JointRecording
from solvers.motion.skeletons.point_layouts import LAYOUTS
from solvers.recordings import read_recording

F = 40
SMPL = (
    "hips", "leftUpperLeg", "rightUpperLeg", "spine", "leftLowerLeg", "rightLowerLeg", "chest",
    "leftFoot", "rightFoot", "upperChest", "leftToes", "rightToes", "neck", "leftShoulder",
    "rightShoulder", "head", "leftUpperArm", "rightUpperArm", "leftLowerArm", "rightLowerArm",
    "leftHand", "rightHand",
)  # fmt: skip


@pytest.fixture(scope="module")
def body(walker):
    """Positions of the joints of SMPL, shape (F, 22, 3), meters, Z up."""
    return np.stack([walker[role][:F] for role in SMPL], axis=1)


@pytest.mark.parametrize("n_frames", [17, 22, 25, F])
@pytest.mark.parametrize("axes", [(0, 1, 2), (1, 2, 0), (2, 1, 0), (1, 0, 2), (2, 0, 1)])
def test_frames_are_found_on_any_axis(tmp_path, body, axes, n_frames):
    """Also where there are as many frames as joints of this or another order."""
    savemat(tmp_path / "take.mat", {"joints": body[:n_frames].transpose(axes)})

    recording = read_recording(tmp_path / "take.mat")

    assert isinstance(recording, JointRecording)
    assert recording.n_frames == n_frames
    assert recording.names == LAYOUTS["SMPL"]
    sizes = [np.ptp(each[..., 2]) for each in (recording.tracks.positions, body[:n_frames])]
    assert sizes[0] == pytest.approx(sizes[1], abs=1e-3)


@pytest.mark.parametrize("compressed", [False, True])
def test_the_order_of_utd_mhad_keeps_its_sides(tmp_path, walker, compressed):
    """Head first; Y up, and z from the camera, which the actor faces."""
    center = ["head", "upperChest", "spine", "hips"]
    parts = [("UpperArm", "LowerArm", "Hand", "Hand"), ("UpperLeg", "LowerLeg", "Foot", "Toes")]
    limbs = [side + part for limb in parts for side in ("left", "right") for part in limb]
    x, y, z = np.moveaxis(np.stack([walker[role][:F] for role in center + limbs]), -1, 0)
    seen = np.stack([-x, z, 3.0 + y], axis=1)
    savemat(tmp_path / "take.mat", {"d_skel": seen}, do_compression=compressed)

    recording = read_recording(tmp_path / "take.mat")

    assert recording.names == LAYOUTS["UTD-MHAD"]
    left, right = (recording.names.index(f"Shoulder{side}") for side in ("Left", "Right"))
    head, foot, ankle = map(recording.names.index, ("Head", "FootLeft", "AnkleLeft"))
    points = recording.tracks.positions
    assert (points[:, head, 2] > points[:, foot, 2] + 1.0).all()
    across, ahead = points[:, left] - points[:, right], points[:, foot] - points[:, ankle]
    assert (np.cross(across, ahead)[:, 2] < 0.0).mean() > 0.8


def test_the_array_with_the_clearest_name_is_read_at_the_stated_rate(tmp_path, body, rng):
    other = rng.normal(size=(F, 22, 3))
    savemat(
        tmp_path / "take.mat",
        {"velocity": other, "joints": body, "fps": 50.0, "note": "a take", "weights": other},
    )

    recording = read_recording(tmp_path / "take.mat")

    assert (recording.names, recording.frame_rate) == (LAYOUTS["SMPL"], 50.0)


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ({"markers": {"LFHD": np.zeros((5, 3))}}, "none of numbers"),
        ({"angles": np.zeros((5, 7))}, r"without an array of joints over time \(angles\)"),
    ],
)
def test_other_arrays_are_refused_with_what_would_serve(tmp_path, content, words):
    savemat(tmp_path / "take.mat", content)

    with pytest.raises(InvalidFileError, match=words):
        read_recording(tmp_path / "take.mat")


def test_version_7_3_is_refused_with_what_would_serve(tmp_path):
    (tmp_path / "take.mat").write_bytes(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(512))

    with pytest.raises(InvalidFileError, match="Save it again in MATLAB"):
        read_recording(tmp_path / "take.mat")
