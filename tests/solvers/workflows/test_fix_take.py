"""One call fixes a take of any origin, and its report compares before and after."""

import numpy as np
import pytest
from kinect_walks import tracked_walk, true_positions
from marked_bodies import markers_on
from numpy.testing import assert_allclose

from solvers import motion as vocabulary
from solvers import samples
from solvers.denoising import denoise, find_worst_issues, measure_quality, plant_feet
from solvers.errors import InvalidMotionError
from solvers.motion import Motion, Skeleton, Tracks, motion_from_points
from solvers.motion.humanoid import posture_joints
from solvers.rotations.representations import angle_between
from solvers.samples import (
    CorruptionSettings,
    GaitSettings,
    corrupt,
    noisy_walk,
    walking_gait,
)
from solvers.workflows import (
    FixSettings,
    MotionFromJoints,
    TakeOrigin,
    figure_texts,
    find_origin,
    fix_take,
    measure_take,
    reconstruct_recording,
)

WRONG = CorruptionSettings(jitter=3.0, spikes=0.004, root_jitter=0.004, root_sway=0.03)
MISSING = {"RightArm": range(60, 90)}


@pytest.fixture(scope="module")
def walk() -> Motion:
    return walking_gait(GaitSettings(duration=5.0, frame_rate=30.0))


@pytest.fixture(scope="module")
def noisy(walk) -> Motion:
    return corrupt(walk, WRONG, missing=MISSING)


@pytest.fixture(scope="module")
def fixed(noisy):
    return fix_take(noisy)


@pytest.fixture(scope="module")
def camera_walk():
    return tracked_walk(vocabulary, true_positions(samples, posture_joints))


@pytest.fixture(scope="module")
def clean(noisy):
    return denoise(noisy).recording


def test_skeleton_is_cleaned_and_its_feet_are_planted(fixed, clean):
    planted = plant_feet(clean)

    assert fixed.origin is TakeOrigin.SKELETON
    assert_allclose(fixed.recording.rotations, planted.motion.rotations, atol=1e-9)
    assert np.array_equal(fixed.chain.planted.contacts, planted.contacts)


def test_fixed_walk_is_nearer_to_the_truth(fixed, noisy, walk):
    observed = noisy.observed
    before, after = (
        np.degrees(angle_between(each.rotations, walk.rotations)[observed].mean())
        for each in (noisy, fixed.recording)
    )
    assert after < before / 3.0


def test_figures_improve_and_are_those_of_check(fixed):
    before, after = fixed.before.figures(), fixed.after.figures()
    contacts = fixed.chain.planted.contacts
    quality = measure_quality(fixed.recording, contacts=contacts)

    assert before["jitter_deg"] > 2.0 > 0.2 > after["jitter_deg"]
    assert before["longest_foot_slide_cm"] > 5.0 * after["longest_foot_slide_cm"]
    assert before["spikes"] > 10 * after["spikes"]
    assert (before["gaps"], after["gaps"]) == (3, 0)
    assert after["issues"] == len(find_worst_issues(fixed.recording, quality))


def test_longest_slide_is_that_of_one_contact():
    """A foot that creeps 3 cm in one contact and 2 cm back in the next slides 3 cm, not 5."""
    walk = walking_gait(GaitSettings(duration=2.0, frame_rate=30.0))
    rotations, positions = (
        np.repeat(each[:1], 60, axis=0) for each in (walk.rotations, walk.root_positions)
    )
    positions[5:25, 0] += np.linspace(0.0, 0.03, 20)
    positions[25:, 0] += 0.03
    positions[35:55, 0] -= np.linspace(0.0, 0.02, 20)
    positions[55:, 0] -= 0.02
    contacts = np.ones((60, 2), bool)
    contacts[30] = False

    taken = measure_take(walk.with_poses(rotations, positions), contacts=contacts)

    assert taken.quality.longest_foot_slide == pytest.approx(0.03, abs=1e-9)


def test_steps_report_what_was_done(fixed):
    assert any("Plant Feet" in step for step in fixed.steps)


def test_steps_count_spikes_and_gaps_as_the_figures_do(fixed):
    before, after = fixed.figures()["before"], fixed.figures()["after"]
    spikes, gaps = (f"{before[name]} → {after[name]}" for name in ("spikes", "gaps"))

    assert before["spikes"] > after["spikes"] and before["gaps"] == 3
    assert f"Spikes {spikes}, gaps {gaps}." in fixed.steps


def test_feet_stay_as_they_are_on_request(noisy, clean):
    result = fix_take(noisy, settings=FixSettings(plant_feet=False))

    assert result.chain.planted is None
    assert_allclose(result.recording.rotations, clean.rotations, atol=1e-9)


def test_contacts_of_the_animator_are_used(noisy):
    contacts = np.zeros((noisy.n_frames, 7), bool)
    contacts[20:40, [0, 3]] = True

    result = fix_take(noisy, contacts=contacts)

    assert np.array_equal(result.chain.planted.all_contacts, contacts)
    assert "moving legs, arms and hips" in " ".join(result.chain.steps)


def test_skeleton_without_legs_is_cleaned_all_the_same():
    rng = np.random.default_rng(4)
    skeleton = Skeleton(("base", "tip"), (-1, 0), np.array([[0, 0, 0], [0, 0, 0.5]]))
    angles = 0.5 * np.sin(np.arange(60) / 8.0) + rng.normal(0.0, 0.05, 60)
    rotations = np.zeros((60, 2, 4))
    rotations[..., 0] = 1.0
    rotations[:, 0, 0], rotations[:, 0, 1] = np.cos(angles / 2), np.sin(angles / 2)

    result = fix_take(Motion(skeleton, rotations, np.zeros((60, 3)), 30.0))

    assert result.chain.planted is None
    assert result.headline.startswith("Feet were not planted.")
    assert result.after.quality.rotation_noise < 0.2 * result.before.quality.rotation_noise
    assert result.figures()["after"]["longest_foot_slide_cm"] is None


