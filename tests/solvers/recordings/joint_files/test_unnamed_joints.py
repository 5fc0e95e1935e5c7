"""Arrays of joints without names come in as the body that they form, or as points."""

import numpy as np
import pytest

from solvers.errors import InvalidFileError
from solvers.motion import JointRecording, roles_by_name
from solvers.recordings import Axis, ReadingSettings, read_as, read_recording

LEG, ARM = ("UpperLeg", "LowerLeg", "Foot"), ("UpperArm", "LowerArm", "Hand")


def _both(*parts):
    return [side + part for part in parts for side in ("left", "right")]


def _one(side, *parts):
    return [side + part for part in parts]


ORDERS = {
    "Human3.6M": ["hips", *_one("right", *LEG), *_one("left", *LEG), "spine", "neck", "neck",
                  "head", *_one("left", *ARM), *_one("right", *ARM)],
    "Human3.6M without neck": [
        "hips", *_one("right", *LEG), *_one("left", *LEG), "spine", "neck", "head",
        *_one("left", *ARM), *_one("right", *ARM),
    ],
    "COCO": ["head"] * 5 + _both(*ARM, *LEG),
    "BODY_25": ["head", "neck", *_one("right", *ARM), *_one("left", *ARM), "hips",
                *_one("right", *LEG), *_one("left", *LEG), *["head"] * 4,
                *["leftToes"] * 2, "leftFoot", *["rightToes"] * 2, "rightFoot"],
    "SMPL": ["hips", *_both("UpperLeg"), "spine", *_both("LowerLeg"), "chest", *_both("Foot"),
             "chest", *_both("Toes"), "neck", *_both("Shoulder"), "head", *_both(*ARM)],
}  # fmt: skip
"""Joint of the walker at each index, as the data sets publish them."""
AXES = {
    "Y up": lambda points: np.stack([points[..., 0], points[..., 2], -points[..., 1]], axis=-1),
    "Z up": lambda points: points,
    "camera": lambda points: np.stack(
        [points[..., 0], -points[..., 2], points[..., 1] + 3.0], axis=-1
    ),
}


def ordered(walker, layout):
    return np.stack([walker.get(role, walker["neck"]) for role in ORDERS[layout]], axis=1)


def read(tmp_path, array):
    """Return the recording and what the reader says."""
    np.save(tmp_path / "joints.npy", array)
    said = []
    recording = read_recording(
        tmp_path / "joints.npy", progress=lambda _, text="": said.append(str(text))
    )
    return recording, " ".join(said)


@pytest.mark.parametrize("axes", AXES)
@pytest.mark.parametrize("layout", ORDERS)
def test_a_body_is_named_and_stands(tmp_path, walker, layout, axes):
    recording, said = read(tmp_path, 1000.0 * AXES[axes](ordered(walker, layout)))

    assert isinstance(recording, JointRecording)
    assert f"in the order of {layout} with 100%" in said
    joints = {
        role: recording.tracks.positions[:, recording.names.index(name)]
        for role, name in roles_by_name(recording.names).items()
    }
    for role in ("leftHand", "rightLowerArm", "leftFoot", "rightLowerLeg"):
        from_hips = joints[role] - joints["hips"]
        middle = (walker["leftUpperLeg"] + walker["rightUpperLeg"]) / 2.0
        hips = walker["hips"] if "hips" in ORDERS[layout] else middle
        assert np.allclose(from_hips, walker[role] - hips, atol=1e-6), role
    assert sum(parent < 0 for parent in recording.parents) == 1


def test_mirrored_axes_are_undone_and_reported(tmp_path, walker):
    points = ordered(walker, "SMPL")

    recording, said = read(tmp_path, points * (-1.0, 1.0, 1.0))

    assert "Left and right are swapped" in said
    assert np.allclose(recording.tracks.positions, points)


def test_forward_is_an_axis_of_the_file_that_is_mirrored(tmp_path, walker):
    """In mirrored axes X is where -X is otherwise."""
    np.save(tmp_path / "right.npy", ordered(walker, "SMPL"))
    np.save(tmp_path / "left.npy", ordered(walker, "SMPL") * (-1.0, 1.0, 1.0))

    left, right = (
        read_as(tmp_path / f"{name}.npy", ReadingSettings(forward=axis)).tracks.positions
        for name, axis in (("left", Axis.X), ("right", Axis.MINUS_X))
    )

    assert np.allclose(left, right)


def test_points_without_a_unit_get_the_size_of_an_adult(tmp_path, walker):
    points = ordered(walker, "Human3.6M")

    recording, said = read(tmp_path, 0.1 * points)

    assert "scaled to 1.75 m" in said
    height = np.ptp(recording.tracks.positions[..., 2], axis=1).max()
    assert height == pytest.approx(np.ptp(points[..., 2], axis=1).max(), rel=0.1)


