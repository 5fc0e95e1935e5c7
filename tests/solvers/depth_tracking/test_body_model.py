"""The body has the documented parts, lengths and symmetry."""

import pickle

import numpy as np
import pytest
from numpy.testing import assert_allclose, assert_array_equal

from solvers.depth_tracking.body.coordinates import COORDINATES
from solvers.depth_tracking.body.model import BodyModel, default_body, load_body_model
from solvers.depth_tracking.body.segment_kinematics import joint_positions, segment_frames
from solvers.depth_tracking.body.tables import CAPSULES, JOINTS, LENGTHS, PARENTS, SEGMENTS
from solvers.errors import InvalidFileError, InvalidMotionError
from solvers.motion.humanoid.roles import HUMANOID_ROLES


def joint(body, pose, name):
    return joint_positions(body, segment_frames(body, pose))[JOINTS.index(name)]


def test_parts_equal_those_of_the_paper():
    """[WZC12] section 2: 15 segments and 34 coordinates, head 3, neck 2, lower back 3, ...

    This body also has two flexible feet.
    """
    assert (len(SEGMENTS), len(COORDINATES)) == (15 + 2, 34 + 2)
    for start, n in {"lowerBack": 3, "lowerNeck": 2, "head": 3, "leftClavicle": 2,
                     "rightHumerus": 3, "leftRadius": 1, "rightFemur": 3,
                     "leftTibia": 1, "rightAnkle": 1}.items():  # fmt: skip
        assert sum(name.startswith(start) for name in COORDINATES) == n
    assert set(JOINTS) <= set(HUMANOID_ROLES)
    assert all(parent < child for child, parent in enumerate(PARENTS))


def test_default_body_has_the_requested_stature():
    body = default_body(1.75)
    frames = segment_frames(body, np.zeros(36))
    crown = crown_height(body, frames)
    sole = joint(body, np.zeros(36), "leftFoot")[1] + 0.25 * body.length("leftFoot") + 0.038

    assert_allclose(sole - crown, 1.75, atol=0.03)
    assert_allclose(default_body(1.4).lengths / default_body(1.75).lengths, 1.4 / 1.75)


def crown_height(body, frames):
    head = CAPSULES.index("head")
    top = frames[SEGMENTS.index("head"), :3, 3] + body.capsule_ends[head, 1]
    return top[1] - body.radii[head, 1]


def test_joint_distances_equal_the_lengths(rng):
    body, pose = default_body(), rng.normal(scale=0.5, size=36)
    for upper, lower, length in (
        ("leftUpperArm", "leftLowerArm", "leftUpperArm"),
        ("rightLowerArm", "rightHand", "rightLowerArm"),
        ("leftUpperLeg", "leftLowerLeg", "leftUpperLeg"),
        ("rightLowerLeg", "rightFoot", "rightLowerLeg"),
    ):
        distances = joint(body, pose, upper) - joint(body, pose, lower)
        assert_allclose(np.linalg.norm(distances), body.length(length), atol=1e-12)
    hips = joint(body, pose, "leftUpperLeg") - joint(body, pose, "rightUpperLeg")
    assert_allclose(np.linalg.norm(hips), 2 * body.length("hipWidth"), atol=1e-12)


def test_symmetric_takes_the_mean_of_both_sides():
    body = default_body().with_lengths(leftUpperArm=0.20, rightUpperArm=0.30, chest=0.33)

    even = body.symmetric()

    assert_allclose([even.length("leftUpperArm"), even.length("rightUpperArm")], 0.25)
    assert even.length("chest") == 0.33
    assert_allclose(even.symmetric().lengths, even.lengths)


def test_load_body_model_restores_a_saved_body(tmp_path):
    body = default_body(1.62).with_lengths(hipWidth=0.11)
    body.save(tmp_path / "body.npz")

    loaded = load_body_model(tmp_path / "body.npz")

    assert_array_equal(loaded.lengths, body.lengths)
    assert_array_equal(loaded.radii, body.radii)


def test_load_body_model_raises_for_damaged_or_foreign_files(tmp_path):
    body, path = default_body(), tmp_path / "body.npz"
    with pytest.raises(InvalidFileError, match="no file"):
        load_body_model(path)
    body.save(path)
    path.write_bytes(path.read_bytes()[:200])
    with pytest.raises(InvalidFileError, match="not a readable archive"):
        load_body_model(path)
    sizes = {"kind": "body model", "version": 1, "lengths": body.lengths, "radii": body.radii}
    np.savez(path, **sizes)
    with pytest.raises(
        InvalidFileError, match=r"damaged body \('length_names', 'capsule_names' missing"
    ):
        load_body_model(path)
    np.savez(path, **sizes, length_names=np.array(["a"] * 20), capsule_names=np.array(["b"]))
    with pytest.raises(InvalidFileError, match="other parts"):
        load_body_model(path)


@pytest.mark.parametrize(
    ("lengths", "radii", "words"),
    [
        (np.ones(3), np.ones((19, 2)), "lengths of a body have shape"),
        (np.ones(20), np.ones((19, 1)), "radii of a body have shape"),
        (np.full(20, np.nan), np.ones((19, 2)), "lengths of a body must all be from 0.001"),
        (np.ones(20), np.full((19, 2), 9e-4), "radii of a body must all be from 0.001"),
        (np.full(20, 101.0), np.ones((19, 2)), "lengths of a body must all be from 0.001 to"),
    ],
)
def test_body_model_raises_for_invalid_values(lengths, radii, words):
    assert (len(LENGTHS), len(CAPSULES)) == (20, 19)
    with pytest.raises(InvalidMotionError, match=words):
        BodyModel(lengths, radii)
    with pytest.raises(InvalidMotionError, match=r"The stature 3 m is invalid"):
        default_body(3.0)


def test_pickle_excludes_cached_properties():
    """Callers compare pickles to detect whether a body was changed."""
    body = default_body()
    before = pickle.dumps(body)
    assert body.offsets.shape == (len(JOINTS), 3) and body.capsule_ends.shape[0] == 19

    assert pickle.dumps(body) == before

    again = pickle.loads(before)
    assert_array_equal(again.lengths, body.lengths)
    assert_array_equal(again.radii, body.radii)
    assert not (again.lengths.flags.writeable or again.radii.flags.writeable)