def test_body_of_a_video_model_is_recognized():
    names = (
        "pelvis", "left_hip", "left_knee", "left_ankle", "left_foot", "right_hip",
        "right_knee", "right_ankle", "right_foot", "spine1", "spine2", "spine3", "neck",
        "head", "left_collar", "left_shoulder", "left_elbow", "left_wrist",
    )  # fmt: skip
    parents = (-1, 0, 1, 2, 3, 0, 5, 6, 7, 0, 9, 10, 11, 12, 11, 14, 15, 16)
    offsets = np.zeros((len(names), 3))
    rotations = np.zeros((5, len(names), 4))
    rotations[..., 0] = 1.0
    motion = Motion(Skeleton(names, parents, offsets), rotations, np.zeros((5, 3)), 30.0)

    assert find_origin(motion) is TakeOrigin.VIDEO


def test_joints_of_a_camera_are_reconstructed_and_not_cleaned_again(camera_walk):
    result = fix_take(camera_walk)

    expected = reconstruct_recording(camera_walk).motion
    assert result.origin is TakeOrigin.CAMERA and result.chain.denoised is None
    assert_allclose(result.recording.rotations, expected.rotations, atol=1e-9)
    assert result.after.quality.rotation_noise < 0.3 * result.before.quality.rotation_noise


def test_armature_of_a_camera_is_reconstructed_on_its_skeleton(camera_walk):
    tracks = camera_walk.tracks
    motion = motion_from_points(tracks, vocabulary.joint_parents(tracks.names))
    tracked = MotionFromJoints(
        motion, tracking_state=camera_walk.tracking_state, sensor=camera_walk.sensor
    )

    result = fix_take(tracked)

    assert result.origin is TakeOrigin.CAMERA
    assert result.recording.skeleton is motion.skeleton
    assert result.recording.observed.all()
    assert result.before.n_gaps == measure_take(motion).n_gaps


def test_markers_become_a_skeleton_with_correct_labels(walk):
    markers = markers_on(walk)
    left, right = (markers.names.index(name) for name in ("LKNE", "RKNE"))
    positions = markers.positions.copy()
    positions[50:80, [left, right]] = positions[50:80, [right, left]]
    positions[100:110, markers.names.index("LANK")] = np.nan

    result = fix_take(markers.with_positions(positions))

    assert result.origin is TakeOrigin.MARKERS and len(result.chain.solved.swaps) == 1
    assert any("1 swapped label" in step for step in result.steps)
    assert isinstance(result.recording, Motion) and result.recording.observed.all()
    assert result.after.n_spikes == 0


def test_points_of_no_marker_set_are_cleaned(rng):
    time = np.arange(90)[:, None, None] / 30.0
    path = np.sin(time + np.arange(4)[None, :, None]) * np.array([0.3, 0.2, 0.1])
    noisy = path + rng.normal(scale=0.005, size=path.shape)
    points = Tracks(("a", "b", "c", "d"), noisy, 30.0)

    result = fix_take(points)

    assert result.origin is TakeOrigin.POINTS and isinstance(result.recording, Tracks)
    off = [np.sqrt(np.mean((each - path) ** 2)) for each in (noisy, result.recording.positions)]
    assert off[1] < 0.5 * off[0]
    assert result.figures()["before"]["jitter_deg"] is None


def test_take_without_observations_is_refused(walk):
    nothing = walk.with_poses(np.full_like(walk.rotations, np.nan), walk.root_positions)

    with pytest.raises(InvalidMotionError):
        fix_take(nothing)


def test_spikes_that_are_left_are_reported(fixed):
    n_left = fixed.after.n_spikes

    assert n_left == 1  # a thigh in the last two frames
    assert fixed.steps[-1].startswith("1 spike is left")
    assert fixed.figures()["steps"] == list(fixed.steps)


def test_number_of_issues_shows_that_check_lists_no_more():
    both = [dict.fromkeys(("spikes", "gaps"), 0) | {"issues": number} for number in (100, 99)]

    assert figure_texts(*both)[-1] == ("Issues", "100+", "99")


def test_figures_become_texts_with_units():
    before = {"jitter_deg": 2.614, "longest_foot_slide_cm": 26.28, "spikes": 57, "gaps": 4}
    before["issues"] = 77
    after = {"jitter_deg": 0.08, "longest_foot_slide_cm": None, "spikes": 0, "gaps": 0}

    assert figure_texts(before, after) == (
        ("Jitter", "2.61°", "0.08°"),
        ("Longest Slide", "26.3 cm", "–"),
        ("Spikes, Gaps", "61", "0"),
        ("Issues", "77", "–"),
    )


def test_issues_before_are_those_that_check_lists_of_the_take():
    """The slides are compared at the contacts of the result, where other feet slide."""
    walk = noisy_walk()
    result = fix_take(walk)

    issues = find_worst_issues(walk, measure_quality(walk))
    assert [each.sentence for each in result.before.issues] == [
        each.sentence for each in issues
    ]
    contacts = np.stack([foot.contact for foot in result.before.quality.feet], axis=1)
    assert (contacts == result.chain.planted.contacts).all()
