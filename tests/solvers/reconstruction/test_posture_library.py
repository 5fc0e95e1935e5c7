"""Build posture libraries from clips, save and load them."""

import numpy as np
import pytest

from solvers.errors import InvalidFileError, InvalidMotionError
from solvers.motion.humanoid.body_size import ADULT_BONE_LENGTHS_M, estimate_bone_lengths
from solvers.motion.humanoid.bone_directions import (
    bone_directions,
    positions_from_directions,
    rates_from_directions,
)
from solvers.motion.humanoid.posture_heading import mirror_postures, normalize_postures
from solvers.motion.humanoid.posture_joints import POSTURE_JOINTS, postures_from_motion
from solvers.reconstruction.joint_rotations.library_body import (
    CORRECTED_BONES,
    bone_axis_corrections,
    build_body_postures,
)
from solvers.reconstruction.pose_library.posture_library import (
    LAYOUT,
    SHIPPED_LIBRARY,
    PostureLibrarySettings,
    build_posture_library,
    load_posture_library,
)
from solvers.reconstruction.pose_library.subsample import subsample_postures
from solvers.samples import GaitSettings, walking_gait


@pytest.fixture(scope="module")
def gait():
    return walking_gait(GaitSettings(duration=3.0, frame_rate=30.0))


@pytest.fixture(scope="module")
def library(gait):
    settings = PostureLibrarySettings(spacing=0.02)
    return build_posture_library([gait], settings=settings, trained_on="a made walk")


@pytest.fixture(scope="module")
def walk(gait):
    return normalize_postures(postures_from_motion(gait), 30.0).postures


def test_directions_and_lengths_restore_the_posture(walk):
    for one in walk[::20, None]:
        postures = positions_from_directions(bone_directions(one), estimate_bone_lengths(one))
        np.testing.assert_allclose(postures, one, atol=1e-9)


def test_changes_of_a_constant_rotation_equal_its_speed():
    angle = 2.0 * np.arange(30) / 30.0
    smooth = np.stack([angle, 0.5 * angle, -angle], axis=-1)
    np.testing.assert_allclose(
        rates_from_directions(smooth, 30.0), np.tile([2.0, 1.0, -2.0], (30, 1))
    )


def test_mirrored_posture_has_left_and_right_swapped(walk):
    left, right = (POSTURE_JOINTS.index(f"{side}Hand") for side in ("left", "right"))
    np.testing.assert_array_equal(mirror_postures(walk)[:, left], walk[:, right] * (-1, 1, 1))
    np.testing.assert_array_equal(mirror_postures(mirror_postures(walk)), walk)


def test_subsampled_postures_are_distinct_and_cover_the_rest():
    random = np.random.default_rng(0)
    displacements = random.normal(size=(3, 60)) * 0.1
    directions = (random.normal(size=(400, 3)) @ displacements).reshape(400, 20, 3)
    spacing = 0.03
    subsample = subsample_postures(directions, 400, spacing)
    points = positions_from_directions(directions, ADULT_BONE_LENGTHS_M).reshape(400, -1)
    displacements = np.linalg.norm(points[:, None] - points[subsample], axis=-1) / np.sqrt(20.0)
    among = displacements[subsample] + np.eye(len(subsample))
    assert 1 < len(subsample) < 400
    assert among.min() > 0.8 * spacing  # compared in principal components
    assert displacements.min(axis=1).max() < 1.2 * spacing


def test_library_contains_the_postures_of_its_clip(gait, library, walk):
    body = build_body_postures(library.directions, library.changes, estimate_bone_lengths(walk))
    postures = np.concatenate([walk, mirror_postures(walk)]).reshape(-1, 60)
    distances = np.linalg.norm(postures[:, None] - body.positions.reshape(-1, 60), axis=-1)
    assert distances.min(axis=1).max() / np.sqrt(20.0) < 0.05
    assert library.n_postures < library.n_seen
    separate = build_posture_library(
        [gait], settings=PostureLibrarySettings(mirror=False, spacing=0.02)
    )
    assert library.n_seen == 2 * separate.n_seen


def test_smaller_libraries_hold_the_most_different_postures(gait, library):
    few = build_posture_library([gait], settings=PostureLibrarySettings(n_postures=10))
    np.testing.assert_array_equal(few.directions, library.directions[:10])


def test_load_restores_a_saved_library(library, tmp_path):
    library.save(tmp_path / "postures.npz")
    read = load_posture_library(tmp_path / "postures.npz")
    np.testing.assert_allclose(read.directions, library.directions, atol=2e-3)
    np.testing.assert_allclose(np.linalg.norm(read.directions[:, 1:], axis=-1), 1.0, rtol=1e-5)
    np.testing.assert_allclose(read.changes, library.changes, atol=0.07)
    assert (read.n_seen, read.trained_on) == (library.n_seen, "a made walk")


def test_shipped_library_is_small_and_names_its_sources():
    library = load_posture_library()
    assert 1000 <= library.n_postures <= 5000
    assert "CMU" in library.trained_on
    assert "UI-PRMD" in library.trained_on
    assert SHIPPED_LIBRARY.stat().st_size < 600_000


def test_shipped_library_has_twists_of_clips_with_rotations():
    twists = np.abs(load_posture_library().twists_or_zero)

    knowing = (twists > 0.0).all(axis=1)
    assert knowing.sum() == 2500  # of CMU; UI-PRMD has positions of markers
    assert twists[knowing].min() > 0.5


@pytest.mark.parametrize("fault", ["missing", "zero", "shape"])
def test_load_raises_for_damaged_libraries(library, tmp_path, fault):
    directions = np.round(library.directions[:, 1:] * 500).astype(np.int16)
    arrays = {
        "directions": 0 * directions if fault == "zero" else directions,
        "changes": directions[:-1] if fault == "shape" else directions,
        "groups": library.groups,
        "n_seen": np.array(3),
        "trained_on": np.array(""),
    }
    if fault == "missing":
        del arrays["groups"]
    LAYOUT.write(tmp_path / "bad.npz", arrays)
    with pytest.raises(InvalidFileError, match=r"damaged postures .* Build them again"):
        load_posture_library(tmp_path / "bad.npz")


def test_build_raises_without_postures():
    with pytest.raises(InvalidMotionError, match="Choose clean clips"):
        build_posture_library([])


def test_bone_axis_corrections_recover_known_rotations(walk, library):
    """Rotate the bones of the observed body by given angles; one frame shows hardly any."""
    lengths = estimate_bone_lengths(walk)
    rotations = np.tile(np.eye(3), (20, 1, 1))
    cos, sin = np.cos(0.3), np.sin(0.3)
    for bone, name in enumerate(POSTURE_JOINTS):
        side = 1.0 if "left" in name else -1.0
        if bone in CORRECTED_BONES and name not in {"spine", "chest", "head"}:
            rotations[bone] = [[cos, 0, side * sin], [0, 1, 0], [-side * sin, 0, cos]]
    directions = bone_directions(walk)
    observed = build_body_postures(
        directions, np.zeros_like(directions), lengths, rotations
    ).positions
    plain = positions_from_directions(directions, lengths)
    reliability = np.full(walk.shape[:2], 100.0)
    found = build_body_postures(
        directions,
        0 * directions,
        lengths,
        bone_axis_corrections(observed, reliability, directions, lengths),
    ).positions
    before, after = (np.linalg.norm(each - observed, axis=-1).mean() for each in (plain, found))
    assert before > 0.02
    assert after < 0.25 * before
    once = bone_axis_corrections(observed[:1], np.ones((1, 20)), directions[:1], lengths)
    assert np.abs(once - np.eye(3)).max() < 0.1
