"""Missing joints of a take are reconstructed from the postures of similar clips."""

from dataclasses import replace

import numpy as np
import pytest

from solvers.motion import Motion, resample
from solvers.reconstruction import load_posture_library, reconstruct
from solvers.reconstruction.pose_library.posture_library import merge_posture_libraries
from solvers.recordings import read_acclaim
from solvers.retrieval import Clip, build_clip_library
from solvers.workflows import postures_from_library, reconstruct_from_library
from solvers.workflows.reconstruct_motion import postures_recording

MISSING = ("KneeLeft", "AnkleLeft", "FootLeft")


@pytest.fixture(scope="module")
def clips(request) -> dict[str, Motion]:
    """Lying down, squats and kicks of two actors, at 30 Hz."""
    hdm05 = request.getfixturevalue("recordings") / "mocap" / "hdm05"
    return {
        path.stem.removeprefix("HDM_"): resample(read_acclaim(path), 30.0)
        for actor in ("bk", "dg")
        for kind in ("lieDownFloor", "squat1Reps", "kickLFront1Reps")
        for path in sorted(hdm05.glob(f"HDM_{actor}_{kind}_*_120.amc"))[:3]
    }


@pytest.fixture(scope="module")
def library(clips):
    return build_clip_library(Clip(name, motion) for name, motion in clips.items())


@pytest.fixture
def squat(clips):
    """A squat with the left leg missing in the middle, and its true positions."""
    name = next(name for name in clips if name.startswith("dg_squat"))
    truth = postures_recording(clips[name])
    positions = truth.tracks.positions.copy()
    columns = [truth.tracks.names.index(joint) for joint in MISSING]
    middle = len(positions) // 2
    hidden = slice(middle - 12, middle + 12)
    positions[hidden, columns] = np.nan
    recording = replace(truth, tracks=truth.tracks.with_positions(positions))
    return recording, truth.tracks.positions[hidden][:, columns], hidden, columns


def of_others(clips):
    return [name for name in clips if name.startswith("dg")]


def test_missing_limbs_are_closer_than_with_shipped_postures(clips, library, squat):
    recording, truth, hidden, columns = squat

    found = reconstruct_from_library(
        recording, library, ignore=of_others(clips), fetch=lambda entry: clips[entry.name]
    )
    default = reconstruct(recording)

    errors = [
        np.linalg.norm(one.tracks.positions[hidden][:, columns] - truth, axis=-1).mean()
        for one in (found, default)
    ]
    assert errors[0] < 0.9 * errors[1]
    assert found.method.startswith("Learned from 9 clips of the library: bk_squat1Reps")


def test_motion_of_a_skeleton_can_be_the_query(clips, library):
    name = next(iter(of_others(clips)))
    found = postures_from_library(
        clips[name], library, ignore=of_others(clips), fetch=lambda entry: clips[entry.name]
    )
    assert found.clips[0].startswith("bk_lieDownFloor")
    assert found.postures.n_postures > load_posture_library().n_postures


def test_result_equals_that_without_a_library_when_no_clip_matches(squat):
    recording = squat[0]
    empty = reconstruct_from_library(recording, build_clip_library([]))
    default = reconstruct(recording)
    np.testing.assert_array_equal(empty.tracks.positions, default.tracks.positions)
    assert empty.method.startswith("No clip of the library is similar to this take; ")


def test_joined_libraries_have_the_postures_of_both():
    shipped = load_posture_library()
    part = replace(
        shipped, directions=shipped.directions[:50], changes=shipped.changes[:50],
        groups=shipped.groups[:50], n_seen=60, trained_on="a few",
    )  # fmt: skip
    joined = merge_posture_libraries(part, shipped)
    assert joined.n_postures == shipped.n_postures + 50
    assert joined.n_seen == shipped.n_seen + 60
    assert joined.trained_on == f"a few, and {shipped.trained_on}"
    np.testing.assert_array_equal(joined.directions[50:], shipped.directions)
    assert joined.groups.shape == (joined.n_postures,)