def test_frames_that_are_fitted_into_a_box_get_one_scale(tmp_path, walker):
    """As the demos of pose estimators write them: from 0 to 1 in each frame."""
    points = ordered(walker, "Human3.6M")
    middle = points[:, :1] * (1.0, 1.0, 0.0)
    lowest = points[..., 2].min(axis=1)[:, None, None] * (0.0, 0.0, 1.0)
    placed = points - middle - lowest
    boxed = placed / placed.max(axis=(1, 2), keepdims=True)

    recording, said = read(tmp_path, boxed)

    assert "scaled to 1.75 m" in said
    joints = {role: recording.tracks.positions[:, recording.names.index(name)]
              for role, name in roles_by_name(recording.names).items()}  # fmt: skip
    found = joints["leftHand"] - joints["hips"]
    expected = walker["leftHand"] - walker["hips"]
    size = np.linalg.norm(found, axis=1) / np.linalg.norm(expected, axis=1)
    assert size == pytest.approx(np.median(size), rel=1e-6)
    assert np.median(size) == pytest.approx(1.0, rel=0.1)


@pytest.mark.parametrize("shape", [(1, 17), (4, 6), (3, 8)])
def test_a_board_of_points_is_no_body(tmp_path, shape):
    """Corners of a board for calibration keep their distances, and rows look like limbs."""
    n_frames = 60
    angle = 0.4 * np.sin(np.arange(n_frames) / 9.0)
    corners = 0.08 * np.stack([*np.indices(shape), np.zeros(shape)], axis=-1).reshape(-1, 3)
    x, y, z = corners.T
    sine, cosine = np.sin(angle)[:, None], np.cos(angle)[:, None]
    turned = (cosine * x - sine * y, sine * x + cosine * y, z + angle[:, None])
    moved = np.stack(turned, axis=-1)[..., [1, 2, 0]] + np.array([0.2, 1.0, 2.0])

    recording, said = read(tmp_path, moved)

    assert not isinstance(recording, JointRecording)
    assert "form no body in a known order" in said


def test_points_in_another_order_are_no_body(tmp_path, walker):
    shuffled = np.random.default_rng(2).permutation(17)

    recording, said = read(tmp_path, ordered(walker, "COCO")[:, shuffled])

    assert not isinstance(recording, JointRecording)
    assert "form no body in a known order" in said


@pytest.mark.parametrize("layout", ["Human3.6M", "Human3.6M without neck"])
def test_legs_and_arms_with_other_orders_of_the_sides_are_no_body(tmp_path, walker, layout):
    """Otherwise such legs come in crossed."""
    points = ordered(walker, layout)
    points[:, 1:7] = points[:, [4, 5, 6, 1, 2, 3]]

    assert not isinstance(read(tmp_path, points)[0], JointRecording)


@pytest.mark.parametrize("make", [
    lambda points: points[None],
    lambda points: np.moveaxis(points, 2, 1),
    lambda points: np.moveaxis(points, 0, 2),
    lambda points: points.reshape(len(points), -1),
    lambda points: np.concatenate([points, np.ones_like(points[..., :1])], axis=-1),
    lambda points: np.concatenate([points, np.zeros_like(points[..., :1])], axis=-1),
])  # fmt: skip
def test_other_orders_of_the_axes_are_understood(tmp_path, walker, make):
    points = ordered(walker, "Human3.6M")

    recording, _ = read(tmp_path, make(points))

    assert np.allclose(recording.tracks.positions[:, 0], points[:, 0])


def test_an_archive_of_joints_is_read(tmp_path, walker):
    points = ordered(walker, "COCO")
    np.savez(tmp_path / "joints.npz", keypoints3d=points, scores=np.ones(3))

    recording = read_recording(tmp_path / "joints.npz")

    assert np.allclose(recording.tracks.positions[:, :17], points)


@pytest.mark.parametrize(
    ("stated", "rate"),
    [
        ({"fps": 60}, 60.0),
        ({"frame_rate": np.array([23.976])}, 23.976),
        ({"fps": np.nan}, 30.0),
        ({"fps": np.ones(4)}, 30.0),
        ({"fps": "60"}, 30.0),
    ],
)
def test_an_archive_states_its_rate(tmp_path, walker, stated, rate):
    """Joints at 60 Hz are not read as 30 Hz."""
    said = []
    np.savez(tmp_path / "joints.npz", reconstruction=ordered(walker, "COCO"), **stated)

    recording = read_recording(
        tmp_path / "joints.npz", progress=lambda _, text="": said.append(str(text))
    )

    assert recording.frame_rate == pytest.approx(rate, rel=1e-3)
    assert ("assumed" in " ".join(said)) == (rate == 30.0)


@pytest.mark.parametrize("third", [None, 0.0, 0.9])
def test_points_of_images_are_refused(tmp_path, walker, third):
    flat = 300.0 * ordered(walker, "COCO")[..., [0, 2]]
    scores = np.full_like(flat[..., :1], 0.0 if third is None else third)
    array = flat if third is None else np.concatenate([flat, scores], axis=-1)

    with pytest.raises(InvalidFileError, match="2D points of images, without depth"):
        read(tmp_path, array)
