"""Why a joint of an armature is reliable or not: three terms, and which are missing."""

from dataclasses import replace

import numpy as np
import pytest
from kinect_walks import HIDDEN, OCCLUDED_FRAMES, tracked_walk, true_positions

import solvers.motion as motion_module
from solvers import samples
from solvers.errors import InvalidMotionError
from solvers.motion import Skeleton, motion_from_points
from solvers.motion.humanoid import posture_joints
from solvers.workflows import reconstruct_motion

GUESSED = 0.5  # what an inferred joint counts for


@pytest.fixture
def walk():
    return tracked_walk(motion_module, true_positions(samples, posture_joints))


@pytest.fixture
def moved(walk):
    """The motion of an armature that the recording was imported as."""
    return motion_from_points(walk.tracks, walk.parents)


def of(values, motion, name):
    return values[:, motion.skeleton.index(name)]


def test_tracking_term_is_that_of_the_sensor(walk, moved):
    order = [walk.names.index(name) for name in moved.skeleton.names]

    reliability = reconstruct_motion(
        moved, tracking_state=walk.tracking_state[:, order]
    ).reliability_terms

    for name in HIDDEN:
        message = of(reliability.tracking, moved, name)
        assert np.allclose(message[OCCLUDED_FRAMES], GUESSED)
        assert np.allclose(
            np.delete(message, np.arange(OCCLUDED_FRAMES.start, OCCLUDED_FRAMES.stop)), 1.0
        )
    assert np.allclose(of(reliability.tracking, moved, "WristRight"), 1.0)


def test_missing_tracking_state_gives_no_term(moved):
    reliability = reconstruct_motion(moved).reliability_terms

    assert np.isnan(reliability.tracking).all()
    assert np.isfinite(reliability.combined).all() and np.isfinite(reliability.behavior).all()


def test_length_term_needs_the_recording_of_an_armature(walk, moved):
    alone = reconstruct_motion(moved).reliability_terms
    with_file = reconstruct_motion(moved, source=walk).reliability_terms

    assert np.isnan(alone.kinematics).all()
    elbow = of(with_file.kinematics, moved, "ElbowLeft")
    assert elbow[OCCLUDED_FRAMES].mean() < 0.8 < np.median(elbow[: OCCLUDED_FRAMES.start])


def test_jittering_joint_has_a_low_behavior_term(walk, moved):
    reliability = reconstruct_motion(moved, source=walk).reliability_terms

    wrist = of(reliability.behavior, moved, "WristLeft")
    assert wrist[OCCLUDED_FRAMES].mean() < 0.7
    assert np.allclose(wrist[: OCCLUDED_FRAMES.start - 3], 1.0)


def test_other_joints_have_no_reliability():
    walk = samples.walking_gait(samples.GaitSettings(duration=1.0, frame_rate=30.0))
    hand = walk.skeleton.index("LeftHand")
    skeleton = Skeleton(
        (*walk.skeleton.names, "Umbrella"),
        (*walk.skeleton.parents, hand),
        np.vstack([walk.skeleton.offsets, (0.0, 0.0, 0.4)]),
    )
    still = np.tile((1.0, 0.0, 0.0, 0.0), (walk.n_frames, 1, 1))
    held = replace(
        walk, skeleton=skeleton, rotations=np.concatenate([walk.rotations, still], axis=1)
    )

    result = reconstruct_motion(held)

    umbrella = skeleton.index("Umbrella")
    for term in (
        result.reliability_terms.combined,
        result.reliability_terms.behavior,
        result.confidence,
    ):
        assert np.isnan(term[:, umbrella]).all()
        assert np.isfinite(np.delete(term, umbrella, axis=1)).any()


@pytest.mark.parametrize("tracked", [True, False])
def test_skeleton_without_positions_is_refused(moved, tracked):
    motion = moved
    if not tracked:
        motion = samples.walking_gait(samples.GaitSettings(duration=1.0, frame_rate=30.0))
    missing = motion.with_poses(motion.rotations, np.full_like(motion.root_positions, np.nan))

    with pytest.raises(InvalidMotionError, match="No joint is tracked in any of the"):
        reconstruct_motion(missing)
